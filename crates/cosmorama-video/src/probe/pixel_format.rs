/// Properties of ffmpeg's pixel formats, by their names.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct PixelFormat {
    pub(super) bits: u32,
    pub(super) has_alpha: bool,
    pub(super) is_grey: bool,
    pub(super) is_rgb: bool,
}

impl PixelFormat {
    /// Returns the properties of a name; `None` for floats, for colours that are neither RGB nor YUV, and for pictures that lie in
    /// another device's memory.
    pub(super) fn of_name(name: &str) -> Option<Self> {
        let stem = name.trim_end_matches("le").trim_end_matches("be");
        if stem.is_empty() || stem.contains("f32") || stem.contains("f16") || stem.starts_with("xyz") {
            return None;
        }
        let starts = |stems: &[&str]| stems.iter().any(|start| stem.starts_with(start));
        let is_grey = starts(&["gray", "ya8", "ya16", "monow", "monob"]);
        let is_rgb = starts(&[
            "gbr", "rgb", "bgr", "argb", "abgr", "rgba", "bgra", "0rgb", "0bgr", "x2rgb", "x2bgr", "pal8", "bayer",
        ]);
        let is_yuv = starts(&["yuv", "nv", "uyvy", "yvyu", "yuyv", "p0", "p2", "p4", "y2", "ayuv", "vuy", "xv", "v30"]);
        if !(is_grey || is_rgb || is_yuv) {
            return None;
        }
        let has_alpha = ["yuva", "gbrap", "argb", "abgr", "rgba", "bgra", "ya8", "ya16", "ayuv", "vuya", "pal8"]
            .iter()
            .any(|alpha| stem.starts_with(alpha));
        Some(Self { bits: bits(stem), has_alpha, is_grey, is_rgb })
    }
}

/// Returns the bits of a sample, which stand at the end of the name where they are not 8.
fn bits(stem: &str) -> u32 {
    match stem {
        "rgb48" | "bgr48" | "rgba64" | "bgra64" | "ya16" | "gray16" | "ayuv64" => return 16,
        "nv20" | "y210" | "x2rgb10" | "x2bgr10" | "xv30" | "v30x" => return 10,
        "y212" | "xv36" => return 12,
        _ => {}
    }
    let letters = stem.trim_end_matches(|letter: char| letter.is_ascii_digit());
    let digits = &stem[letters.len()..];
    // Of p010, p216 and others of their kind, the first digit is of the sampling.
    let digits = if letters == "p" && digits.len() == 3 { &digits[1..] } else { digits };
    let is_depth = letters.ends_with('p') || letters == "gray";
    match digits.parse() {
        Ok(bits @ 9..=16) if is_depth => bits,
        _ => 8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_bits_alpha_and_kind() {
        let of = |name: &str| {
            PixelFormat::of_name(name).map(|found| (found.bits, found.has_alpha, found.is_grey, found.is_rgb))
        };
        for (name, bits) in [
            ("yuv420p", 8),
            ("yuvj444p", 8),
            ("yuv420p10le", 10),
            ("yuv422p12be", 12),
            ("yuv444p16le", 16),
            ("p010le", 10),
            ("p216le", 16),
            ("nv12", 8),
            ("nv20le", 10),
            ("uyvy422", 8),
            ("y210le", 10),
            ("yuyv422", 8),
        ] {
            assert_eq!(of(name), Some((bits, false, false, false)), "{name}");
        }
        for (name, bits) in
            [("rgb24", 8), ("gbrp", 8), ("gbrp12le", 12), ("rgb48le", 16), ("bgr0", 8), ("x2rgb10le", 10)]
        {
            assert_eq!(of(name), Some((bits, false, false, true)), "{name}");
        }
        assert_eq!(of("yuva444p10le"), Some((10, true, false, false)));
        assert_eq!(of("gbrap16le"), Some((16, true, false, true)));
        assert_eq!(of("rgba64le"), Some((16, true, false, true)));
        assert_eq!(of("gray12le"), Some((12, false, true, false)));
        assert_eq!(of("ya16be"), Some((16, true, true, false)));
        for name in ["gbrpf32le", "xyz12le", "vaapi", "cuda", ""] {
            assert_eq!(of(name), None, "{name}");
        }
    }
}
