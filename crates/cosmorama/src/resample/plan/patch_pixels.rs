use super::mirrors::UPRIGHT;
use crate::resample::patch::SIDE;

/// The pixels of a patch in each mirror, laid as they are written from.
pub(super) struct PatchPixels<P> {
    /// Row by row of the patch, from left to right as the mirrors show them.
    pub(super) upright: [Square<P>; UPRIGHT],
    /// Where mirrors show columns as rows: column by column of the patch, from left to right as the mirrors show them.
    pub(super) turned: [Square<P>; UPRIGHT],
}

type Square<P> = [[P; SIDE]; SIDE];

/// Where the pixels of a row of the patch go in one mirror, one for each lane.
pub(super) enum Places<'a, P> {
    /// One after the other.
    Forward(&'a mut [P; SIDE]),
    /// The last one first.
    Reversed(&'a mut [P; SIDE]),
    /// In each line the one of this index.
    Lines(&'a mut Square<P>, usize),
}

impl<P: Copy> PatchPixels<P> {
    /// All of them the same.
    pub(super) fn filled(pixel: P) -> Self {
        let squares = [[[pixel; SIDE]; SIDE]; UPRIGHT];
        Self { upright: squares, turned: squares }
    }

    /// That of a lane and a row in a mirror, given what exchanges left and right there if that does.
    #[inline(always)]
    pub(super) fn pixel(&mut self, image: usize, [lane, row]: [usize; 2], flip: usize) -> &mut P {
        match self.upright.get_mut(image) {
            Some(rows) => &mut rows[row % SIDE][(lane ^ flip) % SIDE],
            None => &mut self.turned[image % UPRIGHT][lane % SIDE][(row ^ flip) % SIDE],
        }
    }

    /// All of a row in a mirror, given what exchanges left and right there if that does.
    #[inline(always)]
    pub(super) fn places(&mut self, image: usize, row: usize, flip: usize) -> Places<'_, P> {
        match (self.upright.get_mut(image), flip) {
            (Some(rows), 0) => Places::Forward(&mut rows[row % SIDE]),
            (Some(rows), _) => Places::Reversed(&mut rows[row % SIDE]),
            (None, _) => Places::Lines(&mut self.turned[image % UPRIGHT], (row ^ flip) % SIDE),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_are_where_mirrors_show_them() {
        const LANES: [usize; SIDE] = [0, 1, 2, 3, 4, 5, 6, 7];
        let (row, mirrored) = (3, SIDE - 1);
        for (image, flip) in [(0, 0), (1, mirrored), (UPRIGHT + 1, 0), (UPRIGHT + 2, mirrored)] {
            let mut pixels = PatchPixels::filled(SIDE);
            for lane in LANES {
                *pixels.pixel(image, [lane, row], flip) = lane;
            }
            let found = match pixels.places(image, row, flip) {
                Places::Forward(pixels) => *pixels,
                Places::Reversed(pixels) => LANES.map(|lane| pixels[SIDE - 1 - lane]),
                Places::Lines(lines, at) => lines.map(|line| line[at]),
            };
            assert_eq!(found, LANES, "mirror {image}");
            let expected = match (image < UPRIGHT, flip) {
                (true, 0) => pixels.upright[image][row] == LANES,
                (true, _) => pixels.upright[image][row] == LANES.map(|lane| SIDE - 1 - lane),
                (false, flip) => pixels.turned[image - UPRIGHT].map(|line| line[row ^ flip]) == LANES,
            };
            assert!(expected, "mirror {image}");
            let squares = pixels.upright.iter().chain(&pixels.turned);
            assert_eq!(squares.flatten().flatten().filter(|pixel| **pixel < SIDE).count(), SIDE, "no other is touched");
        }
    }
}
