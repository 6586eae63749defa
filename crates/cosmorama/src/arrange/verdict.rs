use super::mismatch::{Seam, SeamKey};
use super::search::{Found, Search, is_same};
use super::symmetry::Symmetry;
use super::{Change, Mismatch, Pose, changes};

/// Judgement of an arrangement of pictures by the continuity of its borders.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The arrangement fits, and no other does.
    Fits(Fit),
    /// The borders do not tell: others fit as well, or none fits.
    CannotTell,
    /// Another arrangement fits, and the declared one does not.
    Wrong {
        /// The arrangement that fits, turned and mirrored as a whole to resemble the declared one.
        fits: Vec<Pose>,
        /// Confidence in the arrangement that fits.
        fit: Fit,
    },
}

/// Confidence in an arrangement that fits.
#[derive(Clone, Debug, PartialEq)]
pub struct Fit {
    /// Confidence from 0 to 1: a lower bound of the probability that no other arrangement looks this much worse by
    /// chance.
    pub confidence: f64,
    /// Indices of pictures whose rotation does not show, because their borders are the same all round.
    pub free: Vec<usize>,
}

/// Least confidence for calling an arrangement wrong.
const SURE: f64 = 0.99;
/// Least confidence for calling an arrangement the only one.
const LIKELY: f64 = 0.9;
/// Greatest average mismatch of seams within one picture of the world.
const CONTINUOUS: f64 = 1.0;

/// Judges an arrangement of pictures by the continuity of their borders.
///
/// An arrangement is clearly worse than another if its mismatch is greater by more than chance. Chance is estimated
/// from the variation of mismatch along seams, and from the number of possible arrangements. An arrangement is called
/// wrong only if another one is continuous and no third is as good. Faces that were never continuous, such as test
/// patterns, fit in many ways.
///
/// # Panics
/// When the number of poses differs from that of pictures.
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
    // A free picture fits equally in every rotation, so the search tries only one.
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

/// Returns whether every picture matches its neighbours.
///
/// # Panics
/// When the number of poses differs from that of pictures.
pub fn is_continuous(mismatch: &Mismatch, poses: &[Pose]) -> bool {
    mismatch.check(poses);
    mismatch.seams(poses).iter().all(|seam| is_seamless(mismatch, std::slice::from_ref(seam)))
}

/// Returns whether seams are, on average, within one picture of the world.
fn is_seamless(mismatch: &Mismatch, seams: &[SeamKey]) -> bool {
    mismatch.sum(seams.iter()).cost <= CONTINUOUS * (seams.len() * Mismatch::PARTS) as f64
}

/// Returns whether an arrangement is not clearly worse than one that fits.
///
/// # Panics
/// When the number of poses differs from that of pictures.
pub fn fits_as_well(mismatch: &Mismatch, fitting: &[Pose], other: &[Pose]) -> bool {
    [fitting, other].into_iter().for_each(|poses| mismatch.check(poses));
    confidence(mismatch, fitting, other) < SURE
}

/// Returns whether all poses of a picture on its face are as good as the best.
fn turns_freely(mismatch: &Mismatch, best: &Found, picture: usize) -> bool {
    let mut other = best.poses.clone();
    Pose::all_of(best.poses[picture].face).into_iter().all(|pose| {
        other[picture] = pose;
        fits_as_well(mismatch, &best.poses, &other)
    })
}

/// Turns and mirrors an arrangement as a whole, so that it differs least from the declared one. Free pictures keep
/// their declared rotation.
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

/// Returns the effort of the changes between two arrangements. A rotated picture is a more likely mistake than a
/// mirrored one or one on another face. Two exchanged pictures are one mistake.
fn effort(poses: &[Pose], given: &[Pose]) -> u32 {
    let cost = |change: &Change| match change {
        Change::Swapped(..) | Change::Moved { .. } => 2,
        Change::Turned { .. } => 1,
        Change::Mirrored { quarter_turns, .. } => 2 + u32::from(*quarter_turns % 2),
    };
    changes(given, poses).iter().map(cost).sum()
}

/// Returns a lower bound of the probability that no arrangement as continuous as `better` looks as much worse as
/// `worse` does by chance. Only seams in which they differ count.
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
    // The tail of the normal distribution, times the number of arrangements.
    let chance = arrangements(pictures) * 0.5 * (-0.5 * excess * excess / variance).exp();
    (1.0 - chance).clamp(0.0, 1.0)
}

/// Returns the number of ways to arrange pictures around a cube, apart from rotations and reflections of the whole.
fn arrangements(pictures: usize) -> f64 {
    (1..=pictures).map(|count| 8.0 * count as f64).product::<f64>() / 48.0
}
