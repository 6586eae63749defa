use cosmorama::raster::Transfer;

/// Returns the transfer function of a number of ITU-T H.273 (table 3); `None` if it is unknown here. The curves of BT.709,
/// BT.601 and BT.2020 cameras are read as displays show them, by BT.1886.
pub fn transfer_of_number(number: u8) -> Option<Transfer> {
    match number {
        1 | 6 | 14 | 15 => Some(Transfer::Bt1886),
        4 => Some(Transfer::Gamma(2.2)),
        5 => Some(Transfer::Gamma(2.8)),
        8 => Some(Transfer::Linear),
        13 => Some(Transfer::Srgb),
        16 => Some(Transfer::Pq),
        18 => Some(Transfer::Hlg),
        _ => None,
    }
}
