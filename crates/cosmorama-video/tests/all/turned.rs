//! Display matrices: pictures come upright.

use std::path::Path;

use cosmorama::raster::{EncodedImage, Samples};
use cosmorama_video::ReadOptions;

use crate::common::{ffmpeg, frames, moving, run};

/// Writes the numbers a, b, c and d of the matrix in the header of the first track.
fn set_matrix(path: &Path, [a, b, c, d]: [i32; 4]) {
    let mut bytes = std::fs::read(path).unwrap();
    let at = bytes.windows(4).position(|name| name == b"tkhd").unwrap() + 4 + 40;
    for (index, number) in [(0, a), (1, b), (3, c), (4, d)] {
        bytes[at + 4 * index..at + 4 * index + 4].copy_from_slice(&(number * 65536).to_be_bytes());
    }
    std::fs::write(path, bytes).unwrap();
}

/// Returns the picture whose point (x, y) has moved to (ax + cy, bx + dy).
fn moved(image: &EncodedImage, [a, b, c, d]: [i32; 4]) -> EncodedImage {
    let (width, height) = (image.width() as i32, image.height() as i32);
    let (new_width, new_height) = if a == 0 { (height, width) } else { (width, height) };
    let Samples::U8(samples) = image.samples() else { panic!("8 bits") };
    let mut new = vec![0; samples.len()];
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let (i, j) = (a * x + c * y, b * x + d * y);
        let (i, j) = (if a + c < 0 { i + new_width - 1 } else { i }, if b + d < 0 { j + new_height - 1 } else { j });
        let (from, to) = ((y * width + x) as usize * 3, (j * new_width + i) as usize * 3);
        new[to..to + 3].copy_from_slice(&samples[from..from + 3]);
    }
    EncodedImage::new(new_width as usize, new_height as usize, image.channels(), image.depth(), Samples::U8(new))
        .unwrap()
}

#[test]
fn all_eight_turns_come_upright() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    run(&format!("{} -c:v libx264 -pix_fmt yuv422p", moving(48, 32, "25", 2)), &path);
    let coded = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
    for matrix in [
        [1, 0, 0, 1],
        [0, 1, -1, 0],
        [-1, 0, 0, -1],
        [0, -1, 1, 0],
        [-1, 0, 0, 1],
        [1, 0, 0, -1],
        [0, 1, 1, 0],
        [0, -1, -1, 0],
    ] {
        set_matrix(&path, matrix);
        let info = ffmpeg.probe(&path).unwrap();
        let found = frames(&ffmpeg, &path, ReadOptions::default()).unwrap();
        let expected = moved(&coded[1].image, matrix);
        assert_eq!(info.size(), (expected.width(), expected.height()), "{matrix:?}");
        assert!(found[1].image == expected, "{matrix:?}");
    }
}

#[test]
fn other_angles_are_refused() {
    let Some(ffmpeg) = ffmpeg() else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mp4");
    run(&format!("{} -c:v libx264", moving(48, 32, "25", 2)), &path);
    set_matrix(&path, [1, 1, -1, 1]);
    let error = ffmpeg.probe(&path).unwrap_err().to_string();
    assert!(error.contains("multiple of 90"), "{error}");
}
