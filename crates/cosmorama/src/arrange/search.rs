use super::symmetry::Symmetry;
use super::{Mismatch, Pose, Side};
use crate::layout::FacePlacement;
use crate::sphere::CubeFace::{self, Back, Down, Front, Left, Right, Up};

/// An arrangement and its mismatch.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Found {
    pub(super) poses: Vec<Pose>,
    pub(super) cost: f64,
}

/// Faces in an order in which each soon has neighbours among those before it.
const ORDER: [CubeFace; 6] = [Front, Right, Up, Left, Down, Back];

/// Looks through the arrangements of pictures on some faces, each face with one picture, by branch and bound.
pub(super) struct Search<'a> {
    mismatch: &'a Mismatch,
    faces: Vec<CubeFace>,
    /// Pictures of which one turn is as good as any other.
    free: &'a [bool],
    /// The picture that is laid first, as it is, where turning the whole cube brings it there.
    anchor: Option<usize>,
    /// The eight poses of each face, and which side they turn to each earlier face.
    places: Vec<Vec<Place>>,
    /// At each depth, what the seams that are still to come cost at least.
    rest: Vec<f64>,
    best: [Option<Found>; 2],
    /// Steps that may still be taken.
    steps: usize,
}

/// Where so many steps lead to no end, too many arrangements are as good as the best: pictures that differ take a tenth.
const STEPS: usize = 200_000;

/// A pose, and what it touches of the faces before it: which of them, and with which side.
struct Place {
    pose: Pose,
    is_mirrored: bool,
    touches: Vec<(usize, Side)>,
}

/// A picture that has been laid.
#[derive(Clone, Copy)]
struct Laid {
    picture: usize,
    place: usize,
}

impl<'a> Search<'a> {
    /// Over all arrangements of the pictures on as many faces. Of `free` pictures only one turn is tried.
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

    /// The best arrangement, and the next best, if any, that is not the same turned or mirrored as a whole. `None` where
    /// too many are as good.
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

    /// The pictures that may be laid next, in every way, each with the mismatch that it adds.
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

    /// The mismatch that a picture in a place has with those laid before.
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

/// Whether two arrangements differ by a turn or a reflection of the whole cube, and by how free pictures lie.
pub(super) fn is_same(a: &[Pose], b: &[Pose], is_free: &[bool]) -> bool {
    let same = |((a, b), free): ((&Pose, &Pose), &bool)| a == b || (*free && a.face == b.face);
    Symmetry::all().any(|symmetry| symmetry.of(a).iter().zip(b).zip(is_free).all(same))
}
