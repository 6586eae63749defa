//! Files that other programs wrote.

use cosmorama::raster::{Channels, Depth, Transfer};
use cosmorama::sphere::CubeFace;
use cosmorama_io::{Choice, EnvMap, FacePlacement, FaceSet, Limits, check_chosen, open, probe, read};

#[test]
fn every_real_file_is_read() {
    for folder in
        ["equirect_hdr", "openexr_envmap", "equirect", "fisheye", "cube", "cube/vtk_cubemapDebug", "filament_ibl"]
    {
        let Some(folder) = crate::common::shared(&format!("data/{folder}")) else { return };
        for path in crate::common::files(&folder).into_iter().filter(|path| path.is_file()) {
            let header = probe(&path).unwrap();
            let file = read(&path, &Limits::default()).unwrap();
            check_chosen(open(&path).unwrap(), &path, &Limits::default(), &Choice::default()).unwrap();
            assert_eq!((file.image.width(), file.image.height()), (header.width, header.height), "{path:?}");
            assert_eq!((file.image.channels(), file.image.depth()), (header.channels, header.depth), "{path:?}");
            let light = file.image.to_light(file.metadata.transfer.as_ref().unwrap_or(&Transfer::Srgb));
            assert!(light.pixels().iter().all(|pixel| pixel.0.iter().all(|c| c.is_finite())), "{path:?}");
            let mean =
                light.pixels().iter().map(|pixel| f64::from(pixel.0[1])).sum::<f64>() / light.pixels().len() as f64;
            assert!(mean > 1e-4, "{path:?} is black");
        }
    }
}

#[test]
fn openexr_environments_say_what_they_are() {
    let Some(folder) = crate::common::shared("data/openexr_envmap") else { return };
    for (name, kind) in [
        ("KernerEnvCube.exr", EnvMap::Cube),
        ("KernerEnvLatLong.exr", EnvMap::LatLong),
        ("OrientationCube.exr", EnvMap::Cube),
        ("OrientationLatLong.exr", EnvMap::LatLong),
    ] {
        let header = probe(folder.join(name)).unwrap();
        assert_eq!(header.metadata.envmap, Some(kind), "{name}");
        assert_eq!(header.depth, Depth::Half, "{name}");
    }
}

#[test]
fn textures_are_cubes() {
    for (name, width, channels, depth) in [
        ("cube/bevy_sky_skybox.ktx2", 128, Channels::Rgb, Depth::Half),
        ("cube/playcanvas_helipad.dds", 128, Channels::Rgba, Depth::Eight),
        ("filament_ibl/hall_skybox.ktx", 256, Channels::Rgb, Depth::Half),
    ] {
        let Some(path) = crate::common::shared(&format!("data/{name}")) else { return };
        let header = probe(&path).unwrap();
        assert_eq!((header.width, header.height), (width, 6 * width), "{name}");
        assert_eq!((header.channels, header.depth), (channels, depth), "{name}");
        assert_eq!(header.metadata.envmap, Some(EnvMap::GlCube), "{name}");
    }
}

#[test]
fn oracles_are_16_bit_pngs() {
    let Some(path) = crate::common::shared("oracles/povray/face_front.png") else { return };
    let header = probe(&path).unwrap();
    assert_eq!((header.width, header.height, header.depth), (1024, 1024, Depth::Sixteen));
    assert_eq!(header.channels, Channels::Rgb);
}

#[test]
fn an_opengl_cube_has_plus_z_in_front() {
    // VTK's picture has an arrow from each face to each neighbour: +Z in front, +X right of it, +Y above.
    let Some(folder) = crate::common::shared("data/cube/vtk_cubemapDebug") else { return };
    let set = FaceSet::find(&folder.join("_{face}.jpg").display().to_string(), None).unwrap();
    assert_eq!((set.naming().name, set.present().count()), ("px", 6));
    assert!(set.face(CubeFace::Front).path.ends_with("_pz.jpg"));
    assert!(set.face(CubeFace::Right).path.ends_with("_px.jpg"));
    assert!(set.face(CubeFace::Up).path.ends_with("_py.jpg"));
    assert!(set.present().all(|face| face.placement == FacePlacement::UPRIGHT));
}
