//! Average of a footprint in pinhole views, across their edges. A round kernel on the sphere has a conic as its outline
//! in each view's image plane.

use fearless_simd::{Simd, f32x8, prelude::*};
use glam::{DMat2, DMat3, DVec2, DVec3};

use super::blocks::{Blocks, LANES, LaneKernel, Weighed, count_up};
use super::lanes::Falloff;
use super::prefetch::prefetch;
use super::rows::{Conic, Lattice, Row, Rows};
use crate::camera::{FieldStop, Footprint};
use crate::filter::gather::{LINEAR_PART, reach, shape};
use crate::filter::{Ellipse, Kernel};
use crate::raster::Rgba;
use crate::sphere::Direction;
use crate::world::{Source, World};

/// Pinhole views with texels of one size, such as the faces of a cube.
pub(crate) struct Pinholes {
    views: Vec<Pinhole>,
    /// Size of the largest texel of all views: the longer of its two sides, in radians.
    texel_pitch: f64,
}

/// A pinhole view as three vectors: the point (U, V) of its image, in pixels, shows the direction across·U + down·V +
/// corner.
struct Pinhole {
    across: DVec3,
    down: DVec3,
    corner: DVec3,
    /// Matrix from a direction to (U, V, 1) times the depth, which is the direction's component along the view's axis.
    to_image: DMat3,
    size: [usize; 2],
    /// Index of the view's first texel in the light.
    offset: usize,
    /// Cone that holds the view: its axis, and cosine and sine of its half angle.
    axis: DVec3,
    cone: [f64; 2],
}

/// Kernel of a footprint, on the sphere.
struct Shape {
    direction: DVec3,
    /// Axes whose dot products with a direction give its offset from the footprint's middle, in the kernel's unit.
    axes: [DVec3; 2],
    /// Upper bound of the kernel's radius in radians.
    radius: f64,
}

/// A kernel in the image plane of a view. Offsets (u, v), in texels, are measured from a reference point: the image of
/// the footprint's direction. If the footprint looks along the plane or away from it, the middle of the image takes its
/// place.
struct Plane {
    /// Whether the reference point is the image of the footprint's direction.
    is_before: bool,
    lattice: Lattice,
    /// Terms of a texel's offset from the footprint's middle, in the kernel's unit: (middle + u·across + v·down) / √s.
    middle: DVec2,
    across: DVec2,
    down: DVec2,
    /// Coefficients of s = 1 + u·s₀ + v·s₁ + u²·s₂ + v²·s₃: the squared distance of a texel from the pinhole, relative
    /// to that of the reference point.
    s: [f64; 4],
    /// Coefficients of front₀ + u·front₁ + v·front₂, which is positive less than a right angle from the footprint's
    /// direction.
    front: [f64; 3],
    /// Whether the kernel is so small that distances are taken as linear in u and v. Then s enters only solid angles
    /// and offsets.
    is_linear: bool,
    /// Solid angle of a texel at the reference point, in steradians.
    solid_angle: f64,
    /// Share of the coarse cubic.
    coarseness: f64,
}

/// Least depth of a footprint's direction before the plane for its image to be the reference point.
const NEAR: f64 = 0.05;

impl Pinholes {
    /// Returns the views of a world. `None` unless all are pinhole views with texels of one size, without field stops,
    /// masks or overlaps.
    pub(crate) fn of(world: &World) -> Option<Self> {
        let texel_pitch = world.sources()[0].texel_pitch;
        let views =
            world.sources().iter().map(|source| Pinhole::of(source).filter(|_| source.texel_pitch == texel_pitch));
        Some(Self { views: views.collect::<Option<_>>()?, texel_pitch })
    }

    /// Returns the view that holds a direction.
    pub(crate) fn holder(&self, direction: Direction) -> Option<usize> {
        self.views.iter().position(|view| view.holds(direction.vector()))
    }
}

impl Pinhole {
    fn of(source: &Source) -> Option<Self> {
        let view = &source.view;
        let is_plain = view.stop == FieldStop::NONE && source.mask.is_none() && source.others.is_empty();
        let rays = view.rays()?;
        let [across, down, corner] = [rays.x_axis, rays.y_axis, rays.z_axis];
        let size = [view.width(), view.height()];
        let [right, bottom] = size.map(|size| size as f64);
        let axis = (corner + across * (0.5 * right) + down * (0.5 * bottom)).normalize();
        let corners = [[0.0, 0.0], [right, 0.0], [0.0, bottom], [right, bottom]];
        let cosine = |[x, y]: [f64; 2]| (corner + across * x + down * y).normalize().dot(axis);
        let cosine = corners.map(cosine).into_iter().fold(1.0, f64::min);
        let to_image = rays.inverse();
        let cone = [cosine, (1.0 - cosine * cosine).sqrt()];
        is_plain.then_some(Self { across, down, corner, to_image, size, offset: source.offset, axis, cone })
    }

    /// Returns whether a direction is in the picture.
    #[inline(always)]
    fn holds(&self, direction: DVec3) -> bool {
        let at = self.to_image * direction;
        let [right, bottom] = self.size.map(|size| size as f64 * at.z);
        at.z > 0.0 && at.x >= 0.0 && at.y >= 0.0 && at.x < right && at.y < bottom
    }

    /// Returns whether a kernel may reach into the picture.
    #[inline(always)]
    fn is_reached(&self, shape: &Shape) -> bool {
        // Offsets are seen along the footprint's direction, so the radius is the sine of an angle, and of a right angle
        // at most.
        let sine = shape.radius.min(1.0);
        let cosine = (1.0 - sine * sine).sqrt();
        self.axis.dot(shape.direction) > self.cone[0] * cosine - self.cone[1] * sine
    }

    /// Returns a kernel in this view's plane.
    #[inline(always)]
    fn plane(&self, shape: &Shape, kernel: &Kernel) -> Plane {
        let at = self.to_image * shape.direction;
        let depth = at.z;
        let is_before = depth > NEAR;
        let (place, point) = if is_before {
            ([at.x / depth, at.y / depth], shape.direction / depth)
        } else {
            let middle = self.size.map(|size| 0.5 * size as f64);
            (middle, self.corner + self.across * middle[0] + self.down * middle[1])
        };
        let nearness = point.length_recip();
        let [point, step, line] = [point * nearness, self.across * nearness, self.down * nearness];
        let [x, y] = shape.axes;
        let along = |vector: DVec3| DVec2::new(x.dot(vector), y.dot(vector));
        let (across, down) = (along(step), along(line));
        let texels = across.perp_dot(down).abs().sqrt().recip() / kernel.scale;
        Plane {
            is_before,
            lattice: Lattice::around(place, self.size),
            middle: along(point),
            across,
            down,
            s: [2.0 * point.dot(step), 2.0 * point.dot(line), step.length_squared(), line.length_squared()],
            front: [point, step, line].map(|vector| vector.dot(shape.direction)),
            is_linear: shape.radius < LINEAR_PART * depth,
            solid_angle: step.cross(line).length() * nearness,
            coarseness: kernel.coarseness(texels),
        }
    }
}

impl Shape {
    /// Returns the kernel of a footprint, among texels of this pitch.
    #[inline(always)]
    fn of(footprint: &Footprint, kernel: &Kernel, texel_pitch: f64) -> Self {
        let footprint = shape(kernel, footprint);
        let (dx, dy) = (footprint.jacobian.dx, footprint.jacobian.dy);
        let normal = dx.cross(dy);
        let unit = (normal.length_squared() * kernel.scale).recip();
        let axes = [dy.cross(normal) * unit, normal.cross(dx) * unit];
        let radius = reach(kernel, &footprint, texel_pitch, kernel.floor);
        Self { direction: footprint.direction.vector(), axes, radius }
    }
}

impl Plane {
    /// Raises the kernel's axes to `floor` texels. Returns whether one was shorter.
    #[inline(always)]
    fn raise(&mut self, floor: f64) -> bool {
        let (a, b) = (self.across.length_squared(), self.down.length_squared());
        let (half, both) = (0.5 * (a - b), self.across.dot(self.down));
        // The greater singular value belongs to the shorter axis.
        if (0.5 * (a + b) + (half * half + both * both).sqrt()) * floor * floor <= 1.0 {
            return false;
        }
        let ellipse = Ellipse::new(DMat2::from_cols(self.across, self.down).inverse(), floor);
        let root = ellipse.a.sqrt();
        let lean = 0.5 * ellipse.b / root;
        self.across = DVec2::new(root, 0.0);
        self.down = DVec2::new(lean, (ellipse.c - lean * lean).max(0.0).sqrt());
        true
    }

    /// Returns the conic of points whose squared distance from the middle, in the kernel's unit, is less than `reach`.
    #[inline(always)]
    fn conic(&self, reach: f64) -> Conic {
        let Self { middle, across, down, s, .. } = self;
        let bend = if self.is_linear { 0.0 } else { reach };
        Conic {
            uu: across.length_squared() - bend * s[2],
            uv: 2.0 * across.dot(*down),
            vv: down.length_squared() - bend * s[3],
            u: 2.0 * middle.dot(*across) - bend * s[0],
            v: 2.0 * middle.dot(*down) - bend * s[1],
            one: middle.length_squared() - reach,
        }
    }
}

impl Pinholes {
    /// Averages the texels under a footprint. `view` is the index of the view that shows the footprint's centre, if the
    /// caller knows it. Returns `None` where these fast loops over rows of texels do not apply. Then the caller lists
    /// the texels one by one.
    #[inline(always)]
    pub(crate) fn average<S: Simd>(
        &self,
        simd: S,
        kernel: &LaneKernel,
        light: &[Rgba],
        footprint: &Footprint,
        view: Option<usize>,
    ) -> Option<Rgba> {
        let LaneKernel { kernel: profile, anti_ringing, .. } = kernel;
        let shape = Shape::of(footprint, profile, self.texel_pitch);
        let own = view.or_else(|| self.holder(footprint.direction))?;
        let mut blocks = Blocks::default();
        let mut plane = self.views[own].plane(&shape, profile);
        let is_raised = plane.raise(profile.floor);
        if self.views[own].fill(simd, kernel, &plane, light, &mut blocks)? {
            for (index, other) in self.views.iter().enumerate() {
                if index == own || !other.is_reached(&shape) {
                    continue;
                }
                let mut plane = other.plane(&shape, profile);
                // Axes raised to the floor would differ between views. Where the other view's plane does not show the
                // footprint's direction, nothing is raised: only a wide kernel reaches that view.
                if is_raised || plane.is_before && plane.raise(profile.floor) {
                    return None;
                }
                other.fill(simd, kernel, &plane, light, &mut blocks)?;
            }
            if kernel.needs_surroundings() && !blocks.surround() {
                return None;
            }
        }
        Some(blocks.average(simd, light, profile.centred, *anti_ringing))
    }
}

impl Pinhole {
    /// Adds the texels of a view under a kernel. Returns whether the kernel reaches outside the view; `None` if there
    /// are too many texels.
    #[inline(always)]
    fn fill<S: Simd>(
        &self,
        simd: S,
        kernel: &LaneKernel,
        plane: &Plane,
        light: &[Rgba],
        blocks: &mut Blocks,
    ) -> Option<bool> {
        let reach = kernel.kernel.radius().powi(2);
        let mut rows = Rows::default();
        rows.cut(simd, &plane.conic(reach), &plane.lattice)?;
        let first = |row: &Row| self.offset + row.row * self.size[0] + row.column;
        for row in &rows.rows {
            prefetch(&light[first(row)..][..row.count]);
        }
        let curve = kernel.cubics.blend(f32x8::splat(simd, plane.coarseness as f32));
        let inverse = reach.recip() as f32;
        let [across, down] = [plane.across, plane.down].map(|vector| [vector.x as f32, vector.y as f32]);
        let (middle, s) = ([plane.middle.x as f32, plane.middle.y as f32], plane.s.map(|part| part as f32));
        let front = plane.front.map(|part| part as f32);
        for row in &rows.rows {
            let v = row.v;
            let (x, y) = (down[0] * v + middle[0], down[1] * v + middle[1]);
            let (s0, f0) = (1.0 + (s[3] * v + s[1]) * v, front[0] + front[2] * v);
            for start in (0..row.count).step_by(LANES) {
                let u = count_up(simd) + (row.u + start as f32);
                let (x, y) = (u * across[0] + x, u * across[1] + y);
                let nearness = f32x8::splat(simd, 1.0) / ((u * s[2] + s[0]) * u + s0);
                let root = nearness.sqrt();
                let mut q = x * x + y * y;
                if !plane.is_linear {
                    let is_front = (u * front[1] + f0).simd_gt(f32x8::splat(simd, 0.0));
                    q = is_front.select(q * nearness, f32x8::splat(simd, f32::MAX));
                }
                let weighed = Weighed {
                    q,
                    weight: curve.weight(q),
                    solid_angle: nearness * root * plane.solid_angle as f32,
                    offset: [x * root, y * root],
                };
                blocks.push(simd, (first(row) + start, (row.count - start).min(LANES)), weighed, inverse)?;
            }
        }
        Some(rows.is_cut)
    }
}
