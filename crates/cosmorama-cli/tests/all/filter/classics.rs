//! Filters of the literature in each verb that filters.

use cosmorama::raster::{Image, Rgba};
use cosmorama_io::{Limits, read};

use crate::bench::{Bench, assert_says, picture, text};

fn light(bench: &Bench, name: &str) -> Image<Rgba> {
    read(bench.path(name), &Limits::NONE).unwrap().to_light()
}

/// Root mean square difference between two pictures of light.
fn difference(a: &Image<Rgba>, b: &Image<Rgba>) -> f32 {
    let pairs = a.pixels().iter().zip(b.pixels());
    let squares: Vec<f32> = pairs.flat_map(|(a, b)| (0..4).map(|c| (a.0[c] - b.0[c]).powi(2))).collect();
    (squares.iter().sum::<f32>() / squares.len() as f32).sqrt()
}

fn bench() -> Bench {
    let bench = Bench::new();
    bench.save("sky.png", &picture(1, 256, 128));
    bench
}

/// Other pictures than those of EWA, and nearly the same.
fn assert_resemble(bench: &Bench, name: &str) {
    let found = difference(&light(bench, "ewa.png"), &light(bench, name));
    assert!(found > 0.0 && found < 0.05, "{name}: {found}");
}

#[test]
fn pictures_are_converted_by_them() {
    let bench = bench();
    let convert = |output: &str, filter: &str| {
        bench.succeed(&["convert", "sky.png", output, "--to", "fulldome", "--size", "64", "--filter", filter]);
    };
    convert("ewa.png", "ewa");
    for (output, filter) in
        [("catmull.png", "catmull"), ("mip.png", "mipmap:levels=trilinear"), ("flc.png", "feibush-levoy-cook")]
    {
        convert(output, filter);
        assert_resemble(&bench, output);
    }
    // Their table has the shape of a Gaussian that is asked for, and of no other kernel.
    let args =
        ["convert", "sky.png", "wide.png", "--to", "fulldome", "--size", "64", "--filter", "ewa:paper", "--kernel"];
    let said = |kernel: &str| text(&bench.run(&[&args[..], &[kernel, "-y"]].concat()).stderr);
    assert_says(&said("mitchell"), &["--kernel", "no effect", "ewa:paper"]);
    let paper = light(&bench, "wide.png");
    assert!(!said("gaussian:cutoff=2").contains("no effect"));
    assert!(difference(&paper, &light(&bench, "wide.png")) > 0.0);
}

#[test]
fn mirrors_reflect_by_them() {
    let bench = bench();
    let shade = |output: &str, filter: &str| {
        bench.succeed(&["shade", "sky.png", output, "--material", "mirror", "--size", "64", "--reflect", filter]);
    };
    shade("ewa.png", "ewa");
    for (output, filter) in [("sums.png", "summed-area"), ("tents.png", "blinn-newell")] {
        shade(output, filter);
        assert_resemble(&bench, output);
    }
}

#[test]
fn cameras_move_by_them() {
    let bench = bench();
    let shot = ["--to", "fulldome", "--size", "48", "--yaw", "0..20", "--frames", "1-2", "--shutter", "0.5", "-y"];
    let convert = |filter: &str, motion: &str| {
        let more = ["--filter", filter, "--motion", motion];
        let output = bench.run(&[&["convert", "sky.png", "f_#.png"], &shot[..], &more].concat());
        assert!(output.status.success(), "{}", text(&output.stderr));
        (light(&bench, "f_1.png"), text(&output.stderr))
    };
    let [(ewa, _), (catmull, said)] = ["ewa", "catmull"].map(|filter| convert(filter, "swept"));
    let found = difference(&ewa, &catmull);
    assert!(found > 0.0 && found < 0.1 && !said.contains("no effect"), "{found}: {said}");
    // An ellipse of a pixel and its path is EWA's.
    let [(ewa, silent), (catmull, said)] = ["ewa", "catmull"].map(|filter| convert(filter, "ellipse"));
    assert_eq!(difference(&ewa, &catmull), 0.0);
    assert!(!silent.contains("no effect"), "{silent}");
    assert_says(&said, &["--filter has no effect", "--motion ellipse"]);
}
