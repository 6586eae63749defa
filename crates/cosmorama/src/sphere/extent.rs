use std::fmt;

use super::Direction;

/// Range of yaws and pitches of a set of directions, in whole degrees. It does not depend on the directions' order.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Extent {
    /// One bit for each degree of yaw, from -180 on, that contains a direction.
    yaws: [u64; WORDS],
    /// Lowest and highest pitch.
    pitches: (i32, i32),
}

const WORDS: usize = 6;
const TURN: i32 = 360;

/// Longest arc of yaws, in degrees, that is described by its ends; of a longer one the gap is described.
const MOST: i32 = 300;

/// Widest gap, in degrees, that is left out: coarse pixels leave such between one another.
const LEAST_GAP: i32 = 8;

impl Extent {
    /// Returns the extent of one direction.
    pub fn of(direction: Direction) -> Self {
        let (yaw, pitch) = direction.longitude_latitude();
        let (yaw, pitch) = (yaw.degrees(), pitch.degrees());
        let bit = (yaw + 180.0).floor().clamp(0.0, f64::from(TURN - 1)) as usize;
        let mut yaws = [0; WORDS];
        yaws[bit / 64] = 1 << (bit % 64);
        Self { yaws, pitches: (pitch.floor() as i32, pitch.ceil() as i32) }
    }

    /// Returns the extent of both sets together.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            yaws: std::array::from_fn(|word| self.yaws[word] | other.yaws[word]),
            pitches: (self.pitches.0.min(other.pitches.0), self.pitches.1.max(other.pitches.1)),
        }
    }

    fn has_yaw(&self, degree: i32) -> bool {
        let bit = degree.rem_euclid(TURN) as usize;
        (self.yaws[bit / 64] >> (bit % 64)) & 1 == 1
    }

    /// Returns the shortest arc of yaws that holds all directions: its beginning, from -180 to 179, and its end, to the
    /// right of it, in degrees.
    pub fn yaws(&self) -> (i32, i32) {
        // The longest run of degrees without a direction ends where the arc begins.
        let starts = (0..TURN).filter(|degree| self.has_yaw(*degree));
        let gap = |start: &i32| (1..TURN).take_while(|before| !self.has_yaw(start - before)).count() as i32;
        let (start, gap) = starts.map(|start| (start, gap(&start))).max_by_key(|(_, gap)| *gap).unwrap_or((0, 0));
        (start - 180, start - 180 + TURN - gap)
    }

    /// Returns the lowest and the highest pitch, in degrees.
    pub fn pitches(&self) -> (i32, i32) {
        self.pitches
    }
}

impl fmt::Display for Extent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ((left, right), (low, high)) = (self.yaws(), self.pitches);
        match right - left {
            arc if arc >= TURN - LEAST_GAP => write!(f, "all yaws")?,
            MOST..TURN => {
                let (from, to) = if right < TURN / 2 { (right, left + TURN) } else { (right - TURN, left) };
                write!(f, "all yaws but {from}° to {to}°")?;
            }
            _ => write!(f, "yaw {left}° to {right}°")?,
        }
        write!(f, ", pitch {low}° to {high}°")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Angle;

    fn extent(directions: &[(f64, f64)]) -> String {
        let of = |(yaw, pitch): &(f64, f64)| {
            Extent::of(Direction::from_longitude_latitude(Angle::from_degrees(*yaw), Angle::from_degrees(*pitch)))
        };
        directions.iter().map(of).reduce(Extent::union).map_or_else(String::new, |extent| extent.to_string())
    }

    #[test]
    fn the_shortest_arc_is_told() {
        assert_eq!(extent(&[(-10.5, 3.2), (20.5, -4.7)]), "yaw -11° to 21°, pitch -5° to 4°");
        assert_eq!(extent(&[(-170.5, 1.5), (160.5, 0.5)]), "yaw 160° to 190°, pitch 0° to 2°");
        assert_eq!(extent(&[(179.999, 89.9)]), "yaw 179° to 180°, pitch 89° to 90°");
        let but_ahead: Vec<_> = (-10..300).map(|yaw| (f64::from(yaw) + 20.5, 0.5)).collect();
        assert_eq!(extent(&but_ahead), "all yaws but -40° to 10°, pitch 0° to 1°");
        let but_behind: Vec<_> = (-170..150).map(|yaw| (f64::from(yaw) + 0.5, 0.5)).collect();
        assert_eq!(extent(&but_behind), "all yaws but 150° to 190°, pitch 0° to 1°");
        let round: Vec<_> = (0..360).map(|yaw| (f64::from(yaw) + 0.5, -60.5)).collect();
        assert_eq!(extent(&round), "all yaws, pitch -61° to -60°");
        let coarse: Vec<_> = (0..90).map(|yaw| (f64::from(4 * yaw) + 0.5, -60.5)).collect();
        assert_eq!(extent(&coarse), "all yaws, pitch -61° to -60°");
    }
}
