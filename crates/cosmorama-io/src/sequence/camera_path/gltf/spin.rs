use cosmorama::motion::{Key, Pose, Smoothness, Track};
use cosmorama::sphere::Orientation;
use gltf::Node;
use gltf::animation::{Channel, Interpolation};

use super::buffers::Buffers;
use super::wrong;
use crate::sequence::camera_path::CameraPathError;

/// Turns of one node against what it hangs on.
pub(super) enum Spin {
    /// It stands still.
    Still(Orientation),
    /// It turns evenly from key to key.
    Even(Vec<Key>),
    /// It jumps at each key.
    Steps(Vec<Key>),
    /// Cubic curves between numbers of quaternions: at each time an incoming tangent, a value and an outgoing tangent.
    Cubic(Vec<(f64, [[f64; 4]; 3])>),
}

impl Spin {
    /// Reads the turns of a node in the channel that turns it, if there is one.
    pub(super) fn of(node: &Node, channel: Option<&Channel>, buffers: &Buffers) -> Result<Self, CameraPathError> {
        let Some(channel) = channel else {
            let (_, rotation, _) = node.transform().decomposed();
            return Ok(Self::Still(orientation(rotation.map(f64::from)).unwrap_or(Orientation::IDENTITY)));
        };
        let sampler = channel.sampler();
        let (times, values) = (buffers.numbers(&sampler.input())?, buffers.numbers(&sampler.output())?);
        let is_cubic = sampler.interpolation() == Interpolation::CubicSpline;
        let numbers = if is_cubic { 12 } else { 4 };
        let is_sorted = times.windows(2).all(|pair| pair[0] < pair[1]);
        if times.is_empty() || !is_sorted || values.len() != numbers * times.len() {
            let reason = format!(
                "an animation has {} times and {} numbers for rotations; expected times in order, and {numbers} numbers for each",
                times.len(),
                values.len()
            );
            return Err(wrong(buffers.name, reason));
        }
        let quaternion = |numbers: &[f64]| [numbers[0], numbers[1], numbers[2], numbers[3]];
        if is_cubic {
            let parts = values.chunks(12).map(|all| [&all[..4], &all[4..8], &all[8..]].map(quaternion));
            return Ok(Self::Cubic(times.into_iter().zip(parts).collect()));
        }
        let key = |(time, value): (f64, &[f64])| {
            let turned = orientation(quaternion(value));
            let turned =
                turned.ok_or_else(|| wrong(buffers.name, format!("at {time} s a rotation is no unit quaternion")))?;
            Ok(Key { time, pose: Pose::of(turned) })
        };
        let keys = times.into_iter().zip(values.chunks(4)).map(key).collect::<Result<Vec<Key>, CameraPathError>>()?;
        Ok(if sampler.interpolation() == Interpolation::Step { Self::Steps(keys) } else { Self::Even(keys) })
    }

    /// Joins nodes that stand still with those above them, the outermost first.
    pub(super) fn joined(spins: impl IntoIterator<Item = Self>) -> Vec<Self> {
        let mut joined: Vec<Self> = Vec::new();
        for spin in spins {
            if let (Some(Self::Still(outer)), Self::Still(inner)) = (joined.last_mut(), &spin) {
                *outer = inner.within(*outer);
            } else {
                joined.push(spin);
            }
        }
        joined
    }

    /// Returns the times of its keys, in seconds.
    pub(super) fn times(&self) -> Vec<f64> {
        match self {
            Self::Still(_) => Vec::new(),
            Self::Even(keys) | Self::Steps(keys) => keys.iter().map(|key| key.time).collect(),
            Self::Cubic(keys) => keys.iter().map(|(time, _)| *time).collect(),
        }
    }

    pub(super) fn moves(&self) -> bool {
        !matches!(self, Self::Still(_))
    }

    /// Returns whether it turns at a constant rate between two keys.
    pub(super) fn is_even(&self) -> bool {
        matches!(self, Self::Still(_) | Self::Even(_))
    }

    /// Returns the orientation at a time. Before the first key and after the last it rests.
    pub(super) fn at(&self, time: f64) -> Orientation {
        match self {
            Self::Still(orientation) => *orientation,
            Self::Steps(keys) => {
                let after = keys.partition_point(|key| key.time <= time + 1e-9);
                keys[after.saturating_sub(1)].pose.orientation
            }
            Self::Even(keys) => {
                let (first, last) = (keys[0], keys[keys.len() - 1]);
                let after = keys.partition_point(|key| key.time <= time);
                match keys.get(after.saturating_sub(1)..=after) {
                    Some(pair) if after > 0 => {
                        let track = Track::new(pair.to_vec(), Smoothness::Slerp);
                        track.map_or(first.pose.orientation, |track| track.pose(time).orientation)
                    }
                    _ if after == 0 => first.pose.orientation,
                    _ => last.pose.orientation,
                }
            }
            Self::Cubic(keys) => cubic(keys, time),
        }
    }
}

/// Returns the orientation on a cubic curve by glTF's formula (appendix C of its specification).
fn cubic(keys: &[(f64, [[f64; 4]; 3])], time: f64) -> Orientation {
    let after = keys.partition_point(|(key, _)| *key <= time);
    let numbers = match (keys.get(after.wrapping_sub(1)), keys.get(after)) {
        (Some((from, [_, a, outgoing])), Some((to, [incoming, b, _]))) => {
            let (length, t) = (to - from, (time - from) / (to - from));
            let (t2, t3) = (t * t, t * t * t);
            let weights =
                [2.0 * t3 - 3.0 * t2 + 1.0, length * (t3 - 2.0 * t2 + t), 3.0 * t2 - 2.0 * t3, length * (t3 - t2)];
            [0, 1, 2, 3].map(|k| [a[k], outgoing[k], b[k], incoming[k]].iter().zip(weights).map(|(n, w)| n * w).sum())
        }
        (Some((_, [_, value, _])), None) | (None, Some((_, [_, value, _]))) => *value,
        (None, None) => [0.0, 0.0, 0.0, 1.0],
    };
    orientation(numbers).unwrap_or(Orientation::IDENTITY)
}

/// Returns the orientation of a quaternion x, y, z, w of any length but 0.
fn orientation([x, y, z, w]: [f64; 4]) -> Option<Orientation> {
    let length = (x * x + y * y + z * z + w * w).sqrt();
    let is_rotation = length.is_finite() && length > 1e-3;
    if is_rotation { Orientation::from_quaternion([w, x, y, z].map(|number| number / length)).ok() } else { None }
}
