/// How a file's picture has to be turned to be the face that CONVENTIONS draws: as seen by a camera at the
/// centre, the up face's bottom edge and the down face's top edge touching the front.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct FacePlacement {
    /// Quarter turns of the picture, clockwise, 0 to 3; after mirroring.
    pub quarter_turns: u8,
    /// Whether left and right are to be exchanged first.
    pub mirrored: bool,
}

impl FacePlacement {
    /// As it is.
    pub const UPRIGHT: Self = Self { quarter_turns: 0, mirrored: false };
    /// Turned upside down, by a half turn.
    pub const HALF_TURN: Self = Self { quarter_turns: 2, mirrored: false };

    /// The column and row of the file's picture that hold pixel (i, j) of the face, for a picture of this size.
    pub fn source(self, (width, height): (usize, usize), (i, j): (usize, usize)) -> (usize, usize) {
        let (right, bottom) = (width.saturating_sub(1), height.saturating_sub(1));
        let (x, y) = match self.quarter_turns % 4 {
            0 => (i, j),
            1 => (j, bottom.saturating_sub(i)),
            2 => (right.saturating_sub(i), bottom.saturating_sub(j)),
            _ => (right.saturating_sub(j), i),
        };
        if self.mirrored { (right.saturating_sub(x), y) } else { (x, y) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clockwise_quarter_turn_brings_the_left_column_to_the_top() {
        // A picture of 2x3 becomes a face of 3x2; its bottom left pixel comes to the top left.
        let turn = FacePlacement { quarter_turns: 1, mirrored: false };
        assert_eq!(turn.source((2, 3), (0, 0)), (0, 2));
        assert_eq!(turn.source((2, 3), (2, 0)), (0, 0));
        assert_eq!(turn.source((2, 3), (2, 1)), (1, 0));
    }

    #[test]
    fn four_quarter_turns_are_none() {
        let size = (4, 4);
        for pixel in [(0, 0), (3, 1), (2, 3)] {
            let turned =
                (0..4).fold(pixel, |pixel, _| FacePlacement { quarter_turns: 1, mirrored: false }.source(size, pixel));
            assert_eq!(turned, pixel);
        }
    }
}
