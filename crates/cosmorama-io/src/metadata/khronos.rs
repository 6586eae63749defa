//! Colours in a data format descriptor (Khronos Data Format Specification 1.4, sections 5.5 and 5.6).

use cosmorama::raster::{Primaries, Transfer};

/// Primaries by their number; `KHR_DF_PRIMARIES_…`.
const PRIMARIES: [(u8, Primaries); 10] = [
    (1, Primaries::REC709),
    (2, Primaries::REC601_625),
    (3, Primaries::REC601_525),
    (4, Primaries::REC2020),
    (5, Primaries::XYZ),
    (6, Primaries::AP0),
    (7, Primaries::AP1),
    (8, Primaries::NTSC1953),
    (10, Primaries::P3_D65),
    (11, Primaries::ADOBE_RGB),
];
/// Number for unspecified primaries.
pub(crate) const UNSPECIFIED: u8 = 0;

/// Returns the primaries with a number, if they are known.
pub(crate) fn primaries(number: u8) -> Option<Primaries> {
    PRIMARIES.iter().find(|(known, _)| *known == number).map(|(_, primaries)| *primaries)
}

/// Returns complaints about numbers of primaries and of a transfer function that are unknown here.
pub(crate) fn complaints(of_primaries: u8, of_transfer: u8) -> Vec<String> {
    let unknown = |is_known: bool, number: u8| !is_known && number != UNSPECIFIED;
    let of_primaries = unknown(primaries(of_primaries).is_some(), of_primaries).then(|| {
        format!(
            "the number of its primaries, {of_primaries}, is unknown here: they are taken for Rec. 709; expected 0 to 8, 10 or \
             11 of the Khronos Data Format Specification"
        )
    });
    let of_transfer = unknown(transfer(of_transfer).is_some(), of_transfer).then(|| {
        format!(
            "the number of its transfer function, {of_transfer}, is unknown here, and ignored; expected 0 to 3 or 7 to 11 of \
             the Khronos Data Format Specification"
        )
    });
    of_primaries.into_iter().chain(of_transfer).collect()
}

/// Returns the number of primaries; unspecified for those that have none.
pub(crate) fn primaries_code(primaries: Option<&Primaries>) -> u8 {
    let primaries = primaries.unwrap_or(&Primaries::REC709);
    PRIMARIES.iter().find(|(_, known)| known.is_same(primaries)).map_or(UNSPECIFIED, |(number, _)| *number)
}

/// Transfer functions by their number; `KHR_DF_TRANSFER_…`. PQ and HLG are those from code values to light.
const TRANSFERS: [(u8, Transfer); 8] = [
    (1, Transfer::Linear),
    (2, Transfer::Srgb),
    (7, Transfer::Bt1886),
    (3, Transfer::Bt1886),
    (8, Transfer::Hlg),
    (9, Transfer::Hlg),
    (10, Transfer::Pq),
    (11, Transfer::Pq),
];

/// Returns the transfer function with a number, if it is known.
pub(crate) fn transfer(number: u8) -> Option<Transfer> {
    TRANSFERS.iter().find(|(known, _)| *known == number).map(|(_, transfer)| transfer.clone())
}

/// Returns the number of a transfer function; 0, unspecified, for those that have none.
pub(crate) fn transfer_code(transfer: &Transfer) -> u8 {
    TRANSFERS.iter().find(|(_, known)| known == transfer).map_or(0, |(number, _)| *number)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unknown_numbers_are_complained_of() {
        assert!(complaints(4, 10).is_empty() && complaints(UNSPECIFIED, UNSPECIFIED).is_empty());
        let [primaries, transfer] = &complaints(99, 98)[..] else { panic!("two complaints") };
        assert!(primaries.contains("primaries, 99, is unknown") && transfer.contains("function, 98, is unknown"));
    }
}
