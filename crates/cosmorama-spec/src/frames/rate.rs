use std::fmt;
use std::str::FromStr;

/// Constant rate of a video: so many frames in so many seconds, as typed: `25`, `30000/1001` or `29.97`.
///
/// Decimals within 0.005 of one of television's rates mean that rate.
///
/// ```
/// use cosmorama_spec::FrameRate;
/// assert_eq!("29.97".parse(), Ok(FrameRate { frames: 30_000, seconds: 1001 }));
/// assert_eq!("12.5".parse::<FrameRate>()?.to_string(), "25/2");
/// # Ok::<(), String>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrameRate {
    /// Number of frames, at least 1.
    pub frames: u32,
    /// Number of seconds that they take, at least 1.
    pub seconds: u32,
}

/// Whole rates whose 1000/1001 television uses.
const TELEVISION: [u32; 6] = [24, 30, 48, 60, 120, 240];

/// Most frames in a second, and most seconds for a frame.
const MOST: f64 = 100_000.0;

impl FrameRate {
    /// Returns the number of frames in a second.
    pub fn per_second(self) -> f64 {
        f64::from(self.frames) / f64::from(self.seconds)
    }

    fn of_fraction(frames: u32, seconds: u32) -> Option<Self> {
        let divisor = greatest_common_divisor(frames, seconds);
        let is_possible = frames > 0 && seconds > 0;
        let rate = is_possible.then(|| Self { frames: frames / divisor, seconds: seconds / divisor });
        rate.filter(|rate| (MOST.recip()..=MOST).contains(&rate.per_second()))
    }

    fn of_decimal(text: &str) -> Option<Self> {
        let (whole, fraction) = text.split_once('.')?;
        let is_number = |digits: &str| digits.bytes().all(|byte| byte.is_ascii_digit());
        if whole.is_empty() || !is_number(whole) || !is_number(fraction) || fraction.is_empty() {
            return None;
        }
        let number: f64 = text.parse().ok()?;
        let of_television = |whole: &&u32| (f64::from(**whole) * 1000.0 / 1001.0 - number).abs() < 0.005;
        if let Some(whole) = TELEVISION.iter().find(of_television) {
            return Self::of_fraction(whole * 1000, 1001);
        }
        let digits = fraction.len().min(4);
        let below = 10_u32.pow(digits as u32);
        let above: u32 = format!("{whole}{}", &fraction[..digits]).parse().ok()?;
        Self::of_fraction(above, below)
    }
}

impl FromStr for FrameRate {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let fraction = || {
            let (frames, seconds) = text.split_once('/').unwrap_or((text, "1"));
            Self::of_fraction(frames.parse().ok()?, seconds.parse().ok()?)
        };
        Self::of_decimal(text)
            .or_else(fraction)
            .ok_or_else(|| "expected a number of frames a second above 0, such as 25, 30000/1001 or 29.97".to_owned())
    }
}

impl fmt::Display for FrameRate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self { frames, seconds: 1 } => write!(f, "{frames}"),
            Self { frames, seconds } => write!(f, "{frames}/{seconds}"),
        }
    }
}

fn greatest_common_divisor(a: u32, b: u32) -> u32 {
    if b == 0 { a.max(1) } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rate(text: &str) -> FrameRate {
        text.parse().unwrap()
    }

    #[test]
    fn rates_are_exact() {
        for (text, printed) in [
            ("25", "25"),
            ("50/2", "25"),
            ("29.97", "30000/1001"),
            ("23.976", "24000/1001"),
            ("59.94", "60000/1001"),
            ("12.5", "25/2"),
        ] {
            assert_eq!(rate(text).to_string(), printed);
            assert_eq!(rate(printed), rate(text));
        }
    }

    #[test]
    fn what_is_no_rate() {
        for wrong in ["", "0", "0/1", "1/0", "-25", "x", "1e3", "25.", ".5", "1000000", "1/2/3", "nan", "5000000000"] {
            assert!(wrong.parse::<FrameRate>().is_err(), "{wrong}");
        }
    }
}
