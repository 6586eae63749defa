use glam::{DMat3, DVec3, Vec4};

use crate::camera::Footprint;
use crate::filter::traits::{Filter, PrepareError, Prepared, SetupCost, bounded};
use crate::raster::Rgba;
use crate::sphere::DirectionJacobian;
use crate::world::{Light, Source, World};

/// Cubic look-ups on a pyramid, spread over a footprint: a fast average of light that is smooth already, such as a map of light
/// under a lobe.
///
/// A look-up is round, and as wide as the footprint is narrow; along the footprint there are as many as it is long (J. McCormack,
/// R. Perry, K. I. Farkas and N. P. Jouppi, *Feline: fast elliptical lines for anisotropic texture mapping*, SIGGRAPH 1999).
/// Variances add up to those of the footprint's parallelogram. Between texels it is Catmull's and Rom's cubic, so that light must
/// not change much from texel to texel: what is sharp is for [`Ewa`](crate::filter::Ewa).
///
/// Squares of texels have another shape on the sphere on each side of a cube's edge: what is averaged over several texels may step
/// there, by 0.5 % under waves of 30°.
///
/// The world is of perspective views, which overlap by [`Feline::MARGIN`] texels on each side: a look-up stays in the
/// view whose axis is nearest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Feline;

impl Feline {
    /// Texels by which a view must reach beyond the directions to which its axis is nearest. Then the coarsest level has enough
    /// of them for its look-ups.
    pub const MARGIN: usize = 10;
}

/// Levels of a view: its texels, and their means by squares of two and of four.
const LEVELS: usize = 3;

/// Width that is left out of a look-up, in texels, up to which one look-up is enough.
const NARROW: f64 = 0.5;

/// Part of a coarser level that is left out.
const FAINT: f64 = 0.02;

/// Length of a footprint for each look-up but the first, in their own widths.
const APART: f64 = 3.0;

/// Look-ups along a side of a footprint at most.
const MOST: f64 = 8.0;

impl Filter for Feline {
    fn prepare<'w>(&self, world: &'w World, light: &'w Light) -> Result<Box<dyn Prepared + 'w>, PrepareError> {
        light.check(world)?;
        let views = world.sources().iter().map(|source| Pyramid::of(source, light.texels()));
        let views = views.collect::<Option<Vec<_>>>().ok_or(PrepareError::NotPerspective)?;
        Ok(Box::new(PreparedFeline { world, views }))
    }

    fn setup(&self, world: &World) -> SetupCost {
        let texels = world.texel_count();
        SetupCost { texels, bytes: texels * size_of::<Rgba>() * 4 / 3 }
    }
}

struct PreparedFeline<'w> {
    world: &'w World,
    views: Vec<Pyramid>,
}

/// A perspective view and its coarser copies.
struct Pyramid {
    axis: DVec3,
    /// Matrix from a direction to its column and row, times the depth before the picture's plane, and that depth.
    to_image: DMat3,
    /// Side of a texel in the middle, in radians.
    pitch: f64,
    levels: Vec<Level>,
}

struct Level {
    width: usize,
    height: usize,
    texels: Vec<Vec4>,
}

/// Look-ups of a footprint.
struct Probes {
    /// Level of the pyramid.
    level: usize,
    /// Part of the next coarser level.
    coarser: f64,
    /// Steps from one look-up to the next, in two directions, and how many there are.
    steps: [(DVec3, usize); 2],
}

impl Pyramid {
    /// Returns the pyramid of a view; `None` if it is not in perspective.
    fn of(source: &Source, light: &[Rgba]) -> Option<Self> {
        let view = &source.view;
        let rays = view.rays()?;
        let (width, height) = (view.width(), view.height());
        let texels = &light[source.offset..][..width * height];
        let whole =
            Level { width, height, texels: texels.iter().map(|Rgba(texel)| Vec4::from_array(*texel)).collect() };
        let levels = std::iter::successors(Some(whole), Level::halved).take(LEVELS).collect();
        let middle = rays * DVec3::new(0.5 * width as f64, 0.5 * height as f64, 1.0);
        let pitch = (rays.x_axis.length() * rays.y_axis.length()).sqrt() / middle.length();
        // An inverse keeps depths positive before the plane.
        Some(Self { axis: middle.normalize(), to_image: rays.inverse(), pitch, levels })
    }

    /// Returns the side of a texel that shows a direction, in radians.
    fn texel(&self, direction: DVec3) -> f64 {
        // A texel's solid angle goes with the third power of the cosine.
        let cosine = self.axis.dot(direction).max(0.1);
        self.pitch * cosine * cosine.sqrt()
    }

    /// Looks up the light in a direction.
    fn look(&self, direction: DVec3, probes: &Probes) -> Vec4 {
        let at = self.to_image * direction;
        let nearness = at.z.recip();
        let on = |level: usize| {
            let scale = nearness / (1 << level) as f64;
            self.levels[level].cubic(at.x * scale, at.y * scale)
        };
        let finer = on(probes.level);
        if probes.coarser > 0.0 { finer.lerp(on(probes.level + 1), probes.coarser as f32) } else { finer }
    }
}

impl Level {
    /// Returns the means of squares of two by two texels. `None` if there are too few, or an odd number of them.
    fn halved(&self) -> Option<Self> {
        let [width, height] = [self.width / 2, self.height / 2];
        if width < 4 || height < 4 || !self.width.is_multiple_of(2) || !self.height.is_multiple_of(2) {
            return None;
        }
        let square = |k: usize| {
            let first = k / width * 2 * self.width + k % width * 2;
            let of = |at: usize| self.texels[at] + self.texels[at + 1];
            (of(first) + of(first + self.width)) * 0.25
        };
        Some(Self { width, height, texels: (0..width * height).map(square).collect() })
    }

    /// Interpolates between sixteen texels.
    fn cubic(&self, x: f64, y: f64) -> Vec4 {
        let place = |at: f64, size: usize| {
            let at = (at - 0.5).clamp(1.0, size as f64 - 2.0);
            let first = (at as usize).min(size - 3);
            (first - 1, catmull_rom((at - first as f64) as f32))
        };
        let ((column, across), (row, down)) = (place(x, self.width), place(y, self.height));
        let line = |k: usize| {
            let texels = &self.texels[(row + k) * self.width + column..][..4];
            (texels[0] * across[0] + texels[1] * across[1]) + (texels[2] * across[2] + texels[3] * across[3])
        };
        (line(0) * down[0] + line(1) * down[1]) + (line(2) * down[2] + line(3) * down[3])
    }
}

/// Returns the weights of four points of Catmull's and Rom's cubic (1974), a part of the way from the second to the third.
fn catmull_rom(t: f32) -> [f32; 4] {
    let (square, cube) = (t * t, t * t * t);
    [
        0.5 * (2.0 * square - cube - t),
        0.5 * (3.0 * cube - 5.0 * square + 2.0),
        0.5 * (4.0 * square - 3.0 * cube + t),
        0.5 * (cube - square),
    ]
}

impl Probes {
    /// Returns the look-ups of a footprint among texels of this size, on levels up to a coarsest one.
    fn of(footprint: &Footprint, texel: f64, coarsest: usize) -> Self {
        let DirectionJacobian { dx, dy } = footprint.jacobian;
        let [long, broad] = axes(dx, dy);
        let [length, breadth] = [long, broad].map(DVec3::length);
        // A look-up has the variance of its level's texels less that of the finest, and variances add: those of texels grow
        // fourfold from level to level.
        let (mut level, mut growth) = (0, 1.0 + (breadth / texel).powi(2));
        while growth > 4.0 && level < coarsest {
            (level, growth) = (level + 1, growth / 4.0);
        }
        let coarser = if level < coarsest { (growth - 1.0) / 3.0 } else { 0.0 };
        let coarser = if coarser > FAINT { coarser } else { 0.0 };
        let taken = texel * texel * ((1 << (2 * level)) as f64 * (1.0 + 3.0 * coarser) - 1.0);
        let own = (taken + texel * texel).sqrt();
        let steps = [(long, length), (broad, breadth)].map(|(axis, length)| {
            let left = (length * length - taken).max(0.0).sqrt();
            if left < NARROW * texel {
                return (DVec3::ZERO, 1);
            }
            let count = (1.0 + (left / (APART * own)).ceil()).min(MOST);
            // Points a step apart have the variance (count² − 1)/12.
            (axis * (left / length / (count * count - 1.0).sqrt()), count as usize)
        });
        Self { level, coarser, steps }
    }

    fn count(&self) -> usize {
        self.steps[0].1 * self.steps[1].1
    }

    /// Lists the offsets of look-ups from the footprint's middle.
    fn offsets(&self) -> impl Iterator<Item = DVec3> {
        let [(long, along), (broad, across)] = self.steps;
        let place = |k: usize, count: usize| k as f64 - 0.5 * (count - 1) as f64;
        (0..along * across).map(move |k| long * place(k % along, along) + broad * place(k / along, across))
    }
}

/// Returns the axes of the ellipse that has the covariance of two derivatives, the longer one first.
fn axes(dx: DVec3, dy: DVec3) -> [DVec3; 2] {
    // Of the parallelogram's sides x·dx + y·dy, the longest for x² + y² = 1.
    let (half, both) = (0.5 * (dx.length_squared() - dy.length_squared()), dx.dot(dy));
    let root = (half * half + both * both).sqrt();
    if root == 0.0 {
        return [dx, dy];
    }
    let cosine = (0.5 * (1.0 + half.abs() / root)).sqrt();
    let sine = 0.5 * both / (root * cosine);
    let (x, y) = if half >= 0.0 { (cosine, sine) } else { (sine, cosine) };
    [dx * x + dy * y, dy * x - dx * y]
}

impl PreparedFeline<'_> {
    /// Returns the view whose axis is nearest to a direction.
    fn view(&self, direction: DVec3) -> &Pyramid {
        let nearer = |one: &Pyramid, other: &Pyramid| one.axis.dot(direction).total_cmp(&other.axis.dot(direction));
        self.views.iter().max_by(|one, other| nearer(one, other)).expect("a world has a view")
    }

    /// Returns the look-ups of a footprint, and the view of its middle.
    fn probes(&self, footprint: &Footprint) -> (Probes, &Pyramid) {
        let direction = footprint.direction.vector();
        let view = self.view(direction);
        (Probes::of(footprint, view.texel(direction), view.levels.len() - 1), view)
    }
}

impl Prepared for PreparedFeline<'_> {
    fn world(&self) -> &World {
        self.world
    }

    fn reads(&self, footprint: &Footprint) -> usize {
        const TEXELS: usize = 16;
        bounded(footprint).map_or(0, |footprint| {
            let (probes, _) = self.probes(&footprint);
            TEXELS * probes.count() * if probes.coarser > 0.0 { 2 } else { 1 }
        })
    }

    fn average(&self, footprint: &Footprint) -> Rgba {
        let Some(footprint) = bounded(footprint) else { return Rgba::TRANSPARENT };
        let ((probes, view), middle) = (self.probes(&footprint), footprint.direction.vector());
        let look = |offset: DVec3| {
            let direction = middle + offset;
            self.view(direction).look(direction, &probes)
        };
        let mean = match probes.count() {
            1 => view.look(middle, &probes),
            count => probes.offsets().map(look).sum::<Vec4>() / count as f32,
        };
        // The cubic may fall below black beside a lamp.
        Rgba(mean.max(Vec4::ZERO).to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::camera::{FieldStop, PixelGrid, View};
    use crate::projection::{PlanePoint, PlaneRect, ProjectionKind};
    use crate::sphere::{CubeFace, Direction};
    use crate::world::panorama;

    const EDGE: usize = 64;

    /// Returns the faces of a cube with margins.
    fn cube() -> World {
        let size = EDGE + 2 * Feline::MARGIN;
        let side = size as f64 / EDGE as f64;
        let rect = PlaneRect { min: PlanePoint::new(-side, -side), max: PlanePoint::new(side, side) };
        let face = |face: CubeFace| View {
            projection: ProjectionKind::PERSPECTIVE,
            orientation: face.orientation(),
            grid: PixelGrid::spanning(size, size, rect),
            stop: FieldStop::NONE,
        };
        World::new(CubeFace::ALL.map(|at| (at.name().to_owned(), face(at)))).expect("six faces")
    }

    /// Returns smooth light: waves of 30° and more.
    fn waves(direction: Direction) -> Rgba {
        let DVec3 { x, y, z } = direction.vector();
        let wave = |phase: f64| (0.5 + 0.4 * phase.sin()) as f32;
        Rgba::opaque(wave(12.0 * x + 3.0 * y), wave(9.0 * y - 8.0 * z), wave(11.0 * z + 5.0 * x))
    }

    /// Returns footprints all over the sphere, round and long, from points to several texels.
    fn footprints() -> impl Iterator<Item = Footprint> {
        Direction::spread(3000).enumerate().map(|(k, at)| {
            let (right, up) = at.vector().any_orthonormal_pair();
            let (sin, cos) = (k as f64).sin_cos();
            let (width, long) = ([0.0, 0.005, 0.02, 0.06][k % 4], [1.0f64, 3.0, 8.0][k % 3]);
            let length = (width * long).min(0.2);
            Footprint::new(at, (right * cos + up * sin) * width, (up * cos - right * sin) * length)
        })
    }

    fn difference(found: Rgba, expected: Rgba) -> f32 {
        (0..4).map(|k| (found.0[k] - expected.0[k]).abs()).fold(0.0, f32::max)
    }

    /// Returns the mean over a footprint's parallelogram.
    fn mean(footprint: &Footprint) -> Rgba {
        const SIDE: usize = 24;
        let place = |k: usize| (k as f64 + 0.5) / SIDE as f64 - 0.5;
        let at = |k: usize| footprint.direction_at(place(k % SIDE), place(k / SIDE)).expect("a near direction");
        (0..SIDE * SIDE).fold(Rgba::TRANSPARENT, |sum, k| sum + waves(at(k)) * (1.0 / (SIDE * SIDE) as f32))
    }

    #[test]
    fn smooth_light_is_that_of_the_parallelogram() {
        let world = cube();
        let light = Light::by_direction(&world, waves);
        let prepared = Feline.prepare(&world, &light).expect("faces of a cube");
        let errors = footprints().map(|footprint| difference(prepared.average(&footprint), mean(&footprint)));
        let worst = errors.fold(0.0, f32::max);
        assert!(worst < 0.01, "{worst}");
    }

    #[test]
    fn light_hardly_steps_from_face_to_face() {
        let world = cube();
        let light = Light::by_direction(&world, waves);
        let prepared = Feline.prepare(&world, &light).expect("faces of a cube");
        for (k, footprint) in footprints().enumerate() {
            // On an edge, and to both sides of it.
            let DVec3 { x, y, .. } = footprint.direction.vector();
            let side = [x, y][k % 2].signum();
            let beside = |step: f64| {
                let at = [side * (1.0 + step), 0.9 * (k as f64).sin(), 1.0];
                Direction::new(DVec3::new(at[0], at[1], at[2])).expect("a direction")
            };
            let [left, right] = [-1e-9, 1e-9].map(|step| {
                let direction = beside(step);
                let (right, up) = direction.vector().any_orthonormal_pair();
                let [dx, dy] = [footprint.jacobian.dx.length(), footprint.jacobian.dy.length()];
                prepared.average(&Footprint::new(direction, right * dx, up * dy))
            });
            assert!(difference(left, right) < 5e-3, "{left:?}, {right:?}: {footprint:?}");
        }
    }

    #[test]
    fn white_stays_white_and_panoramas_are_refused() {
        let world = cube();
        let white = Light::by_direction(&world, |_| Rgba::opaque(1.0, 1.0, 1.0));
        let prepared = Feline.prepare(&world, &white).expect("faces of a cube");
        for footprint in footprints() {
            let found = prepared.average(&footprint);
            assert!(difference(found, Rgba::opaque(1.0, 1.0, 1.0)) < 1e-5, "{found:?}");
            assert!((16..=16 * 2 * 64).contains(&prepared.reads(&footprint)));
        }
        let world = World::new([("all".to_owned(), panorama(80, 40))]).expect("a view");
        let light = Light::by_direction(&world, waves);
        assert_eq!(Feline.prepare(&world, &light).err(), Some(PrepareError::NotPerspective));
    }
}
