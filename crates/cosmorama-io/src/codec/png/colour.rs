//! Colour metadata in the chunks of a PNG.

use cosmorama::raster::Transfer;
use png::chunk::ChunkType;
use png::{CodingIndependentCodePoints, Info, ScaledFloat, SrgbRenderingIntent};

use crate::Metadata;
use crate::metadata::{gpano, icc};

pub(super) const CICP: ChunkType = ChunkType(*b"cICP");

/// Reads the chunks; by the specification the order of precedence is cICP, iCCP, sRGB, gAMA.
pub(super) fn metadata(info: &Info<'_>) -> Metadata {
    let profile = info.icc_profile.as_ref().map(|profile| profile.to_vec());
    let cicp = info.coding_independent_code_points;
    let transfer = cicp
        .and_then(|cicp| from_code_points(cicp.transfer_function))
        .or_else(|| profile.as_deref().and_then(icc::transfer))
        .or_else(|| info.srgb.map(|_| Transfer::Srgb))
        .or_else(|| info.gama_chunk.and_then(from_gamma));
    let software = info.uncompressed_latin1_text.iter().find(|text| text.keyword == "Software");
    let said = panorama(info).unwrap_or_default();
    Metadata {
        transfer,
        icc: profile,
        primaries: cicp.map(|cicp| cicp.color_primaries),
        panorama: said.window,
        complaints: said.complaints,
        software: software.map(|text| text.text.clone()),
        ..Metadata::default()
    }
}

/// Keyword of an XMP packet.
pub(super) const XMP: &str = "XML:com.adobe.xmp";
/// Greatest length of an XMP packet in bytes.
const LONGEST_PACKET: usize = 1 << 20;

fn panorama(info: &Info<'_>) -> Option<gpano::Said> {
    let mut packet = info.utf8_text.iter().find(|text| text.keyword == XMP)?.clone();
    packet.decompress_text_with_limit(LONGEST_PACKET).ok()?;
    Some(gpano::parse(packet.get_text().ok()?.as_bytes(), (info.width as usize, info.height as usize)))
}

/// Returns the transfer function of a code point of ITU-T H.273.
fn from_code_points(code: u8) -> Option<Transfer> {
    match code {
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

fn from_gamma(encoding: ScaledFloat) -> Option<Transfer> {
    let exponent = f64::from(encoding.into_scaled()) / 100_000.0;
    if !(0.01..=100.0).contains(&exponent) {
        return None;
    }
    if (exponent - 1.0).abs() < 1e-3 {
        return Some(Transfer::Linear);
    }
    Some(Transfer::Gamma(exponent.recip()))
}

/// Representation of a transfer function in the file.
pub(super) enum Tag {
    Srgb(SrgbRenderingIntent),
    Gamma(ScaledFloat),
    CodePoints(CodingIndependentCodePoints),
}

/// Returns the tag for a transfer function; `None` if only an ICC profile could describe it.
pub(super) fn tag(transfer: &Transfer, primaries: Option<u8>) -> Option<Tag> {
    let code_points = |transfer_function| {
        Some(Tag::CodePoints(CodingIndependentCodePoints {
            color_primaries: primaries.unwrap_or(1),
            transfer_function,
            matrix_coefficients: 0,
            is_video_full_range_image: true,
        }))
    };
    let other_primaries = primaries.is_some_and(|primaries| primaries != 1);
    match transfer {
        Transfer::Srgb if other_primaries => code_points(13),
        Transfer::Srgb => Some(Tag::Srgb(SrgbRenderingIntent::RelativeColorimetric)),
        Transfer::Linear if other_primaries => code_points(8),
        Transfer::Linear => Some(Tag::Gamma(ScaledFloat::from_scaled(100_000))),
        Transfer::Gamma(gamma) => Some(Tag::Gamma(ScaledFloat::from_scaled((100_000.0 / gamma).round() as u32))),
        Transfer::Bt1886 => code_points(1),
        Transfer::Pq => code_points(16),
        Transfer::Hlg => code_points(18),
        Transfer::Curve(_) => None,
    }
}
