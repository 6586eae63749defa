use std::fmt;

/// Version of ffmpeg.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Version {
    /// First number.
    pub major: u32,
    /// Second number.
    pub minor: u32,
}

/// First number of libavutil's version, less the first of ffmpeg's, since version 5.
const LIBAVUTIL: u32 = 52;

impl Version {
    /// Finds the version in what `ffmpeg -version` prints. Builds of a day name no version; their libavutil tells it.
    pub(crate) fn of_words(text: &str) -> Option<Self> {
        let word = text.lines().next().and_then(|line| line.split(" version ").nth(1)).unwrap_or_default();
        Self::of_number(word.trim_start_matches('n')).or_else(|| Self::of_libavutil(text))
    }

    fn of_number(word: &str) -> Option<Self> {
        let mut numbers = word.split(|letter: char| !letter.is_ascii_digit());
        let major = numbers.next()?.parse().ok()?;
        let is_dotted = word.trim_start_matches(|letter: char| letter.is_ascii_digit()).starts_with('.');
        let minor = if is_dotted { numbers.next()?.parse().ok()? } else { 0 };
        // Builds of a day may begin with the year.
        (major < 1000).then_some(Self { major, minor })
    }

    fn of_libavutil(text: &str) -> Option<Self> {
        let line = text.lines().find_map(|line| line.trim_start().strip_prefix("libavutil"))?;
        let mut numbers = line.split(['.', '/']).map(|number| number.trim().parse::<u32>());
        let (major, minor) = (numbers.next()?.ok()?, numbers.next()?.ok()?);
        match major {
            57.. => Some(Self { major: major - LIBAVUTIL, minor: 0 }),
            // 4.4 came with 56.70.
            56 if minor >= 70 => Some(Self { major: 4, minor: 4 }),
            _ => Some(Self { major: 4, minor: 0 }),
        }
    }
}

impl fmt::Display for Version {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.major, self.minor)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_are_found_in_all_builds() {
        let of = |text: &str| Version::of_words(text).map(|version| (version.major, version.minor));
        assert_eq!(of("ffmpeg version 5.1.9-0+deb12u1 Copyright (c)"), Some((5, 1)));
        assert_eq!(of("ffprobe version n4.4.2 Copyright"), Some((4, 4)));
        assert_eq!(of("ffmpeg version 8 Copyright"), Some((8, 0)));
        let daily = "ffmpeg version N-109468-gd39b34123d Copyright\nlibavutil      57. 44.100 / 57. 44.100\n";
        assert_eq!(of(daily), Some((5, 0)));
        let dated = "ffmpeg version 2023-01-01-git-62da0b4a74 Copyright\nlibavutil      56. 70.100 / 56. 70.100\n";
        assert_eq!(of(dated), Some((4, 4)));
        assert_eq!(of("hello"), None);
    }
}
