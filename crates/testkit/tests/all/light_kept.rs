//! What skies with a sun keep of their light in another form, at as many pixels.

use cosmorama::camera::{CameraModel, CubeFaceCamera, PixelPoint, Placement, View};
use cosmorama::filter::{Ewa, FilterSettings, Kernel};
use cosmorama::raster::{Image, Rgba, Transfer};
use cosmorama::render::{Resampler, picture};
use cosmorama::sphere::{CubeFace, Direction};
use cosmorama::world::World;
use cosmorama_io::{Limits, read};
use testkit::{Form, HARD_PLACES, LIGHT, Sky, equirect, equirect_density, shared, sun};

#[test]
fn suns_keep_their_light() {
    let Some(folder) = shared("data/equirect_hdr") else { return };
    let suns = ["chinese_garden", "noon_grass", "spiaggia_di_mondello"].map(|name| {
        let path = folder.join(format!("polyhaven_{name}_1k.hdr"));
        let light: Vec<Rgba> =
            read(&path, &Limits::default()).expect("a sky").image.to_light(&Transfer::Linear).pixels().to_vec();
        (name, light)
    });
    let panorama = World::new([("panorama".to_owned(), equirect(1024))]).expect("one view");
    let forms = ["cube", "octahedral", "mirror-ball", "sinusoidal"];
    for form in Form::all(equirect_density(1024)).iter().filter(|form| forms.contains(&form.name)) {
        let sky = Sky::balanced(&panorama, form, LIGHT);
        for (name, light) in &suns {
            let gain = sky.gain(&panorama, light);
            assert!(gain.abs() < 0.002, "{name} as {}: {gain}", form.name);
        }
    }
}

/// Pairs of forms, and by how much a constant world may differ from itself, at most.
const PAIRS: [(&str, &str, f32); 9] = [
    ("equirect", "cube", 0.025),
    ("equirect", "octahedral", 0.025),
    ("cube", "equirect", 0.025),
    ("cube", "octahedral", 0.025),
    ("octahedral", "equirect", 0.025),
    ("eac", "cube", 0.02),
    ("mirror-ball", "cube", 0.05),
    ("mollweide", "sinusoidal", 0.12),
    ("hammer", "octahedral", 0.08),
];

/// A sun of one pixel is kept wherever it is, and what is constant stays it, but for a few pixels at poles and rims.
#[test]
fn light_is_kept_where_forms_are_singular() {
    let density = equirect_density(256);
    let forms = Form::all(density);
    let form = |name| forms.iter().find(|form| form.name == name).expect("a form");
    for (from, to, ripple) in PAIRS {
        let world = form(from).world();
        let sky = Sky::balanced(&world, form(to), LIGHT);
        for place in HARD_PLACES {
            let gain = sky.gain(&world, &sun(&world, place, density.sqrt().recip()));
            assert!(gain.abs() < 0.002, "{from} to {to}, a sun at {place:?}: {gain}");
        }
        let constant = sky.light(&vec![Rgba::opaque(1.0, 1.0, 1.0); world.texel_count()]);
        let lit = constant.iter().filter(|pixel| pixel.alpha() > 0.0);
        let worst = lit.map(|pixel| (pixel.0[0] - 1.0).abs()).fold(0.0, f32::max);
        assert!(worst < ripple, "{from} to {to}: a constant world differs by {worst}");
    }
}

/// Worlds without suns are kept by the default filter, too.
#[test]
fn daylight_keeps_its_light() {
    let density = equirect_density(512);
    let forms = Form::all(density);
    let form = |name| forms.iter().find(|form| form.name == name).expect("a form");
    for (from, to) in [("equirect", "cube"), ("cube", "octahedral"), ("octahedral", "equirect"), ("hammer", "cube")] {
        let world = form(from).world();
        // Ten degrees wide.
        let light = sun(&world, [0.4, 0.7, -0.3], 0.17);
        let gain = Sky::new(&world, form(to), FilterSettings::DEFAULT).gain(&world, &light);
        assert!(gain.abs() < 0.002, "{from} to {to}: {gain}");
    }
}

fn face(face: CubeFace, edge: usize) -> View {
    let camera = CameraModel::from(CubeFaceCamera);
    let placement = Placement { orientation: face.orientation(), ..Placement::new(camera) };
    placement.view(edge, edge).expect("a face")
}

/// Filter of the mirror level of a chain.
const MIRROR: FilterSettings = FilterSettings { kernel: Kernel { round: true, ..Kernel::LIGHT }, ..LIGHT };

/// Returns the faces of a cube, made fast, and made pixel by pixel from lists of texels.
fn faces_both_ways(world: &World, texels: &[Rgba], edge: usize) -> [Vec<Image<Rgba>>; 2] {
    let singly = Ewa { kernel: MIRROR.kernel, anti_ringing: false }.of_texels(world, texels);
    let views = CubeFace::ALL.map(|side| face(side, edge));
    [
        views.iter().map(|target| Resampler { world, target, filter: MIRROR }.render(texels)).collect(),
        views.iter().map(|target| picture(&*singly, target)).collect(),
    ]
}

fn texels(world: &World, light: impl Fn(usize) -> f32) -> Vec<Rgba> {
    (0..world.texel_count()).map(light).map(|light| Rgba::opaque(light, light, light)).collect()
}

/// Faces of a panorama with eight texels in a pixel: a sun of one texel, at the pole, beside it and away from it, and on the seam
/// behind, has the shape that lists of texels give it, and its energy.
#[test]
fn mirror_levels_are_what_lists_of_texels_make() {
    let world = World::new([("panorama".to_owned(), equirect(512))]).expect("one view");
    let [fast, slow] = faces_both_ways(&world, &texels(&world, |_| 0.7), 64);
    let constant = fast.iter().chain(&slow).flat_map(|face| face.pixels());
    assert!(constant.clone().all(|pixel| (pixel.0[0] - 0.7).abs() < 1e-6 && (pixel.alpha() - 1.0).abs() < 1e-6));
    for sun in [0, 3 * 512 + 17, 12 * 512 + 255, 30 * 512 + 511, 60 * 512 + 140, 128 * 512 + 256, 250 * 512] {
        let [fast, slow] = faces_both_ways(&world, &texels(&world, |at| if at == sun { 250_000.0 } else { 0.18 }), 64);
        let pairs = || fast.iter().zip(&slow).flat_map(|(fast, slow)| fast.pixels().iter().zip(slow.pixels()));
        let peak = pairs().map(|(_, slow)| slow.0[0]).fold(0.0, f32::max);
        let worst = pairs().map(|(fast, slow)| (fast.0[0] - slow.0[0]).abs()).fold(0.0, f32::max);
        assert!(worst < 1e-3 * peak, "a sun in texel {sun}: {worst} of {peak}");
        let sum = |faces: &[Image<Rgba>]| -> f64 {
            faces.iter().flat_map(|face| face.pixels()).map(|pixel| f64::from(pixel.0[0] - 0.18)).sum()
        };
        let gain = sum(&fast) / sum(&slow) - 1.0;
        assert!(gain.abs() < 1e-4, "a sun in texel {sun}: energy differs by {gain}");
    }
}

/// Largest steps of a sun's light from pixel to pixel, inside faces and across their edges, wherever about a corner it stands.
fn steps_about_a_corner(world: &World, filter: FilterSettings) -> [f32; 2] {
    let sides = [CubeFace::Front, CubeFace::Right, CubeFace::Up];
    let views = sides.map(|side| face(side, 64));
    let mut steps = [0f32; 2];
    let (corner, row) = ((512 / 8) * 5, 256.0 * (0.5 - (0.5f64.sqrt()).atan() / std::f64::consts::PI));
    for sun in (0..48).map(|k| (row as usize - 3 + k / 8) * 512 + corner - 4 + k % 8) {
        let light = texels(world, |at| if at == sun { 250_000.0 } else { 0.18 });
        let faces = views.each_ref().map(|target| Resampler { world, target, filter }.render(&light));
        let pixel = |at: Direction| {
            let seen = |(view, face): (&View, &Image<Rgba>)| {
                let pixel = view.pixel(at).filter(|pixel| view.grid.contains(*pixel))?;
                Some(face.get(pixel.x as usize, pixel.y as usize).0[0])
            };
            views.iter().zip(&faces).find_map(seen)
        };
        for (view, face) in views.iter().zip(&faces) {
            for (i, j) in (0..64).flat_map(|j| (0..64).map(move |i| (i, j))) {
                for (right, down) in [(1, 0), (0, 1), (-1, 0), (0, -1)] {
                    let (x, y) = (i + right, j + down);
                    let is_across = !(0..64).contains(&x) || !(0..64).contains(&y);
                    let beside =
                        view.direction(PixelPoint::new(f64::from(x) + 0.5, f64::from(y) + 0.5)).and_then(pixel);
                    let Some(beside) = beside else { continue };
                    let step = &mut steps[usize::from(is_across)];
                    *step = step.max((face.get(i as usize, j as usize).0[0] - beside).abs());
                }
            }
        }
    }
    steps
}

/// Moves a sun about the corner of three faces. Pixels taken as circles step no more across edges than inside; taken as they lie,
/// they do, since pixels of two faces lean to different sides.
#[test]
fn faces_of_mirror_levels_meet_about_a_corner() {
    let world = World::new([("panorama".to_owned(), equirect(512))]).expect("one view");
    let [inside, across] = steps_about_a_corner(&world, MIRROR);
    assert!(across > 0.0 && across <= inside, "{across} across edges, {inside} inside");
    let [inside, across] = steps_about_a_corner(&world, LIGHT);
    assert!(across > 1.05 * inside, "pixels as they lie: {across} across edges, {inside} inside");
}
