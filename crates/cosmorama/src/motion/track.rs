use glam::DQuat;
use thiserror::Error;

use crate::sphere::{Angle, Orientation};

/// Orientation and field of view of a camera at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Orientation in the world.
    pub orientation: Orientation,
    /// Field of view, horizontal, vertical or diagonal as the camera's; that is kept, unless one is given.
    pub fov: Option<Angle>,
}

impl Pose {
    /// Returns the pose of a camera of its own field of view.
    pub const fn of(orientation: Orientation) -> Self {
        Self { orientation, fov: None }
    }
}

/// A pose at a given time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Key {
    /// Number of the frame, or a part between two frames.
    pub time: f64,
    /// Pose at that time.
    pub pose: Pose,
}

/// Movement of a camera from key to key.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Smoothness {
    /// At a constant rate along the shortest arc (Shoemake 1985, *slerp*). The rate jumps at keys.
    #[default]
    Slerp,
    /// Along a curve whose rate does not jump: cubic, by the rates of neighbouring keys (Kim, Kim & Shin 1995).
    Smooth,
}

/// Mistake in the keys of a track.
#[derive(Clone, Copy, Debug, Error, PartialEq)]
pub enum TrackError {
    /// There are no keys.
    #[error("a path needs at least one pose")]
    Empty,
    /// A time or a field of view is no number, or the field of view is not between 0° and 360°.
    #[error("pose {index}: its time or field of view is out of range")]
    OutOfRange {
        /// Index of the key, from 1.
        index: usize,
    },
    /// A key is not later than the one before it.
    #[error(
        "pose {index}: its time {time} is not after {before}, the one before it; sort them, and give each time once"
    )]
    Order {
        /// Index of the key, from 1.
        index: usize,
        /// Its time.
        time: f64,
        /// Time of the key before it.
        before: f64,
    },
    /// Some keys have a field of view, and others have none.
    #[error("pose {index} has a field of view, or lacks one, unlike the first; give it for all poses, or for none")]
    SomeFov {
        /// Index of the key, from 1.
        index: usize,
    },
}

/// Poses of a camera through given keys.
///
/// Before the first key and after the last the camera goes on turning at the rate it has there, so that a shutter that
/// is open beyond them blurs the first and last frame as much as the others.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    keys: Vec<Key>,
    smoothness: Smoothness,
}

/// State at a key, for interpolation: rotation, rotation vector per unit of time in the camera's own frame, field of
/// view and its rate.
#[derive(Clone, Copy)]
struct State {
    rotation: DQuat,
    rate: glam::DVec3,
    fov: f64,
    fov_rate: f64,
}

impl Track {
    /// Makes a track through keys in the order of their times.
    ///
    /// # Errors
    /// If there are none, times do not increase, a number is not finite, or only some keys have a field of view.
    pub fn new(keys: Vec<Key>, smoothness: Smoothness) -> Result<Self, TrackError> {
        let first = keys.first().ok_or(TrackError::Empty)?;
        for (index, key) in (1..).zip(&keys) {
            let is_fov = |fov: Angle| fov.radians() > 0.0 && fov.radians() <= Angle::TURN.radians();
            if !key.time.is_finite() || !key.pose.fov.is_none_or(is_fov) {
                return Err(TrackError::OutOfRange { index });
            }
            if key.pose.fov.is_some() != first.pose.fov.is_some() {
                return Err(TrackError::SomeFov { index });
            }
        }
        let unsorted = keys.windows(2).position(|pair| pair[1].time <= pair[0].time);
        match unsorted {
            Some(at) => Err(TrackError::Order { index: at + 2, time: keys[at + 1].time, before: keys[at].time }),
            None => Ok(Self { keys, smoothness }),
        }
    }

    /// Returns the keys.
    pub fn keys(&self) -> &[Key] {
        &self.keys
    }

    /// Returns the times of the first and the last key.
    pub fn range(&self) -> [f64; 2] {
        [self.keys[0].time, self.keys[self.keys.len() - 1].time]
    }

    /// Returns the pose at a time. At a key it is that key's own pose, to the last digit.
    pub fn pose(&self, time: f64) -> Pose {
        let after = self.keys.partition_point(|key| key.time < time);
        if let Some(key) = self.keys.get(after)
            && key.time == time
        {
            return key.pose;
        }
        let last = self.keys.len() - 1;
        if after == 0 || after > last {
            return self.beyond(if after == 0 { 0 } else { last }, time);
        }
        let (from, to) = (self.keys[after - 1], self.keys[after]);
        let span = to.time - from.time;
        let part = (time - from.time) / span;
        match self.smoothness {
            // To the last digit: where a camera rests, its pose is one.
            Smoothness::Slerp if from.pose == to.pose => from.pose,
            Smoothness::Slerp => {
                let turn = rotation_between(from.pose, to.pose) * part;
                let fov = from.pose.fov.zip(to.pose.fov).map(|(a, b)| a + (b - a) * part);
                Pose { orientation: turned(from.pose, turn), fov }
            }
            Smoothness::Smooth => {
                smooth(&self.state(after - 1), &self.state(after), span, part, from.pose.fov.is_some())
            }
        }
    }

    /// Returns the pose beyond the ends, where the rate of the end stays.
    fn beyond(&self, key: usize, time: f64) -> Pose {
        let Key { time: end, pose } = self.keys[key];
        let (state, beyond) = (self.state(key), time - end);
        let fov = pose.fov.map(|fov| Angle::from_radians(fov.radians() + state.fov_rate * beyond));
        Pose { orientation: turned(pose, state.rate * beyond), fov: fov.map(within_reason) }
    }

    /// Returns the state at a key: its rate is the mean of those on both sides, weighted by nearness, as by a parabola
    /// through three keys.
    fn state(&self, key: usize) -> State {
        let pose = self.keys[key].pose;
        let rates = |from: usize| {
            let (a, b) = (self.keys.get(from)?, self.keys.get(from + 1)?);
            let span = b.time - a.time;
            let fov = a.pose.fov.zip(b.pose.fov).map_or(0.0, |(a, b)| (b - a).radians());
            Some((rotation_between(a.pose, b.pose) / span, fov / span, span))
        };
        let (rate, fov_rate) = match (key.checked_sub(1).and_then(rates), rates(key)) {
            (Some((before, fov_before, wide)), Some((after, fov_after, near))) => {
                let part = wide / (wide + near);
                (before.lerp(after, part), fov_before + (fov_after - fov_before) * part)
            }
            (Some((rate, fov, _)), None) | (None, Some((rate, fov, _))) => (rate, fov),
            (None, None) => (glam::DVec3::ZERO, 0.0),
        };
        State { rotation: pose.orientation.rotation(), rate, fov: pose.fov.map_or(0.0, Angle::radians), fov_rate }
    }
}

/// Returns the pose on the cubic between two states: q₀ exp(ω₁β₁) exp(ω₂β₂) exp(ω₃β₃) with cumulative Bernstein
/// polynomials β (Kim, Kim & Shin 1995, section 4).
fn smooth(from: &State, to: &State, span: f64, part: f64, has_fov: bool) -> Pose {
    let (first, last) = (from.rate * (span / 3.0), to.rate * (span / 3.0));
    let [out, home] = [first, last].map(DQuat::from_scaled_axis);
    let middle = short_axis(out.inverse() * from.rotation.inverse() * to.rotation * home.inverse());
    let rest = 1.0 - part;
    let betas = [1.0 - rest.powi(3), part * part * (3.0 - 2.0 * part), part.powi(3)];
    let turns = [first * betas[0], middle * betas[1], last * betas[2]].map(DQuat::from_scaled_axis);
    let rotation = from.rotation * turns[0] * turns[1] * turns[2];
    let fov = || {
        let [a, b] = [from.fov + from.fov_rate * span / 3.0, to.fov - to.fov_rate * span / 3.0];
        rest.powi(3) * from.fov + 3.0 * part * rest * (rest * a + part * b) + part.powi(3) * to.fov
    };
    let fov = has_fov.then(|| within_reason(Angle::from_radians(fov())));
    Pose { orientation: Orientation::from_rotation(rotation), fov }
}

/// Least field of view beyond the keys, in radians.
const LEAST_FOV: f64 = 1e-3;

/// Clamps a field of view that a curve has carried too far.
fn within_reason(fov: Angle) -> Angle {
    Angle::from_radians(fov.radians().clamp(LEAST_FOV, Angle::TURN.radians()))
}

/// Returns the rotation vector from a pose to another, by the shortest way, in the first camera's frame.
fn rotation_between(from: Pose, to: Pose) -> glam::DVec3 {
    short_axis(from.orientation.rotation().inverse() * to.orientation.rotation())
}

/// Returns a rotation as a vector of at most half a turn.
fn short_axis(rotation: DQuat) -> glam::DVec3 {
    let rotation = if rotation.w < 0.0 { -rotation } else { rotation };
    rotation.normalize().to_scaled_axis()
}

/// Returns a pose's orientation after a turn in the camera's frame.
fn turned(pose: Pose, turn: glam::DVec3) -> Orientation {
    Orientation::from_rotation(pose.orientation.rotation() * DQuat::from_scaled_axis(turn))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Direction;

    fn pose(yaw: f64, pitch: f64, roll: f64) -> Pose {
        let [yaw, pitch, roll] = [yaw, pitch, roll].map(Angle::from_degrees);
        Pose::of(Orientation::from_yaw_pitch_roll(yaw, pitch, roll))
    }

    fn track(keys: &[(f64, Pose)], smoothness: Smoothness) -> Track {
        let keys = keys.iter().map(|&(time, pose)| Key { time, pose }).collect();
        Track::new(keys, smoothness).expect("a track")
    }

    /// Returns the angle between two orientations, in degrees.
    fn apart(a: Orientation, b: Orientation) -> f64 {
        short_axis(a.rotation().inverse() * b.rotation()).length().to_degrees()
    }

    #[test]
    fn the_shortest_arc_crosses_180_degrees() {
        let track = track(&[(1.0, pose(170.0, 0.0, 0.0)), (3.0, pose(-170.0, 0.0, 0.0))], Smoothness::Slerp);
        for (time, yaw) in [(1.0, 170.0), (1.5, 175.0), (2.0, 180.0), (2.5, -175.0), (3.5, -165.0), (0.0, 160.0)] {
            let (found, expected) = (track.pose(time).orientation, pose(yaw, 0.0, 0.0).orientation);
            assert!(apart(found, expected) < 1e-6, "{time}: {:?}", found.yaw_pitch_roll());
        }
    }

    #[test]
    fn smooth_tracks_pass_their_keys_at_one_rate() {
        let keys = [
            (0.0, pose(0.0, 0.0, 0.0)),
            (1.0, pose(30.0, 10.0, -5.0)),
            (3.0, pose(50.0, -20.0, 20.0)),
            (4.0, pose(100.0, 0.0, 0.0)),
        ];
        let track = track(&keys, Smoothness::Smooth);
        let step = 1e-4;
        for (time, key) in &keys {
            assert_eq!(track.pose(*time), *key);
            let [before, at, after] = [time - step, *time, time + step].map(|time| track.pose(time).orientation);
            let rate = |a: Orientation, b: Orientation| {
                (a.to_world(Direction::FRONT).vector() - b.to_world(Direction::FRONT).vector()) / step
            };
            let jump = (rate(before, at) - rate(at, after)).length();
            assert!(jump < 1e-3, "{time}: the rate jumps by {jump}");
        }
    }

    #[test]
    fn both_ways_keep_a_constant_turn() {
        let keys: Vec<_> = (0..5).map(|k| (f64::from(k * k), pose(7.0 * f64::from(k * k), 0.0, 0.0))).collect();
        for smoothness in [Smoothness::Slerp, Smoothness::Smooth] {
            let track = track(&keys, smoothness);
            for time in [-1.0, 0.3, 2.5, 8.0, 11.9, 17.0] {
                let (found, expected) = (track.pose(time).orientation, pose(7.0 * time, 0.0, 0.0).orientation);
                assert!(apart(found, expected) < 1e-6, "{smoothness:?} at {time}");
            }
        }
    }

    #[test]
    fn a_camera_at_rest_has_one_pose() {
        let key = pose(40.0, 7.0, -3.0);
        let track = track(&[(2.0, key), (5.0, key), (6.0, pose(0.0, 0.0, 0.0))], Smoothness::Slerp);
        assert!([2.0, 2.3, 3.0, 4.0, 5.0].iter().all(|time| track.pose(*time) == key));
    }

    #[test]
    fn fields_of_view_follow_the_keys() {
        let with = |fov: f64| Pose { fov: Some(Angle::from_degrees(fov)), ..pose(0.0, 0.0, 0.0) };
        for smoothness in [Smoothness::Slerp, Smoothness::Smooth] {
            let track = track(&[(0.0, with(40.0)), (2.0, with(60.0))], smoothness);
            let fov = |time: f64| track.pose(time).fov.expect("a field of view").degrees();
            assert!((fov(1.0) - 50.0).abs() < 1e-9 && (fov(2.5) - 65.0).abs() < 1e-9, "{smoothness:?}");
        }
    }

    #[test]
    fn mistakes_are_named() {
        let new = |keys: &[(f64, Pose)]| {
            Track::new(keys.iter().map(|&(time, pose)| Key { time, pose }).collect(), Smoothness::Slerp)
        };
        let at = |time: f64| (time, pose(0.0, 0.0, 0.0));
        assert_eq!(new(&[]), Err(TrackError::Empty));
        assert_eq!(new(&[at(1.0), at(1.0)]), Err(TrackError::Order { index: 2, time: 1.0, before: 1.0 }));
        assert_eq!(new(&[at(1.0), at(f64::NAN)]), Err(TrackError::OutOfRange { index: 2 }));
        let wide = Pose { fov: Some(Angle::from_degrees(50.0)), ..pose(0.0, 0.0, 0.0) };
        assert_eq!(new(&[at(1.0), (2.0, wide)]), Err(TrackError::SomeFov { index: 2 }));
    }
}
