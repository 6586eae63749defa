//! First line of a stream.

use super::{Subsampling, Y4mFormat, usual_matrix};
use crate::{Ratio, SignalRange};

/// First word of a stream.
pub(super) const MAGIC: &str = "YUV4MPEG2";

/// First word of a frame.
pub(super) const FRAME: &str = "FRAME";

/// Reads the line; the error says what is wrong.
pub(super) fn parse(line: &str) -> Result<Y4mFormat, String> {
    let mut words = line.split(' ');
    if words.next() != Some(MAGIC) {
        return Err(format!("it is no YUV4MPEG2; expected {MAGIC} at its beginning"));
    }
    let (mut width, mut height, mut rate, mut pixel_aspect) = (None, None, None, None);
    let (mut layout, mut range) = ("420jpeg", SignalRange::Narrow);
    for word in words.filter(|word| !word.is_empty()) {
        let (name, value) = word.split_at(word.chars().next().map_or(0, char::len_utf8));
        match name {
            "W" => width = value.parse::<usize>().ok(),
            "H" => height = value.parse::<usize>().ok(),
            "F" => rate = Ratio::parse(value),
            "A" => pixel_aspect = Ratio::parse(value),
            "C" => layout = value,
            "I" if !matches!(value, "p" | "?") => {
                return Err(format!("its frames are interlaced (I{value}); expected Ip: deinterlace it first"));
            }
            "X" => range = range_of(value).unwrap_or(range),
            _ => {}
        }
    }
    let (Some(width), Some(height)) = (width, height) else {
        return Err("its first line names no size; expected W and H with numbers".to_owned());
    };
    let rate = rate.ok_or("its first line names no frame rate; expected F with two numbers, as in F25:1")?;
    let (subsampling, bits) = layout_of(layout).ok_or_else(|| {
        format!("its samples lie as C{layout}; expected C420jpeg, C420mpeg2, C422, C444, C444alpha or Cmono, or p10, p12 or p16")
    })?;
    let size = (width, height);
    Ok(Y4mFormat { size, rate, pixel_aspect, subsampling, bits, range, matrix: usual_matrix(size) })
}

fn range_of(value: &str) -> Option<SignalRange> {
    match value.strip_prefix("COLORRANGE=")? {
        "FULL" => Some(SignalRange::Full),
        "LIMITED" => Some(SignalRange::Narrow),
        _ => None,
    }
}

/// Returns the places and bits of a word such as `420p10`.
fn layout_of(word: &str) -> Option<(Subsampling, u32)> {
    let eight = match word {
        "420" | "420jpeg" => Some(Subsampling::Jpeg420),
        "420mpeg2" => Some(Subsampling::Mpeg420),
        "422" => Some(Subsampling::C422),
        "444" => Some(Subsampling::C444),
        "444alpha" => Some(Subsampling::C444Alpha),
        "mono" => Some(Subsampling::Grey),
        _ => None,
    };
    if let Some(eight) = eight {
        return Some((eight, 8));
    }
    let (places, bits) = word.strip_prefix("mono").map(|bits| ("mono", bits)).or_else(|| word.split_once('p'))?;
    let bits = bits.parse().ok().filter(|bits| (9..=16).contains(bits))?;
    match places {
        "420" => Some((Subsampling::Mpeg420, bits)),
        "422" => Some((Subsampling::C422, bits)),
        "444" => Some((Subsampling::C444, bits)),
        "mono" => Some((Subsampling::Grey, bits)),
        _ => None,
    }
}

/// Returns the first line of a format; `None` if it has no word for the samples.
pub(super) fn line(format: &Y4mFormat) -> Option<String> {
    let eight = format.bits == 8;
    let places = match (format.subsampling, eight) {
        (Subsampling::Jpeg420, true) => "420jpeg",
        (Subsampling::Mpeg420, true) => "420mpeg2",
        (Subsampling::Mpeg420, false) => "420",
        (Subsampling::C422, _) => "422",
        (Subsampling::C444, _) => "444",
        (Subsampling::C444Alpha, true) => "444alpha",
        (Subsampling::Grey, _) => "mono",
        (Subsampling::Jpeg420 | Subsampling::C444Alpha, false) => return None,
    };
    let bits = match format.bits {
        8 => String::new(),
        bits @ (10 | 12 | 16) if format.subsampling == Subsampling::Grey => bits.to_string(),
        bits @ (10 | 12 | 16) => format!("p{bits}"),
        _ => return None,
    };
    let range = match format.range {
        SignalRange::Narrow => "LIMITED",
        SignalRange::Full => "FULL",
    };
    let (width, height) = format.size;
    let part = |ratio: Ratio| format!("{}:{}", ratio.numerator(), ratio.denominator());
    let aspect = format.pixel_aspect.map_or_else(|| "0:0".to_owned(), part);
    Some(format!(
        "{MAGIC} W{width} H{height} F{} Ip A{aspect} C{places}{bits} XCOLORRANGE={range}\n",
        part(format.rate)
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn first_lines_are_read_and_written() {
        let ffmpeg = "YUV4MPEG2 W64 H32 F30000:1001 Ip A1:1 C420mpeg2 XYSCSS=420MPEG2 XCOLORRANGE=LIMITED";
        let format = parse(ffmpeg).unwrap();
        assert_eq!((format.size, format.rate.to_string()), ((64, 32), "30000/1001".to_owned()));
        assert_eq!((format.subsampling, format.bits, format.range), (Subsampling::Mpeg420, 8, SignalRange::Narrow));
        assert_eq!((format.matrix, format.chroma_size()), (6, (32, 16)));
        assert_eq!(parse("YUV4MPEG2 W1921 H3 F25:1").unwrap().matrix, 1);
        for layout in ["420jpeg", "420mpeg2", "420p10", "422", "422p12", "444", "444p16", "444alpha", "mono", "mono10"]
        {
            let format = parse(&format!("YUV4MPEG2 W5 H3 F25:1 Ip C{layout} XCOLORRANGE=FULL")).unwrap();
            assert_eq!(format.range, SignalRange::Full);
            let line = line(&format).unwrap();
            assert_eq!(parse(line.trim_end()).unwrap(), format);
            assert!(line.contains(&format!(" C{layout} ")), "{line}");
        }
    }

    #[test]
    fn other_first_lines_are_refused() {
        for (line, word) in [
            ("RIFF", "YUV4MPEG2"),
            ("YUV4MPEG2 H3 F25:1", "size"),
            ("YUV4MPEG2 W4 H3", "frame rate"),
            ("YUV4MPEG2 W4 H3 F25:1 It", "interlaced"),
            ("YUV4MPEG2 W4 H3 F25:1 C411", "C411"),
            ("YUV4MPEG2 W4 H3 F25:1 C420paldv", "C420paldv"),
            ("YUV4MPEG2 W4 H3 F25:1 C420p99", "C420p99"),
        ] {
            assert!(parse(line).unwrap_err().contains(word), "{line}");
        }
    }
}
