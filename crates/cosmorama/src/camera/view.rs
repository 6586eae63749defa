use std::ops::Range;

use glam::{DMat2, DMat3, DVec2, DVec3};

use super::{FieldStop, Footprint, PixelBounds, PixelGrid, PixelPoint};
use crate::projection::{Outline, PlanePoint, Projection, ProjectionKind};
use crate::sphere::{Angle, Direction, DirectionJacobian, Orientation};

/// Distance from a steep rim, in texels, within which texels are measured from side to side.
const STEEP: f64 = 4.0;

/// Tolerance in pixels for rounding errors: a point this close to an edge, or to a whole number of columns, is taken to
/// be there.
pub(crate) const ROUNDING: f64 = 1e-6;

/// The geometry of an image: how its pixels see the world. A source's view says where its texels lie, a target's which
/// pixels are wanted. It does not hold the image itself.
#[derive(Clone, Debug, PartialEq)]
pub struct View {
    /// Projection of the lens.
    pub projection: ProjectionKind,
    /// Orientation of the camera.
    pub orientation: Orientation,
    /// Place of the pixels in the projection's plane.
    pub grid: PixelGrid,
    /// Limits of the field of view inside the image.
    pub stop: FieldStop,
}

/// Bisection steps in the search for a picture's border, which find it to a millionth of the way.
const BORDER_STEPS: usize = 20;

impl View {
    /// Returns whether straight lines stay straight, as in a pinhole camera's picture.
    pub fn is_pinhole(&self) -> bool {
        matches!(self.projection, ProjectionKind::Perspective(_))
    }

    /// Returns whether the pixels of two views are the same except for the views' orientation.
    pub fn is_alike(&self, other: &Self) -> bool {
        self.projection == other.projection && self.grid == other.grid && self.stop == other.stop
    }

    /// Returns the matrix from (x, y, 1) of a pinhole camera's image to a vector along what is seen there, in the world's
    /// frame. Its component along the view's axis is one. `None` for other views.
    pub(crate) fn rays(&self) -> Option<DMat3> {
        let (first, step) = (self.grid.to_plane(PixelPoint::new(0.0, 0.0)), self.grid.step());
        let columns = [DVec3::X * step.x, DVec3::NEG_Y * step.y, DVec3::new(first.x, first.y, -1.0)];
        let [across, down, corner] = columns.map(|column| self.orientation.vector_to_world(column));
        (self.projection == ProjectionKind::PERSPECTIVE).then(|| DMat3::from_cols(across, down, corner))
    }

    /// Returns the number of columns.
    pub fn width(&self) -> usize {
        self.grid.width()
    }

    /// Returns the number of rows.
    pub fn height(&self) -> usize {
        self.grid.height()
    }

    /// Returns the view when the camera's mount is turned by `outer`: the camera's own orientation is relative to the
    /// mount.
    #[must_use]
    pub fn turned(&self, outer: Orientation) -> Self {
        Self { orientation: self.orientation.within(outer), ..self.clone() }
    }

    /// Returns the direction at a point of the image, in the world's frame, even if the field stop hides it.
    pub fn direction(&self, pixel: PixelPoint) -> Option<Direction> {
        let direction = self.projection.unproject(self.grid.to_plane(pixel))?;
        Some(self.orientation.to_world(direction))
    }

    /// Visits the directions of neighbouring pixel centres in row `j`, each with its column.
    pub fn row_directions(&self, j: usize, columns: Range<usize>, mut visit: impl FnMut(usize, Direction)) {
        let first = self.grid.to_plane(PixelPoint::centre(columns.start, j));
        self.projection.unproject_row(first, self.grid.step().x, columns.len(), |k, direction| {
            visit(columns.start + k, self.orientation.to_world(direction));
        });
    }

    /// Returns the last direction inside the picture on the way from its middle to a direction outside.
    pub(crate) fn border_towards(&self, direction: Direction) -> Option<Direction> {
        let middle = self.direction(PixelPoint::new(self.width() as f64 / 2.0, self.height() as f64 / 2.0))?.vector();
        let at = |part: f64| Direction::new(middle.lerp(direction.vector(), part));
        let is_inside = |part: f64| at(part).and_then(|d| self.pixel(d)).is_some_and(|pixel| self.grid.contains(pixel));
        let (mut inside, mut outside) = (0.0, 1.0);
        for _ in 0..BORDER_STEPS {
            let part = 0.5 * (inside + outside);
            if is_inside(part) { inside = part } else { outside = part }
        }
        at(inside)
    }

    /// Returns the longitude of the plane's origin in an upright cylinder, whose rows are rings of one latitude and
    /// whose columns lie at evenly spaced longitudes; `None` for other views.
    pub(crate) fn upright_cylinder(&self) -> Option<f64> {
        use ProjectionKind::{CentralCylinder, EqualAreaCylinder, Equirectangular, Mercator};
        let is_cylinder =
            matches!(self.projection, Equirectangular(_) | Mercator(_) | CentralCylinder(_) | EqualAreaCylinder(_));
        let is_upright = self.orientation.to_world(Direction::UP) == Direction::UP;
        let front = self.orientation.to_world(Direction::FRONT).vector();
        (is_cylinder && is_upright).then(|| front.x.atan2(-front.z))
    }

    /// Returns whether every direction of the world is in the picture: all longitudes, from pole to pole.
    pub fn covers_sphere(&self) -> bool {
        let sees_pole = |pole| {
            let pole = self.orientation.to_world(pole);
            self.pixel(pole).is_some_and(|pixel| (-ROUNDING..=self.height() as f64 + ROUNDING).contains(&pixel.y))
        };
        self.period().is_some_and(|period| period <= self.width())
            && self.stop == FieldStop::NONE
            && sees_pole(Direction::UP)
            && sees_pole(Direction::DOWN)
    }

    /// Returns whether the picture is flat, as those of pinhole cameras and cube faces are: planar depth is a distance from
    /// the plane of such a camera.
    pub fn is_flat(&self) -> bool {
        use ProjectionKind::{EquiAngular, Perspective, Pinhole};
        matches!(self.projection, Perspective(_) | Pinhole(_) | EquiAngular(_))
    }

    /// Calls `visit` with each column of row `j` that sees something, and the planar depth of a point there at the distance
    /// 1: the cosine of its angle from the camera's axis.
    pub fn row_planar_depths(&self, j: usize, mut visit: impl FnMut(usize, f32)) {
        let axis = self.orientation.to_world(Direction::FRONT);
        self.row_directions(j, 0..self.width(), |i, direction| visit(i, direction.dot(axis) as f32));
    }

    /// Returns the direction at a point of the image with its derivatives per pixel.
    pub fn footprint(&self, pixel: PixelPoint) -> Option<Footprint> {
        let point = self.grid.to_plane(pixel);
        let (direction, plane) = self.projection.unproject_with_jacobian(point)?;
        let step = self.grid.step();
        let jacobian = DirectionJacobian { dx: plane.dx * step.x, dy: plane.dy * -step.y };
        Some(Footprint {
            direction: self.orientation.to_world(direction),
            jacobian: self.orientation.jacobian_to_world(jacobian),
        })
    }

    /// Returns the pixel position of a direction of the world, in the image or outside it.
    pub fn pixel(&self, direction: Direction) -> Option<PixelPoint> {
        self.projection.project(self.orientation.to_view(direction)).map(|point| self.grid.to_pixel(point))
    }

    /// Returns whether a point shows something: it lies in the image, and the field stop does not hide it.
    pub fn shows(&self, pixel: PixelPoint) -> bool {
        self.grid.contains(pixel) && self.stop_passes(pixel)
    }

    /// Returns whether a direction of the world is in the picture.
    pub fn sees(&self, direction: Direction) -> bool {
        self.pixel(direction).is_some_and(|pixel| self.shows(self.wrapped(pixel)))
    }

    /// Maps a footprint to this view's own pixels: its centre, and the matrix whose columns are the steps for one
    /// screen pixel along x and y ((Ux, Vx) and (Uy, Vy) in Greene & Heckbert).
    pub fn texel_footprint(&self, footprint: &Footprint) -> Option<(PixelPoint, DMat2)> {
        if self.projection.has_steep_rim() {
            let pixel = self.pixel(footprint.direction)?;
            let texel = self.texel(pixel)?;
            let [x, y] = [footprint.jacobian.dx, footprint.jacobian.dy].map(|t| texel.pseudo_inverse(t));
            return Some((pixel, DMat2::from_cols(x?, y?)));
        }
        let direction = self.orientation.to_view(footprint.direction);
        let tangents = [footprint.jacobian.dx, footprint.jacobian.dy].map(|t| self.orientation.vector_to_view(t));
        let (point, [x, y]) = self.projection.project_with_derivatives(direction, tangents)?;
        let step = self.grid.step();
        let texels = DMat2::from_cols(DVec2::new(x.x / step.x, -x.y / step.y), DVec2::new(y.x / step.x, -y.y / step.y));
        Some((self.grid.to_pixel(point), texels))
    }

    /// Returns the change of the direction over the texel around a point of the image, per texel. These are its
    /// derivatives, except on a steep rim: there they are measured from one side of the texel to the other.
    pub(crate) fn texel(&self, pixel: PixelPoint) -> Option<DirectionJacobian> {
        let footprint = self.footprint(pixel)?;
        let Footprint { direction, jacobian } = footprint;
        if !self.is_steep_at(&footprint) {
            return Some(jacobian);
        }
        let at = |dx: f64, dy: f64| self.direction(PixelPoint::new(pixel.x + dx, pixel.y + dy)).map(Direction::vector);
        let across = |dx: f64, dy: f64| {
            let here = direction.vector();
            let between = at(dx / 2.0, dy / 2.0).zip(at(-dx / 2.0, -dy / 2.0)).map(|(next, last)| next - last);
            between.or_else(|| at(-dx, -dy).map(|last| here - last)).or_else(|| at(dx, dy).map(|next| next - here))
        };
        let (dx, dy) = (across(1.0, 0.0), across(0.0, 1.0));
        let Some(period) = self.projection.period() else { return Some(DirectionJacobian { dx: dx?, dy: dy? }) };
        // In a panorama of one or two columns, the chord across a texel says nothing. In a row that reaches beyond both
        // poles, there is no chord.
        let dx = dx.filter(|_| self.grid.step().x.abs() < 0.4 * period);
        let by_derivative = |side: DVec3| side * (std::f64::consts::PI / side.length()).min(1.0);
        Some(DirectionJacobian {
            dx: dx.unwrap_or_else(|| by_derivative(jacobian.dx)),
            dy: dy.unwrap_or_else(|| by_derivative(jacobian.dy)),
        })
    }

    /// Returns the solid angle of a texel in steradians (to first order), zero where it shows nothing.
    pub fn texel_solid_angle(&self, i: usize, j: usize) -> f64 {
        let pixel = PixelPoint::centre(i, j);
        // Texels that show nothing have no solid angle.
        let shows = self.grid.contains(pixel) && (self.stop == FieldStop::NONE || self.stop_passes(pixel));
        if shows { self.solid_angle(pixel).unwrap_or(0.0) } else { 0.0 }
    }

    /// Computes the solid angles of the first texels of row `j`, in steradians, as [`View::texel_solid_angle`] does one by one.
    pub(crate) fn row_solid_angles(&self, j: usize, row: &mut [f32]) {
        if self.stop != FieldStop::NONE || self.projection.has_steep_rim() {
            row.iter_mut().enumerate().for_each(|(i, angle)| *angle = self.texel_solid_angle(i, j) as f32);
            return;
        }
        self.solid_angles_from(PixelPoint::centre(0, j), row.len(), |i, solid_angle| {
            row[i] = solid_angle.map_or(0.0, |solid_angle| solid_angle as f32);
        });
    }

    /// Computes solid angles as [`View::solid_angle`] does, around a point and points to its right, a pixel apart each, and calls
    /// `visit` with the number of each.
    pub(crate) fn solid_angles_from(&self, first: PixelPoint, count: usize, mut visit: impl FnMut(usize, Option<f64>)) {
        if self.projection.has_steep_rim() {
            let at = |i: usize| PixelPoint::new(first.x + i as f64, first.y);
            return (0..count).for_each(|i| visit(i, self.solid_angle(at(i))));
        }
        let (first, step) = (self.grid.to_plane(first), self.grid.step());
        let area = (step.x * step.y).abs();
        self.projection.row_solid_angles(first, step.x, count, |i, solid_angle| {
            visit(i, solid_angle.map(|solid_angle| solid_angle * area));
        });
    }

    /// Returns the solid angle in steradians (to first order) of a texel around a point of the image or beyond it,
    /// whether or not it shows something.
    pub(crate) fn solid_angle(&self, pixel: PixelPoint) -> Option<f64> {
        let step = self.grid.step();
        let solid_angle = self.projection.solid_angle(self.grid.to_plane(pixel))? * (step.x * step.y).abs();
        if !self.projection.has_steep_rim() {
            return Some(solid_angle);
        }
        // On the very rim the derivatives may be infinite, but the texel's solid angle is not.
        Some(solid_angle.min(2.0 * self.texel(pixel)?.solid_angle()))
    }

    /// Returns pixels per radian at the centre of the projection: the mean of both axes where pixels are not square.
    pub fn pixels_per_radian(&self) -> f64 {
        let step = self.grid.step();
        let centre = self.projection.jacobian(PlanePoint::new(0.0, 0.0)).map_or(1.0, |jacobian| jacobian.solid_angle());
        (centre * (step.x * step.y).abs()).sqrt().recip()
    }

    /// Returns the number of columns after which the picture repeats, if it goes all the way round.
    pub fn period(&self) -> Option<usize> {
        let columns = (self.projection.period()? / self.grid.step().x).abs();
        let whole = columns.round();
        ((columns - whole).abs() < ROUNDING && whole >= 1.0).then_some(whole as usize)
    }

    /// Returns whether the field stop lets a point of the plane pass, inside the image or outside it.
    pub fn stop_passes(&self, pixel: PixelPoint) -> bool {
        let point = self.grid.to_plane(pixel);
        self.projection.unproject(point).is_some_and(|direction| self.stop.passes(point, || Some(direction)))
    }

    /// Returns [`Projection::margin`] of a direction of the world.
    pub fn margin(&self, direction: Direction) -> f64 {
        self.projection.margin(self.orientation.to_view(direction))
    }

    /// Returns [`Projection::beyond_seam`] of a direction of the world.
    pub(crate) fn beyond_seam(&self, direction: Direction) -> Option<Direction> {
        let beyond = self.projection.beyond_seam(self.orientation.to_view(direction))?;
        Some(self.orientation.to_world(beyond))
    }

    /// Returns whether a rim or a pole is so close that texels of this footprint are measured from side to side.
    pub(crate) fn is_steep_at(&self, footprint: &Footprint) -> bool {
        let Footprint { direction, jacobian } = footprint;
        let size = (jacobian.dx.length_squared() + jacobian.dy.length_squared()).sqrt();
        self.projection.has_steep_rim() && self.margin(*direction) <= STEEP * size
    }

    /// Returns the rectangle that holds every direction within `radius` of a direction of the world.
    pub fn cap_bounds(&self, centre: Direction, radius: Angle) -> PixelBounds {
        let plane = self.projection.cap_bounds(self.orientation.to_view(centre), radius);
        let (a, b) = (self.grid.to_pixel(plane.min), self.grid.to_pixel(plane.max));
        PixelBounds {
            min: PixelPoint::new(a.x.min(b.x), a.y.min(b.y)),
            max: PixelPoint::new(a.x.max(b.x), a.y.max(b.y)),
        }
    }

    /// Returns the part of the projection's plane that holds every direction within `radius` of a direction of the
    /// world.
    pub(crate) fn cap_outline(&self, centre: Direction, radius: Angle) -> Outline {
        self.projection.cap_outline(self.orientation.to_view(centre), radius)
    }

    /// Shifts a point by whole turns into the image, in projections that repeat along x. Others return it unchanged.
    pub fn wrapped(&self, pixel: PixelPoint) -> PixelPoint {
        match self.projection.period() {
            Some(period) if !self.grid.contains(pixel) => {
                PixelPoint { x: pixel.x.rem_euclid((period / self.grid.step().x).abs()), ..pixel }
            }
            _ => pixel,
        }
    }
}
