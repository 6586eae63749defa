//! Gaps: what pixels of the output look at, and the files do not hold.

use cosmorama::camera::{Canvas, PixelRect, View};
use cosmorama::filter::FilterSettings;
use cosmorama::motion::Pose;
use cosmorama::render::{Accuracy, Need, Needs, Progress, Uncovered};
use cosmorama::world::World;
use cosmorama_io::FrameList;

use crate::diagnostic::{Code, ConvertError, Diagnostic, PITCH, ROLL, Result, YAW, failed_as};
use crate::input::InputView;
use crate::target::{Movement, TargetView, time};

/// Views of the target that belong to some frames: in one pose, or in the poses of one exposure.
pub(crate) struct Shot {
    /// Frames that it stands for; empty if the camera does not move.
    pub(crate) frames: Vec<u64>,
    pub(crate) views: Vec<TargetView>,
}

impl Shot {
    /// Returns the shots of all frames: of an exposure, its ends and its middle. Frames that follow one another in one pose
    /// share a shot.
    pub(crate) fn all(movement: &Movement, targets: &[TargetView], frames: &[Option<u64>]) -> Result<Vec<Self>> {
        let mut shots: Vec<(Vec<Pose>, Self)> = Vec::new();
        for frame in frames.iter().copied().flatten() {
            let exposed = movement.blur.map_or_else(Vec::new, |blur| blur.shutter.division(time(frame)).to_vec());
            let mut poses = vec![movement.pose(time(frame))];
            poses.extend(exposed.into_iter().map(|time| movement.pose(time)));
            poses.dedup();
            if let Some((_, shot)) = shots.last_mut().filter(|(last, _)| *last == poses) {
                shot.frames.push(frame);
                continue;
            }
            let views = poses.iter().map(|pose| movement.views(targets, pose)).collect::<Result<Vec<_>>>()?;
            shots.push((poses, Self { frames: vec![frame], views: views.into_iter().flatten().collect() }));
        }
        Ok(shots.into_iter().map(|(_, shot)| shot).collect())
    }
}

/// Returns whether the input is a whole panorama, which lacks nothing, whatever the target needs; then it is wanted.
fn is_whole_panorama(views: &mut [InputView]) -> bool {
    let [view] = views else { return false };
    let is_whole = view.nominal.covers_sphere()
        && view.mask.is_none()
        && view.window.as_ref().is_some_and(|(held, _)| *held == view.nominal);
    view.wanted |= is_whole;
    is_whole
}

/// Finds what is missing in the views of a world over all shots, and marks the views that are needed. Gaps of a moving camera
/// name their frames. The world is that of an index among so many.
pub(crate) fn find_gaps(
    views: &mut [InputView],
    (nominal, index, count): (&World, usize, usize),
    shots: &[Shot],
    filter: &FilterSettings,
    (warnings, progress): (&mut Vec<Diagnostic>, &dyn Progress),
) -> Result<Vec<String>> {
    if is_whole_panorama(views) {
        return Ok(Vec::new());
    }
    views.iter_mut().for_each(|view| view.wanted = false);
    let mut lacking: Vec<Lacking> = views.iter().map(|_| Lacking::default()).collect();
    let mut uncovered: Option<(String, Vec<u64>, Uncovered)> = None;
    // Whether the files hold all that some shot may need.
    let mut is_held = false;
    for (place, Shot { frames, views: targets }) in shots.iter().enumerate() {
        let targets: Vec<&TargetView> = targets.iter().filter(|target| target.world(count) == index).collect();
        let geometry: Vec<View> = targets.iter().map(|target| target.view.clone()).collect();
        // Of a view that is read anyway, and holds what it may have to, there is nothing to be found.
        let matters = |at: usize, need: &Need| !(views[at].wanted && holds((&views[at], need)));
        let mut needs = Needs::bounds(nominal, &geometry, filter, matters);
        let sees_any = needs.views.iter().any(|need| need.seen.is_some());
        views.iter_mut().zip(&needs.views).for_each(|(view, need)| view.wanted |= need.read.is_some());
        if sees_any && views.iter().zip(&needs.views).all(holds) {
            is_held = true;
        } else {
            needs = Needs::of(nominal, &geometry, filter, Accuracy::Seen);
            // Only where the filter may read beyond a file, it matters what it reads.
            if views.iter().zip(&needs.views).any(|(view, need)| frayed(view, need).is_some()) {
                needs = Needs::of(nominal, &geometry, filter, Accuracy::Exact);
            }
        }
        for ((view, need), lacking) in views.iter().zip(&needs.views).zip(&mut lacking) {
            lacking.add(view, need, frames);
        }
        if let Some(found) = needs.uncovered {
            uncovered = Some(match uncovered.take() {
                None => (targets[found.target].name.clone(), frames.clone(), found),
                Some((name, of, all)) => (name, [of, frames.clone()].concat(), all.union(found)),
            });
        }
        if progress.advance((place + 1) as f64 / shots.len() as f64).is_break() {
            return Err(ConvertError::Stopped { done: 0, frames: None });
        }
    }
    let mut gaps = Vec::new();
    for (view, lacking) in views.iter().zip(&lacking) {
        gaps.extend(lacking.seen.as_ref().and_then(|need| Some(of_frames(&lacking.frames, &shortfall(view, need)?))));
        warnings.extend(lacking.frayed.as_ref().and_then(|need| frayed(view, need)));
    }
    gaps.extend(uncovered.map(|(name, frames, gap)| of_frames(&frames, &format!("{name}: {gap}"))));
    if !is_held && !views.iter().any(|view| view.wanted && view.window.is_some()) {
        gaps.push("nothing of what the input shows is in the output's field of view".to_owned());
        return Err(empty(&gaps));
    }
    Ok(gaps)
}

/// Need of a view in all frames that lack something of it.
#[derive(Default)]
struct Lacking {
    frames: Vec<u64>,
    /// Need of these frames together.
    seen: Option<Need>,
    /// Need of frames whose filter reads beyond the file.
    frayed: Option<Need>,
}

impl Lacking {
    fn add(&mut self, view: &InputView, need: &Need, frames: &[u64]) {
        if shortfall(view, need).is_some() {
            self.frames.extend(frames);
            self.seen = Some(both(self.seen.take(), need));
        } else if frayed(view, need).is_some() {
            self.frayed = Some(both(self.frayed.take(), need));
        }
    }
}

fn both(known: Option<Need>, need: &Need) -> Need {
    let union = |a: Option<PixelRect>, b: Option<PixelRect>| a.into_iter().chain(b).reduce(PixelRect::union);
    match known {
        Some(known) => Need { seen: union(known.seen, need.seen), read: union(known.read, need.read), ..known },
        None => need.clone(),
    }
}

/// Prepends the frames of a gap, if the camera moves.
fn of_frames(frames: &[u64], gap: &str) -> String {
    if frames.is_empty() {
        return gap.to_owned();
    }
    let plural = if frames.len() == 1 { "frame" } else { "frames" };
    format!("{plural} {}: {gap}", FrameList::new(frames.iter().copied()))
}

/// Returns whether everything that may be needed of a view is there.
fn holds((view, need): (&InputView, &Need)) -> bool {
    let held = view.window.as_ref().map(|(held, canvas)| rect(canvas, held));
    need.read.is_none_or(|read| held.is_some_and(|held| held.contains(&read)))
}

/// Returns the error for an input without any view, which cannot be filled up.
pub(super) fn empty(gaps: &[String]) -> ConvertError {
    let gaps = gaps.join("\n  ");
    let message =
        format!("the output would be empty:\n  {gaps}\nturn it with {YAW}, {PITCH} and {ROLL}, or add the views");
    failed_as(Code::Uncovered, message)
}

/// Describes what pixels of the output look at and the file does not hold.
fn shortfall(view: &InputView, need: &Need) -> Option<String> {
    let seen = need.seen?;
    match &view.window {
        None => Some(format!(
            "{}: {seen} of its {}x{} pixels are needed, but {} is {}",
            view.name,
            view.nominal.width(),
            view.nominal.height(),
            view.files.path(None).display(),
            if view.files.is_folder() { "a folder, not an image" } else { "missing" }
        )),
        Some((held, canvas)) => {
            let held = rect(canvas, held);
            (!held.contains(&seen)).then(|| {
                format!(
                    "{}: {seen} of its {}x{} pixels are needed, but {} holds only {held}",
                    view.name,
                    view.nominal.width(),
                    view.nominal.height(),
                    view.files.path(None).display()
                )
            })
        }
    }
}

/// Returns a warning where everything that pixels look at is there, but not all that the filter would read around it.
fn frayed(view: &InputView, need: &Need) -> Option<Diagnostic> {
    let (seen, read, (held, canvas)) = (need.seen?, need.read?, view.window.as_ref()?);
    let held = rect(canvas, held);
    (held.contains(&seen) && !held.contains(&read)).then(|| {
        let message = format!(
            "{}: the filter would read {read}, but the file holds {held}; pixels at its edge go without the rest",
            view.name
        );
        Diagnostic::warning(Code::Frayed, message).about(&view.name)
    })
}

/// Returns the part of its canvas that an image shows. One that goes all the way round shows every column, wherever it
/// begins.
fn rect(canvas: &Canvas, held: &View) -> PixelRect {
    let edge = |at: i64, size: usize| at.clamp(0, size as i64) as usize;
    let goes_round = held.period().is_some_and(|period| held.width() >= period);
    let left = if goes_round { 0 } else { canvas.left };
    PixelRect {
        left: edge(left, canvas.width),
        top: edge(canvas.top, canvas.height),
        right: edge(left + held.width() as i64, canvas.width),
        bottom: edge(canvas.top + held.height() as i64, canvas.height),
    }
}
