//! TIFF files that say something of their pixels which is not done: refused, or told.

use crate::bench::{Bench, assert_says, text};

/// A tag's number, type (3: 16 bits, 4: 32 bits), count and value.
type Entry = (u16, u16, u32, u32);

/// A file of 8×4 pixels of three samples, all 128.
fn tiff(photometric: u32, more: Option<Entry>) -> Vec<u8> {
    let pixels = [128; 8 * 4 * 3];
    let mut entries: Vec<Entry> = vec![
        (256, 4, 1, 8),
        (257, 4, 1, 4),
        (258, 3, 1, 8),
        (259, 3, 1, 1),
        (262, 3, 1, photometric),
        (273, 4, 1, 0),
        (277, 3, 1, 3),
        (278, 4, 1, 4),
        (279, 4, 1, pixels.len() as u32),
    ];
    entries.extend(more);
    entries.sort_unstable();
    let start = 8 + 2 + 12 * entries.len() + 4;
    let mut file = b"II\x2a\0\x08\0\0\0".to_vec();
    file.extend((entries.len() as u16).to_le_bytes());
    for (tag, kind, count, value) in entries {
        let value = if tag == 273 { start as u32 } else { value };
        file.extend(tag.to_le_bytes());
        file.extend(kind.to_le_bytes());
        file.extend(count.to_le_bytes());
        file.extend(value.to_le_bytes());
    }
    file.extend([0; 4]);
    file.extend(pixels);
    file
}

fn convert(bench: &Bench) -> std::process::Output {
    bench.run(&["convert", "a.tif", "out.png", "-y", "--from", "equirect", "--to", "fisheye", "--size", "4"])
}

#[test]
fn luma_and_differences_of_colour_are_not_taken_for_red_green_and_blue() {
    let bench = Bench::new();
    // Without subsampling, which the decoder itself would refuse.
    std::fs::write(bench.path("a.tif"), tiff(6, Some((530, 3, 2, 0x0001_0001)))).unwrap();
    let before = bench.files();
    let message = bench.check_failure(1, &convert(&bench), &before);
    assert_says(&message, &["a.tif", "YCbCr colours", "grey or RGB"]);
    std::fs::write(bench.path("a.tif"), tiff(2, None)).unwrap();
    assert!(convert(&bench).status.success());
}

#[test]
fn a_picture_that_is_to_be_turned_is_told_of() {
    let bench = Bench::new();
    for (orientation, expected) in [(1, 0), (6, 1)] {
        std::fs::write(bench.path("a.tif"), tiff(2, Some((274, 3, 1, orientation)))).unwrap();
        // A view of any shape: turned, it is higher than wide.
        let convert =
            ["convert", "a.tif", "out.png", "-y", "--from", "perspective:fov=60", "--to", "perspective:fov=20"];
        let told = |more: &[&str]| {
            let output = bench.run(&[more, &convert[..], &["--size", "4"]].concat());
            assert!(output.status.success(), "{}", text(&output.stderr));
            text(&output.stderr)
        };
        assert_eq!(told(&[]).matches("warning").count(), 0);
        let noted = told(&["-v"]);
        let of_it = "a.tif is turned or mirrored as it asks (orientation 6)";
        assert_eq!(noted.matches(of_it).count(), expected, "{noted}");
        assert_eq!(bench.succeed(&["info", "a.tif"]).matches("orientation: 6").count(), expected);
    }
}
