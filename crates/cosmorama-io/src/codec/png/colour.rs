//! Colour metadata in the chunks of a PNG.

use std::sync::Arc;

use cosmorama::raster::{Primaries, Transfer};
use png::chunk::ChunkType;
use png::{CodingIndependentCodePoints, ColorType, Info, ScaledFloat, SourceChromaticities, SrgbRenderingIntent};

use super::carried::Found;
use crate::metadata::{colour_name, gpano, icc, orientation, transfer_of_number};
use crate::{Exif, Metadata, TextChunk};

pub(super) const CICP: ChunkType = ChunkType(*b"cICP");

/// Reads the chunks; by the specification the order of precedence is cICP, iCCP, sRGB, gAMA with cHRM.
pub(super) fn metadata(info: &Info<'_>, found: Found) -> Metadata {
    let Found { carried, packet, complaints, has_profile, .. } = found;
    let software = carried.texts.iter().find(|text| text.keyword() == "Software").and_then(TextChunk::text);
    let orientation = carried.exif.as_ref().and_then(Exif::orientation);
    let size = orientation::turned((info.width as usize, info.height as usize), orientation);
    let said = packet.map(|packet| gpano::parse(packet.as_bytes(), size)).unwrap_or_default();
    let other = Metadata {
        panorama: said.window,
        pose: said.pose,
        complaints: [said.complaints, complaints].concat(),
        orientation,
        carried: Arc::new(carried),
        rescaled: rescaled(info),
        ..Metadata::by(software)
    };
    colour(info, other, has_profile && info.icc_profile.is_none())
}

/// Adds the colours that the chunk of highest precedence gives, and complains of chunks that contradict it.
fn colour(info: &Info<'_>, mut metadata: Metadata, is_damaged: bool) -> Metadata {
    let profile = info.icc_profile.as_ref().map(|profile| profile.to_vec());
    let (primaries, transfer) = (info.chrm_chunk.and_then(from_chromaticities), info.gama_chunk.and_then(from_gamma));
    let chroma = |used: Option<Primaries>| {
        let other = primaries.filter(|said| used.is_some_and(|used| !used.is_same(said)));
        other.map(|other| ("its cHRM chunk", other.to_string()))
    };
    let srgb = info.srgb.map(|_| ("its sRGB chunk", "sRGB".to_owned()));
    match cicp(info) {
        Some(Err(unknown)) => metadata.complaints.push(unknown),
        Some(Ok((primaries, transfer))) => {
            let profile =
                Metadata::default().with_profile(profile).colour_space().map(|name| ("its ICC profile", name));
            let damaged = is_damaged.then(|| ("its ICC profile", "nothing, since it is damaged".to_owned()));
            let metadata = Metadata { primaries, transfer, ..metadata };
            return told("cICP", metadata, [profile.or(damaged), srgb, chroma(primaries)]).with_range(info);
        }
        None => {}
    }
    if is_damaged {
        return metadata.with_damaged_profile("its iCCP chunk cannot be unpacked");
    }
    if profile.is_some() {
        let metadata = metadata.with_profile(profile);
        let is_read = metadata.profile_fault.is_none();
        let chroma = chroma(metadata.primaries);
        return told("iCCP", metadata, [srgb.filter(|_| is_read), chroma]);
    }
    if info.srgb.is_some() {
        let chroma = chroma(Some(Primaries::REC709));
        // The gAMA chunk can only approximate such a function.
        let steep =
            transfer.filter(|transfer| !matches!(transfer, Transfer::Gamma(gamma) if (2.1..2.3).contains(gamma)));
        let gamma = colour_name(steep.as_ref().map(|_| &Primaries::REC709), steep.as_ref());
        let metadata = Metadata { primaries: Some(Primaries::REC709), transfer: Some(Transfer::Srgb), ..metadata };
        return told("sRGB", metadata, [chroma, gamma.map(|gamma| ("its gAMA chunk", gamma))]);
    }
    if info.chrm_chunk.is_some() && primaries.is_none() {
        metadata.complaints.push("its cHRM chunk is ignored: its red, green and blue span no triangle".to_owned());
    }
    Metadata { primaries, transfer, ..metadata }
}

/// Adds complaints about statements that contradict the chunk that takes precedence.
fn told<const N: usize>(chunk: &str, mut metadata: Metadata, sayings: [Option<(&str, String)>; N]) -> Metadata {
    let name = metadata.colour_space().unwrap_or_else(|| "nothing of primaries or encoding".to_owned());
    for (place, other) in sayings.into_iter().flatten().filter(|(_, other)| *other != name) {
        metadata.complaints.push(format!(
            "its {chunk} chunk says {name} and {place} {other}; {chunk} comes first, as the PNG specification has it"
        ));
    }
    metadata
}

/// Returns what the stored codes are where they are not read as they are.
fn rescaled(info: &Info<'_>) -> Option<String> {
    let bits = info.bit_depth as u8;
    let is_small = bits < 8 && info.color_type == ColorType::Grayscale;
    if is_narrow(info) {
        return Some("of narrow range, as in video".to_owned());
    }
    is_small.then(|| format!("of {bits} bits"))
}

/// Returns whether code values run from 16 to 235, as in video.
pub(super) fn is_narrow(info: &Info<'_>) -> bool {
    let narrow = info.coding_independent_code_points.is_some_and(|cicp| !cicp.is_video_full_range_image);
    narrow && matches!(cicp(info), Some(Ok(_)))
}

/// Primaries and transfer function of a cICP chunk.
type Coded = (Option<Primaries>, Option<Transfer>);

/// Reads the cICP chunk; the error says why it is ignored.
fn cicp(info: &Info<'_>) -> Option<Result<Coded, String>> {
    let cicp = info.coding_independent_code_points?;
    let ignored = |what: &str, number: u8, expected: &str| {
        Some(Err(format!("its cICP chunk is ignored: {what} {number} is unknown here, expected {expected}")))
    };
    let primaries = Primaries::of_number(cicp.color_primaries);
    if primaries.is_none() && cicp.color_primaries != UNSPECIFIED {
        return ignored("the number of its primaries,", cicp.color_primaries, "one of ITU-T H.273's, 1 to 12 or 22");
    }
    if (cicp.color_primaries, cicp.transfer_function) == (UNSPECIFIED, UNSPECIFIED) {
        return None;
    }
    let transfer = transfer_of_number(cicp.transfer_function);
    if transfer.is_none() && cicp.transfer_function != UNSPECIFIED {
        return ignored("the transfer function", cicp.transfer_function, "1, 4 to 6, 8, 13 to 16 or 18 of ITU-T H.273");
    }
    Some(Ok((primaries, transfer)))
}

/// Number of ITU-T H.273 for an unspecified value.
const UNSPECIFIED: u8 = 2;

impl Metadata {
    fn with_range(mut self, info: &Info<'_>) -> Self {
        if is_narrow(info) {
            self.notes
                .push("its code values are of narrow range, as in video; they are read as of full range".to_owned());
        }
        self
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

fn from_chromaticities(chunk: SourceChromaticities) -> Option<Primaries> {
    let pair = |(x, y): (ScaledFloat, ScaledFloat)| [x, y].map(|number| f64::from(number.into_scaled()) / 100_000.0);
    Primaries::of_pairs(pair(chunk.red), pair(chunk.green), pair(chunk.blue), pair(chunk.white))
}

/// Representation of colours in the file.
pub(super) enum Tag {
    Srgb(SrgbRenderingIntent),
    Gamma(ScaledFloat, Option<SourceChromaticities>),
    CodePoints(CodingIndependentCodePoints),
    Profile(Vec<u8>),
}

/// Returns the tag for a transfer function and primaries; `None` if the transfer function has none.
pub(super) fn tag(transfer: &Transfer, primaries: Option<&Primaries>) -> Option<Tag> {
    let primaries = primaries.unwrap_or(&Primaries::REC709);
    let is_usual = primaries.is_same(&Primaries::REC709);
    let profile = || icc::made(transfer, primaries).map(Tag::Profile);
    let code_points = |transfer_function| match primaries.number() {
        None => profile(),
        Some(color_primaries) => Some(Tag::CodePoints(CodingIndependentCodePoints {
            color_primaries,
            transfer_function,
            matrix_coefficients: 0,
            is_video_full_range_image: true,
        })),
    };
    let gamma = |gamma: f64| {
        let exponent = ScaledFloat::from_scaled((100_000.0 / gamma).round() as u32);
        if is_usual {
            return Some(Tag::Gamma(exponent, None));
        }
        chromaticities(primaries).map_or_else(profile, |chroma| Some(Tag::Gamma(exponent, Some(chroma))))
    };
    match transfer {
        Transfer::Srgb if is_usual => Some(Tag::Srgb(SrgbRenderingIntent::RelativeColorimetric)),
        Transfer::Srgb => code_points(13),
        Transfer::Linear if !is_usual && primaries.number().is_some() => code_points(8),
        Transfer::Linear => gamma(1.0),
        Transfer::Gamma(exponent) => gamma(*exponent),
        Transfer::Bt1886 => code_points(1),
        Transfer::Pq => code_points(16),
        Transfer::Hlg => code_points(18),
        Transfer::Curve(_) => profile(),
    }
}

/// Returns the chunk of primaries; `None` where a coordinate is negative, which the chunk cannot hold.
fn chromaticities(primaries: &Primaries) -> Option<SourceChromaticities> {
    let scaled = |number: f64| (number >= 0.0).then(|| ScaledFloat::from_scaled((number * 100_000.0).round() as u32));
    let pair = |[x, y]: [f64; 2]| Some((scaled(x)?, scaled(y)?));
    let [red, green, blue, white] = primaries.pairs().map(pair);
    Some(SourceChromaticities { white: white?, red: red?, green: green?, blue: blue? })
}
