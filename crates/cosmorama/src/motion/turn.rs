use super::Pose;
use crate::sphere::{Angle, Orientation};

/// A turn from one set of angles to another, angle by angle, between two frames.
///
/// Unlike a [`Track`](super::Track), it may go round more than once: yaw from 0° to 720° is two turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Turn {
    /// Yaw, pitch and roll in degrees.
    pub angles: [Ramp; 3],
    /// Field of view in degrees, measured as the camera's is; that is kept, unless one is given.
    pub fov: Option<Ramp>,
    /// Times at which the turn begins and ends.
    pub times: [f64; 2],
    /// Rate between them.
    pub easing: Easing,
}

/// A number that goes from a value to another.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ramp {
    /// Value at the beginning.
    pub from: f64,
    /// Value at the end.
    pub to: f64,
}

/// Rate of a turn over its time.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Easing {
    /// A constant rate, before the beginning and after the end, too.
    #[default]
    Linear,
    /// From rest.
    In,
    /// To rest.
    Out,
    /// From rest to rest.
    InOut,
}

impl Ramp {
    /// Returns the ramp that stays at a value.
    pub const fn constant(value: f64) -> Self {
        Self { from: value, to: value }
    }

    /// Returns whether the value changes.
    pub fn moves(&self) -> bool {
        self.from != self.to
    }

    fn at(self, part: f64) -> f64 {
        // Exact at both ends.
        if part == 1.0 { self.to } else { self.from + (self.to - self.from) * part }
    }
}

impl Easing {
    /// Returns the part of the way after a part of the time. A turn that rests at an end stays there beyond it.
    pub fn part(self, time: f64) -> f64 {
        let held = time.clamp(0.0, 1.0);
        match self {
            Self::Linear => time,
            Self::In if time > 1.0 => 2.0 * time - 1.0,
            Self::In => held * held,
            Self::Out if time < 0.0 => 2.0 * time,
            Self::Out => held * (2.0 - held),
            Self::InOut => held * held * (3.0 - 2.0 * held),
        }
    }
}

impl Turn {
    /// Returns the pose at a time. Whole turns apart, poses are equal to the last digit.
    pub fn pose(&self, time: f64) -> Pose {
        let [first, last] = self.times;
        let span = last - first;
        let part = self.easing.part(if span == 0.0 { 0.0 } else { (time - first) / span });
        let [yaw, pitch, roll] = self.angles.map(|ramp| Angle::from_degrees(ramp.at(part) % 360.0));
        let fov = self.fov.map(|fov| Angle::from_degrees(fov.at(part)));
        Pose { orientation: Orientation::from_yaw_pitch_roll(yaw, pitch, roll), fov }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn turn(yaw: Ramp, easing: Easing) -> Turn {
        Turn { angles: [yaw, Ramp::default(), Ramp::default()], fov: None, times: [1.0, 361.0], easing }
    }

    #[test]
    fn a_whole_turn_ends_where_it_began() {
        let turn = turn(Ramp { from: 0.0, to: 360.0 }, Easing::Linear);
        assert_eq!(turn.pose(361.0), turn.pose(1.0));
        assert!((turn.pose(91.0).orientation.yaw_pitch_roll()[0].degrees() - 90.0).abs() < 1e-9);
        assert!((turn.pose(0.0).orientation.yaw_pitch_roll()[0].degrees() + 1.0).abs() < 1e-9);
    }

    #[test]
    fn easings_go_all_the_way_without_a_jump() {
        for easing in [Easing::Linear, Easing::In, Easing::Out, Easing::InOut] {
            assert_eq!([easing.part(0.0), easing.part(1.0)], [0.0, 1.0]);
            for end in [0.0, 1.0] {
                let rates = [easing.part(end) - easing.part(end - 1e-6), easing.part(end + 1e-6) - easing.part(end)];
                assert!((rates[0] - rates[1]).abs() < 1e-11, "{easing:?} at {end}: {rates:?}");
            }
        }
    }
}
