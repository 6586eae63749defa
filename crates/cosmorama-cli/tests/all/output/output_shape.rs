//! Outputs of another shape than their own, and what files say of themselves that is not so: told, not silent.

use crate::bench::{Bench, assert_says, picture, text};

fn told(bench: &Bench, output: &str, to: &str, size: &str) -> String {
    let run = bench.run(&["convert", "sky.png", output, "-y", "--from", "equirect", "--to", to, "--size", size]);
    assert!(run.status.success(), "{}", text(&run.stderr));
    text(&run.stderr)
}

fn sky() -> Bench {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 64, 32));
    bench
}

#[test]
fn maps_in_another_shape_are_told() {
    let bench = sky();
    for (to, size, natural) in [
        ("equirect", "60x40", "30"),
        ("hammer", "60x40", "30"),
        ("octahedral", "60x40", "60"),
        ("mercator:lat=60", "60x40", "25"),
    ] {
        let message = told(&bench, "out.png", to, size);
        let name = to.split(':').next().unwrap();
        let (what, natural) =
            (format!("warning: --to {name}: pixels are not square: {size}"), format!("height is {natural}:"));
        assert_says(&message, &[&what, &natural]);
    }
    for (to, size) in [
        ("equirect", "60x30"),
        ("equirect", "60"),
        ("equirect:hfov=360,vfov=180", "60x40"),
        ("mercator", "60x40"),
        ("fulldome", "60x40"),
        ("perspective:fov=60,vfov=20", "60x40"),
        ("fulldome:aspect=1.5", "60x40"),
    ] {
        assert!(!told(&bench, "out.png", to, size).contains("not square"), "{to} {size}");
    }
    // What would be told of a conversion, `explain` tells, too.
    let run = bench.run(&["explain", "sky.png", "--to", "equirect", "--size", "60x40"]);
    assert_says(&text(&run.stderr), &["pixels are not square"]);
    let run = bench.run(&["convert", "builtin:grid", "out.png", "-y", "--to", "equirect", "--size", "60x40"]);
    assert_says(&text(&run.stderr), &["pixels are not square"]);
}

#[test]
fn a_part_of_a_panorama_that_cannot_say_so_is_told_with_a_size_that_can() {
    let bench = sky();
    for name in ["out.jpg", "out.png"] {
        let message = told(&bench, name, "equirect:hfov=200,vfov=100", "256");
        assert_says(&message, &["warning: ", name, "no GPano metadata", "--size 260x130 would do"]);
        assert!(!told(&bench, name, "equirect:hfov=200,vfov=100", "260x130").contains("GPano"));
        assert_says(&bench.succeed(&["info", name]), &["equirect:canvas=468x234+104+52"]);
    }
    for (name, to) in [("out.tif", "equirect:hfov=200,vfov=100"), ("out.jpg", "equirect"), ("out.jpg", "fulldome")] {
        assert!(!told(&bench, name, to, "256").contains("GPano"), "{name} {to}");
    }
}

#[test]
fn what_gpano_metadata_say_wrongly_is_told() {
    let bench = sky();
    told(&bench, "part.jpg", "equirect:hfov=200,vfov=100", "260x130");
    let bytes = bench.bytes("part.jpg");
    let change = |from: &str, to: &str| {
        assert_eq!(from.len(), to.len());
        let at = bytes.windows(from.len()).position(|window| window == from.as_bytes()).unwrap();
        std::fs::write(bench.path("lie.jpg"), [&bytes[..at], to.as_bytes(), &bytes[at + from.len()..]].concat())
            .unwrap();
    };
    for (from, to, part) in [
        ("AreaLeftPixels=\"104\"", "AreaLeftPixels=\"abc\"", "CroppedAreaLeftPixels is \"abc\""),
        ("AreaLeftPixels=\"104\"", "AreaLeftPixels=\"400\"", "CroppedAreaLeftPixels 400"),
        ("FullPanoWidthPixels=\"468\"", "FullPanoWidthPixels=\"000\"", "FullPanoWidthPixels is 0"),
    ] {
        change(from, to);
        assert_says(&bench.succeed(&["info", "lie.jpg"]), &["left out", part]);
        let to = ["--to", "perspective:fov=20", "--size", "16"];
        let run = bench.run(&[&["convert", "lie.jpg", "out.png", "-y"], &to[..]].concat());
        assert_says(&text(&run.stderr), &["warning: lie.jpg: its GPano metadata are left out", part]);
    }
}
