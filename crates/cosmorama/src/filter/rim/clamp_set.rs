use crate::filter::gather::candidate::Candidate;
use crate::filter::kernel::UNDER;

/// Returns the squared distance within which texels bound a pixel: those under it, or enough of the nearest to surround
/// its centre. `None` if all texels that the kernel reaches lie to one side.
///
/// At a point that texels surround, a linear function has no value outside theirs. In one lattice, the texels under a
/// pixel always surround it. At a pole, or where two views have texels of different sizes or shapes, they may all lie
/// to one side.
pub(crate) fn reach(candidates: &[Candidate]) -> Option<f32> {
    let under = UNDER as f32;
    let mut wedge = Wedge::default();
    if candidates.iter().any(|candidate| candidate.q < under && wedge.closes_with(candidate.offset)) {
        return Some(under);
    }
    let mut others: Vec<&Candidate> = candidates.iter().filter(|candidate| candidate.q >= under).collect();
    others.sort_unstable_by(|a, b| a.q.total_cmp(&b.q));
    let last = others.into_iter().find(|candidate| wedge.closes_with(candidate.offset));
    last.map(|candidate| candidate.q.next_up())
}

/// Smallest wedge from the origin that holds some points, as long as they span less than half a turn.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Wedge {
    /// The outermost points: the right one, then the left one, counterclockwise.
    sides: Option<[[f32; 2]; 2]>,
}

impl Wedge {
    /// Adds a point. Returns whether the points now surround the origin, or have it between two of them.
    pub(crate) fn closes_with(&mut self, point: [f32; 2]) -> bool {
        let Some([right, left]) = &mut self.sides else {
            self.sides = Some([point; 2]);
            return point == [0.0; 2];
        };
        // Left of the right side, and right of the left side, the point is inside the wedge.
        let (from_right, from_left) = (cross(*right, point), cross(*left, point));
        match (from_right >= 0.0, from_left <= 0.0) {
            (true, true) => return from_right == 0.0 && from_left == 0.0 && dot(*right, point) <= 0.0,
            (true, false) => *left = point,
            (false, true) => *right = point,
            (false, false) => return true,
        }
        // The point closes the wedge if it is opposite to the side that it did not replace.
        from_right == 0.0 || from_left == 0.0
    }
}

fn cross(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: [f32; 2], b: [f32; 2]) -> f32 {
    a[0] * b[0] + a[1] * b[1]
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(degrees: f32, distance: f32) -> [f32; 2] {
        [distance * degrees.to_radians().cos(), distance * degrees.to_radians().sin()]
    }

    fn surround(points: &[[f32; 2]]) -> bool {
        let mut wedge = Wedge::default();
        points.iter().any(|point| wedge.closes_with(*point))
    }

    #[test]
    fn points_surround_what_is_not_to_one_side_of_them() {
        for turn in 0..36 {
            let at = |degrees: f32, distance| at(degrees + 10.0 * turn as f32, distance);
            assert!(surround(&[at(0.0, 1.0), at(120.0, 0.1), at(240.0, 5.0)]));
            assert!(surround(&[at(0.0, 1.0), at(90.0, 1.0), at(-80.0, 1.0), at(175.0, 2.0)]));
            assert!(!surround(&[at(0.0, 1.0), at(90.0, 1.0), at(-80.0, 1.0), at(45.0, 2.0)]));
            assert!(!surround(&[at(170.0, 1.0), at(10.0, 1.0), at(90.0, 1.0), at(175.0, 0.2)]));
        }
        assert!(surround(&[[1.0, 2.0], [3.0, 6.0], [-2.0, -4.0]]));
        assert!(surround(&[[1.0, 2.0], [0.0, 0.0]]) && surround(&[[0.0, 0.0]]));
        assert!(!surround(&[]) && !surround(&[[1.0, 2.0], [3.0, 6.0]]));
    }

    #[test]
    fn the_nearest_that_surround_bound_a_pixel() {
        let candidate = |q: f32, degrees| Candidate { q, offset: at(degrees, q.sqrt()), ..Candidate::default() };
        let one_side = [candidate(0.2, 10.0), candidate(1.4, 80.0), candidate(3.0, -85.0), candidate(1.9, 40.0)];
        assert_eq!(reach(&one_side), None);
        let all_around =
            [&one_side[..], &[candidate(2.5, 200.0), candidate(2.2, 230.0), candidate(3.5, 210.0)]].concat();
        assert!(reach(&all_around).is_some_and(|q| (2.2..2.5).contains(&q)));
        let under = [&all_around[..], &[candidate(1.3, 215.0)]].concat();
        assert_eq!(reach(&under), Some(UNDER as f32));
    }
}
