//! Cameras and other nodes of glTF files whose animations turn them.

mod buffers;
mod scene;
mod spin;

use std::path::Path;

use cosmorama::sphere::Orientation;
use gltf::Gltf;
use gltf::animation::Property;

use super::error::wrong;
use super::{CameraPath, CameraPathError, PathPose, PathSource};
use buffers::Buffers;
use scene::Scene;
use spin::Spin;

/// Poses in each frame where the turn between two keys is not at a constant rate about one axis.
const POSES_A_FRAME: f64 = 4.0;

/// Greatest number of frames; more is a mistake in the file's times.
const MOST_FRAMES: f64 = 1_000_000.0;

/// Greatest number of keys of all nodes above one another, and of turns of them in all frames.
const MOST_TURNS: usize = 20_000_000;

/// Greatest error of a frame's number by the rounding of its time.
const ROUNDED: f64 = 1e-3;

/// Bytes of the header of glTF in one file.
const HEADER: u32 = 12;

/// Returns the number of bytes that a file says it has, if it is glTF in one file. The crate takes its header's from it unseen.
fn told_length(bytes: &[u8]) -> Option<u32> {
    let length = bytes.strip_prefix(b"glTF")?.get(4..8)?;
    length.try_into().ok().map(u32::from_le_bytes)
}

/// Returns whether a file is glTF, by its name.
pub(super) fn is_named(name: &Path) -> bool {
    let extension = name.extension().and_then(|extension| extension.to_str()).unwrap_or_default();
    extension.eq_ignore_ascii_case("glb") || extension.eq_ignore_ascii_case("gltf")
}

/// Returns whether all animations move what glTF knows, in known ways. The crate's own checks leave these out, and what
/// reads them panics.
fn has_known_animations(document: &gltf::Document) -> bool {
    use gltf::json::validation::Checked::Valid;
    let json = document.as_json();
    json.animations.iter().all(|animation| {
        let mut targets = animation.channels.iter().map(|channel| &channel.target);
        targets.all(|target| matches!(target.path, Valid(_)) && target.node.value() < json.nodes.len())
            && animation.samplers.iter().all(|sampler| matches!(sampler.interpolation, Valid(_)))
    })
}

/// Reads the turns of a camera, or of another node, from a file with times in seconds.
pub(super) fn path(bytes: &[u8], source: &PathSource) -> Result<CameraPath, CameraPathError> {
    let name = source.name;
    if let Some(length) = told_length(bytes).filter(|length| *length < HEADER) {
        return Err(wrong(
            name,
            format!("no valid glTF (its header says that it has {length} bytes, fewer than its own)"),
        ));
    }
    let Gltf { document, blob } =
        Gltf::from_slice(bytes).map_err(|error| wrong(name, format!("no valid glTF ({error})")))?;
    if !has_known_animations(&document) {
        return Err(wrong(name, "no valid glTF (an animation of what there is not)"));
    }
    let Some(fps) = source.fps else {
        let reason = "poses are by time, so that the rate of frames (fps) is needed; give it";
        return Err(CameraPathError { is_of_rate: true, ..wrong(name, reason) });
    };
    let scene = Scene::new(&document);
    let node = scene.choose(source)?;
    let chain = scene.chain(node);
    if !scene.is_turned(node) {
        let reason = format!(
            "nothing turns {}; turn it with yaw, pitch and roll, or name a node that an animation turns",
            scene.name_of(node)
        );
        return Err(wrong(name, reason));
    }
    let buffers = Buffers::new(name, blob.as_deref(), source.beside);
    let spins = spins(&scene, &chain, &buffers)?;
    let frames = frames(&spins, fps).ok_or_else(|| {
        wrong(
            name,
            format!("its animation is longer than {MOST_FRAMES} frames at {fps} frames a second; check the times"),
        )
    })?;
    if frames.len().saturating_mul(spins.len()) > MOST_TURNS {
        return Err(too_deep(name, &format!("{} poses of {} nodes", frames.len(), spins.len())));
    }
    let pose = |frame: f64| {
        let orientation = spins.iter().fold(Orientation::IDENTITY, |outer, spin| spin.at(frame / fps).within(outer));
        PathPose { frame, orientation, fov: None }
    };
    let goes = scene.is_animated(node, Property::Translation);
    let remark = || {
        format!(
            "{} also goes from place to place, which a picture of a world does not show; explain tells how much that matters",
            scene.name_of(node)
        )
    };
    let remarks = goes.then(remark).into_iter().collect();
    Ok(CameraPath { poses: frames.into_iter().map(pose).collect(), ignored: Vec::new(), remarks })
}

/// Reads the turns of nodes that hang on one another, the outermost first.
fn spins(scene: &Scene, chain: &[usize], buffers: &Buffers) -> Result<Vec<Spin>, CameraPathError> {
    let rotations = scene.rotations();
    let keys = chain.iter().filter_map(|node| rotations.get(node)).map(|channel| channel.sampler().input().count());
    // Nodes may share their keys, which are read for each.
    let keys = keys.fold(0, usize::saturating_add);
    if keys > MOST_TURNS {
        return Err(too_deep(buffers.name, &format!("{keys} keys of {} nodes", chain.len())));
    }
    let spin = |node: &usize| Spin::of(&scene.node(*node), rotations.get(node), buffers);
    Ok(Spin::joined(chain.iter().map(spin).collect::<Result<Vec<_>, _>>()?))
}

fn too_deep(name: &Path, found: &str) -> CameraPathError {
    let reason = format!(
        "{found} above one another are more than the {MOST_TURNS} that are computed; bake the camera's own turns"
    );
    wrong(name, reason)
}

/// Returns the frames at which poses are taken: those of the keys, and more where the turn between them is uneven. `None` if
/// there are too many.
fn frames(spins: &[Spin], fps: f64) -> Option<Vec<f64>> {
    let mut frames: Vec<f64> = spins.iter().flat_map(Spin::times).map(|time| snapped(time * fps)).collect();
    frames.sort_by(f64::total_cmp);
    let (first, last) = (*frames.first()?, *frames.last()?);
    // Of infinite times the difference is no number.
    if (last - first).is_nan() || last - first > MOST_FRAMES {
        return None;
    }
    let mut moving = spins.iter().filter(|spin| spin.moves());
    let is_even = moving.next().is_none_or(Spin::is_even) && moving.next().is_none();
    if !is_even {
        let steps = ((last - first) * POSES_A_FRAME).floor() as usize;
        frames.extend((0..=steps).map(|step| first + step as f64 / POSES_A_FRAME));
        frames.sort_by(f64::total_cmp);
    }
    frames.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    Some(frames)
}

/// Returns a frame without the error of a time in single precision.
fn snapped(frame: f64) -> f64 {
    if (frame - frame.round()).abs() < ROUNDED { frame.round() } else { frame }
}

#[cfg(test)]
mod tests {
    use std::io;

    use super::*;

    /// Writes a file of a camera on a turning arm, with two keys each: the arm turns by 90° to the left in one second, and
    /// the camera looks up by 30°, evenly.
    fn file(arm: bool) -> Vec<u8> {
        let [quarter, twelfth] = [45_f32, 15.0].map(|half| half.to_radians().sin_cos());
        let numbers: [f32; 18] = [
            0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, quarter.0, 0.0, quarter.1, 0.0, 0.0, 0.0, 1.0, twelfth.0, 0.0, 0.0,
            twelfth.1,
        ];
        let bytes: Vec<u8> = numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
        let channel = |sampler: usize, node: usize| {
            format!(r#"{{"sampler":{sampler},"target":{{"node":{node},"path":"rotation"}}}}"#)
        };
        let channels = if arm { format!("{},{}", channel(0, 0), channel(1, 1)) } else { channel(1, 1) };
        let json = format!(
            r#"{{"asset":{{"version":"2.0"}},"buffers":[{{"byteLength":72}}],
            "bufferViews":[{{"buffer":0,"byteLength":72}}],
            "accessors":[{{"bufferView":0,"componentType":5126,"count":2,"type":"SCALAR","min":[0],"max":[1]}},
            {{"bufferView":0,"byteOffset":8,"componentType":5126,"count":2,"type":"VEC4"}},
            {{"bufferView":0,"byteOffset":40,"componentType":5126,"count":2,"type":"VEC4"}}],
            "cameras":[{{"type":"perspective","perspective":{{"yfov":0.8,"znear":0.1}}}}],
            "nodes":[{{"name":"Arm","children":[1]}},{{"name":"Shot","camera":0}},{{"name":"Rest","camera":0}}],
            "scenes":[{{"nodes":[0,2]}}],
            "animations":[{{"samplers":[{{"input":0,"output":1}},{{"input":0,"output":2}}],"channels":[{channels}]}}]}}"#
        );
        let mut json = json.into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let length = 12 + 8 + json.len() + 8 + bytes.len();
        let mut file = b"glTF".to_vec();
        file.extend([2, length as u32].iter().flat_map(|number| number.to_le_bytes()));
        file.extend((json.len() as u32).to_le_bytes());
        file.extend(b"JSON");
        file.extend(json);
        file.extend((bytes.len() as u32).to_le_bytes());
        file.extend(b"BIN\0");
        file.extend(bytes);
        file
    }

    fn read(bytes: &[u8], fps: Option<f64>, node: Option<&str>) -> Result<CameraPath, String> {
        let beside = |_: &Path| Err(io::ErrorKind::NotFound.into());
        let source = PathSource { name: Path::new("shot.glb"), fps, node, is_of_input: false, beside: &beside };
        CameraPath::read(bytes, &source).map_err(|error| error.to_string())
    }

    fn angles(pose: &PathPose) -> [f64; 3] {
        pose.orientation.yaw_pitch_roll().map(|angle| (angle.degrees() * 1e3).round() / 1e3)
    }

    #[test]
    fn a_camera_turns_with_what_it_hangs_on() {
        // Alone, it turns evenly, and its keys are enough.
        let path = read(&file(false), Some(24.0), None).unwrap();
        assert_eq!(path.poses.iter().map(|pose| pose.frame).collect::<Vec<_>>(), [0.0, 24.0]);
        assert_eq!(angles(&path.poses[1]), [0.0, 30.0, 0.0]);
        let path = read(&file(true), Some(24.0), Some("Shot")).unwrap();
        assert_eq!(path.poses.len(), 97);
        assert_eq!(angles(&path.poses[96]), [-90.0, 30.0, 0.0]);
        assert_eq!(angles(&path.poses[48]), [-45.0, 15.0, 0.0]);
        assert_eq!(angles(&read(&file(true), Some(24.0), Some("Arm")).unwrap().poses[1]), [-90.0, 0.0, 0.0]);
    }

    /// Returns a file of so many nodes, one below the other, of which the first `turned` turn by the same keys; the last is a camera.
    fn deep(nodes: usize, turned: usize) -> Vec<u8> {
        let node = |node: usize| format!(r#"{{"children":[{}]}},"#, node + 1);
        let tree: String = (0..nodes - 1).map(node).collect();
        let channel = |node: usize| format!(r#"{{"sampler":0,"target":{{"node":{node},"path":"rotation"}}}},"#);
        let channels: String = (0..turned).map(channel).collect();
        let whole = file(true);
        let json = String::from_utf8_lossy(&whole[20..]);
        let (head, _) = json.split_once(r#""nodes""#).unwrap();
        let json = format!(
            r#"{head}"nodes":[{tree}{{"camera":0}}],"scenes":[{{"nodes":[0]}}],"animations":[{{"samplers":[{{"input":0,"output":1}}],"channels":[{}]}}]}}"#,
            channels.trim_end_matches(',')
        );
        json.replacen(r#""byteLength":72}],"#, r#""byteLength":72,"uri":"turn.bin"}],"#, 1).into_bytes()
    }

    #[test]
    fn nodes_far_down_take_time_by_their_number() {
        let keys = file(true);
        let beside = |_: &Path| Ok(keys[keys.len() - 72..].to_vec());
        let read = |bytes: &[u8], fps: f64| {
            let name = Path::new("deep.gltf");
            let source = PathSource { name, fps: Some(fps), node: None, is_of_input: false, beside: &beside };
            let started = std::time::Instant::now();
            let read = CameraPath::read(bytes, &source).map_err(|error| error.to_string());
            assert!(started.elapsed().as_secs() < 10, "{:?}", started.elapsed());
            read
        };
        let path = read(&deep(200_000, 1), 2.0).unwrap();
        assert_eq!(angles(&path.poses[path.poses.len() - 1]), [-90.0, 0.0, 0.0]);
        // Four turns by 90° come to none, but for the rounding of all of them.
        let path = read(&deep(100_000, 20_000), 2.0).unwrap();
        let turned = angles(&path.poses[path.poses.len() - 1]);
        assert!(path.poses.len() == 9 && turned.iter().all(|angle| angle.abs() < 0.5), "{turned:?}");
        let told = read(&deep(60_000, 60_000), 1000.0).map(|path| path.poses.len());
        assert_eq!(told.map_err(|error| error.contains("above one another")), Err(true));
    }

    #[test]
    fn what_is_wrong_is_named() {
        let whole = file(true);
        type Case<'a> = (&'a [u8], Option<f64>, Option<&'a str>, &'a str);
        let cases: [Case; 5] = [
            (&whole, None, None, "rate of frames"),
            (&whole, Some(24.0), Some("Crane"), "no camera or node Crane; there are Arm, Shot and Rest"),
            (&whole, Some(24.0), Some("Rest"), "nothing turns Rest"),
            (&whole[..whole.len() - 20], Some(24.0), None, "no valid glTF"),
            (b"glTF", Some(24.0), None, "no valid glTF"),
        ];
        for (bytes, fps, node, words) in cases {
            let found = read(bytes, fps, node).unwrap_err();
            assert!(found.contains(words), "{found}");
        }
        let key = b"\"node\":1";
        let at = whole.windows(key.len()).position(|bytes| bytes == key).unwrap();
        let lost = [&whole[..at], b"\"node\":9", &whole[at + key.len()..]].concat();
        let found = read(&lost, Some(24.0), None).unwrap_err();
        assert!(found.contains("an animation of what there is not"), "{found}");
        // Whatever is damaged, nothing panics.
        for at in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[at] = damaged[at].wrapping_add(1);
            let _ = read(&damaged, Some(24.0), None);
        }
    }
}
