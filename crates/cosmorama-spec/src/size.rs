use std::fmt;
use std::str::FromStr;

/// The size of a picture in pixels: `WxH`, or the width alone; `4k` is 4096.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: usize,
    /// Rows, if given.
    pub height: Option<usize>,
}

impl Size {
    /// Largest number of columns or rows; no image format holds more.
    pub const MOST: usize = 1_000_000;
}

impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.height {
            Some(height) => write!(f, "{}x{height}", self.width),
            None => write!(f, "{}", self.width),
        }
    }
}

impl FromStr for Size {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let most = Self::MOST;
        let other = text.trim_end_matches("px").replace(['*', ':', ',', '/', ' '], "x");
        let meant = || if other == text { None } else { other.parse::<Self>().ok() };
        let expected = || match meant() {
            Some(size) => format!("write {size}"),
            None => format!("expected WxH or a width, in pixels from 1 to {most}, as in 1966x1436, 4096 or 4k"),
        };
        let side = |text: &str| pixels(text).filter(|side| (1..=most).contains(side)).ok_or_else(expected);
        match text.split_once(['x', 'X', '×']) {
            Some((width, height)) => Ok(Self { width: side(width)?, height: Some(side(height)?) }),
            None => Ok(Self { width: side(text)?, height: None }),
        }
    }
}

/// Parses a number of pixels; `k` multiplies by 1024, since pictures of 2k, 4k and 8k are powers of two wide.
fn pixels(text: &str) -> Option<usize> {
    match text.strip_suffix(['k', 'K']) {
        Some(thousands) => thousands.parse::<usize>().ok()?.checked_mul(1024),
        None => text.parse().ok(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!("1966x1436".parse(), Ok(Size { width: 1966, height: Some(1436) }));
        assert_eq!("4096".parse(), Ok(Size { width: 4096, height: None }));
        for (text, width) in [("2k", 2048), ("4k", 4096), ("8K", 8192)] {
            assert_eq!(text.parse(), Ok(Size { width, height: None }));
        }
        assert_eq!("8kx4k".parse(), Ok(Size { width: 8192, height: Some(4096) }));
        for wrong in ["0", "0x4", "4x", "-3", "wide", "99999999", "k", "0k", "4kk", "18446744073709551615k"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
        for (typed, size) in
            [("512px", "512"), ("640:480", "640x480"), ("640*480", "640x480"), ("640,480px", "640x480")]
        {
            assert_eq!(typed.parse::<Size>(), Err(format!("write {size}")));
        }
    }
}
