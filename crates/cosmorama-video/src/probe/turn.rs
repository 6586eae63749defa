/// Turn of coded pictures that makes them upright: first rows and columns are exchanged, then mirrored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Turn {
    /// Whether rows become columns.
    pub is_transposed: bool,
    /// Whether left and right are exchanged afterwards.
    pub is_mirrored: bool,
    /// Whether above and below are exchanged afterwards.
    pub is_flipped: bool,
}

impl Turn {
    /// Returns the turn of a display matrix as ffprobe prints it, three rows of numbers behind colons; `None` for matrices that turn
    /// by other angles, or scale.
    pub(super) fn of_matrix(text: &str) -> Option<Self> {
        const ONE: u64 = 1 << 16;
        let rows = text.lines().filter_map(|line| line.split_once(':')).map(|(_, row)| row);
        let numbers: Vec<i64> = rows.flat_map(str::split_whitespace).filter_map(|word| word.parse().ok()).collect();
        let &[a, b, _, c, d, ..] = numbers.as_slice() else { return None };
        // A point moves from (x, y) to (ax + cy, bx + dy).
        match [a, b, c, d].map(i64::unsigned_abs) {
            [ONE, 0, 0, ONE] => Some(Self { is_transposed: false, is_mirrored: a < 0, is_flipped: d < 0 }),
            [0, ONE, ONE, 0] => Some(Self { is_transposed: true, is_mirrored: c < 0, is_flipped: b < 0 }),
            _ => None,
        }
    }

    /// Returns the turn by an angle in degrees, positive clockwise; `None` unless it is a multiple of 90.
    pub(super) fn of_degrees(clockwise: i64) -> Option<Self> {
        let turn = |is_transposed, is_mirrored, is_flipped| Some(Self { is_transposed, is_mirrored, is_flipped });
        match clockwise.rem_euclid(360) {
            0 => turn(false, false, false),
            90 => turn(true, true, false),
            180 => turn(false, true, true),
            270 => turn(true, false, true),
            _ => None,
        }
    }

    /// Returns ffmpeg's filters for the turn.
    pub(crate) fn filters(self) -> Vec<&'static str> {
        let mut filters = Vec::new();
        if self.is_transposed {
            // Rows become columns, and no more.
            filters.push("transpose=dir=cclock_flip");
        }
        if self.is_mirrored {
            filters.push("hflip");
        }
        if self.is_flipped {
            filters.push("vflip");
        }
        filters
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_matrix_and_an_angle_say_the_same() {
        let matrix = |[a, b, c, d]: [i64; 4]| {
            let one = 65536;
            format!(
                "\n00000000: {} {} 0\n00000001: {} {} 0\n00000002: 0 0 1073741824\n",
                a * one,
                b * one,
                c * one,
                d * one
            )
        };
        // At 90 degrees clockwise, what is right comes below: (1, 0) moves to (0, 1).
        let turns = [(0, [1, 0, 0, 1]), (90, [0, 1, -1, 0]), (180, [-1, 0, 0, -1]), (270, [0, -1, 1, 0])];
        for (degrees, numbers) in turns {
            let turn = Turn::of_degrees(degrees);
            assert!(turn.is_some());
            assert_eq!(Turn::of_matrix(&matrix(numbers)), turn, "{degrees}");
            assert_eq!(Turn::of_degrees(degrees - 360), turn);
        }
        assert_eq!(Turn::of_degrees(45), None);
        assert_eq!(Turn::of_matrix(&matrix([2, 0, 0, 2])), None);
        assert_eq!(Turn::of_matrix("nothing"), None);
        assert!(Turn::of_matrix(&matrix([-1, 0, 0, 1])).unwrap().is_mirrored);
    }
}
