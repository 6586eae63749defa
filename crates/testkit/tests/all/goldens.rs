//! Golden pictures: the demo world by the reference filter alone, small, in crates/testkit/goldens.
//!
//! The reference must still give them exactly, and EWA must stay as near to them as it is. To make them anew after a
//! change of the demo world, of a projection or of the default kernel, and look at what changed before committing:
//!
//! `UPDATE_GOLDENS=1 cargo test -p testkit goldens`

use std::path::{Path, PathBuf};

use cosmorama::camera::View;
use cosmorama::compare::{Mask, compare};
use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama::raster::{Channels, Depth, EncodedImage, Image, Rgba, Transfer};
use cosmorama::render::Resampler;
use cosmorama::sphere::CubeFace;
use cosmorama::world::World;
use cosmorama_builtin::{DemoWorld, picture};
use cosmorama_io::{Limits, Metadata, WriteOptions, read, write};
use testkit::{cube, cube_face, equirect, fisheye, omnimax, perspective};

/// Edge of the cube faces that the pictures are made of.
const FACE: usize = 128;

const REFERENCE: FilterSettings =
    FilterSettings { kind: FilterKind::Reference { samples: 8 }, ..FilterSettings::DEFAULT };

/// One step of eight bits: another machine's rounding, nothing more.
const ROUNDING: f32 = 1.01 / 255.0;

struct Golden {
    name: &'static str,
    /// Whether it is made from a panorama, not from faces.
    from_panorama: bool,
    view: fn() -> View,
    /// How near to it EWA is: sRGB-encoded PSNR in dB.
    least_psnr: f64,
}

const GOLDENS: [Golden; 6] = [
    Golden { name: "omnimax", from_panorama: false, view: || omnimax(112, 82), least_psnr: 42.9 },
    Golden { name: "fisheye", from_panorama: false, view: || fisheye(80, 220.0), least_psnr: 47.3 },
    Golden { name: "equirect", from_panorama: false, view: || equirect(128), least_psnr: 43.2 },
    Golden {
        name: "perspective",
        from_panorama: false,
        view: || perspective(96, 72, 60.0, -37.0, 12.0, -9.0),
        least_psnr: 36.5,
    },
    Golden { name: "face", from_panorama: true, view: || cube_face(CubeFace::Front, 80, 80), least_psnr: 40.3 },
    Golden {
        name: "corner",
        from_panorama: true,
        view: || perspective(64, 64, 50.0, 45.0, 35.0, 20.0),
        least_psnr: 39.4,
    },
];

#[test]
fn reference_and_ewa_are_as_the_goldens() {
    let (faces, panorama) = (cube(&CubeFace::ALL, FACE, FACE), one(equirect(4 * FACE)));
    let (face_light, panorama_light) = (light_of(&faces), light_of(&panorama));
    for Golden { name, from_panorama, view, least_psnr } in GOLDENS {
        let (world, light) = if from_panorama { (&panorama, &panorama_light) } else { (&faces, &face_light) };
        let target = view();
        let by = |filter| Resampler { world, target: &target, filter }.render(light);
        let reference = by(REFERENCE);
        let path = golden(name);
        if std::env::var_os("UPDATE_GOLDENS").is_some() {
            save(&path, &reference);
        }
        let kept = read(&path, &Limits::default()).unwrap().image;
        check_codes(name, &kept.to_light(&Transfer::Linear), &encoded(&reference).to_light(&Transfer::Linear));

        let (ewa, kept) = (by(FilterSettings::DEFAULT), kept.to_light(&Transfer::Srgb));
        let mask = Mask::opaque(&ewa, &kept).unwrap();
        let psnr = compare(&ewa, &kept, &mask).unwrap().srgb.psnr;
        println!("{name}: EWA is {psnr:.2} dB from the reference");
        if psnr < least_psnr {
            panic!(
                "{name}: EWA is {psnr:.2} dB from the reference, at least {least_psnr} before: {}",
                refused(name, &ewa)
            );
        }
    }
}

fn one(view: View) -> World {
    World::new([("view".to_owned(), view)]).unwrap()
}

/// The demo world's light by texel, each the average over it.
fn light_of(world: &World) -> Vec<Rgba> {
    world.sources().iter().flat_map(|source| picture(&DemoWorld, &source.view).into_pixels()).collect()
}

/// Fails where a code differs by more than rounding, and keeps what was found.
fn check_codes(name: &str, kept: &Image<Rgba>, found: &Image<Rgba>) {
    let difference = |(a, b): (&Rgba, &Rgba)| (0..4).map(|c| (a.0[c] - b.0[c]).abs()).fold(0.0, f32::max);
    let largest = kept.pixels().iter().zip(found.pixels()).map(difference).fold(0.0, f32::max);
    if kept.width() != found.width() || largest > ROUNDING {
        panic!("{name}: the reference is {:.1} codes from its golden: {}", largest * 255.0, refused(name, found));
    }
}

fn golden(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("goldens").join(name).with_extension("png")
}

fn refused(name: &str, image: &Image<Rgba>) -> String {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name).with_extension("png");
    save(&path, image);
    path.display().to_string()
}

fn encoded(light: &Image<Rgba>) -> EncodedImage {
    EncodedImage::encode(light, Channels::Rgba, Depth::Eight, &Transfer::Srgb)
}

fn save(path: &Path, light: &Image<Rgba>) {
    let metadata = Metadata { transfer: Some(Transfer::Srgb), ..Metadata::default() };
    write(path, &encoded(light), &WriteOptions::with_metadata(metadata)).unwrap();
}
