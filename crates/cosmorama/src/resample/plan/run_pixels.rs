use super::mirrors::UPRIGHT;
use crate::resample::patch::SIDE;

/// The pixels of a run in each mirror; where mirrors show columns as rows, those of the runs above it, too, that are not written yet: they
/// lie beside each other there.
pub(super) struct RunPixels<P> {
    /// From left to right as the mirrors show them.
    pub(super) upright: [[P; SIDE]; UPRIGHT],
    pub(super) turned: [TurnedPixels<P>; UPRIGHT],
}

/// Pixels of a mirror that shows columns as rows.
#[derive(Clone, Copy)]
pub(super) struct TurnedPixels<P> {
    /// Lane by lane, from left to right as the mirror shows them.
    pub(super) lines: [[P; SIDE]; SIDE],
    /// Which of each line is the run's.
    pub(super) at: usize,
}

/// Where the pixels of a run go in one mirror, one for each lane.
pub(super) enum Places<'a, P> {
    /// One after the other.
    Forward(&'a mut [P; SIDE]),
    /// The last one first.
    Reversed(&'a mut [P; SIDE]),
    /// In each line the one of this index.
    Lines(&'a mut [[P; SIDE]; SIDE], usize),
}

impl<P: Copy> RunPixels<P> {
    /// All of them the same.
    pub(super) fn filled(pixel: P) -> Self {
        let turned = TurnedPixels { lines: [[pixel; SIDE]; SIDE], at: 0 };
        Self { upright: [[pixel; SIDE]; UPRIGHT], turned: [turned; UPRIGHT] }
    }

    /// That of a lane in a mirror, given what exchanges left and right in the index of a lane if that does.
    #[inline(always)]
    pub(super) fn pixel(&mut self, image: usize, lane: usize, flip: usize) -> &mut P {
        match self.upright.get_mut(image) {
            Some(pixels) => &mut pixels[(lane ^ flip) % SIDE],
            None => {
                let TurnedPixels { lines, at } = &mut self.turned[image % UPRIGHT];
                &mut lines[lane % SIDE][*at % SIDE]
            }
        }
    }

    /// All in a mirror, given what exchanges left and right in the index of a lane if that does.
    #[inline(always)]
    pub(super) fn places(&mut self, image: usize, flip: usize) -> Places<'_, P> {
        match (self.upright.get_mut(image), flip) {
            (Some(pixels), 0) => Places::Forward(pixels),
            (Some(pixels), _) => Places::Reversed(pixels),
            (None, _) => {
                let TurnedPixels { lines, at } = &mut self.turned[image % UPRIGHT];
                Places::Lines(lines, *at % SIDE)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lanes_are_where_mirrors_show_them() {
        const LANES: [usize; SIDE] = [0, 1, 2, 3, 4, 5, 6, 7];
        let mut pixels = RunPixels::filled(SIDE);
        pixels.turned[1].at = 3;
        for (image, flip) in [(0, 0), (1, SIDE - 1), (UPRIGHT + 1, 0)] {
            for lane in LANES {
                *pixels.pixel(image, lane, flip) = lane;
            }
            let found = match pixels.places(image, flip) {
                Places::Forward(pixels) => *pixels,
                Places::Reversed(pixels) => LANES.map(|lane| pixels[SIDE - 1 - lane]),
                Places::Lines(lines, at) => lines.map(|line| line[at]),
            };
            assert_eq!(found, LANES, "mirror {image}");
        }
        assert_eq!(pixels.upright[0], LANES);
        assert_eq!(pixels.upright[1], LANES.map(|lane| SIDE - 1 - lane));
        assert!(pixels.turned[1].lines.iter().zip(LANES).all(|(line, lane)| line[3] == lane && line[2] == SIDE));
    }
}
