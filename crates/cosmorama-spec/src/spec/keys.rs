use std::fmt::{self, Display};

use cosmorama::camera::{Canvas, LensCircle, Mirror};
use cosmorama::sphere::{Angle, Orientation};

use crate::angle::Degrees;
use crate::window::Window;

/// Keys and values of a SPEC to print: the counterpart of [`Fields`](super::fields::Fields).
///
/// Keys with default values are left out.
#[derive(Debug, Default)]
pub(crate) struct Keys(Vec<(String, String)>);

impl Keys {
    /// Adds a key.
    pub(super) fn with(mut self, key: impl Into<String>, value: impl Display) -> Self {
        self.0.push((key.into(), value.to_string()));
        self
    }

    /// Adds a key whose value may be missing.
    pub(super) fn maybe(self, key: impl Into<String>, value: Option<impl Display>) -> Self {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// Adds a number, unless it is the default.
    pub(super) fn number(self, key: &str, value: f64, default: f64) -> Self {
        self.maybe(key, Some(value).filter(|value| *value != default))
    }

    /// Adds an angle, unless it is the default.
    pub(super) fn angle(self, key: impl Into<String>, value: Angle, default: Angle) -> Self {
        self.maybe(key, Some(Degrees(value)).filter(|_| value != default))
    }

    /// Adds one of a list of words, unless it is the default.
    pub(super) fn choice<T: PartialEq>(self, key: &str, value: T, default: T, choices: &[(&str, T)]) -> Self {
        let word = choices.iter().find(|(_, choice)| *choice == value).map(|(word, _)| *word);
        self.maybe(key, word.filter(|_| value != default))
    }

    /// Adds `yes` if a switch is on.
    pub(super) fn switch(self, key: &str, is_on: bool) -> Self {
        self.maybe(key, is_on.then_some("yes"))
    }

    /// Adds the width of a pixel over its height.
    pub(super) fn aspect(self, aspect: f64) -> Self {
        self.number("aspect", aspect, 1.0)
    }

    /// Adds a circle, with a prefix for its keys.
    pub(super) fn circle(self, prefix: &str, circle: LensCircle) -> Self {
        let centre = circle.centre.map(|centre| format!("{}:{}", centre.x, centre.y));
        self.maybe(format!("{prefix}center"), centre).maybe(format!("{prefix}radius"), circle.radius)
    }

    /// Adds an orientation, with a prefix for its keys.
    pub(super) fn orientation(self, prefix: &str, orientation: Orientation) -> Self {
        let [yaw, pitch, roll] = typed(orientation);
        self.angle(format!("{prefix}yaw"), yaw, Angle::ZERO).angle(format!("{prefix}pitch"), pitch, Angle::ZERO).angle(
            format!("{prefix}roll"),
            roll,
            Angle::ZERO,
        )
    }

    /// Adds the orientation, mirroring and canvas of a picture.
    pub(super) fn placed(self, orientation: Orientation, mirror: Mirror, canvas: Option<Canvas>) -> Self {
        let flip = match mirror {
            Mirror { x: false, y: false } => None,
            Mirror { x: true, y: false } => Some("x"),
            Mirror { x: false, y: true } => Some("y"),
            Mirror { x: true, y: true } => Some("xy"),
        };
        self.maybe("flip", flip).orientation("", orientation).maybe("canvas", canvas.map(Window))
    }
}

/// Prints `key=value,key=value`.
impl Display for Keys {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, (key, value)) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { "," };
            write!(f, "{separator}{key}={value}")?;
        }
        Ok(())
    }
}

impl Keys {
    /// Returns whether there are no keys.
    pub(super) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Decimal places of a degree that are tried in the search for typed angles.
const PLACES: i32 = 12;

/// Returns yaw, pitch and roll as short numbers that give exactly this orientation, if there are any.
fn typed(orientation: Orientation) -> [Angle; 3] {
    let found = orientation.yaw_pitch_roll();
    let degrees = found.map(Angle::degrees);
    let [yaw, pitch, roll] = degrees;
    // Other angles for the same orientation: leaning over backwards, or straight up or down with roll instead of yaw.
    let turns = [[yaw, pitch, roll], [yaw + 180.0, 180.0 - pitch, roll + 180.0], [0.0, pitch, yaw], [0.0, pitch, -yaw]];
    let rounds = [0.0, 360.0, -360.0];
    for places in 0..=PLACES {
        let scale = f64::from(10u32).powi(places);
        for turn in turns {
            for (yaw_round, pitch_round, roll_round) in combinations(rounds) {
                let [yaw, pitch, roll] = turn;
                let candidate = [yaw + yaw_round, pitch + pitch_round, roll + roll_round]
                    .map(|degrees| Angle::from_degrees((degrees * scale).round() / scale + 0.0));
                let [yaw, pitch, roll] = candidate;
                if Orientation::from_yaw_pitch_roll(yaw, pitch, roll) == orientation {
                    return candidate;
                }
            }
        }
    }
    found
}

/// Returns every triple of three numbers.
fn combinations(of: [f64; 3]) -> impl Iterator<Item = (f64, f64, f64)> {
    of.into_iter().flat_map(move |a| of.into_iter().flat_map(move |b| of.into_iter().map(move |c| (a, b, c))))
}
