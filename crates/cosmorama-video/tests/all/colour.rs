//! Matrices and ranges against the closed form.

use std::path::Path;

use cosmorama::raster::Depth;
use cosmorama_video::{ColourTags, Ffmpeg, Ratio, ReadOptions, SignalRange, VideoWriter, WriteSettings};

use crate::common::{ffmpeg, frames, raw, rgb_picture, run, values};

/// Weights of red and blue by the number of a matrix.
fn weights(matrix: u8) -> (f64, f64) {
    match matrix {
        1 => (0.2126, 0.0722),
        6 => (0.299, 0.114),
        7 => (0.212, 0.087),
        9 => (0.2627, 0.0593),
        other => panic!("{other}"),
    }
}

/// Black, and distances from black to white and between the ends of chroma, of codes.
fn scale(range: SignalRange, bits: u32) -> (f64, f64, f64) {
    let step = f64::from(1 << (bits - 8));
    match range {
        SignalRange::Narrow => (16.0 * step, 219.0 * step, 224.0 * step),
        SignalRange::Full => (0.0, 256.0 * step - 1.0, 256.0 * step - 1.0),
    }
}

fn rgb([y, u, v]: [f64; 3], matrix: u8, range: SignalRange, bits: u32) -> [f64; 3] {
    let ((kr, kb), (black, luma, chroma)) = (weights(matrix), scale(range, bits));
    let neutral = f64::from(128 << (bits - 8));
    let (y, u, v) = ((y - black) / luma, (u - neutral) / chroma, (v - neutral) / chroma);
    let (red, blue) = (y + 2.0 * (1.0 - kr) * v, y + 2.0 * (1.0 - kb) * u);
    [red, (y - kr * red - kb * blue) / (1.0 - kr - kb), blue].map(|value| value.clamp(0.0, 1.0))
}

fn yuv([red, green, blue]: [f64; 3], matrix: u8, range: SignalRange, bits: u32) -> [f64; 3] {
    let ((kr, kb), (black, luma, chroma)) = (weights(matrix), scale(range, bits));
    let y = kr * red + (1.0 - kr - kb) * green + kb * blue;
    let (u, v) = ((blue - y) / (2.0 * (1.0 - kb)), (red - y) / (2.0 * (1.0 - kr)));
    let neutral = f64::from(128 << (bits - 8));
    [black + y * luma, neutral + u * chroma, neutral + v * chroma]
}

/// Colours of YUV that are colours of RGB, one for each of 16 × 16 pixels.
fn colours(matrix: u8, range: SignalRange, bits: u32) -> Vec<[u16; 3]> {
    let levels = |i: u32| [i % 7, i / 7 % 6, i / 42 % 6].map(|level| f64::from(level) / 6.0);
    (0..256)
        .map(|i| yuv(levels(i), matrix, range, bits).map(|code| code.round().min(f64::from((1 << bits) - 1)) as u16))
        .collect()
}

fn name(matrix: u8) -> &'static str {
    match matrix {
        1 => "bt709",
        6 => "smpte170m",
        7 => "smpte240m",
        _ => "bt2020nc",
    }
}

/// Makes a video of planar YUV with all chroma samples.
fn stored(path: &Path, codes: &[[u16; 3]], bits: u32, tags: &str) {
    let input = path.with_extension("raw");
    let planes = (0..3).flat_map(|axis| codes.iter().map(move |code| code[axis]));
    let bytes: Vec<u8> =
        if bits > 8 { planes.flat_map(u16::to_le_bytes).collect() } else { planes.map(|code| code as u8).collect() };
    std::fs::write(&input, bytes).unwrap();
    let format = if bits > 8 { format!("yuv444p{bits}le") } else { "yuv444p".to_owned() };
    run(&format!("-f rawvideo -pix_fmt {format} -s 16x16 -i {} -c:v ffv1 {tags}", input.to_str().unwrap()), path);
}

fn check(ffmpeg: &Ffmpeg, path: &Path, matrix: u8, range: SignalRange, bits: u32) {
    let codes = colours(matrix, range, bits);
    let found = frames(ffmpeg, path, ReadOptions::default()).unwrap();
    let found = values(&found[0].image);
    for (index, (code, pixel)) in codes.iter().zip(found.chunks(3)).enumerate() {
        let expected = rgb(code.map(f64::from), matrix, range, bits);
        let error = (0..3).map(|c| (pixel[c] - expected[c]).abs()).fold(0.0, f64::max);
        // One code of the source.
        let allowed = 1.0 / f64::from((1 << bits) - 1);
        assert!(error <= allowed, "{matrix} {range:?} {bits} bits, colour {index}: {pixel:?} {expected:?}");
    }
}

#[test]
fn matrices_and_ranges_are_those_of_the_tags() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    for matrix in [1, 6, 7, 9] {
        for (range, bits) in
            [(SignalRange::Narrow, 8), (SignalRange::Full, 8), (SignalRange::Narrow, 10), (SignalRange::Full, 12)]
        {
            let path = folder.path().join(format!("{matrix}-{range:?}-{bits}.mkv"));
            let tags = format!("-colorspace {} -color_range {}", name(matrix), range.name());
            stored(&path, &colours(matrix, range, bits), bits, &tags);
            let info = ffmpeg.probe(&path).unwrap();
            assert_eq!((info.colour.matrix, info.colour.range, info.bits), (Some(matrix), Some(range), bits));
            check(&ffmpeg, &path, matrix, range, bits);
        }
    }
}

/// Without a tag, small pictures are of BT.601 and narrow range.
#[test]
fn what_is_not_tagged_is_read_by_its_size() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mkv");
    stored(&path, &colours(6, SignalRange::Narrow, 8), 8, "");
    assert_eq!(ffmpeg.probe(&path).unwrap().colour.matrix, None);
    check(&ffmpeg, &path, 6, SignalRange::Narrow, 8);
}

/// Chroma of a quarter is filled up, and patches keep their colours.
#[test]
fn patches_keep_their_colours_with_fewer_chroma_samples() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (input, path) = (folder.path().join("a.raw"), folder.path().join("a.mkv"));
    let patches = [[180, 100, 150], [60, 160, 110], [120, 128, 128], [200, 90, 140]];
    let plane = |axis: usize, size: usize| {
        (0..size * size).map(move |at| patches[at / size / (size / 2) * 2 + at % size / (size / 2)][axis] as u8)
    };
    let bytes: Vec<u8> = plane(0, 32).chain(plane(1, 16)).chain(plane(2, 16)).collect();
    std::fs::write(&input, bytes).unwrap();
    let source = format!("-f rawvideo -pix_fmt yuv420p -s 32x32 -i {}", input.to_str().unwrap());
    run(&format!("{source} -c:v ffv1 -colorspace bt709 -color_range tv"), &path);
    let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    let found = values(&found[0].image);
    for (index, patch) in patches.iter().enumerate() {
        let (i, j) = (index % 2 * 16 + 8, index / 2 * 16 + 8);
        let expected = rgb(patch.map(f64::from), 1, SignalRange::Narrow, 8);
        let pixel = &found[(j * 32 + i) * 3..][..3];
        let error = (0..3).map(|c| (pixel[c] - expected[c]).abs()).fold(0.0, f64::max);
        assert!(error <= 1.0 / 255.0, "{index}: {pixel:?} {expected:?}");
    }
}

/// Ramp of chroma over 32 columns: three codes each, so that a sample at the wrong place is seen.
fn ramp(column: usize) -> f64 {
    90.0 + 3.0 * column.min(31) as f64
}

/// Chroma samples lie at the left one of two columns, where no tag says otherwise: read by the video's own tag, or none.
#[test]
fn chroma_is_read_at_its_columns() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (input, path) = (folder.path().join("a.raw"), folder.path().join("a.mkv"));
    for (format, rows) in [("yuv422p", 8), ("yuv420p", 4), ("yuv422p10le", 8), ("yuv420p10le", 4)] {
        let step = if format.ends_with("10le") { 4.0 } else { 1.0 };
        let grey = |count: usize, code: f64| vec![code * step; count];
        let chroma: Vec<f64> = (0..16 * rows).map(|at| ramp(2 * (at % 16)) * step).collect();
        let codes = [grey(32 * 8, 126.0), chroma, grey(16 * rows, 128.0)].concat();
        let bytes: Vec<u8> = if step > 1.0 {
            codes.iter().flat_map(|code| (*code as u16).to_le_bytes()).collect()
        } else {
            codes.iter().map(|code| *code as u8).collect()
        };
        std::fs::write(&input, bytes).unwrap();
        let source = format!("-f rawvideo -pix_fmt {format} -s 32x8 -i {}", input.to_str().unwrap());
        run(&format!("{source} -c:v ffv1 -colorspace bt709 -color_range tv"), &path);
        let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let found = values(&found[0].image);
        for column in 4..28 {
            let expected = rgb([126.0, ramp(column), 128.0], 1, SignalRange::Narrow, 8);
            let blue = found[(4 * 32 + column) * 3 + 2];
            // Half a column is 0.0124 of blue.
            assert!((blue - expected[2]).abs() <= 0.0075, "{format}, column {column}: {blue} {}", expected[2]);
        }
    }
}

/// And written so.
#[test]
fn chroma_is_written_at_its_columns() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    let pixel = |at: usize| rgb([126.0, ramp(at % 64), 128.0], 1, SignalRange::Narrow, 8);
    for (depth, codec) in [(Depth::Eight, "-crf 0"), (Depth::Sixteen, "-x265-params lossless=1:log-level=error")] {
        let image = rgb_picture((64, 64), depth, (0..64 * 64).flat_map(pixel));
        let arguments = codec.split(' ').map(str::to_owned).collect();
        let settings = WriteSettings { depth, arguments, ..WriteSettings::new((64, 64), Ratio::new(25, 1).unwrap()) };
        let mut writer = VideoWriter::create(&ffmpeg, &path, settings, &Default::default()).unwrap();
        writer.write(&image, None).unwrap();
        writer.finish().unwrap();
        let bytes = raw(&path, if depth == Depth::Eight { "yuv420p" } else { "yuv420p10le" });
        let step = if depth == Depth::Eight { 1 } else { 4 };
        for column in 2..14 {
            let at = 64 * 64 + 16 * 32 + column;
            let code = if step == 1 {
                f64::from(bytes[at])
            } else {
                f64::from(u16::from_le_bytes([bytes[2 * at], bytes[2 * at + 1]])) / 4.0
            };
            // In the middle of two columns it would be 1.5 more.
            let expected = ramp(2 * column);
            assert!((code - expected).abs() <= 0.75, "{depth}, column {column}: {code} {expected}");
        }
    }
}

/// What is written has the matrix and range that it says, in codes within one of the closed form.
#[test]
fn what_is_written_has_the_codes_of_its_tags() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let levels = |at: usize| [at % 5, at / 5 % 5, at / 25 % 4].map(|level| level as f64 / 4.0);
    for (matrix, range, bits, codec) in [
        (1, SignalRange::Narrow, 8, "-crf 0"),
        (6, SignalRange::Full, 8, "-crf 0"),
        (9, SignalRange::Narrow, 10, "-x265-params lossless=1:log-level=error"),
    ] {
        let path = folder.path().join(format!("{matrix}.mp4"));
        let depth = if bits > 8 { Depth::Sixteen } else { Depth::Eight };
        // Patches of 16 x 16 pixels, so that chroma has one colour in its middle.
        let pixel = |at: usize| levels(at / 64 / 16 * 4 + at % 64 / 16);
        let image = rgb_picture((64, 64), depth, (0..64 * 64).flat_map(pixel));
        let primaries = if matrix == 9 { 9 } else { 1 };
        let colour = ColourTags {
            primaries: Some(primaries),
            transfer: Some(1),
            matrix: Some(matrix),
            range: Some(range),
            chroma: None,
        };
        let arguments = codec.split(' ').map(str::to_owned).collect();
        let settings =
            WriteSettings { depth, colour, arguments, ..WriteSettings::new((64, 64), Ratio::new(25, 1).unwrap()) };
        let mut writer = VideoWriter::create(&ffmpeg, &path, settings, &Default::default()).unwrap();
        writer.write(&image, None).unwrap();
        writer.finish().unwrap();
        let info = ffmpeg.probe(&path).unwrap();
        assert_eq!((info.colour.matrix, info.colour.range, info.bits), (Some(matrix), Some(range), bits), "{matrix}");
        assert_eq!(info.colour.primaries, Some(primaries));
        let format = if bits > 8 {
            "yuv420p10le"
        } else if range == SignalRange::Full {
            "yuvj420p"
        } else {
            "yuv420p"
        };
        let bytes = raw(&path, format);
        let codes: Vec<f64> = if bits > 8 {
            bytes.chunks(2).map(|pair| f64::from(u16::from_le_bytes([pair[0], pair[1]]))).collect()
        } else {
            bytes.iter().map(|code| f64::from(*code)).collect()
        };
        for patch in 0..16 {
            let (i, j) = (patch % 4 * 16 + 8, patch / 4 * 16 + 8);
            let chroma = 64 * 64 + j / 2 * 32 + i / 2;
            let found = [codes[j * 64 + i], codes[chroma], codes[chroma + 32 * 32]];
            let expected = yuv(levels(patch), matrix, range, bits);
            let error = (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f64::max);
            // Half a code for rounding, and half a code for ffmpeg's tables.
            assert!(error <= 1.0, "{matrix} {bits} bits, patch {patch}: {found:?} {expected:?}");
        }
    }
}
