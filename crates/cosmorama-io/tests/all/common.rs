//! Pictures for tests.

use std::path::{Path, PathBuf};

use cosmorama::raster::{AlphaMode, Channels, Depth, EncodedImage, Samples};
use half::f16;

/// A picture that no codec finds easy: gradients, noise, extremes; alpha never quite zero.
pub(crate) fn picture(width: usize, height: usize, channels: Channels, depth: Depth) -> EncodedImage {
    let count = width * height * channels.count();
    let noise = |i: usize| (i as u32).wrapping_mul(2_654_435_761) >> 16;
    let value = |i: usize| {
        let alpha = channels.has_alpha() && i % channels.count() == channels.count() - 1;
        let smooth = (i / channels.count() % width) as u32 * 65535 / width as u32;
        if alpha { smooth.max(600) } else { (smooth + noise(i) / 8).min(65535) }
    };
    let spread = |value: u32, bits: u32| {
        let code = value >> (16 - bits);
        (code << (16 - bits) | code >> (2 * bits - 16)) as u16
    };
    let samples = match depth {
        Depth::Eight => Samples::U8((0..count).map(|i| (value(i) >> 8) as u8).collect()),
        Depth::Ten => Samples::U16((0..count).map(|i| spread(value(i), 10)).collect()),
        Depth::Twelve => Samples::U16((0..count).map(|i| spread(value(i), 12)).collect()),
        Depth::Sixteen => Samples::U16((0..count).map(|i| value(i) as u16).collect()),
        Depth::Half => Samples::Half((0..count).map(|i| f16::from_f32(value(i) as f32 / 65535.0)).collect()),
        Depth::Float => Samples::Float((0..count).map(|i| value(i) as f32 / 65535.0).collect()),
    };
    let mode = if depth.is_float() { AlphaMode::Premultiplied } else { AlphaMode::Straight };
    EncodedImage::new(width, height, channels, depth, samples).unwrap().with_alpha_mode(mode)
}

/// A KTX file of the first version: the faces of a cube with these texels, each row at a multiple of four bytes.
pub(crate) fn ktx(edge: u32, kind: u32, order: u32, faces: &[u8]) -> Vec<u8> {
    let numbers = [0x0403_0201, kind, 1, order, order, order, edge, edge, 0, 0, 6, 1, 0, faces.len() as u32 / 6];
    let mut bytes = b"\xabKTX 11\xbb\r\n\x1a\n".to_vec();
    numbers.iter().for_each(|number: &u32| bytes.extend(number.to_le_bytes()));
    bytes.extend(faces);
    bytes
}

/// A file of the shared folder; `None`, loudly, where that is not at hand. In CI it must be.
pub(crate) fn shared(path: &str) -> Option<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared");
    if root.is_dir() {
        return Some(root.join(path));
    }
    assert!(std::env::var_os("CI").is_none(), "{} is missing", root.display());
    eprintln!("SKIPPED: {} is missing", root.display());
    None
}

/// The files of a folder, in order.
pub(crate) fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// A program, if it is installed; its absence is said loudly.
pub(crate) fn program(name: &'static str) -> Option<&'static str> {
    let runs = std::process::Command::new(name).arg("-version").output().is_ok();
    if !runs {
        assert!(std::env::var_os("CI").is_none(), "{name} is not installed");
        eprintln!("SKIPPED: {name} is not installed");
    }
    runs.then_some(name)
}
