/// Number of pixels along a patch's side, and of lanes that are processed together.
pub(crate) const SIDE: usize = 8;

/// Number of pixels between the points at which a patch is measured.
pub(crate) const HALF: usize = SIDE / 2;

/// Returns a bit for each lane for which a condition holds.
pub(crate) fn lanes_of(holds: impl Fn(usize) -> bool) -> u8 {
    (0..SIDE).fold(0, |lanes, lane| lanes | u8::from(holds(lane)) << lane)
}

/// Number of texels in the largest window. Weights in integers would have too few bits for more: with 1764 texels of
/// noise in a pixel, fewer than 97 % of pixels had the codes that floats make.
pub(crate) const LARGEST: usize = 1024;
