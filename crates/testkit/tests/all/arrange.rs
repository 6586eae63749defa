//! Arrangements of faces, found from what their borders show.

use std::path::{Path, PathBuf};
use std::time::Instant;

use cosmorama::arrange::{Border, Change, Mismatch, Pose, Side, Verdict, changes, fits_as_well, judge};
use cosmorama::camera::{PixelPoint, View};
use cosmorama::layout::FacePlacement;
use cosmorama::raster::{Image, Rgba, Transfer};
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama_io::{Limits, read};

/// Pictures and how they lie.
struct Set {
    name: String,
    pictures: Vec<Image<Rgba>>,
    poses: Vec<Pose>,
}

fn load(path: &Path) -> Image<Rgba> {
    let image = read(path, &Limits::NONE).unwrap().image;
    let transfer = if image.depth().is_float() { Transfer::Linear } else { Transfer::Srgb };
    image.to_light(&transfer)
}

fn upright() -> Vec<Pose> {
    CubeFace::ALL.map(|face| Pose::new(face, FacePlacement::UPRIGHT)).to_vec()
}

fn files(name: &str, paths: Vec<PathBuf>) -> Set {
    let pictures: Vec<_> = paths.iter().map(|path| load(path)).collect();
    let poses = upright().into_iter().take(pictures.len()).collect();
    Set { name: name.to_owned(), pictures, poses }
}

fn strip(path: &Path) -> Set {
    let image = load(path);
    let edge = image.width();
    let picture = |k: usize| Image::from_fn(edge, edge, |i, j| *image.get(i, k * edge + j));
    use CubeFace::{Back, Down, Front, Left, Right, Up};
    let poses = [Right, Left, Up, Down, Front, Back].map(|face| Pose::new(face, FacePlacement::UPRIGHT)).to_vec();
    Set { name: path.display().to_string(), pictures: (0..6).map(picture).collect(), poses }
}

fn mismatch(pictures: &[Image<Rgba>]) -> Mismatch {
    let samples =
        Border::samples_for(pictures.iter().map(|picture| picture.width().min(picture.height())).min().unwrap());
    let border =
        |picture: &Image<Rgba>| Border::of((picture.width(), picture.height()), samples, |i, j| *picture.get(i, j));
    Mismatch::new(&pictures.iter().map(border).collect::<Vec<_>>())
}

fn sets() -> Option<Vec<Set>> {
    let (oracles, data) = (testkit::shared("oracles/povray")?, testkit::shared("data")?);
    let words = ["front", "right", "back", "left", "top", "bottom"];
    let of_oracle = |file: &str| words.map(|word| oracles.join(file.replace("{face}", word))).to_vec();
    let strips = ["cube/bevy_Ryfjallet_cubemap.png", "cube/playcanvas_helipad.dds", "filament_ibl/hall_skybox.ktx"];
    let sets = [files("face_{face}", of_oracle("face_{face}.png")), files("srgb8", of_oracle("face_{face}_srgb8.png"))];
    Some(sets.into_iter().chain(strips.map(|name| strip(&data.join(name)))).collect())
}

/// Numbers that look like chance, the same in each run.
struct Dice(u64);

impl Dice {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end
    }
}

/// Shuffles faces, and turns and mirrors each at random.
fn shuffled(faces: &[Pose], dice: &mut Dice) -> Vec<Pose> {
    let mut given: Vec<CubeFace> = faces.iter().map(|pose| pose.face).collect();
    for k in (1..given.len()).rev() {
        given.swap(k, dice.below(k + 1));
    }
    given.into_iter().map(|face| Pose::all_of(face)[dice.below(8)]).collect()
}

/// The cube but for turns and reflections of the whole: which side of which picture touches which.
fn touching(poses: &[Pose]) -> Vec<Option<Side>> {
    poses.iter().flat_map(|pose| poses.iter().map(|other| pose.side_towards(other.face))).collect()
}

#[test]
fn every_shuffled_cube_is_put_in_order() {
    for set in sets().unwrap_or_default() {
        let mismatch = mismatch(&set.pictures);
        assert!(matches!(judge(&mismatch, &set.poses), Verdict::Fits(_)), "{}", set.name);
        let mut dice = Dice(1986);
        for round in 0..40 {
            let given = shuffled(&set.poses, &mut dice);
            let start = Instant::now();
            let verdict = judge(&mismatch, &given);
            if round == 0 {
                println!("{}: {:?}", set.name, start.elapsed());
            }
            let Verdict::Wrong { fits, fit } = verdict else { panic!("{}: {given:?} is {verdict:?}", set.name) };
            assert_eq!(touching(&fits), touching(&set.poses), "{}", set.name);
            assert!(fit.confidence >= 0.9, "{}: {fit:?}", set.name);
            assert!(fits_as_well(&mismatch, &fits, &set.poses));
        }
    }
}

#[test]
fn four_faces_for_a_dome_are_told_apart() {
    let Some(oracles) = testkit::shared("oracles/povray") else { return };
    let path = |word: &str| oracles.join(format!("face4_{word}.png"));
    let mut set = files("face4", ["front", "right", "left", "top"].map(path).to_vec());
    let faces = [CubeFace::Front, CubeFace::Right, CubeFace::Left, CubeFace::Up];
    set.poses = faces.map(|face| Pose::new(face, FacePlacement::UPRIGHT)).to_vec();
    let mismatch = mismatch(&set.pictures);
    assert!(matches!(judge(&mismatch, &set.poses), Verdict::Fits(_)));
    let mut given = set.poses.clone();
    given.swap(1, 2);
    let Verdict::Wrong { fits, .. } = judge(&mismatch, &given) else { panic!("a swap is wrong") };
    assert_eq!(changes(&given, &fits), [Change::Swapped(CubeFace::Left, CubeFace::Right)]);
}

/// Faces of a world, with the noise of a camera: so many codes of eight bits, either way.
fn faces_of(world: impl Fn(Direction) -> [f32; 3], codes: f32, seed: u64) -> Vec<Image<Rgba>> {
    let mut dice = Dice(seed);
    let mut noise = || (dice.below(1001) as f32 / 500.0 - 1.0) * codes / 255.0;
    let views = CubeFace::ALL.map(|face| testkit::cube_face(face, 96, 96));
    let picture = |view: &View| {
        Image::from_fn(96, 96, |i, j| {
            let [red, green, blue] = view.direction(PixelPoint::centre(i, j)).map_or([0.0; 3], &world);
            let code = |tone: f32, noise: f32| (((tone + noise) * 255.0).round() / 255.0).clamp(0.0, 1.0).powf(2.2);
            Rgba::opaque(code(red, noise()), code(green, noise()), code(blue, noise()))
        })
    };
    views.iter().map(picture).collect()
}

#[test]
fn smooth_skies_do_not_tell() {
    // The same all round; the same at every height, too.
    let by_height = |direction: Direction| [0.3 + 0.2 * direction.vector().y as f32, 0.5, 0.8];
    let plain = |_: Direction| [0.3, 0.5, 0.8];
    let mut dice = Dice(1);
    for seed in 0..5 {
        for noise in [0.0, 1.0, 4.0] {
            for pictures in [faces_of(by_height, noise, seed), faces_of(plain, noise, seed)] {
                let mismatch = mismatch(&pictures);
                assert_eq!(judge(&mismatch, &upright()), Verdict::CannotTell, "seed {seed}, noise {noise}");
                let sides_swapped = [0, 3, 2, 1, 4, 5].map(|k| upright()[k]);
                assert_eq!(judge(&mismatch, &sides_swapped), Verdict::CannotTell, "seed {seed}, noise {noise}");
            }
            let anyhow = shuffled(&upright(), &mut dice);
            assert_eq!(judge(&mismatch(&faces_of(plain, noise, seed)), &anyhow), Verdict::CannotTell);
        }
    }
}

#[test]
fn a_face_that_is_the_same_all_round_may_lie_anyhow() {
    // Black below, as where a tripod was painted over.
    let world = |direction: Direction| {
        let [x, y, z] = direction.vector().as_vec3().to_array();
        if y < -0.57 { [0.0; 3] } else { [0.5 + 0.3 * (3.0 * x).sin(), 0.5 + 0.3 * (4.0 * z + x).cos(), 0.5 + 0.2 * y] }
    };
    let mismatch = mismatch(&faces_of(world, 1.0, 7));
    let Verdict::Fits(fit) = judge(&mismatch, &upright()) else { panic!("it fits") };
    assert_eq!(fit.free, [5]);
    let mut given = upright();
    given[1] = Pose::new(CubeFace::Left, FacePlacement::UPRIGHT);
    given[3] = Pose::new(CubeFace::Right, FacePlacement::UPRIGHT);
    given[4] = Pose::new(CubeFace::Up, FacePlacement { quarter_turns: 3, mirrored: false });
    let Verdict::Wrong { fits, .. } = judge(&mismatch, &given) else { panic!("a swap is wrong") };
    let told: Vec<String> = changes(&given, &fits).iter().map(ToString::to_string).collect();
    assert_eq!(told, ["left and right are swapped", "up has to be turned clockwise by 90 degrees"]);
}

#[test]
fn labels_on_checks_are_no_world() {
    let Some(data) = testkit::shared("data/cube/vtk_cubemapDebug") else { return };
    let names = ["pz", "px", "nz", "nx", "py", "ny"];
    let set = files("vtk", names.map(|name| data.join(format!("_{name}.jpg"))).to_vec());
    assert_eq!(judge(&mismatch(&set.pictures), &set.poses), Verdict::CannotTell);
}
