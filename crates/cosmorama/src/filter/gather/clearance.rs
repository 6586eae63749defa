/// Three rows of three points of a patch: the corners, the points half way between them, and the middle.
pub(crate) type Grid<T> = [[T; 3]; 3];

/// Distance of a target's patch from the edge of its field of view.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Clearance {
    /// The edge is near none of the patch's pixels.
    Whole,
    /// The edge may affect only those pixels of the patch that lie within this many radians of it.
    Within(f64),
}
