//! Every picture of the shared folder opens, is described as its manifest has it, and converts.

use std::path::Path;

use crate::bench::{Bench, text};
use serde_json::Value;

/// A file or face set, what `info` says of its projection, of its faces, and the `--from` that it needs.
struct Picture {
    name: &'static str,
    size: (u64, u64),
    projection: &'static str,
    faces_fit: Option<bool>,
    from: &'static [&'static str],
}

const fn panorama(name: &'static str, size: (u64, u64)) -> Picture {
    Picture { name, size, projection: "equirect (2:1)", faces_fit: None, from: &[] }
}

const fn texture(name: &'static str, edge: u64, faces_fit: Option<bool>) -> Picture {
    Picture { name, size: (edge, 6 * edge), projection: "cube (the file's own six faces", faces_fit, from: &[] }
}

const fn openexr(name: &'static str, edge: u64, faces_fit: Option<bool>) -> Picture {
    let projection = "cube:layout=strip-v,order=openexr, samples on the edges";
    Picture { name, size: (edge, 6 * edge), projection, faces_fit, from: &[] }
}

const fn latlong(name: &'static str) -> Picture {
    Picture { name, size: (1024, 512), projection: "equirect, samples on the edges", faces_fit: None, from: &[] }
}

const PICTURES: [Picture; 24] = [
    Picture {
        name: "cube/bevy_Ryfjallet_cubemap.png",
        size: (256, 1536),
        projection: "cube:layout=strip-v (by its shape)",
        faces_fit: Some(true),
        from: &[],
    },
    // A smooth sky.
    texture("cube/bevy_sky_skybox.ktx2", 128, None),
    texture("cube/playcanvas_helipad.dds", 128, Some(true)),
    // Faces that only name their neighbours.
    Picture {
        name: "cube/vtk_cubemapDebug/_{face}.jpg",
        size: (1024, 1024),
        projection: "cube",
        faces_fit: None,
        from: &[],
    },
    panorama("equirect/bmng.jpg", (5400, 2700)),
    panorama("equirect/threeglobe_earth-night.jpg", (4096, 2048)),
    panorama("equirect/vtkdata_mars.jpg", (2000, 1000)),
    panorama("equirect_hdr/blender_courtyard.exr", (1024, 512)),
    panorama("equirect_hdr/blender_night.exr", (1024, 512)),
    panorama("equirect_hdr/blender_studio.exr", (1024, 512)),
    panorama("equirect_hdr/blender_sunset.exr", (1024, 512)),
    panorama("equirect_hdr/polyhaven_adams_place_bridge_1k.hdr", (1024, 512)),
    panorama("equirect_hdr/polyhaven_chinese_garden_1k.hdr", (1024, 512)),
    panorama("equirect_hdr/polyhaven_leadenhall_market_1k.hdr", (1024, 512)),
    panorama("equirect_hdr/polyhaven_noon_grass_1k.hdr", (1024, 512)),
    panorama("equirect_hdr/polyhaven_rainforest_trail_1k.hdr", (1024, 512)),
    panorama("equirect_hdr/polyhaven_spiaggia_di_mondello_1k.hdr", (1024, 512)),
    texture("filament_ibl/hall_ibl.ktx", 256, Some(true)),
    texture("filament_ibl/hall_skybox.ktx", 256, Some(true)),
    Picture {
        name: "fisheye/hemispheR_circular_coolpix4500+FC-E8_chestnut.jpg",
        size: (2272, 1704),
        projection: "fisheye:fov=180,center=",
        faces_fit: None,
        from: &["--from", "fisheye:fov=183,center=1136:852,radius=754"],
    },
    openexr("openexr_envmap/KernerEnvCube.exr", 256, Some(true)),
    // A plain colour to each face.
    openexr("openexr_envmap/OrientationCube.exr", 512, None),
    latlong("openexr_envmap/KernerEnvLatLong.exr"),
    latlong("openexr_envmap/OrientationLatLong.exr"),
];

fn info(bench: &Bench, path: &str) -> Value {
    serde_json::from_str(&bench.succeed(&["info", path, "--json"])).unwrap()
}

#[test]
fn every_picture_is_described_rightly_and_converts() {
    let Some(data) = testkit::shared("data") else { return };
    let bench = Bench::new();
    for picture in &PICTURES {
        let path = data.join(picture.name).to_string_lossy().into_owned();
        let report = info(&bench, &path);
        let header = report["faces"].get("front").unwrap_or(&report);
        let size = (header["width"].as_u64().unwrap(), header["height"].as_u64().unwrap());
        assert_eq!(size, picture.size, "{}", picture.name);
        let projection = report["projection"].as_str().unwrap();
        assert!(projection.starts_with(picture.projection), "{}: {projection}", picture.name);
        assert_eq!(report["arrangement"]["fits"].as_bool(), picture.faces_fit, "{}: {report}", picture.name);
        let to = [
            "out.png",
            "-y",
            "--to",
            "fulldome",
            "--size",
            "48",
            "--depth",
            "8",
            "--filter",
            "bilinear",
            "--missing",
            "black",
        ];
        let output = bench.run(&[&["convert", &path][..], picture.from, &to[..]].concat());
        let message = text(&output.stderr);
        assert!(output.status.success(), "{}: {message}", picture.name);
        assert!(!message.contains("do not meet"), "{}: {message}", picture.name);
    }
}

#[test]
fn the_circle_of_a_fisheye_photograph_is_where_its_authors_have_it() {
    let Some(data) = testkit::shared("data/fisheye") else { return };
    let bench = Bench::new();
    let path = data.join("hemispheR_circular_coolpix4500+FC-E8_chestnut.jpg").to_string_lossy().into_owned();
    let circle = &info(&bench, &path)["circle"];
    // Under the canopy its rim is as black as what is around it: the light reaches nearly as far.
    assert_eq!(circle["measured"], false);
    for (found, given) in [(&circle["x"], 1136.0), (&circle["y"], 852.0), (&circle["radius"], 754.0)] {
        assert!((found.as_f64().unwrap() - given).abs() < 75.0, "{circle}");
    }
    // Its field of view is not in the picture: an error that says what is missing.
    let message = bench.fail(1, &["convert", &path, "out.png", "--to", "perspective:fov=60", "--size", "32"]);
    crate::bench::assert_says(&message, &["circle on black", "fisheye:fov=DEGREES,center=1", "radius="]);
}

#[test]
fn a_mirror_ball_fills_its_frame_and_is_anyones_guess() {
    let Some(data) = testkit::shared("data/probe") else { return };
    let bench = Bench::new();
    let path = data.join("mirrorball_lamp.jpg").to_string_lossy().into_owned();
    let projection = info(&bench, &path)["projection"].as_str().unwrap().to_owned();
    assert!(projection.contains("mirror"), "{projection}");
    let to =
        ["--from", "mirror-ball", "--to", "equirect", "--size", "64", "--filter", "bilinear", "--missing", "black"];
    bench.succeed(&[&["convert", &path, "out.png"], &to[..]].concat());
}

/// Nothing is left out above.
#[test]
fn every_picture_of_the_manifest_is_looked_at() {
    let Some(manifest) = testkit::shared("data/MANIFEST.tsv") else { return };
    let text = std::fs::read_to_string(manifest).unwrap();
    let names = text.lines().skip(1).filter_map(|line| line.split('\t').next());
    for name in names.filter(|name| !name.starts_with("models/") && !name.starts_with("probe/")) {
        let in_set = |picture: &Picture| {
            Path::new(picture.name).parent() == Path::new(name).parent() && picture.name.contains("{face}")
        };
        assert!(PICTURES.iter().any(|picture| picture.name == name || in_set(picture)), "{name} is not looked at");
    }
}

#[test]
fn two_circles_and_two_eyes_of_real_scenes_are_found() {
    let Some(data) = testkit::shared("data/equirect_hdr") else { return };
    let bench = Bench::new();
    for name in ["polyhaven_leadenhall_market_1k.hdr", "polyhaven_noon_grass_1k.hdr", "blender_night.exr"] {
        let path = data.join(name).to_string_lossy().into_owned();
        for to in ["dual-fisheye", "fulldome:stereo=sbs", "equirect:stereo=tb", "equirect:stereo=sbs"] {
            bench.succeed(&["convert", &path, "made.png", "-y", "--to", to, "--size", "128", "--depth", "8"]);
            let projection = info(&bench, "made.png")["projection"].as_str().unwrap().to_owned();
            assert!(projection.starts_with(to), "{name} {to}: {projection}");
        }
    }
}
