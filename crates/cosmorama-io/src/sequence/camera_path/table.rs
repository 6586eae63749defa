use std::path::Path;

use cosmorama::sphere::{Angle, Orientation};

use super::{CameraPathError, PathPose};

/// Numbers by name, as typed.
pub(super) struct Table<'a> {
    /// Name of the file.
    pub(super) name: &'a Path,
    /// Word for a row in messages.
    pub(super) unit: &'static str,
    /// Names of the columns, in small letters.
    pub(super) names: Vec<String>,
    /// Place of the names; 0 where they are with the values.
    pub(super) header: u64,
    pub(super) rows: Vec<Row>,
}

/// A row of values.
pub(super) struct Row {
    /// Line in the file, or number of the pose.
    pub(super) place: u64,
    /// Values, in the order of the columns; those at the end may lack.
    pub(super) values: Vec<Option<String>>,
}

/// Columns by their meaning.
pub(super) struct Columns {
    time: usize,
    /// Frames for each unit of time.
    rate: f64,
    turn: Turn,
    fov: Option<usize>,
    pub(super) ignored: Vec<String>,
}

/// Columns of an orientation.
enum Turn {
    /// Yaw, and pitch and roll, which are 0 unless given.
    Angles([Option<usize>; 3]),
    /// A unit quaternion: w, x, y, z.
    Quaternion([usize; 4]),
    /// A rotation by Gyroflow.
    Gyroflow(Gyroflow),
}

/// Columns of a rotation as Gyroflow writes it: from the camera's frame to a world of its own.
#[derive(Clone)]
enum Gyroflow {
    /// Unit quaternion: w, x, y, z.
    Quaternion([usize; 4]),
    /// Angles in degrees about x, then y, then z, which it calls pitch, yaw and roll.
    Angles([usize; 3]),
}

const ANGLES: [&str; 3] = ["yaw", "pitch", "roll"];
const QUATERNION: [&str; 4] = ["qw", "qx", "qy", "qz"];

/// Gyroflow's names for poses as they were measured, and as it has smoothed them; it counts time in milliseconds.
const MEASURED: &str = "org_";
const SMOOTHED: &str = "stab_";
const MILLISECONDS: &str = "timestamp_ms";

/// Most columns of a table: Gyroflow's have some thirty. Poses that each bring a name of their own would take memory by the square
/// of their number.
const MOST_COLUMNS: usize = 256;

/// Greatest number of a frame. Beyond, numbers of frames are not one apart, and times in frames are infinite at last.
const GREATEST_FRAME: f64 = 1e15;

/// Columns that a path may have.
const EXPECTED: &str = "expected frame,yaw,pitch,roll or frame,qw,qx,qy,qz, and fov if it changes; time in seconds may stand for \
                        frame";

impl Table<'_> {
    /// Creates an error about a row.
    pub(super) fn error(&self, row: &Row, reason: &str) -> CameraPathError {
        self.error_at(row.place, reason)
    }

    fn error_at(&self, place: u64, reason: &str) -> CameraPathError {
        let place = if place == 0 { String::new() } else { format!("{} {place}: ", self.unit) };
        CameraPathError { path: self.name.to_owned(), place, reason: reason.to_owned(), is_of_rate: false }
    }

    fn rate_error(&self, reason: &str) -> CameraPathError {
        CameraPathError { is_of_rate: true, ..self.error_at(self.header, reason) }
    }

    /// Checks that there are not more columns than programs write.
    pub(super) fn check_names(&self) -> Result<(), CameraPathError> {
        if self.names.len() <= MOST_COLUMNS {
            return Ok(());
        }
        Err(self.error_at(self.header, &format!("more than {MOST_COLUMNS} columns, which no path has; {EXPECTED}")))
    }

    /// Checks that the last row has a value for each column.
    pub(super) fn check_length(&self) -> Result<(), CameraPathError> {
        match self.rows.last() {
            Some(row) if row.values.len() != self.names.len() => {
                let (found, names) = (row.values.len(), self.names.join(","));
                Err(self.error(row, &format!("{found} values, but {} columns: {names}", self.names.len())))
            }
            _ => Ok(()),
        }
    }

    /// Finds the columns that make poses.
    pub(super) fn columns(&self, fps: Option<f64>, is_of_input: bool) -> Result<Columns, CameraPathError> {
        if self.names.is_empty() {
            return Err(self.error_at(0, &format!("no pose in it; {EXPECTED}")));
        }
        let twice = self.names.iter().enumerate().find(|(index, name)| self.names[..*index].contains(name));
        if let Some((_, name)) = twice {
            return Err(self.error_at(self.header, &format!("two columns {name}; give it once")));
        }
        let at = |name: &str| self.names.iter().position(|other| other == name);
        let lacking = |name: &str| self.error_at(self.header, &format!("no column {name}; {EXPECTED}"));
        let gyroflow = self.gyroflow(is_of_input);
        let milliseconds = at(MILLISECONDS).filter(|_| gyroflow.is_some());
        let (time, rate) = match (milliseconds, at("frame"), at("time"), fps) {
            (Some(time), _, _, Some(fps)) => (time, fps / 1000.0),
            (None, Some(_), _, Some(_)) => {
                return Err(self.rate_error("poses are by frame, so that a rate (fps) has no effect; leave it out"));
            }
            (_, Some(frame), _, None) => (frame, 1.0),
            (None, None, Some(time), Some(fps)) => (time, fps),
            (Some(_), None, _, None) | (None, None, Some(_), None) => {
                return Err(self.rate_error("poses are by time, so that the rate of frames (fps) is needed; give it"));
            }
            (None, None, None, _) => return Err(lacking("frame")),
        };
        if let Some(turn) = gyroflow {
            return Ok(Columns { time, rate, turn: Turn::Gyroflow(turn), fov: None, ignored: Vec::new() });
        }
        let angles = ANGLES.map(at);
        let quaternion = QUATERNION.map(at);
        let turn = match (angles[0], quaternion.iter().any(Option::is_some)) {
            (Some(_), true) => {
                return Err(self.error_at(self.header, "both angles and quaternions; give one of them"));
            }
            (None, true) => {
                let lacks = QUATERNION.iter().zip(quaternion).find(|(_, column)| column.is_none());
                if let Some((name, _)) = lacks {
                    return Err(lacking(name));
                }
                Turn::Quaternion(quaternion.map(Option::unwrap_or_default))
            }
            (None, false) => return Err(lacking("yaw")),
            (Some(_), false) => Turn::Angles(angles),
        };
        let known =
            |name: &&String| ["frame", "time", "fov"].iter().chain(&ANGLES).chain(&QUATERNION).any(|k| k == name);
        let ignored = self.names.iter().filter(|name| !known(name)).cloned().collect();
        Ok(Columns { time, rate, turn, fov: at("fov"), ignored })
    }

    /// Finds the rotations of a table by Gyroflow: those of the input's camera are measured, those of another smoothed if it has
    /// any.
    fn gyroflow(&self, is_of_input: bool) -> Option<Gyroflow> {
        let at = |name: String| self.names.iter().position(|other| *other == name);
        let kinds = if is_of_input { [MEASURED, SMOOTHED] } else { [SMOOTHED, MEASURED] };
        kinds.into_iter().find_map(|kind| {
            let quaternion = ["w", "x", "y", "z"].map(|part| at(format!("{kind}quat_{part}")));
            let angles = ["pitch", "yaw", "roll"].map(|angle| at(format!("{kind}{angle}")));
            match (quaternion, angles) {
                ([Some(w), Some(x), Some(y), Some(z)], _) => Some(Gyroflow::Quaternion([w, x, y, z])),
                (_, [Some(x), Some(y), Some(z)]) => Some(Gyroflow::Angles([x, y, z])),
                _ => None,
            }
        })
    }

    /// Returns a number of a row.
    fn number(&self, row: &Row, column: usize) -> Result<f64, CameraPathError> {
        let name = &self.names[column];
        let Some(value) = row.values.get(column).cloned().flatten() else {
            return Err(self.error(row, &format!("no {name}; {EXPECTED}")));
        };
        match value.parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            _ if value.starts_with('"') => Err(self.error(row, &format!("{name} is {value}; expected a number"))),
            _ => Err(self.error(row, &format!("{name} is '{value}'; expected a number"))),
        }
    }
}

impl Columns {
    /// Returns the pose of a row.
    pub(super) fn pose(&self, table: &Table, row: &Row) -> Result<PathPose, CameraPathError> {
        let number = |column: usize| table.number(row, column);
        let orientation = match &self.turn {
            Turn::Angles(columns) => {
                let [yaw, pitch, roll] = columns.map(|column| column.map_or(Ok(0.0), number));
                let [yaw, pitch, roll] = [yaw?, pitch?, roll?].map(Angle::from_degrees);
                Orientation::from_yaw_pitch_roll(yaw, pitch, roll)
            }
            Turn::Quaternion(columns) | Turn::Gyroflow(Gyroflow::Quaternion(columns)) => {
                let [w, x, y, z] = columns.map(number);
                Orientation::from_quaternion([w?, x?, y?, z?]).map_err(|length| {
                    let found =
                        format!("the quaternion's length is {length:.4}; expected 1: a rotation is a unit quaternion");
                    table.error(row, &found)
                })?
            }
            Turn::Gyroflow(Gyroflow::Angles(columns)) => {
                let [x, y, z] = columns.map(number);
                let [x, y, z] = [x?, y?, z?].map(Angle::from_degrees);
                // Our own angles turn about y, then x, then z, and two of them the other way.
                let about_x = Orientation::from_yaw_pitch_roll(Angle::ZERO, x, Angle::ZERO);
                let about_y = Orientation::from_yaw_pitch_roll(-y, Angle::ZERO, Angle::ZERO);
                about_x.within(about_y).within(Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::ZERO, -z))
            }
        };
        let fov = self.fov.map(number).transpose()?;
        if let Some(fov) = fov.filter(|fov| !(*fov > 0.0 && *fov <= 360.0)) {
            return Err(table.error(row, &format!("fov is {fov}; expected an angle above 0° and at most 360°")));
        }
        let frame = number(self.time)? * self.rate;
        if frame.abs() > GREATEST_FRAME {
            let found =
                format!("it is of frame {frame:e}; expected one from -{GREATEST_FRAME:e} to {GREATEST_FRAME:e}");
            return Err(table.error(row, &found));
        }
        Ok(PathPose { frame, orientation, fov: fov.map(Angle::from_degrees) })
    }

    /// Turns a path by Gyroflow so that it begins at the front: its world has an orientation of its own. A smoothed path begins as
    /// far from there as from the measured one. Returns a remark on it.
    pub(super) fn settle(&self, table: &Table, poses: &mut [PathPose]) -> Result<Option<String>, CameraPathError> {
        let (Turn::Gyroflow(_), Some(row)) = (&self.turn, table.rows.first()) else { return Ok(None) };
        let Some(measured) = table.gyroflow(true) else { return Ok(None) };
        let columns = Columns { turn: Turn::Gyroflow(measured), fov: None, ignored: Vec::new(), ..*self };
        let first = columns.pose(table, row)?.orientation;
        for pose in poses {
            pose.orientation = pose.orientation.within(first.inverse());
        }
        Ok(Some("a path by Gyroflow: its first pose looks to the front, upright".to_owned()))
    }

    /// Describes an angle that goes on by more than half a turn over several frames: the shortest way is taken, and may not be
    /// the one that was meant. From a frame to the next it is a wrap.
    pub(super) fn long_way(&self, table: &Table, [before, row]: [&Row; 2], frames: f64) -> Option<String> {
        let Turn::Angles(columns) = &self.turn else { return None };
        let far = |name: &str, column: Option<usize>| {
            let (a, b) = (table.number(before, column?).ok()?, table.number(row, column?).ok()?);
            (frames > 1.0 && (b - a).abs() > 180.0).then(|| {
                format!(
                    "{} {}: {name} goes from {a} to {b} in {frames} frames; the shortest way between two poses is taken, so that \
                     whole turns need poses in between",
                    table.unit, row.place
                )
            })
        };
        ANGLES.into_iter().zip(columns).find_map(|(name, column)| far(name, *column))
    }
}
