use std::fmt;
use std::str::FromStr;

/// The size of a picture in pixels: `WxH`, or the width alone.
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
        let expected = || format!("expected WxH or a width, in pixels from 1 to {most}, as in 1966x1436 or 4096");
        let side = |text: &str| text.parse().ok().filter(|side| (1..=most).contains(side)).ok_or_else(expected);
        match text.split_once(['x', 'X', '×']) {
            Some((width, height)) => Ok(Self { width: side(width)?, height: Some(side(height)?) }),
            None => Ok(Self { width: side(text)?, height: None }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes() {
        assert_eq!("1966x1436".parse(), Ok(Size { width: 1966, height: Some(1436) }));
        assert_eq!("4096".parse(), Ok(Size { width: 4096, height: None }));
        for wrong in ["0", "0x4", "4x", "-3", "wide", "99999999"] {
            assert!(wrong.parse::<Size>().is_err(), "{wrong}");
        }
    }
}
