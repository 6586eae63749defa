/// Rows of three points of a patch: corners, what is half way between them, and the middle.
pub(crate) type Grid<T> = [[T; 3]; 3];

/// How far a patch of a target is from the edge of its field of view.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clearance {
    /// The edge is near none of its pixels.
    Whole,
    /// It may be near those that have it within so many radians.
    Within(f64),
}
