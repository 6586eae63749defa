use std::path::Path;

use cosmorama::camera::Placement;
use cosmorama::motion::{Key, Pose, Track, Turn};
use cosmorama::sphere::Orientation;
use cosmorama_io::{CameraPath, FrameList, PathPose, PathSource};
use cosmorama_spec::{Shape, Spec};

use crate::diagnostic::{
    Code, Diagnostic, FOV, FRAMES, FROM, IN_PATH, Mark, PATH, Result, Setting, TO, failed_as, failure, of_opening,
    usage, usage_as,
};
use crate::settings::{CameraMovement, GeometrySettings, MotionBlur, PoseFile};
use crate::source::Access;
use crate::target::TargetView;

/// Movement of the target's camera in the input, either of which may move: views are a function of time, in frames.
#[derive(Clone)]
pub(crate) struct Movement {
    /// Poses of the camera; `None` where it stands still.
    camera: Option<Course>,
    /// Poses of the input; `None` where it stands still.
    input: Option<Track>,
    /// The only view's place before it is turned, where its field of view changes.
    zoom: Option<Placement>,
    /// Blur of what moves.
    pub(crate) blur: Option<MotionBlur>,
}

/// Poses by time.
#[derive(Clone)]
enum Course {
    Track(Track),
    Turn(Turn),
}

/// Greatest number of frames; more is a typing error.
const MOST_FRAMES: f64 = 10_000_000.0;

impl Movement {
    /// Resolves the movement of a target over the frames of the input, or, with a still input, over those that are `wanted`
    /// or that the path has. Also returns these frames.
    pub(crate) fn resolve(
        geometry: &GeometrySettings,
        targets: &[TargetView],
        (frames, wanted): (&[Option<u64>], Option<&FrameList>),
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Option<(Self, Vec<Option<u64>>)>> {
        if geometry.camera.is_none() && geometry.in_path.is_none() {
            return Ok(None);
        }
        let mut sequence: Vec<u64> = match (frames, wanted) {
            (&[None], Some(wanted)) => wanted.frames().to_vec(),
            _ => frames.iter().copied().flatten().collect(),
        };
        let camera = match &geometry.camera {
            None => None,
            Some(CameraMovement::Path(path)) => {
                let track = track((PATH, path), access, warnings)?;
                sequence = frames_of((PATH, path), &track, sequence)?;
                Some(Course::Track(track))
            }
            Some(CameraMovement::Turn { angles, fov, easing }) => {
                let turn = Turn { angles: *angles, fov: *fov, times: ends(&sequence)?, easing: *easing };
                Some(Course::Turn(turn))
            }
        };
        let mut input = None;
        if let Some(path) = &geometry.in_path {
            let track = track((IN_PATH, path), access, warnings)?;
            sequence = frames_of((IN_PATH, path), &track, sequence)?;
            check_no_zoom(path, &track)?;
            input = Some(track);
        }
        let mut movement = Self { camera, input, zoom: None, blur: geometry.blur };
        let zooms = sequence.first().is_some_and(|frame| movement.pose(time(*frame)).fov.is_some());
        if let (true, Some(camera)) = (zooms, &geometry.camera) {
            movement.zoom = Some(placement(geometry, targets, camera)?);
        }
        let frames = sequence.into_iter().map(Some).collect();
        Ok(Some((movement, frames)))
    }

    /// Returns whether the camera's poses depend on which frames are asked for: a turn goes from the first of them to the last.
    pub(crate) fn is_turn(&self) -> bool {
        matches!(self.camera, Some(Course::Turn(_)))
    }

    /// Returns the movement of the camera before an input that stands still; `None` if nothing moves there.
    pub(crate) fn of_camera(&self) -> Option<Self> {
        self.camera.is_some().then(|| Self { input: None, ..self.clone() })
    }

    /// Returns the camera's pose in the input at a time, in frames.
    pub(crate) fn pose(&self, time: f64) -> Pose {
        let camera = match &self.camera {
            None => Pose::of(Orientation::IDENTITY),
            Some(Course::Track(track)) => track.pose(time),
            Some(Course::Turn(turn)) => turn.pose(time),
        };
        let Some(input) = &self.input else { return camera };
        let input = input.pose(time).orientation;
        // Where both go together, nothing moves, not even by a rounding error.
        let together = input == camera.orientation;
        let orientation = if together { Orientation::IDENTITY } else { camera.orientation.within(input.inverse()) };
        Pose { orientation, ..camera }
    }

    /// Returns the target's views at several times.
    pub(crate) fn views_at(&self, targets: &[TargetView], times: &[f64]) -> Result<Vec<Vec<TargetView>>> {
        times.iter().map(|time| self.views(targets, &self.pose(*time))).collect()
    }

    /// Returns the target's views in a pose.
    pub(crate) fn views(&self, targets: &[TargetView], pose: &Pose) -> Result<Vec<TargetView>> {
        let posed = |target: &TargetView| {
            let view = match (&self.zoom, pose.fov) {
                (Some(placement), Some(fov)) => {
                    let frame = placement.frame.with_field_of_view(fov).unwrap_or(placement.frame.clone());
                    let zoomed = Placement { frame, ..placement.clone() };
                    let view = zoomed.view(target.view.width(), target.view.height());
                    view.map_err(|error| usage(format!("{TO}, when {:.3}° wide: {error}", fov.degrees())))?
                }
                _ => target.view.clone(),
            };
            Ok(TargetView { view: view.turned(pose.orientation), ..target.clone() })
        };
        targets.iter().map(posed).collect()
    }
}

/// Returns the times of the first and the last frame of a turn.
fn ends(sequence: &[u64]) -> Result<[f64; 2]> {
    match (sequence.iter().min(), sequence.iter().max()) {
        (Some(&first), Some(&last)) => Ok([first, last].map(time)),
        _ => Err(usage_as(
            Code::MissingSetting,
            format!("{FRAMES} is missing: say over which frames the camera turns, as in {FRAMES} 1-240"),
        )),
    }
}

/// Refuses poses of the input that have a field of view.
fn check_no_zoom(path: &PoseFile, track: &Track) -> Result<()> {
    if track.pose(track.range()[0]).fov.is_none() {
        return Ok(());
    }
    let file = &path.file;
    Err(usage(format!(
        "{IN_PATH} {file} has fov, but the input's field of view is that of {FROM}; leave the column out"
    )))
}

/// Returns the time of a frame.
pub(crate) fn time(frame: u64) -> f64 {
    frame as f64
}

fn key(pose: &PathPose) -> Key {
    Key { time: pose.frame, pose: Pose { orientation: pose.orientation, fov: pose.fov } }
}

/// Reads the poses of a file, and tells what of it is ignored.
fn track(
    (setting, PoseFile { file, fps, smoothness }): (Mark, &PoseFile),
    access: Access,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Track> {
    let (named, node) = CameraPath::split_node(file);
    let name = Path::new(named);
    let beside = |path: &Path| access.read_bytes(path);
    let bytes = beside(name)
        .map_err(|error| failed_as(of_opening(&error), format!("cannot open {setting} {named}: {error}")))?;
    let is_of_input = setting.0 == Setting::InPath;
    let path = CameraPath::read(&bytes, &PathSource { name, fps: *fps, node, is_of_input, beside: &beside })?;
    let mut remarks: Vec<String> = path.remarks.iter().map(|remark| format!("{file}: {remark}")).collect();
    if !path.ignored.is_empty() {
        remarks.push(format!("{file}: of no meaning here, and ignored: {}", path.ignored.join(", ")));
    }
    let told = remarks.into_iter().map(|text| Diagnostic::warning(Code::CameraPath, text).about(file));
    // One file may be the path of the camera and of the input.
    let new: Vec<Diagnostic> = told.filter(|told| !warnings.contains(told)).collect();
    warnings.extend(new);
    Track::new(path.poses.iter().map(key).collect(), *smoothness)
        .map_err(|error| failure!(Malformed: "{setting} {file}: {error}"))
}

/// Returns the frames to make: those of a sequence, all of which need poses, or else all of the path.
fn frames_of((setting, path): (Mark, &PoseFile), track: &Track, sequence: Vec<u64>) -> Result<Vec<u64>> {
    let ([first, last], file) = (track.range(), &path.file);
    if sequence.is_empty() {
        let (from, to) = (first.max(0.0).ceil(), last.floor());
        if from > to {
            return Err(usage(format!(
                "{setting} {file} has poses from frame {first} to {last}, and no whole frame between; choose frames with {FRAMES}"
            )));
        }
        if to - from >= MOST_FRAMES {
            return Err(usage(format!(
                "{setting} {file} has poses from frame {first} to {last}, which are too many; choose frames with {FRAMES}"
            )));
        }
        return Ok((from as u64..=to as u64).collect());
    }
    let without: Vec<u64> = sequence.iter().copied().filter(|frame| !(first..=last).contains(&time(*frame))).collect();
    if without.is_empty() {
        return Ok(sequence);
    }
    let count = without.len();
    Err(usage(format!(
        "{setting} {file} has poses from frame {first} to {last}, but none for {} {}; add poses, or choose frames with {FRAMES}",
        if count == 1 { "frame" } else { "frames" },
        FrameList::new(without)
    )))
}

/// Returns the place of a target whose field of view can change.
fn placement(geometry: &GeometrySettings, targets: &[TargetView], camera: &CameraMovement) -> Result<Placement> {
    let zoomed = geometry.to.as_ref().and_then(|spec| match spec {
        Spec { shape: Shape::Single(single), stereo: None, .. } if targets.len() == 1 => {
            let fov = single.placement.frame.with_field_of_view(cosmorama::sphere::Angle::from_degrees(60.0));
            fov.map(|_| single.placement.clone())
        }
        _ => None,
    });
    let Some(placement) = zoomed else {
        let name = geometry.to.as_ref().map_or("cube", |spec| spec.name);
        let remedy = match camera {
            CameraMovement::Path(PoseFile { file, .. }) => format!("{PATH} {file} has fov, which may stay out"),
            CameraMovement::Turn { .. } => format!("leave {FOV} out"),
        };
        return Err(usage(format!(
            "{TO} {name} has no single field of view that can change, as perspective:fov= and fulldome:fov= have: {remedy}"
        )));
    };
    let orientation = placement.orientation.within(geometry.orientation);
    Ok(Placement { orientation, ..placement })
}
