//! Streams of pictures, before ffmpeg and back.

use std::io::Cursor;
use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_video::{
    ByteOrder, PamReader, PamWriter, PfmReader, PfmWriter, Ratio, ReadOptions, SignalRange, Subsampling, VideoError,
    Y4mFormat, Y4mReader, Y4mWriter,
};

use crate::common::{difference, ffmpeg, frames, picture, raw, rgb_picture, run};

const MEMORY: u64 = 1 << 24;

/// A picture without detail finer than chroma samples.
fn smooth(width: usize, height: usize, depth: Depth, number: usize) -> EncodedImage {
    let value = |at: usize| {
        let (c, i, j) = (at % 3, at / 3 % width, at / 3 / width);
        let waves = [i as f64 / 11.0, j as f64 / 9.0, (i + j) as f64 / 14.0 + number as f64];
        0.5 + 0.35 * waves[c].sin()
    };
    let count = width * height * 3;
    rgb_picture((width, height), depth, (0..count).map(value))
}

fn image(bytes: &[u8], width: usize, height: usize) -> EncodedImage {
    EncodedImage::new(width, height, Channels::Rgb, Depth::Eight, Samples::U8(bytes.to_vec())).unwrap()
}

/// Largest differences of two frames, of 1: but in the last column, and there.
fn differences(a: &EncodedImage, b: &EncodedImage) -> (f64, f64) {
    let (row, pixel) = (a.width() * a.channels().count(), a.channels().count());
    let (a, b) = (crate::common::values(a), crate::common::values(b));
    let each = a.iter().zip(&b).map(|(a, b)| (a - b).abs()).enumerate();
    each.fold(
        (0.0, 0.0),
        |(inner, last): (f64, f64), (at, off)| {
            if at % row < row - pixel { (inner.max(off), last) } else { (inner, last.max(off)) }
        },
    )
}

/// Places of chroma samples for ffmpeg's filter, which takes the middle of two columns unless told otherwise. Y4M's own word for
/// that is 420jpeg; all others mean the left column.
fn place(side: &str, is_jpeg: bool) -> String {
    if is_jpeg { String::new() } else { format!("{side}_h_chr_pos=0:") }
}

/// What ffmpeg writes as Y4M we read as it reads the file itself.
#[test]
fn y4m_of_ffmpeg_is_read() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let (source, stream) = (folder.path().join("a.raw"), folder.path().join("a.y4m"));
    let pictures: Vec<EncodedImage> = (0..3).map(|number| smooth(64, 48, Depth::Eight, number)).collect();
    let bytes: Vec<u8> = pictures
        .iter()
        .flat_map(|picture| match picture.samples() {
            Samples::U8(samples) => samples.clone(),
            _ => Vec::new(),
        })
        .collect();
    std::fs::write(&source, bytes).unwrap();
    let input = format!("-f rawvideo -pix_fmt rgb24 -s 64x48 -i {}", source.to_str().unwrap());
    for (format, range) in [
        ("yuv420p", "tv"),
        ("yuvj420p", "pc"),
        ("yuv420p10le", "tv"),
        ("yuv422p", "tv"),
        ("yuv444p", "tv"),
        ("yuv422p12le", "tv"),
        ("yuv444p16le", "tv"),
    ] {
        let place = place("out", ["yuv420p", "yuvj420p"].contains(&format));
        let filter = format!(
            "scale=out_color_matrix=bt601:out_range={range}:{place}flags=accurate_rnd+full_chroma_int+full_chroma_inp"
        );
        run(
            &format!("{input} -vf {filter} -pix_fmt {format} -color_range {range} -strict -1 -f yuv4mpegpipe"),
            &stream,
        );
        let mut reader = Y4mReader::new(Cursor::new(std::fs::read(&stream).unwrap()), "in", MEMORY).unwrap();
        assert_eq!(reader.format().size, (64, 48));
        for picture in &pictures {
            let found = reader.next_frame().unwrap().unwrap();
            // The last column has no chroma sample of its own: ten bits have that of the column before, where eight bits, sited in the middle,
            // have one half as far away.
            let (allowed, most) = match format {
                "yuv444p" | "yuv444p16le" => (2.5, 2.5),
                "yuv422p" | "yuv422p12le" => (4.0, 10.0),
                "yuv420p10le" => (8.0, 11.0),
                _ => (8.0, 10.0),
            };
            let (inner, last) = differences(&found, picture);
            let (inner, last) = (inner * 255.0, last * 255.0);
            assert!(inner <= allowed && last <= most, "{format}: {inner}, in the last column {last}");
        }
        assert!(reader.next_frame().unwrap().is_none());
        // And as the installed program decodes it.
        let ours = frames(&ffmpeg, &stream, ReadOptions::default()).unwrap();
        let mut reader = Y4mReader::new(Cursor::new(std::fs::read(&stream).unwrap()), "in", MEMORY).unwrap();
        let found = reader.next_frame().unwrap().unwrap();
        // With all chroma samples there is nothing to choose; else ffmpeg's filter of four samples, which takes chroma for that of
        // the middle of two columns, meets ours of two.
        let allowed = if format.contains("444") { 2.5 } else { 10.0 } / 255.0;
        let worst = difference(&found, &ours[0].image);
        assert!(worst <= allowed, "{format}: {}", worst * 255.0);
    }
}

/// What we write as Y4M, ffmpeg reads.
#[test]
fn y4m_of_ours_is_read_by_ffmpeg() {
    let Some(found) = ffmpeg() else { return };
    drop(found);
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.y4m");
    for (subsampling, bits, range) in [
        (Subsampling::Jpeg420, 8, SignalRange::Full),
        (Subsampling::Mpeg420, 8, SignalRange::Narrow),
        (Subsampling::Mpeg420, 10, SignalRange::Narrow),
        (Subsampling::C422, 8, SignalRange::Narrow),
        (Subsampling::C444, 8, SignalRange::Narrow),
        (Subsampling::C444, 12, SignalRange::Narrow),
    ] {
        let rate = Ratio::new(30_000, 1001).unwrap();
        let format = Y4mFormat { subsampling, bits, range, ..Y4mFormat::new((64, 48), rate) };
        let mut writer = Y4mWriter::new(Vec::new(), "out", format).unwrap();
        let pictures: Vec<_> = (0..2).map(|number| smooth(64, 48, Depth::Eight, number)).collect();
        for picture in &pictures {
            writer.write(picture).unwrap();
        }
        let stream = writer.finish().unwrap();
        std::fs::write(&path, &stream).unwrap();
        let place = place("in", subsampling == Subsampling::Jpeg420);
        let flags = format!("scale=in_color_matrix=bt601:{place}flags=accurate_rnd+full_chroma_int+full_chroma_inp");
        let read =
            run(&format!("-i {} -vf {flags} -f rawvideo -pix_fmt rgb24", path.to_str().unwrap()), Path::new("pipe:1"));
        assert_eq!(read.len(), 2 * 64 * 48 * 3);
        let allowed = if subsampling == Subsampling::C444 { 2.5 } else { 9.0 } / 255.0;
        for (picture, bytes) in pictures.iter().zip(read.chunks(64 * 48 * 3)) {
            let worst = difference(picture, &image(bytes, 64, 48));
            assert!(worst <= allowed, "{subsampling:?} {bits}: {}", worst * 255.0);
        }
        // By our own reader, too.
        let mut reader = Y4mReader::new(Cursor::new(stream), "in", MEMORY).unwrap();
        assert_eq!(*reader.format(), format);
        reader.next_frame().unwrap().unwrap();
        assert!(reader.next_frame().unwrap().is_some() && reader.next_frame().unwrap().is_none());
    }
}

/// Where chroma does not change, its places do not matter: we and the installed program read the same.
#[test]
fn y4m_of_one_chroma_is_read_as_by_ffmpeg() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.y4m");
    for (layout, chroma) in [("420jpeg", 8 * 6), ("420mpeg2", 8 * 6), ("422", 8 * 12), ("444", 16 * 12)] {
        let header = format!("YUV4MPEG2 W16 H12 F25:1 Ip C{layout} XCOLORRANGE=LIMITED\nFRAME\n");
        let luma: Vec<u8> = (0..16 * 12).map(|at| 40 + at as u8).collect();
        let frame = [luma, vec![110; chroma], vec![140; chroma]].concat();
        std::fs::write(&path, [header.into_bytes(), frame].concat()).unwrap();
        let mut reader = Y4mReader::new(Cursor::new(std::fs::read(&path).unwrap()), "in", MEMORY).unwrap();
        let theirs = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let worst = difference(&reader.next_frame().unwrap().unwrap(), &theirs[0].image);
        assert!(worst <= 2.0 / 255.0 + 1e-9, "{layout}: {}", worst * 255.0);
    }
}

/// All chroma samples and 16 bits: the picture comes back to the code.
#[test]
fn y4m_of_16_bits_is_exact() {
    let format = Y4mFormat { bits: 16, range: SignalRange::Full, ..Y4mFormat::new((31, 17), Ratio::ONE) };
    let noise = picture((31, 17), Channels::Rgb, Depth::Eight, 5);
    let mut writer = Y4mWriter::new(Vec::new(), "out", format).unwrap();
    writer.write(&noise).unwrap();
    let mut reader = Y4mReader::new(Cursor::new(writer.finish().unwrap()), "in", MEMORY).unwrap();
    assert!(difference_of_values(&reader.next_frame().unwrap().unwrap(), &noise) < 2.5 / 65535.0);
}

fn difference_of_values(a: &EncodedImage, b: &EncodedImage) -> f64 {
    let pairs = crate::common::values(a).into_iter().zip(crate::common::values(b));
    pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

#[test]
fn pictures_of_netpbm_come_back() {
    for channels in Channels::ALL {
        for depth in [Depth::Eight, Depth::Sixteen] {
            let pictures: Vec<_> = (0..3).map(|number| picture((7, 5), channels, depth, number)).collect();
            let mut writer = PamWriter::new(Vec::new(), "out");
            pictures.iter().for_each(|picture| writer.write(picture).unwrap());
            let mut reader = PamReader::new(Cursor::new(writer.finish().unwrap()), "in", MEMORY);
            for picture in &pictures {
                assert!(reader.next_frame().unwrap().unwrap() == *picture, "{channels} {depth}");
            }
            assert!(reader.next_frame().unwrap().is_none());
        }
    }
}

#[test]
fn netpbm_of_ffmpeg_is_read_and_ours_by_ffmpeg() {
    let Some(found) = ffmpeg() else { return };
    drop(found);
    let folder = tempfile::tempdir().unwrap();
    let (video, path) = (folder.path().join("a.mkv"), folder.path().join("stream"));
    run(&format!("{} -c:v ffv1 -pix_fmt bgr0", crate::common::moving(34, 22, "25", 3)), &video);
    let expected = raw(&video, "rgb24");
    for (codec, format) in [("ppm", "rgb24"), ("pam", "rgb24"), ("pam", "rgba"), ("pgm", "gray")] {
        run(&format!("-i {} -f image2pipe -c:v {codec} -pix_fmt {format}", video.to_str().unwrap()), &path);
        let mut reader = PamReader::new(Cursor::new(std::fs::read(&path).unwrap()), "in", MEMORY);
        let mut found = Vec::new();
        while let Some(frame) = reader.next_frame().unwrap() {
            let frame = frame.without_alpha();
            match frame.samples() {
                Samples::U8(samples) => found.extend(samples),
                Samples::U16(samples) => found.extend(samples.iter().map(|sample| (sample >> 8) as u8)),
                _ => panic!("floats"),
            }
        }
        assert!(if format == "gray" { found == raw(&video, "gray") } else { found == expected }, "{codec} {format}");
    }
    let mut writer = PamWriter::new(Vec::new(), "out");
    for frame in expected.chunks(34 * 22 * 3) {
        writer.write(&image(frame, 34, 22)).unwrap();
    }
    std::fs::write(&path, writer.finish().unwrap()).unwrap();
    let read =
        run(&format!("-f pam_pipe -i {} -f rawvideo -pix_fmt rgb24", path.to_str().unwrap()), Path::new("pipe:1"));
    assert!(read == expected);
}

#[test]
fn values_of_fewer_steps_are_scaled() {
    let read = |bytes: &[u8]| PamReader::new(Cursor::new(bytes.to_vec()), "in", MEMORY).next_frame();
    let frame = read(b"P5 # a comment\n3 1\n15\n\x00\x07\x0f").unwrap().unwrap();
    assert_eq!(frame.samples(), &Samples::U8(vec![0, 119, 255]));
    let frame = read(b"P6\n1 1\n1023\n\x00\x00\x02\x00\x03\xff").unwrap().unwrap();
    assert_eq!(frame.samples(), &Samples::U16(vec![0, 32800, 65535]));
    let error = read(b"P5 1 1 15\n\x10").unwrap_err().to_string();
    assert!(error.contains("16") && error.contains("15"), "{error}");
}

#[test]
fn float_maps_come_back_in_both_orders() {
    for (channels, order) in [(Channels::Rgb, ByteOrder::Little), (Channels::Grey, ByteOrder::Big)] {
        let count = 3 * 2 * channels.count();
        let values = (0..count).map(|at| at as f32 * 1.5 - 2.0).collect::<Vec<_>>();
        let picture = EncodedImage::new(3, 2, channels, Depth::Float, Samples::Float(values)).unwrap();
        let mut writer = PfmWriter::new(Vec::new(), "out", order);
        writer.write(&picture).unwrap();
        writer.write(&picture).unwrap();
        let bytes = writer.finish().unwrap();
        let mut reader = PfmReader::new(Cursor::new(bytes), "in", MEMORY);
        assert!(reader.next_frame().unwrap().unwrap() == picture && reader.next_frame().unwrap().unwrap() == picture);
        assert!(reader.next_frame().unwrap().is_none());
    }
    // The lowest row comes first, and values are multiplied.
    let mut bytes = b"Pf\n1 2\n-2.0\n".to_vec();
    bytes.extend([1.0_f32, 3.0].iter().flat_map(|value| value.to_le_bytes()));
    let frame = PfmReader::new(Cursor::new(bytes), "in", MEMORY).next_frame().unwrap().unwrap();
    assert_eq!(frame.samples(), &Samples::Float(vec![6.0, 2.0]));
}

/// Every stream that ends within a frame, is too large, or is something else, is an error that names the frame.
#[test]
fn streams_that_are_damaged_are_refused() {
    let y4m = |bytes: &[u8]| -> Result<usize, VideoError> {
        let mut reader = Y4mReader::new(Cursor::new(bytes.to_vec()), "in", 1 << 16)?;
        let mut count = 0;
        while reader.next_frame()?.is_some() {
            count += 1;
        }
        Ok(count)
    };
    let header = b"YUV4MPEG2 W2 H2 F25:1 Ip C420jpeg\n".as_slice();
    let frame = b"FRAME\nabcdef".as_slice();
    assert_eq!(y4m(&[header, frame, frame].concat()).unwrap(), 2);
    let error = y4m(&[header, frame, &frame[..9]].concat()).unwrap_err().to_string();
    assert!(error.contains("frame 1") && error.contains("ends within"), "{error}");
    assert!(y4m(&[header, frame, b"NOISE\n"].concat()).unwrap_err().to_string().contains("FRAME"));
    assert!(y4m(b"YUV4MPEG2 W2 H2 F25:1 It C420jpeg\n").unwrap_err().to_string().contains("interlaced"));
    assert!(y4m(&[b'Y'; 5000]).unwrap_err().to_string().contains("1024 bytes"));
    let large = b"YUV4MPEG2 W100000 H100000 F25:1 C444\nFRAME\n";
    assert!(matches!(y4m(large).unwrap_err(), VideoError::TooLarge { .. }));

    let pam = |bytes: &[u8]| PamReader::new(Cursor::new(bytes.to_vec()), "in", 1 << 16).next_frame().unwrap_err();
    assert!(matches!(pam(b"P6\n99999 99999\n255\n"), VideoError::TooLarge { .. }));
    for (bytes, word) in [
        (b"P4\n1 1\n".as_slice(), "P4"),
        (b"P6\n1 x\n", "height"),
        (b"P6\n1 1\n70000\n", "70000"),
        (b"P6\n1 1\n255\nab", "ends within"),
        (b"P7\nWIDTH 1\nHEIGHT 1\nDEPTH 5\nMAXVAL 255\nENDHDR\n", "5 channels"),
        (b"P7\nWIDTH 0\nHEIGHT 1\nDEPTH 1\nMAXVAL 255\nENDHDR\n", "0x1"),
        (b"\xff\xff\xff", "damaged"),
    ] {
        let error = pam(bytes).to_string();
        assert!(error.contains(word), "{word}: {error}");
    }
    let mut two = PamReader::new(Cursor::new(b"P5 1 1 255\naP5 1 2 255\nab".to_vec()), "in", 99);
    two.next_frame().unwrap();
    let error = two.next_frame().unwrap_err().to_string();
    assert!(error.contains("frame 1") && error.contains("alike"), "{error}");
    let pfm = |bytes: &[u8]| PfmReader::new(Cursor::new(bytes.to_vec()), "in", 1 << 16).next_frame().unwrap_err();
    assert!(matches!(pfm(b"PF\n99999 99999\n-1.0\n"), VideoError::TooLarge { .. }));
    for (bytes, word) in [
        (b"PF\n1 1\n0\n".as_slice(), "scale"),
        (b"PF\n1 1\nnan\n", "scale"),
        (b"PG\n", "PG"),
        (b"Pf 1 1 1\nab", "ends within"),
    ] {
        let error = pfm(bytes).to_string();
        assert!(error.contains(word), "{word}: {error}");
    }
}
