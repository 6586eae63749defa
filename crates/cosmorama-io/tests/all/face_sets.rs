//! Which file is which face.

use std::path::Path;

use cosmorama::camera::SamplePositions;
use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama::sphere::CubeFace;
use cosmorama_io::{FacePlacement, FaceSet, IoError, Limits, Naming, WriteOptions, write};

fn folder_with(names: &[&str]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in names {
        let path = folder.path().join(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, "").unwrap();
    }
    folder
}

fn find(names: &[&str], pattern: &str) -> Result<FaceSet, IoError> {
    let folder = folder_with(names);
    FaceSet::find(&folder.path().join(pattern).display().to_string(), None)
}

fn found(names: &[&str], pattern: &str) -> (&'static str, Vec<CubeFace>) {
    let set = find(names, pattern).unwrap();
    (set.naming().name, set.present().map(|face| face.face).collect())
}

#[test]
fn every_preset_is_found_by_its_own_names() {
    for naming in Naming::presets().iter().filter(|naming| naming.automatic) {
        let names: Vec<String> = naming.names.iter().map(|name| format!("a_{name}.png")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        assert_eq!(found(&names, "a_{face}.png"), (naming.name, CubeFace::ALL.to_vec()));
        for alias in naming.aliases {
            assert_eq!(Naming::named(alias).unwrap(), naming);
        }
    }
}

#[test]
fn the_naming_that_explains_more_wins() {
    let (naming, faces) = found(&["front.png", "left.png", "right.png", "top.png"], "{face}.png");
    assert_eq!((naming, faces.len()), ("words", 4));
    let (naming, faces) = found(&["front.png", "left.png", "right.png", "up.png"], "{face}.png");
    assert_eq!((naming, faces.len()), ("cosmorama", 4));
    let (naming, faces) = found(&["f.png", "l.png", "r.png", "u.png"], "%c.png");
    assert_eq!((naming, faces.len()), ("pannellum", 4));
}

#[test]
fn the_same_mapping_under_two_names_is_no_conflict() {
    let (_, faces) = found(&["front.png", "left.png", "right.png"], "{face}.png");
    assert_eq!(faces, [CubeFace::Front, CubeFace::Right, CubeFace::Left]);
    let (_, faces) = found(&["f.png", "l.png", "r.png", "b.png"], "%c.png");
    assert_eq!(faces, [CubeFace::Front, CubeFace::Right, CubeFace::Back, CubeFace::Left]);
}

#[test]
fn two_namings_that_disagree_are_an_error_that_lists_both() {
    let names = ["front.png", "left.png", "top.png", "posx.png", "posy.png"];
    let message = find(&names, "{face}.png").unwrap_err().to_string();
    assert!(message.contains("naming=words") && message.contains("naming=opengl"), "{message}");
    assert!(message.contains("posx.png is right"), "{message}");
    let names = ["front.png", "left.png", "top.png", "up.png"];
    let message = find(&names, "{face}.png").unwrap_err().to_string();
    assert!(message.contains("naming=words") && message.contains("naming=cosmorama"), "{message}");
    let folder = folder_with(&names);
    let pattern = folder.path().join("{face}.png").display().to_string();
    let set = FaceSet::find(&pattern, Some(Naming::named("words").unwrap())).unwrap();
    assert!(set.face(CubeFace::Up).path.ends_with("top.png"));
    assert!(set.face(CubeFace::Up).present && !set.face(CubeFace::Down).present);
}

#[test]
fn strays_beside_enough_faces_are_none() {
    let (naming, faces) = found(&["front.png", "left.png", "right.png", "top.png", "r.png", "posx.png"], "{face}.png");
    assert_eq!((naming, faces.len()), ("words", 4));
    let letters = ["f.png", "l.png", "r.png", "b.png", "t.png", "d.png", "up.png", "front.png", "Left.png"];
    assert_eq!(found(&letters, "{face}.png").0, "bourke");
    // Beside three of them, one more may be either.
    let message = find(&["front.png", "left.png", "right.png", "r.png"], "{face}.png").unwrap_err().to_string();
    assert!(message.contains("naming=words") && message.contains("r.png is right"), "{message}");
    let both = ["front.png", "left.png", "right.png", "top.png", "posx.png", "posy.png", "posz.png", "negx.png"];
    let message = find(&both, "{face}.png").unwrap_err().to_string();
    assert!(message.contains("naming=words") && message.contains("naming=opengl"), "{message}");
}

#[test]
fn letters_may_be_large() {
    assert_eq!(found(&["FRONT.png", "TOP.png"], "{face}.png").0, "words");
    assert_eq!(found(&["Front.png", "Up.png"], "{face}.png").0, "cosmorama");
    assert_eq!(found(&["F.png", "T.png"], "%c.png").0, "bourke");
}

#[test]
fn bourkes_second_letter_names_a_folder_and_frames_follow() {
    let names = ["f/frame_f_0001.tga", "l/frame_l_0001.tga", "t/frame_t_0001.tga"];
    let folder = folder_with(&names);
    let pattern = folder.path().join("%c/frame_%c_%04d.tga").display().to_string();
    let set = FaceSet::find(&pattern, None).unwrap();
    assert_eq!(set.naming().name, "bourke");
    assert_eq!(set.present().count(), 3);
    assert!(set.face(CubeFace::Up).path.ends_with("t/frame_t_%04d.tga"));
    assert_eq!(set.missing().count(), 3);
}

#[test]
fn nothing_found_says_what_was_tried() {
    assert!(matches!(find(&[], "faces/{face}.png"), Err(IoError::Open { path, .. }) if path.ends_with("faces")));
    let message = find(&["elsewhere.png"], "{face}.png").unwrap_err().to_string();
    for part in ["{face}.png", "front right back left top bottom (words)", "posz posx negz negx posy negy (opengl)"] {
        assert!(message.contains(part), "{message}");
    }
    assert!(matches!(FaceSet::find("a.png", None), Err(IoError::NotAFacePattern { .. })));
    assert!(Naming::named("nonsense").is_none());
}

#[test]
fn envutil_is_only_for_those_who_ask() {
    let naming = Naming::named("envutil").unwrap();
    assert_eq!(naming.placement(CubeFace::Up), FacePlacement::HALF_TURN);
    assert_eq!(naming.placement(CubeFace::Left), FacePlacement::UPRIGHT);
    assert_eq!(found(&["left.png", "top.png"], "{face}.png").0, "words");
}

#[test]
fn faces_for_output_need_not_exist() {
    let set = FaceSet::named("out/{face}_####.png", Naming::named("cosmorama").unwrap()).unwrap();
    assert_eq!(set.face(CubeFace::Down).path, Path::new("out/down_####.png"));
}

/// On a disk where `front.png` opens `FRONT.png`, only the name that is really there may count.
#[test]
fn a_name_is_found_as_it_is_written() {
    for names in [["FRONT.png", "LEFT.png"], ["Front.png", "Left.png"], ["FRONT/LEFT.png", "LEFT/LEFT.png"]] {
        let pattern = if names[0].contains('/') { "{face}/LEFT.png" } else { "{face}.png" };
        let folder = folder_with(&names);
        let set = FaceSet::find(&folder.path().join(pattern).display().to_string(), None).unwrap();
        assert_eq!(set.naming().name, "words");
        let paths: Vec<_> = set.present().map(|face| face.path.clone()).collect();
        assert_eq!(paths, names.map(|name| folder.path().join(name)));
    }
}

/// The library draws faces as [`FacePlacement::UPRIGHT`] has them: what a preset turns is turned back when it is read.
#[test]
fn all_faces_are_read_upright() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["+Z", "-X", "-Z", "+X", "+Y", "-Y"] {
        let image = EncodedImage::new(2, 1, Channels::Grey, Depth::Eight, Samples::U8(vec![1, 2])).unwrap();
        write(folder.path().join(format!("{name}.png")), &image, &WriteOptions::default()).unwrap();
    }
    let pattern = folder.path().join("{face}.png").display().to_string();
    let faces = FaceSet::find(&pattern, None).unwrap().read_all(&Limits::default()).unwrap();
    assert_eq!(faces.samples, SamplePositions::Edges);
    for face in CubeFace::ALL {
        let expected = if matches!(face, CubeFace::Up | CubeFace::Down) { vec![2, 1] } else { vec![1, 2] };
        assert_eq!(*faces.face(face).samples(), Samples::U8(expected), "{face}");
    }
    std::fs::remove_file(folder.path().join("+Y.png")).unwrap();
    let error = FaceSet::find(&pattern, None).unwrap().read_all(&Limits::default()).unwrap_err().to_string();
    assert!(error.contains("+Y.png") && error.ends_with("missing faces: up"), "{error}");
}
