/// Selection from a file that holds more than one picture: a part, and channels. Only OpenEXR files hold several.
///
/// ```
/// use cosmorama_io::Choice;
///
/// let choice = Choice { channels: vec!["diffuse.*".to_owned()], ..Choice::default() };
/// assert!(choice.takes("diffuse.R") && !choice.takes("specular.R"));
/// assert!(Choice::default().takes("specular.R"));
/// ```
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Choice {
    /// Name of a part, or its number from 0; the first part with a picture, unless given.
    pub part: Option<String>,
    /// Names of channels, in which `*` stands for any letters and `?` for one. Empty for all.
    pub channels: Vec<String>,
    /// Whether channels that form no picture are accepted.
    pub without_picture: bool,
}

impl Choice {
    /// Returns whether a channel is chosen.
    pub fn takes(&self, channel: &str) -> bool {
        self.channels.is_empty() || self.channels.iter().any(|pattern| matches(pattern, channel))
    }
}

/// Returns whether a name is one of those that a pattern stands for.
pub(crate) fn matches(pattern: &str, name: &str) -> bool {
    let (pattern, name): (Vec<char>, Vec<char>) = (pattern.chars().collect(), name.chars().collect());
    // Position of the last star, and where the name continues after it. If the rest does not match, the star takes one
    // letter more.
    let (mut p, mut n, mut star) = (0, 0, None);
    while n < name.len() {
        if p < pattern.len() && pattern[p] == '*' {
            star = Some((p, n));
            p += 1;
        } else if p < pattern.len() && (pattern[p] == '?' || pattern[p] == name[n]) {
            (p, n) = (p + 1, n + 1);
        } else if let Some((at, from)) = star {
            star = Some((at, from + 1));
            (p, n) = (at + 1, from + 1);
        } else {
            return false;
        }
    }
    pattern[p..].iter().all(|letter| *letter == '*')
}

#[cfg(test)]
mod tests {
    use super::matches;

    #[test]
    fn stars_stand_for_any_letters() {
        for (pattern, name, expected) in [
            ("Z", "Z", true),
            ("Z", "z", false),
            ("diffuse.*", "diffuse.R", true),
            ("diffuse.*", "diffuse", false),
            ("*.R", "a.b.R", true),
            ("*.?", "N.XY", false),
            ("crypto*.R", "cryptoObject00.R", true),
            ("*a*b", "aabab", true),
            ("*a*b", "aaba", false),
            ("*", "", true),
            ("", "Z", false),
        ] {
            assert_eq!(matches(pattern, name), expected, "{pattern} {name}");
        }
    }
}
