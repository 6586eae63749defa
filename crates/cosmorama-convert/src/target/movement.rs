use std::path::Path;

use cosmorama::camera::Placement;
use cosmorama::motion::{Key, Pose, Track, Turn};
use cosmorama_io::{CameraPath, FrameList, PathPose};
use cosmorama_spec::{Shape, Spec};

use crate::diagnostic::{
    Code, Diagnostic, FOV, FRAMES, PATH, Result, TO, failed_as, failure, of_opening, usage, usage_as,
};
use crate::settings::{CameraMovement, GeometrySettings, MotionBlur};
use crate::source::Access;
use crate::target::TargetView;

/// Movement of the target's camera: its views are a function of time, in frames.
pub(crate) struct Movement {
    course: Course,
    /// The only view's place before it is turned, where its field of view changes.
    zoom: Option<Placement>,
    /// Blur of what moves.
    pub(crate) blur: Option<MotionBlur>,
}

/// Poses by time.
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
        let Some(camera) = &geometry.camera else { return Ok(None) };
        let sequence: Vec<u64> = match (frames, wanted) {
            (&[None], Some(wanted)) => wanted.frames().to_vec(),
            _ => frames.iter().copied().flatten().collect(),
        };
        let (course, sequence) = match camera {
            CameraMovement::Path { file, fps, smoothness } => {
                let path = read(file, *fps, access, warnings)?;
                let track = Track::new(path.poses.iter().map(key).collect(), *smoothness)
                    .map_err(|error| failure!(Malformed: "{PATH} {file}: {error}"))?;
                let sequence = frames_of(file, &track, sequence)?;
                (Course::Track(track), sequence)
            }
            CameraMovement::Turn { angles, fov, easing } => {
                let (Some(&first), Some(&last)) = (sequence.iter().min(), sequence.iter().max()) else {
                    return Err(usage_as(
                        Code::MissingSetting,
                        format!("{FRAMES} is missing: say over which frames the camera turns, as in {FRAMES} 1-240"),
                    ));
                };
                let turn = Turn { angles: *angles, fov: *fov, times: [first, last].map(time), easing: *easing };
                (Course::Turn(turn), sequence)
            }
        };
        let mut movement = Self { course, zoom: None, blur: geometry.blur };
        if sequence.first().is_some_and(|frame| movement.pose(time(*frame)).fov.is_some()) {
            movement.zoom = Some(placement(geometry, targets, camera)?);
        }
        let frames = sequence.into_iter().map(Some).collect();
        Ok(Some((movement, frames)))
    }

    /// Returns the pose at a time, in frames.
    pub(crate) fn pose(&self, time: f64) -> Pose {
        match &self.course {
            Course::Track(track) => track.pose(time),
            Course::Turn(turn) => turn.pose(time),
        }
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

/// Returns the time of a frame.
pub(crate) fn time(frame: u64) -> f64 {
    frame as f64
}

fn key(pose: &PathPose) -> Key {
    Key { time: pose.frame, pose: Pose { orientation: pose.orientation, fov: pose.fov } }
}

/// Reads a path, and tells what of it is ignored.
fn read(file: &str, fps: Option<f64>, access: Access, warnings: &mut Vec<Diagnostic>) -> Result<CameraPath> {
    let name = Path::new(file);
    let bytes = access
        .read_bytes(name)
        .map_err(|error| failed_as(of_opening(&error), format!("cannot open {PATH} {file}: {error}")))?;
    let path = CameraPath::parse(&bytes, name, fps)?;
    let mut remarks: Vec<String> = path.remarks.iter().map(|remark| format!("{file}: {remark}")).collect();
    if !path.ignored.is_empty() {
        remarks.push(format!("{file}: of no meaning here, and ignored: {}", path.ignored.join(", ")));
    }
    warnings.extend(remarks.into_iter().map(|text| Diagnostic::warning(Code::CameraPath, text).about(file)));
    Ok(path)
}

/// Returns the frames to make: those of a sequence, all of which need poses, or else all of the path.
fn frames_of(file: &str, track: &Track, sequence: Vec<u64>) -> Result<Vec<u64>> {
    let [first, last] = track.range();
    if sequence.is_empty() {
        let (from, to) = (first.max(0.0).ceil(), last.floor());
        if from > to {
            return Err(usage(format!(
                "{PATH} {file} has poses from frame {first} to {last}, and no whole frame between; choose frames with {FRAMES}"
            )));
        }
        if to - from >= MOST_FRAMES {
            return Err(usage(format!(
                "{PATH} {file} has poses from frame {first} to {last}, which are too many; choose frames with {FRAMES}"
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
        "{PATH} {file} has poses from frame {first} to {last}, but none for {} {}; add poses, or choose frames with {FRAMES}",
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
            CameraMovement::Path { file, .. } => format!("{PATH} {file} has fov, which may stay out"),
            CameraMovement::Turn { .. } => format!("leave {FOV} out"),
        };
        return Err(usage(format!(
            "{TO} {name} has no single field of view that can change, as perspective:fov= and fulldome:fov= have: {remedy}"
        )));
    };
    let orientation = placement.orientation.within(geometry.orientation);
    Ok(Placement { orientation, ..placement })
}
