//! Plans as bytes: what comes back makes the same pixels, and what does not belong is refused.

use cosmorama::camera::{FieldStop, PixelGrid, View};
use cosmorama::filter::{Filter, FilterKind, Kernel};
use cosmorama::projection::{PlanePoint, PlaneRect, ProjectionKind, StMap, StMapTable};
use cosmorama::raster::{FixedCodec, FixedLight, Image, Rgba, Transfer};
use cosmorama::render::{FixedPlan, Plan, PlanError, Resampler, SavedPlan};
use cosmorama::sphere::{Angle, CubeFace, Direction, Orientation};
use cosmorama::world::{Blend, ViewMask, World, WorldView};
use proptest::prelude::*;
use std::sync::Arc;

fn view(projection: ProjectionKind, size: usize, half: f64, orientation: Orientation) -> View {
    let rect = PlaneRect { min: PlanePoint::new(-half, -half), max: PlanePoint::new(half, half) };
    View { projection, orientation, grid: PixelGrid::spanning(size, size, rect), stop: FieldStop::NONE }
}

fn faces(size: usize) -> Vec<WorldView> {
    let face = |face: CubeFace| {
        let view = view(ProjectionKind::PERSPECTIVE, size, 1.0, face.orientation());
        WorldView { name: face.name().to_owned(), view, blend: Blend::default(), mask: None }
    };
    CubeFace::ALL.map(face).into()
}

fn cube(size: usize) -> World {
    World::blended(faces(size)).unwrap()
}

fn dome(size: usize, yaw: f64) -> View {
    let [yaw, pitch, roll] = [yaw, 90.0, 0.0].map(Angle::from_degrees);
    let dome = view(ProjectionKind::EQUIDISTANT, size, 1.0, Orientation::from_yaw_pitch_roll(yaw, pitch, roll));
    View { stop: FieldStop::circle(1.0), ..dome }
}

fn light(world: &World) -> FixedLight {
    let mut light = FixedLight::black(world.view_sizes());
    for (k, texel) in light.texels_mut().enumerate() {
        let noise = |seed: u32| (k as u32).wrapping_mul(seed).wrapping_mul(2_654_435_761) >> 17;
        *texel = [noise(1) as i16, noise(3) as i16, (k % 300 * 100) as i16, 0];
    }
    light
}

fn codec() -> FixedCodec {
    FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).unwrap()
}

fn floats(light: &FixedLight) -> Vec<Rgba> {
    (0..light.len()).map(|texel| light.rgba(texel)).collect()
}

/// A plan, kept and read again: as large as it was.
fn come_back<P: SavedPlan>(plan: &P, resampler: &Resampler) -> P {
    let key = P::key(resampler);
    let back = P::from_bytes(&plan.to_bytes(key), key, resampler).unwrap();
    assert_eq!(back.bytes(), plan.bytes());
    back
}

#[test]
fn what_comes_back_makes_the_same_pixels() {
    // Rows of light of 15 bits as long as faces are wide, and rows that are filled up.
    for (world, target) in [(40, dome(64, 0.0)), (40, dome(63, 20.0)), (130, dome(64, 0.0)), (130, dome(63, 20.0))] {
        let world = cube(world);
        let light = light(&world);
        for kind in [FilterKind::Ewa, FilterKind::Bilinear, FilterKind::Point] {
            let resampler = Resampler { world: &world, target: &target, filter: Filter { kind, ..Filter::DEFAULT } };
            let plan = resampler.fixed_plan().unwrap();
            assert_eq!(come_back(&plan, &resampler).apply(&light, &codec()), plan.apply(&light, &codec()));
            let plan = resampler.plan().unwrap();
            assert_eq!(come_back(&plan, &resampler).apply(&floats(&light)), plan.apply(&floats(&light)));
        }
    }
}

#[test]
fn whatever_a_plan_depends_on_has_a_key_of_its_own() {
    let (world, target) = (cube(40), dome(64, 0.0));
    let masked = |hidden: usize| {
        let mut views = faces(40);
        views[4].mask = Some(Arc::new(ViewMask::new(40, 40, |i, j| i + 40 * j != hidden)));
        World::blended(views).unwrap()
    };
    let feathered = |feather: f64| {
        let mut views = faces(40);
        views[0].blend.feather = Angle::from_degrees(feather);
        World::blended(views).unwrap()
    };
    let renamed = {
        let mut views = faces(40);
        views[0].name = "another".to_owned();
        World::blended(views).unwrap()
    };
    // Maps of one size that differ in one sample, by a little.
    let mapped = |elsewhere: f64| {
        let table = StMapTable::of_pixels(16, 16, |i, j| {
            let moved = if (i, j) == (5, 9) { elsewhere } else { 0.0 };
            let [longitude, latitude] = [i as f64 - 7.5 + moved, 7.5 - j as f64].map(|k| Angle::from_degrees(3.0 * k));
            Some(Direction::from_longitude_latitude(longitude, latitude))
        });
        view(ProjectionKind::StMap(StMap::new(table.unwrap())), 16, 0.5, Orientation::IDENTITY)
    };
    let maps = [mapped(0.0), mapped(1e-5)];
    let map_world = |map: View| World::new([("map".to_owned(), map)]).unwrap();
    let map_worlds = maps.map(map_world);
    let filter = Filter::DEFAULT;
    let floor = Kernel { floor: 1.2, ..filter.kernel };
    let (kernel, near) = (Kernel { scale: 0.81, ..filter.kernel }, dome(64, 1e-9));
    let (masked, feathered, small) = ([masked(7), masked(8)], feathered(0.5), cube(41));
    fn of<'a>(world: &'a World, target: &'a View, filter: Filter) -> Resampler<'a> {
        Resampler { world, target, filter }
    }
    let all = [
        of(&world, &target, filter),
        of(&world, &near, filter),
        of(&world, &target, Filter { kernel, ..filter }),
        of(&world, &target, Filter { anti_ringing: false, ..filter }),
        of(&world, &target, Filter { kind: FilterKind::Point, ..filter }),
        of(&small, &target, filter),
        of(&masked[0], &target, filter),
        of(&masked[1], &target, filter),
        of(&feathered, &target, filter),
        of(&world, &target, Filter { kernel: floor, ..filter }),
        of(&world, &maps[0], filter),
        of(&world, &maps[1], filter),
        of(&map_worlds[0], &target, filter),
        of(&map_worlds[1], &target, filter),
    ];
    let keys: Vec<_> = all.iter().flat_map(|one| [Plan::key(one), FixedPlan::key(one)]).collect();
    let different: std::collections::HashSet<_> = keys.iter().collect();
    assert_eq!(different.len(), keys.len());
    // The same again, and with another name: the same.
    assert_eq!(Plan::key(&of(&cube(40), &dome(64, 0.0), filter)), keys[0]);
    assert_eq!(Plan::key(&of(&renamed, &target, filter)), keys[0]);
    assert_eq!(keys[0].to_string().len(), 32);
}

#[test]
fn what_does_not_belong_is_refused() {
    let (world, target) = (cube(24), dome(32, 0.0));
    let resampler = Resampler { world: &world, target: &target, filter: Filter::DEFAULT };
    let key = Plan::key(&resampler);
    let bytes = resampler.plan().unwrap().to_bytes(key);
    let load = |bytes: &[u8]| Plan::from_bytes(bytes, key, &resampler).map(|_| ()).unwrap_err();
    for cut in [0, 15, 51, 52, 60, bytes.len() / 2, bytes.len() - 1] {
        let expected = if cut < 52 { PlanError::NotAPlan } else { PlanError::Damaged };
        assert_eq!(load(&bytes[..cut]), expected, "{cut}");
    }
    assert_eq!(load(&[&bytes[..], &[0]].concat()), PlanError::Damaged);
    let flipped = |at: usize| {
        let mut bytes = bytes.clone();
        bytes[at] ^= 1;
        load(&bytes)
    };
    // Behind what it begins with stands the number of its version.
    let found = u32::from(bytes[16] ^ 1);
    assert_eq!(
        [0, 16, 20].map(flipped),
        [PlanError::NotAPlan, PlanError::Version { found }, PlanError::OtherConversion]
    );
    for at in (36..bytes.len()).step_by(101) {
        assert_eq!(flipped(at), PlanError::Damaged, "{at}");
    }
    let other = Resampler { filter: Filter { anti_ringing: false, ..Filter::DEFAULT }, ..resampler };
    assert_eq!(Plan::from_bytes(&bytes, Plan::key(&other), &other).map(|_| ()), Err(PlanError::OtherConversion));
    assert_eq!(
        FixedPlan::from_bytes(&bytes, FixedPlan::key(&resampler), &resampler).map(|_| ()),
        Err(PlanError::OtherConversion)
    );
}

/// A conversion and its plans.
struct Kept {
    world: World,
    target: View,
    fixed: Vec<u8>,
    float: Vec<u8>,
}

impl Kept {
    fn new(world: World, target: View) -> Self {
        let resampler = Resampler { world: &world, target: &target, filter: Filter::DEFAULT };
        let fixed = resampler.fixed_plan().unwrap().to_bytes(FixedPlan::key(&resampler));
        let float = resampler.plan().unwrap().to_bytes(Plan::key(&resampler));
        Self { world, target, fixed, float }
    }
}

#[test]
#[should_panic(expected = "light of the world's views")]
fn light_of_as_many_texels_in_other_views_is_refused() {
    let (world, target) = (cube(32), dome(16, 0.0));
    let plan = Resampler { world: &world, target: &target, filter: Filter::DEFAULT }.fixed_plan().unwrap();
    plan.apply(&FixedLight::black(world.view_sizes().map(|[width, height]| [2 * width, height / 2])), &codec());
}

/// Bytes that claim to be whole and for this conversion, whatever they hold.
fn forged(mut bytes: Vec<u8>, changes: &[(usize, u8)]) -> Vec<u8> {
    for (at, byte) in changes {
        let at = 52 + at % (bytes.len() - 52);
        bytes[at] = *byte;
    }
    let checksum = twox_hash::XxHash3_128::oneshot(&bytes[52..]);
    bytes[36..52].copy_from_slice(&checksum.to_le_bytes());
    bytes
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    /// A file may be made to deceive. It is refused, or makes some picture; it never reads what is not there.
    #[test]
    fn a_forged_plan_is_harmless(
        at in 0..10_000_000_usize,
        which in 0..3_usize,
        bytes in proptest::collection::vec(prop_oneof![Just(0), Just(1), Just(0x7f), Just(0xff), any::<u8>()], 1..6),
    ) {
        static PLANS: std::sync::OnceLock<[Kept; 3]> = std::sync::OnceLock::new();
        // So large that most pixels are in runs, and that rows of light are filled up: seen in eight mirrors, in four, and in one.
        let (square, turned) = (dome(104, 0.0), dome(104, 20.0));
        let oblong = View { grid: square.grid.window(104, 96, 0.0, 4.0), ..square };
        let plans = PLANS.get_or_init(|| [square, oblong, turned].map(|target| Kept::new(cube(130), target)));
        let Kept { world, target, fixed, float } = &plans[which];
        let resampler = Resampler { world, target, filter: Filter::DEFAULT };
        let changes: Vec<(usize, u8)> = bytes.iter().enumerate().map(|(k, byte)| (at + k, *byte)).collect();
        let light = light(world);
        let (key, bytes) = (FixedPlan::key(&resampler), forged(fixed.clone(), &changes));
        match FixedPlan::from_bytes(&bytes, key, &resampler) {
            Ok(plan) => {
                // Whatever it makes, nothing of what an image held before shows.
                let mut image = Image::filled(target.width(), target.height(), [77; 3]);
                plan.apply_into(&light, &codec(), &mut image);
                prop_assert!(image == plan.apply(&light, &codec()));
            }
            Err(error) => prop_assert_eq!(error, PlanError::Unsound),
        }
        let (key, bytes) = (Plan::key(&resampler), forged(float.clone(), &changes));
        match Plan::from_bytes(&bytes, key, &resampler) {
            Ok(plan) => {
                let (texels, bits) = (floats(&light), |image: &Image<Rgba>| -> Vec<_> {
                    image.pixels().iter().map(|pixel| pixel.0.map(f32::to_bits)).collect()
                });
                let mut image = Image::filled(target.width(), target.height(), Rgba::opaque(0.1, 0.2, 0.3));
                plan.apply_into(&texels, Rgba::TRANSPARENT, &mut image);
                // Not numbers, maybe, but the same.
                prop_assert!(bits(&image) == bits(&plan.apply(&texels)));
            }
            Err(error) => prop_assert_eq!(error, PlanError::Unsound),
        }
    }
}
