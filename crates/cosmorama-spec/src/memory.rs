use std::str::FromStr;

use crate::number::decimal;

/// An amount of memory: bytes, with `K`, `M`, `G` or `T` (powers of 1024), or a percentage of free memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MemorySize {
    /// Number of bytes.
    Bytes(u64),
    /// Fraction of free memory; 1 is all of it.
    Part(f64),
}

impl FromStr for MemorySize {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        parse(text).ok_or_else(|| {
            "expected 1 byte or more, as in 500M or 8G (K, M, G or T), or a part of free memory, more than 0% and at most 100%"
                .to_owned()
        })
    }
}

/// Prints bytes, or a percentage.
impl std::fmt::Display for MemorySize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Bytes(bytes) => write!(f, "{bytes}"),
            Self::Part(part) => write!(f, "{}%", decimal(part * 100.0, |percent| percent / 100.0 == *part)),
        }
    }
}

fn parse(text: &str) -> Option<MemorySize> {
    if let Some(percent) = text.strip_suffix('%') {
        let percent: f64 = percent.parse().ok()?;
        return (percent > 0.0 && percent <= 100.0).then_some(MemorySize::Part(percent / 100.0));
    }
    let digits = text.find(|letter: char| !letter.is_ascii_digit() && letter != '.').unwrap_or(text.len());
    let (number, unit) = text.split_at(digits);
    let unit = match unit.trim_start().trim_end_matches(['b', 'B']).trim_end_matches('i') {
        "" => 1u64,
        "k" | "K" => 1 << 10,
        "m" | "M" => 1 << 20,
        "g" | "G" => 1 << 30,
        "t" | "T" => 1 << 40,
        _ => return None,
    };
    let bytes = number.parse::<f64>().ok()? * unit as f64;
    (1.0..1e18).contains(&bytes).then_some(MemorySize::Bytes(bytes as u64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts() {
        assert_eq!("512".parse(), Ok(MemorySize::Bytes(512)));
        assert_eq!("1.5GiB".parse(), Ok(MemorySize::Bytes(3 << 29)));
        assert_eq!("20MB".parse(), Ok(MemorySize::Bytes(20 << 20)));
        assert_eq!("50%".parse(), Ok(MemorySize::Part(0.5)));
        for wrong in ["", "0", "lots", "5X", "0%", "200%", "-3G"] {
            assert!(wrong.parse::<MemorySize>().is_err(), "{wrong}");
        }
    }
}
