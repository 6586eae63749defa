use cosmorama::world::Canvas;

/// A canvas with the place of its window: `WxH+X+Y`, X and Y possibly negative (`+-8` or `-8`).
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
    (width > 0 && height > 0).then_some(())?;
    Some(Canvas { width, height, left: offset(left)?, top: offset(top)? })
}

fn offset(text: &str) -> Option<i64> {
    text.strip_prefix('+').unwrap_or(text).parse().ok()
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
        for wrong in ["1024x768", "1024x768+1", "0x768+0+0", "x+0+0", "1024x768+0+0+0", ""] {
            assert_eq!(parse_window(wrong), None, "{wrong}");
        }
    }
}
