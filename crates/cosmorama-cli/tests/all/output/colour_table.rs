//! The table of docs/colour.md: what becomes of each input's colours in each format.

use std::fmt::Write as _;
use std::path::Path;

use super::colour::tables;
use super::page_table::{self, FORMATS};
use crate::bench::{Bench, text};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Primaries, Rgba, Transfer};
use cosmorama_io::{EnvMap, Metadata, WriteOptions, probe, write};

fn said(transfer: Transfer, primaries: Primaries) -> Metadata {
    Metadata { transfer: Some(transfer), primaries: Some(primaries), ..Metadata::default() }
}

/// Inputs: what they say, their file's name and depth, and their metadata.
fn inputs() -> Vec<(&'static str, &'static str, Depth, Metadata)> {
    let white = Metadata { white_luminance: Some(100.0), ..said(Transfer::Linear, Primaries::AP1) };
    let cube = Metadata { envmap: Some(EnvMap::GlCube), ..said(Transfer::Srgb, Primaries::P3_D65) };
    let tables = Metadata { icc: Some(tables()), ..Metadata::default() };
    let linear = |primaries| said(Transfer::Linear, primaries);
    vec![
        ("8 bits without a tag", "a.png", Depth::Eight, Metadata::default()),
        ("PNG sRGB", "b.png", Depth::Eight, said(Transfer::Srgb, Primaries::REC709)),
        ("PNG cICP: Display P3", "c.png", Depth::Eight, said(Transfer::Srgb, Primaries::P3_D65)),
        ("PNG cICP: Rec. 2020, PQ", "d.png", Depth::Sixteen, said(Transfer::Pq, Primaries::REC2020)),
        ("PNG cICP: Rec. 2020, HLG", "e.png", Depth::Sixteen, said(Transfer::Hlg, Primaries::REC2020)),
        (
            "PNG gAMA, cHRM: Adobe RGB, gamma 2.2",
            "f.png",
            Depth::Eight,
            said(Transfer::Gamma(2.2), Primaries::ADOBE_RGB),
        ),
        ("JPEG ICC: Display P3", "g.jpg", Depth::Eight, said(Transfer::Srgb, Primaries::P3_D65)),
        ("TIFF ICC: tables", "h.tif", Depth::Eight, tables),
        ("TIFF ICC: ACEScg, floats", "i.tif", Depth::Float, linear(Primaries::AP1)),
        ("OpenEXR without a tag", "j.exr", Depth::Half, Metadata::default()),
        ("OpenEXR: ACEScg, white of 100 cd/m²", "k.exr", Depth::Half, white),
        ("Radiance HDR: Rec. 2020", "l.hdr", Depth::Float, linear(Primaries::REC2020)),
        ("KTX 2: Display P3", "m.ktx2", Depth::Eight, cube),
    ]
}

/// Writes a colour that all primaries can show.
fn save(bench: &Bench, name: &str, depth: Depth, metadata: &Metadata) {
    let is_cube = metadata.envmap.is_some();
    let (size, channels) = if is_cube { ((8, 48), Channels::Rgba) } else { ((16, 8), Channels::Rgb) };
    let usual = if depth.is_float() { Transfer::Linear } else { Transfer::Srgb };
    let transfer = metadata.transfer.clone().unwrap_or(usual);
    let image = Image::filled(size.0, size.1, Rgba::opaque(0.4, 0.5, 0.45));
    let encoded = EncodedImage::encode(&image, channels, depth, &transfer);
    write(bench.path(name), &encoded, &WriteOptions::with_metadata(metadata.clone())).unwrap();
}

/// What becomes of an input in a format.
fn cell(bench: &Bench, input: &str, extension: &str) -> String {
    let output = format!("out.{extension}");
    let shape: &[&str] = match (input.ends_with("ktx2"), extension) {
        (true, "ktx2" | "dds") => &["--to", "cube", "--size", "8"],
        (false, "ktx2" | "dds") => &["--from", "equirect", "--to", "cube", "--size", "8"],
        (true, _) => &["--to", "equirect", "--size", "16x8"],
        (false, _) => &["--from", "equirect", "--to", "equirect", "--size", "16x8"],
    };
    let run = bench.run(&[&["convert", input, &output, "-y"], shape].concat());
    let told = text(&run.stderr);
    if !run.status.success() {
        assert!(told.contains("ICC profile holds tables"), "{told}");
        return "refused".to_owned();
    }
    let path = bench.path(&output);
    let metadata = probe(&path).unwrap().metadata;
    let space = metadata.colour_space();
    let space = match (&space, &metadata.transfer, &metadata.icc) {
        (Some(space), ..) => space.clone(),
        (None, None, Some(_)) => "as it came".to_owned(),
        (None, Some(Transfer::Linear), _) => "linear sRGB".to_owned(),
        (None, ..) => "sRGB".to_owned(),
    };
    let mut cell = match tag(&path, extension, &metadata) {
        Some(tag) => format!("{space}: {tag}"),
        None => format!("{space}, no tag"),
    };
    if let Some(white) = metadata.white_luminance {
        let _ = write!(cell, ", white of {white} cd/m²");
    }
    if told.contains("its light is converted") || told.contains("encoded as sRGB") {
        cell += "; converted, told";
    } else {
        assert!(!told.contains("primaries"), "{told}");
    }
    cell
}

/// Name of the tag that an output has for its colours.
fn tag(path: &Path, extension: &str, metadata: &Metadata) -> Option<String> {
    let bytes = std::fs::read(path).unwrap();
    let has = |what: &[u8]| bytes.windows(what.len()).any(|window| window == what);
    let names: &[&str] = match extension {
        "png" => &["cICP", "iCCP", "sRGB", "gAMA", "cHRM"],
        "exr" => &["chromaticities", "colorInteropID"],
        "hdr" => &["PRIMARIES"],
        "jpg" | "tif" if metadata.icc.is_some() => return Some("ICC".to_owned()),
        "ktx2" => return Some("descriptor".to_owned()),
        _ => &[],
    };
    let found: Vec<&str> = names.iter().copied().filter(|name| has(name.as_bytes())).collect();
    (!found.is_empty()).then(|| found.join(", "))
}

#[test]
fn the_table_of_the_page_is_what_happens() {
    let bench = Bench::new();
    let mut rows = Vec::new();
    for (about, input, depth, metadata) in inputs() {
        save(&bench, input, depth, &metadata);
        let cells: String =
            FORMATS.iter().map(|(_, extension)| format!(" {} |", cell(&bench, input, extension))).collect();
        rows.push(format!("| {about} |{cells}"));
    }
    page_table::check("colour.md", "colour_table.rs", &rows);
}
