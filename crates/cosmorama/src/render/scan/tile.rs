/// Pixels along a patch's side, and lanes that are worked on together.
pub(crate) const SIDE: usize = 8;

/// Pixels from one of the points that a patch is measured at to the next.
pub(crate) const HALF: usize = SIDE / 2;

/// A bit for each lane of which something holds.
pub(crate) fn lanes_of(holds: impl Fn(usize) -> bool) -> u8 {
    (0..SIDE).fold(0, |lanes, lane| lanes | u8::from(holds(lane)) << lane)
}

/// Texels of the largest window: of more, weights in integers have too few bits. Of pixels of 1764 texels of noise fewer than 97 % had
/// the codes that floats make.
pub(crate) const LARGEST: usize = 1024;
