use cosmorama::raster::Transfer;

/// Table of ITU-T H.273 that a number belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Axis {
    Primaries,
    Transfer,
    Matrix,
}

/// Names that ffprobe prints, by the numbers of H.273.
const PRIMARIES: [(u8, &str); 12] = [
    (1, "bt709"),
    (4, "bt470m"),
    (5, "bt470bg"),
    (6, "smpte170m"),
    (7, "smpte240m"),
    (8, "film"),
    (9, "bt2020"),
    (10, "smpte428"),
    (11, "smpte431"),
    (12, "smpte432"),
    (22, "ebu3213"),
    (22, "jedec-p22"),
];
const TRANSFERS: [(u8, &str); 18] = [
    (1, "bt709"),
    (4, "bt470m"),
    (4, "gamma22"),
    (5, "bt470bg"),
    (5, "gamma28"),
    (6, "smpte170m"),
    (7, "smpte240m"),
    (8, "linear"),
    (9, "log100"),
    (10, "log316"),
    (11, "iec61966-2-4"),
    (12, "bt1361e"),
    (13, "iec61966-2-1"),
    (14, "bt2020-10"),
    (15, "bt2020-12"),
    (16, "smpte2084"),
    (17, "smpte428"),
    (18, "arib-std-b67"),
];
const MATRICES: [(u8, &str); 13] = [
    (0, "gbr"),
    (1, "bt709"),
    (4, "fcc"),
    (5, "bt470bg"),
    (6, "smpte170m"),
    (7, "smpte240m"),
    (8, "ycgco"),
    (9, "bt2020nc"),
    (10, "bt2020c"),
    (11, "smpte2085"),
    (12, "chroma-derived-nc"),
    (13, "chroma-derived-c"),
    (14, "ictcp"),
];

impl Axis {
    fn names(self) -> &'static [(u8, &'static str)] {
        match self {
            Self::Primaries => &PRIMARIES,
            Self::Transfer => &TRANSFERS,
            Self::Matrix => &MATRICES,
        }
    }

    /// Returns the number of ffprobe's name; `None` for unknown names, "unknown" among them.
    pub(crate) fn number(self, name: &str) -> Option<u8> {
        self.names().iter().find(|(_, known)| *known == name).map(|(number, _)| *number)
    }

    /// Returns the name of a number, or the number itself, for messages.
    pub(crate) fn name(self, number: u8) -> String {
        let known = self.names().iter().find(|(known, _)| *known == number);
        known.map_or_else(|| number.to_string(), |(_, name)| (*name).to_owned())
    }
}

/// Returns the number of ITU-T H.273 (table 3) of a transfer function; `None` if it has none. Of numbers that are read alike, the
/// one of BT.709 is written.
pub fn transfer_number(transfer: &Transfer) -> Option<u8> {
    let close = |gamma: f64, to: f64| (gamma - to).abs() < 1e-3;
    match transfer {
        Transfer::Bt1886 => Some(1),
        Transfer::Gamma(gamma) if close(*gamma, 2.2) => Some(4),
        Transfer::Gamma(gamma) if close(*gamma, 2.8) => Some(5),
        Transfer::Gamma(gamma) if close(*gamma, 2.4) => Some(1),
        Transfer::Linear => Some(8),
        Transfer::Srgb => Some(13),
        Transfer::Pq => Some(16),
        Transfer::Hlg => Some(18),
        Transfer::Gamma(_) | Transfer::Curve(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use cosmorama_io::transfer_of_number;

    use super::*;

    #[test]
    fn transfer_functions_and_numbers_agree() {
        for number in [1, 4, 5, 8, 13, 16, 18] {
            assert_eq!(transfer_number(&transfer_of_number(number).unwrap()), Some(number));
        }
        assert_eq!(transfer_of_number(2), None);
        assert_eq!(transfer_number(&Transfer::Gamma(1.8)), None);
    }

    #[test]
    fn names_are_those_of_ffprobe() {
        assert_eq!(Axis::Transfer.number("arib-std-b67"), Some(18));
        assert_eq!(Axis::Matrix.number("gbr"), Some(0));
        assert_eq!(Axis::Primaries.number("unknown"), None);
        assert_eq!((Axis::Primaries.name(9), Axis::Matrix.name(77)), ("bt2020".to_owned(), "77".to_owned()));
    }
}
