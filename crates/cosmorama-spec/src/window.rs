use std::fmt;

use cosmorama::camera::Canvas;

/// Greatest coordinate of a canvas or its window, the limit of OpenEXR's coordinates.
const FARTHEST: i64 = i32::MAX as i64;

/// Parses a canvas with the place of its window: `WxH+X+Y`, where X and Y may be negative (`+-8` or `-8`).
pub(crate) fn parse_window(text: &str) -> Option<Canvas> {
    let (width, rest) = text.split_once('x')?;
    let height_end = rest.find(['+', '-'])?;
    let (height, offsets) = rest.split_at(height_end);
    let top_start = offsets
        .char_indices()
        .skip(1)
        .find(|(index, sign)| matches!(sign, '+' | '-') && !offsets[..*index].ends_with(['+', '-']))?;
    let (left, top) = offsets.split_at(top_start.0);
    let (width, height) = (width.parse().ok()?, height.parse().ok()?);
    let is_side = |side: usize| (1..=FARTHEST as usize).contains(&side);
    (is_side(width) && is_side(height)).then_some(())?;
    Some(Canvas { width, height, left: offset(left)?, top: offset(top)? })
}

/// A canvas that prints as [`parse_window`] reads it.
pub(crate) struct Window(pub(crate) Canvas);

impl fmt::Display for Window {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Canvas { width, height, left, top } = self.0;
        write!(f, "{width}x{height}{left:+}{top:+}")
    }
}

fn offset(text: &str) -> Option<i64> {
    let offset: i64 = text.strip_prefix('+').unwrap_or(text).parse().ok()?;
    (-FARTHEST..=FARTHEST).contains(&offset).then_some(offset)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_are_written_as_others_write_them() {
        let canvas = |left, top| Some(Canvas { width: 1024, height: 768, left, top });
        assert_eq!(parse_window("1024x768+512+0"), canvas(512, 0));
        assert_eq!(parse_window("1024x768-8+16"), canvas(-8, 16));
        assert_eq!(parse_window("1024x768+-8+-16"), canvas(-8, -16));
        assert_eq!(parse_window("1024x768+2147483647+0"), canvas(2_147_483_647, 0));
        for wrong in ["1024x768+2147483648+0", "1x1-9223372036854775808+0", "2147483648x1+0+0"] {
            assert_eq!(parse_window(wrong), None, "{wrong}");
        }
        for wrong in ["1024x768", "1024x768+1", "0x768+0+0", "x+0+0", "1024x768+0+0+0", ""] {
            assert_eq!(parse_window(wrong), None, "{wrong}");
        }
    }
}
