use super::mismatch::{Seam, SeamKey};
use super::search::{Found, Search, is_same};
use super::symmetry::Symmetry;
use super::{Change, Mismatch, Pose, changes};

/// Judgement of an arrangement of pictures by the continuity of its borders.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// It fits, and no other does.
    Fits(Fit),
    /// Others fit no worse, or none fits: the borders do not tell.
    CannotTell,
    /// Another one fits, and this one does not.
    Wrong {
        /// The one that fits, turned and mirrored as a whole to be as like the given one as can be.
        fits: Vec<Pose>,
        /// How sure that is.
        fit: Fit,
    },
}

/// Confidence in an arrangement that fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// From 0 to 1: at least so likely none of all other arrangements looks so much worse by chance.
    pub confidence: f64,
    /// Pictures whose own turn does not show: their borders are the same all round. By number.
    pub free: Vec<usize>,
}

/// Less than this is not enough to call an arrangement wrong.
const SURE: f64 = 0.99;
/// Less than this is not enough to call it the only one.
const LIKELY: f64 = 0.9;
/// Seams with more mismatch than this, on average, are none of a picture of the world.
const CONTINUOUS: f64 = 1.0;

/// Judges an arrangement of pictures by the continuity of their borders.
///
/// An arrangement is clearly worse than another where its mismatch is greater by more than chance allows, given how much
/// the mismatch varies along a seam and how many arrangements there are to choose from. It is called wrong only where
/// another one is continuous and no third one is as good: faces that were never continuous, such as test patterns, fit
/// somehow in many ways.
///
/// # Panics
/// When there is not a pose for each picture.
pub fn judge(mismatch: &Mismatch, given: &[Pose]) -> Verdict {
    mismatch.check(given);
    let faces: Vec<_> = given.iter().map(|pose| pose.face).collect();
    let Some((best, _)) = Search::new(mismatch, &faces, &vec![false; given.len()]).run() else {
        return Verdict::CannotTell;
    };
    let is_free: Vec<bool> = (0..given.len()).map(|picture| turns_freely(mismatch, &best, picture)).collect();
    if is_free.iter().all(|free| *free) {
        return Verdict::CannotTell;
    }
    let nearest = nearest(&best.poses, given, &is_free);
    let against_given = confidence(mismatch, &nearest, given);
    let fits_given = against_given < SURE;
    let chosen = if fits_given { given } else { &nearest };
    // Of free pictures every turn is as good: the others are compared with them as they happen to lie.
    let Some((first, second)) = Search::new(mismatch, &faces, &is_free).run() else {
        return Verdict::CannotTell;
    };
    let rival = std::iter::once(first).chain(second).find(|other| !is_same(&other.poses, chosen, &is_free));
    let against_rival = rival.map_or(1.0, |rival| confidence(mismatch, chosen, &rival.poses));
    let free: Vec<usize> = (0..given.len()).filter(|picture| is_free[*picture]).collect();
    if against_rival < LIKELY || !is_seamless(mismatch, &mismatch.seams(chosen)) {
        return Verdict::CannotTell;
    }
    if fits_given {
        Verdict::Fits(Fit { confidence: against_rival, free })
    } else {
        Verdict::Wrong { fits: nearest, fit: Fit { confidence: against_given.min(against_rival), free } }
    }
}

/// Whether every picture meets its neighbours.
///
/// # Panics
/// When there is not a pose for each picture.
pub fn is_continuous(mismatch: &Mismatch, poses: &[Pose]) -> bool {
    mismatch.check(poses);
    mismatch.seams(poses).iter().all(|seam| is_seamless(mismatch, std::slice::from_ref(seam)))
}

/// Whether seams show, on average, one picture across them.
fn is_seamless(mismatch: &Mismatch, seams: &[SeamKey]) -> bool {
    mismatch.sum(seams.iter()).cost <= CONTINUOUS * (seams.len() * Mismatch::PARTS) as f64
}

/// Whether an arrangement is not clearly worse than one that fits.
///
/// # Panics
/// When there is not a pose for each picture.
pub fn fits_as_well(mismatch: &Mismatch, fitting: &[Pose], other: &[Pose]) -> bool {
    [fitting, other].into_iter().for_each(|poses| mismatch.check(poses));
    confidence(mismatch, fitting, other) < SURE
}

/// Whether all ways to lay one picture on its face are as good as the best.
fn turns_freely(mismatch: &Mismatch, best: &Found, picture: usize) -> bool {
    let mut other = best.poses.clone();
    Pose::all_of(best.poses[picture].face).into_iter().all(|pose| {
        other[picture] = pose;
        fits_as_well(mismatch, &best.poses, &other)
    })
}

/// An arrangement, turned and mirrored as a whole so that the least has to be done to what was given. Free
/// pictures lie as they were given.
fn nearest(poses: &[Pose], given: &[Pose], is_free: &[bool]) -> Vec<Pose> {
    let faces = |poses: &[Pose]| poses.iter().all(|pose| given.iter().any(|given| given.face == pose.face));
    let images = Symmetry::all().map(|symmetry| symmetry.of(poses)).filter(|image| faces(image));
    let with_free = images.map(|image| -> Vec<Pose> {
        let pictures = image.iter().zip(given).zip(is_free);
        let settle = |((pose, given), is_free): ((&Pose, &Pose), &bool)| {
            if *is_free { Pose::new(pose.face, given.placement()) } else { *pose }
        };
        pictures.map(settle).collect()
    });
    with_free.min_by_key(|image| effort(image, given)).unwrap_or_else(|| poses.to_vec())
}

/// How much has to be done to lay pictures otherwise than they were given, as it is told. A turned picture is a more likely
/// mistake than one on another face or a mirrored one; two pictures that are exchanged are one mistake.
fn effort(poses: &[Pose], given: &[Pose]) -> u32 {
    let cost = |change: &Change| match change {
        Change::Swapped(..) | Change::Moved { .. } => 2,
        Change::Turned { .. } => 1,
        Change::Mirrored { quarter_turns, .. } => 2 + u32::from(*quarter_turns % 2),
    };
    changes(given, poses).iter().map(cost).sum()
}

/// The chance, at least, that no arrangement as continuous as the better one would look as much worse as the other does by
/// chance. Only the seams count in which they differ.
fn confidence(mismatch: &Mismatch, better: &[Pose], worse: &[Pose]) -> f64 {
    let pictures = better.len();
    let (here, there) = (mismatch.seams(better), mismatch.seams(worse));
    let only = |seams: &[SeamKey], others: &[SeamKey]| -> Seam {
        mismatch.sum(seams.iter().filter(|seam| !others.contains(seam)))
    };
    let (better, worse) = (only(&here, &there), only(&there, &here));
    let variance = better.variance + worse.variance;
    let excess = worse.cost - better.cost;
    if excess <= 0.0 || variance <= 0.0 {
        return 0.0;
    }
    // The tail of the normal distribution, for each of the arrangements that there are.
    let chance = arrangements(pictures) * 0.5 * (-0.5 * excess * excess / variance).exp();
    (1.0 - chance).clamp(0.0, 1.0)
}

/// How many ways there are to lay so many pictures round a cube, but for turns and reflections of the whole.
fn arrangements(pictures: usize) -> f64 {
    (1..=pictures).map(|count| 8.0 * count as f64).product::<f64>() / 48.0
}
