use std::fmt;

/// Positive rational number in lowest terms, such as 30000/1001 frames a second, or 1/90000 seconds a tick.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Ratio {
    numerator: u32,
    denominator: u32,
}

impl Ratio {
    /// One.
    pub const ONE: Self = Self { numerator: 1, denominator: 1 };

    /// Creates a number in lowest terms; `None` unless both parts are positive, and fit into 31 bits in lowest terms, as ffmpeg
    /// wants them.
    pub fn new(numerator: u64, denominator: u64) -> Option<Self> {
        let divisor = greatest_common_divisor(numerator, denominator);
        if numerator == 0 || denominator == 0 {
            return None;
        }
        let part = |part: u64| i32::try_from(part / divisor).ok().map(i32::unsigned_abs);
        Some(Self { numerator: part(numerator)?, denominator: part(denominator)? })
    }

    /// Parses `30000/1001`, `30000:1001` or `25`; `None` for anything else.
    pub fn parse(text: &str) -> Option<Self> {
        let (numerator, denominator) = text.split_once(['/', ':']).unwrap_or((text, "1"));
        Self::new(numerator.trim().parse().ok()?, denominator.trim().parse().ok()?)
    }

    /// Returns the number above the line.
    pub const fn numerator(self) -> u32 {
        self.numerator
    }

    /// Returns the number below the line.
    pub const fn denominator(self) -> u32 {
        self.denominator
    }

    /// Returns one divided by the number.
    #[must_use]
    pub const fn inverse(self) -> Self {
        Self { numerator: self.denominator, denominator: self.numerator }
    }

    /// Returns the nearest float.
    pub fn to_f64(self) -> f64 {
        f64::from(self.numerator) / f64::from(self.denominator)
    }

    /// Returns `count` times this number in units of `unit`, rounded to the nearest, upwards from the middle. So ticks of one
    /// clock become ticks of another.
    pub fn rescale(self, count: i64, unit: Self) -> i64 {
        let above = i128::from(count) * i128::from(self.numerator) * i128::from(unit.denominator);
        let below = i128::from(self.denominator) * i128::from(unit.numerator);
        let rounded = (2 * above + below).div_euclid(2 * below);
        rounded.clamp(i128::from(i64::MIN), i128::from(i64::MAX)) as i64
    }
}

impl fmt::Display for Ratio {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}/{}", self.numerator, self.denominator)
    }
}

fn greatest_common_divisor(a: u64, b: u64) -> u64 {
    if b == 0 { a.max(1) } else { greatest_common_divisor(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_in_lowest_terms() {
        let ratio = Ratio::parse("60000/2002").unwrap();
        assert_eq!((ratio.numerator(), ratio.denominator()), (30000, 1001));
        assert_eq!(Ratio::parse("25"), Ratio::new(50, 2));
        assert_eq!(Ratio::parse("16:9").unwrap().to_string(), "16/9");
        for wrong in ["", "0/0", "0/1", "1/0", "-1/2", "x", "4294967296/1", "1/2/3"] {
            assert_eq!(Ratio::parse(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn ticks_are_rounded_to_the_nearest() {
        let (film, fine) = (Ratio::parse("1001/30000").unwrap(), Ratio::parse("1/90000").unwrap());
        assert_eq!(film.rescale(7, fine), 21021);
        assert_eq!(fine.rescale(21020, film), 7);
        assert_eq!(fine.rescale(-21020, film), -7);
        assert_eq!(Ratio::ONE.rescale(i64::MAX, fine), i64::MAX);
    }
}
