use std::fmt;
use std::str::FromStr;

use cosmorama::raster::Depth;

use crate::error::{WordError, WordKind, nearest};

/// The sample type of an output, by name: `8`, `10`, `12`, `16`, `half` or `float`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthName(pub Depth);

impl DepthName {
    /// All sample types, in the order of the help.
    pub const ALL: [Self; 6] = [
        Self(Depth::Eight),
        Self(Depth::Ten),
        Self(Depth::Twelve),
        Self(Depth::Sixteen),
        Self(Depth::Half),
        Self(Depth::Float),
    ];

    /// Returns the name that users type.
    pub fn name(self) -> &'static str {
        match self.0 {
            Depth::Eight => "8",
            Depth::Ten => "10",
            Depth::Twelve => "12",
            Depth::Sixteen => "16",
            Depth::Half => "half",
            Depth::Float => "float",
        }
    }

    /// Returns a line of help.
    pub fn about(self) -> &'static str {
        match self.0 {
            Depth::Eight => "8-bit integers",
            Depth::Ten => "10 bits, spread over 16-bit integers",
            Depth::Twelve => "12 bits, spread over 16-bit integers",
            Depth::Sixteen => "16-bit integers",
            Depth::Half => "16-bit floats",
            Depth::Float => "32-bit floats",
        }
    }
}

impl fmt::Display for DepthName {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// Other programs' words for sample types, each with our name.
const OTHER_NAMES: [(&[&str], &str); 6] = [
    (&["32", "32f", "f32", "float32", "32-bit", "32bit", "single", "full"], "float"),
    (&["16f", "f16", "float16", "half-float", "fp16"], "half"),
    (&["byte", "u8", "uint8", "8-bit", "8bit", "rgb24"], "8"),
    (&["10-bit", "10bit"], "10"),
    (&["12-bit", "12bit"], "12"),
    (&["u16", "uint16", "16-bit", "16bit", "short", "rgb48"], "16"),
];

impl FromStr for DepthName {
    type Err = WordError;

    fn from_str(text: &str) -> Result<Self, WordError> {
        let word = text.to_ascii_lowercase();
        Self::ALL.into_iter().find(|depth| depth.name() == text).ok_or_else(|| {
            let names = Self::ALL.map(Self::name);
            let other = OTHER_NAMES.iter().find(|(words, _)| words.contains(&word.as_str())).map(|(_, name)| *name);
            let meant = other.or_else(|| nearest(&word, &names)).map(str::to_owned);
            WordError::Unknown { what: WordKind::Depth, word: text.to_owned(), meant, known: names.join(", ") }
        })
    }
}

impl From<DepthName> for Depth {
    fn from(depth: DepthName) -> Self {
        depth.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_programs_words_are_answered_by_ours() {
        for (words, name) in OTHER_NAMES {
            assert!(name.parse::<DepthName>().is_ok(), "{name}");
            for word in words {
                let message = word.parse::<DepthName>().unwrap_err().to_string();
                let expected = format!("unknown depth '{word}'; did you mean '{name}'? There are 8, 10, 12");
                assert!(message.starts_with(&expected), "{message}");
            }
        }
    }
}
