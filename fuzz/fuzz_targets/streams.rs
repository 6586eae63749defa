//! Streams of pictures: Y4M, PAM with its elders, and PFM.
#![no_main]

use cosmorama::raster::{Channels, Depth};
use cosmorama_fuzz::{picture, prepare};
use cosmorama_video::{
    ByteOrder, PamReader, PamWriter, PfmReader, PfmWriter, Ratio, Subsampling, Y4mFormat, Y4mReader, Y4mWriter,
};
use libfuzzer_sys::fuzz_target;

/// Memory that a frame may take.
const MEMORY: u64 = 1 << 20;

/// Frames that are read of a stream: some kilobytes hold many that are small.
const MOST: usize = 8;

fuzz_target!(init: prepare(seeds), |bytes: &[u8]| {
    if let Ok(mut reader) = Y4mReader::new(bytes, "in", MEMORY) {
        (0..MOST).take_while(|_| matches!(reader.next_frame(), Ok(Some(_)))).for_each(drop);
    }
    let mut reader = PamReader::new(bytes, "in", MEMORY);
    (0..MOST).take_while(|_| matches!(reader.next_frame(), Ok(Some(_)))).for_each(drop);
    let mut reader = PfmReader::new(bytes, "in", MEMORY);
    (0..MOST).take_while(|_| matches!(reader.next_frame(), Ok(Some(_)))).for_each(drop);
});

/// A stream of one frame of each kind, as we write them.
fn seeds() -> Vec<(String, Vec<u8>)> {
    [seeds_of_y4m(), seeds_of_pam(), seeds_of_pfm()].into_iter().flatten().flatten().collect()
}

fn seeds_of_y4m() -> Option<Vec<(String, Vec<u8>)>> {
    let kinds = [Subsampling::Grey, Subsampling::Jpeg420, Subsampling::C422, Subsampling::C444];
    let seed = |subsampling| {
        let format = Y4mFormat { subsampling, ..Y4mFormat::new((6, 4), Ratio::new(25, 1)?) };
        let channels = if subsampling == Subsampling::Grey { Channels::Grey } else { Channels::Rgb };
        let mut writer = Y4mWriter::new(Vec::new(), "out", format).ok()?;
        writer.write(&picture((6, 4), channels, Depth::Eight)).ok()?;
        Some((format!("{subsampling:?}.y4m"), writer.finish().ok()?))
    };
    kinds.into_iter().map(seed).collect()
}

fn seeds_of_pam() -> Option<Vec<(String, Vec<u8>)>> {
    let kinds = [(Channels::Grey, Depth::Eight), (Channels::Rgb, Depth::Sixteen), (Channels::Rgba, Depth::Eight)];
    let seed = |(channels, depth)| {
        let mut writer = PamWriter::new(Vec::new(), "out");
        writer.write(&picture((6, 4), channels, depth)).ok()?;
        Some((format!("{channels:?}.pam"), writer.finish().ok()?))
    };
    kinds.into_iter().map(seed).collect()
}

fn seeds_of_pfm() -> Option<Vec<(String, Vec<u8>)>> {
    let kinds = [(Channels::Grey, ByteOrder::Little), (Channels::Rgb, ByteOrder::Big)];
    let seed = |(channels, order)| {
        let mut writer = PfmWriter::new(Vec::new(), "out", order);
        writer.write(&picture((6, 4), channels, Depth::Float)).ok()?;
        Some((format!("{channels:?}.pfm"), writer.finish().ok()?))
    };
    kinds.into_iter().map(seed).collect()
}
