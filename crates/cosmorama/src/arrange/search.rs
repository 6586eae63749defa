use super::symmetry::Symmetry;
use super::{Mismatch, Pose, Side};
use crate::layout::FacePlacement;
use crate::sphere::CubeFace::{self, Back, Down, Front, Left, Right, Up};

/// An arrangement with its mismatch.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    pub(super) poses: Vec<Pose>,
    pub(super) cost: f64,
}

/// Faces in an order in which each has early neighbours among those before it.
const ORDER: [CubeFace; 6] = [Front, Right, Up, Left, Down, Back];

/// Branch-and-bound search through the arrangements of pictures on given faces, one picture on each.
pub(super) struct Search<'a> {
    mismatch: &'a Mismatch,
    faces: Vec<CubeFace>,
    /// Whether each picture is free: all its rotations fit equally.
    free: &'a [bool],
    /// Picture that is placed first, unturned, if a rotation of the whole cube permits it.
    anchor: Option<usize>,
    /// Eight poses for each face, with the sides that they turn to each earlier face.
    places: Vec<Vec<Place>>,
    /// Lower bound, at each depth, of the mismatch of the remaining seams.
    rest: Vec<f64>,
    best: [Option<Found>; 2],
    /// Number of steps that are left.
    steps: usize,
}

/// Limit of search steps. If it is reached, too many arrangements are equally good; different pictures take a tenth.
const STEPS: usize = 200_000;

/// A pose, with its neighbours among earlier faces and the sides that touch them.
struct Place {
    pose: Pose,
    is_mirrored: bool,
    touches: Vec<(usize, Side)>,
}

/// A picture that has been placed.
#[derive(Clone, Copy)]
struct Laid {
    picture: usize,
    place: usize,
}

impl<'a> Search<'a> {
    /// Prepares a search over all arrangements of the pictures on as many faces. For a `free` picture only one rotation
    /// is tried.
    pub(super) fn new(mismatch: &'a Mismatch, faces: &[CubeFace], free: &'a [bool]) -> Self {
        let faces: Vec<CubeFace> = ORDER.into_iter().filter(|face| faces.contains(face)).collect();
        let place = |depth: usize| {
            let of_pose = |pose: Pose| {
                let side = |earlier: usize| Some((earlier, pose.side_towards(faces[earlier])?));
                Place { pose, is_mirrored: pose.is_mirrored(), touches: (0..depth).filter_map(side).collect() }
            };
            Pose::all_of(faces[depth]).map(of_pose).into_iter().collect()
        };
        let places: Vec<Vec<Place>> = (0..faces.len()).map(place).collect();
        let least = mismatch.least();
        let seams_after = |depth: usize| places[depth..].iter().map(|all| all[0].touches.len()).sum::<usize>();
        let rest = (0..=faces.len()).map(|depth| seams_after(depth) as f64 * least).collect();
        let anchor = if faces.len() == ORDER.len() { free.iter().position(|free| !free) } else { None };
        Self { mismatch, faces, free, anchor, places, rest, best: [None, None], steps: STEPS }
    }

    /// Returns the best arrangement, and the best one that is not the same when turned or mirrored as a whole, if any.
    /// `None` if too many are equally good.
    pub(super) fn run(mut self) -> Option<(Found, Option<Found>)> {
        self.go_on(&mut Vec::with_capacity(6), 0.0);
        let [best, second] = self.best;
        (self.steps > 0).then_some((best?, second))
    }

    fn go_on(&mut self, laid: &mut Vec<Laid>, cost: f64) {
        let depth = laid.len();
        self.steps = self.steps.saturating_sub(1);
        if self.steps == 0 || self.best[1].as_ref().is_some_and(|second| cost + self.rest[depth] >= second.cost) {
            return;
        }
        if depth == self.faces.len() {
            self.keep(laid, cost);
            return;
        }
        let mut next = self.choices(laid);
        next.sort_by(|a, b| a.1.total_cmp(&b.1));
        for (choice, added) in next {
            laid.push(choice);
            self.go_on(laid, cost + added);
            laid.pop();
        }
    }

    /// Returns the possible next placements, each with the mismatch that it adds.
    fn choices(&self, laid: &[Laid]) -> Vec<(Laid, f64)> {
        let depth = laid.len();
        let anchored = self.anchor.filter(|_| depth == 0);
        let is_left = |picture: &usize| {
            anchored.is_none_or(|anchor| anchor == *picture) && laid.iter().all(|other| other.picture != *picture)
        };
        let ways = |picture: usize| {
            let turns = if self.free[picture] || anchored.is_some() { 1 } else { 8 };
            (0..turns).map(move |place| Laid { picture, place })
        };
        let choices = (0..self.mismatch.pictures()).filter(is_left).flat_map(ways);
        choices.map(|choice| (choice, self.added(laid, choice.picture, &self.places[depth][choice.place]))).collect()
    }

    /// Returns the mismatch of a picture in a place with those placed before.
    fn added(&self, laid: &[Laid], picture: usize, place: &Place) -> f64 {
        let face = self.faces[laid.len()];
        let seam = |&(earlier, here): &(usize, Side)| {
            let other = laid[earlier];
            let there = &self.places[earlier][other.place];
            let side = there.pose.side_towards(face)?;
            let mirrored = there.is_mirrored != place.is_mirrored;
            Some(self.mismatch.seam((picture, here), (other.picture, side), mirrored).cost)
        };
        place.touches.iter().filter_map(seam).sum()
    }

    fn keep(&mut self, laid: &[Laid], cost: f64) {
        let upright = Pose::new(CubeFace::Front, FacePlacement::UPRIGHT);
        let mut poses = vec![upright; self.mismatch.pictures()];
        for (depth, laid) in laid.iter().enumerate() {
            poses[laid.picture] = self.places[depth][laid.place].pose;
        }
        let found = Found { poses, cost };
        let [best, second] = &mut self.best;
        match best {
            Some(known) if is_same(&known.poses, &found.poses, self.free) => {}
            Some(known) if known.cost <= found.cost => *second = Some(found),
            _ => {
                *second = best.take();
                *best = Some(found);
            }
        }
    }
}

/// Returns whether two arrangements differ only by a rotation or reflection of the whole cube, and by rotations of free
/// pictures.
pub(super) fn is_same(a: &[Pose], b: &[Pose], is_free: &[bool]) -> bool {
    let same = |((a, b), free): ((&Pose, &Pose), &bool)| a == b || (*free && a.face == b.face);
    Symmetry::all().any(|symmetry| symmetry.of(a).iter().zip(b).zip(is_free).all(same))
}
