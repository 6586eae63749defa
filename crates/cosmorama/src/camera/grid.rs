use glam::DVec2;

use crate::projection::{PlanePoint, PlaneRect};

/// A point of an image in continuous pixel coordinates: x to the right, y DOWN. (0, 0) is the outer corner of the top
/// left pixel, whose centre is at (½, ½).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelPoint {
    /// Distance to the right of the left edge.
    pub x: f64,
    /// Distance below the top edge.
    pub y: f64,
}

impl PixelPoint {
    /// Returns the point (x, y).
    pub const fn new(x: f64, y: f64) -> Self {
        Self { x, y }
    }

    /// Returns the centre of the pixel in column `i` of row `j`.
    pub const fn centre(i: usize, j: usize) -> Self {
        Self { x: i as f64 + 0.5, y: j as f64 + 0.5 }
    }
}

/// A rectangle in continuous pixel coordinates; it may reach beyond the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelBounds {
    /// The upper left corner.
    pub min: PixelPoint,
    /// The lower right corner.
    pub max: PixelPoint,
}

/// A rectangle of whole pixels: columns `left..right`, rows `top..bottom`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PixelRect {
    /// First column.
    pub left: usize,
    /// First row.
    pub top: usize,
    /// One past the last column.
    pub right: usize,
    /// One past the last row.
    pub bottom: usize,
}

impl PixelRect {
    /// Returns the number of columns.
    pub const fn width(&self) -> usize {
        self.right.saturating_sub(self.left)
    }

    /// Returns the number of rows.
    pub const fn height(&self) -> usize {
        self.bottom.saturating_sub(self.top)
    }

    /// Returns the smallest rectangle that holds both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            left: self.left.min(other.left),
            top: self.top.min(other.top),
            right: self.right.max(other.right),
            bottom: self.bottom.max(other.bottom),
        }
    }

    /// Returns whether all of `other` lies in this rectangle.
    pub const fn contains(&self, other: &Self) -> bool {
        self.left <= other.left && self.top <= other.top && self.right >= other.right && self.bottom >= other.bottom
    }
}

/// Prints `WxH+X+Y`, the usual notation for windows of an image.
impl std::fmt::Display for PixelRect {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}+{}+{}", self.width(), self.height(), self.left, self.top)
    }
}

/// Affine map between the pixels of an image and a projection's plane: x = (px − origin.x)·step.x, y = (origin.y −
/// py)·step.y.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelGrid {
    width: usize,
    height: usize,
    /// Pixel coordinates of the plane's origin.
    origin: DVec2,
    /// Plane units per pixel; a negative step mirrors the picture.
    step: DVec2,
}

impl PixelGrid {
    /// Returns the grid of an image whose edges are those of a rectangle of the plane.
    pub fn spanning(width: usize, height: usize, rect: PlaneRect) -> Self {
        let step = DVec2::new((rect.max.x - rect.min.x) / width as f64, (rect.max.y - rect.min.y) / height as f64);
        Self { width, height, origin: DVec2::new(-rect.min.x / step.x, rect.max.y / step.y), step }
    }

    /// Returns the grid of an image with the plane's origin at pixel `origin` and `step` plane units per pixel along x
    /// and y.
    pub fn centred(width: usize, height: usize, origin: PixelPoint, step: DVec2) -> Self {
        Self { width, height, origin: DVec2::new(origin.x, origin.y), step }
    }

    /// Returns the grid of a crop of `width`×`height` pixels whose top left corner is at (x, y). The crop may extend
    /// beyond the image on any side.
    #[must_use]
    pub fn window(self, width: usize, height: usize, x: f64, y: f64) -> Self {
        Self { width, height, origin: self.origin - DVec2::new(x, y), ..self }
    }

    /// Returns the grid of the same picture with its columns and rows divided by these numbers, without remainder.
    #[must_use]
    pub fn squeezed(self, (across, down): (usize, usize)) -> Self {
        let by = DVec2::new(across as f64, down as f64);
        let (width, height) = (self.width / across, self.height / down);
        Self { width, height, origin: self.origin / by, step: self.step * by }
    }

    /// Halves the resolution of the first `columns` columns and all rows, rounded up; the picture keeps its place.
    #[must_use]
    pub(crate) fn halved(self, columns: usize) -> Self {
        let (width, height) = (columns.div_ceil(2), self.height.div_ceil(2));
        let by = DVec2::new(columns as f64 / width as f64, self.height as f64 / height as f64);
        Self { width, height, origin: self.origin / by, step: self.step * by }
    }

    /// Returns the grid of the picture mirrored left to right.
    #[must_use]
    pub fn flipped_x(self) -> Self {
        let origin = DVec2::new(self.width as f64 - self.origin.x, self.origin.y);
        Self { origin, step: DVec2::new(-self.step.x, self.step.y), ..self }
    }

    /// Returns the grid of the picture mirrored top to bottom.
    #[must_use]
    pub fn flipped_y(self) -> Self {
        let origin = DVec2::new(self.origin.x, self.height as f64 - self.origin.y);
        Self { origin, step: DVec2::new(self.step.x, -self.step.y), ..self }
    }

    /// Returns the number of columns.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Returns the number of rows.
    pub fn height(&self) -> usize {
        self.height
    }

    /// Returns plane units per pixel along x (right) and y (up).
    pub fn step(&self) -> DVec2 {
        self.step
    }

    /// Converts a pixel position to a point of the plane.
    pub fn to_plane(&self, pixel: PixelPoint) -> PlanePoint {
        PlanePoint::new((pixel.x - self.origin.x) * self.step.x, (self.origin.y - pixel.y) * self.step.y)
    }

    /// Converts a point of the plane to a pixel position.
    pub fn to_pixel(&self, point: PlanePoint) -> PixelPoint {
        PixelPoint::new(self.origin.x + point.x / self.step.x, self.origin.y - point.y / self.step.y)
    }

    /// Returns whether a pixel position lies in the image.
    pub fn contains(&self, pixel: PixelPoint) -> bool {
        pixel.x >= 0.0 && pixel.y >= 0.0 && pixel.x < self.width as f64 && pixel.y < self.height as f64
    }
}
