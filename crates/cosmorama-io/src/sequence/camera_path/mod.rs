//! Paths of cameras: poses by frame or by time, as tables (CSV), JSON, or animations of glTF files.

mod csv;
mod error;
mod gltf;
mod json;
mod table;

pub use error::CameraPathError;

use std::io;
use std::path::Path;

use cosmorama::sphere::{Angle, Orientation};

use table::Table;

/// Path of a camera: its poses in the order of time.
///
/// ```
/// use cosmorama_io::CameraPath;
///
/// let text = b"frame,yaw,pitch,roll\n1,0,0,0\n25,30,10,0\n";
/// let path = CameraPath::parse(text, std::path::Path::new("shot.csv"), None)?;
/// assert_eq!(path.poses[1].frame, 25.0);
/// assert!((path.poses[1].orientation.yaw_pitch_roll()[0].degrees() - 30.0).abs() < 1e-9);
/// # Ok::<(), cosmorama_io::CameraPathError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct CameraPath {
    /// Poses, in the order of time.
    pub poses: Vec<PathPose>,
    /// Columns that mean nothing here.
    pub ignored: Vec<String>,
    /// Remarks about poses whose way to the next may not be the one that was meant.
    pub remarks: Vec<String>,
}

/// A pose of a path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPose {
    /// Number of the frame, or a part between two frames.
    pub frame: f64,
    /// Orientation.
    pub orientation: Orientation,
    /// Field of view.
    pub fov: Option<Angle>,
}

/// File with the path of a camera, apart from its bytes.
#[derive(Clone, Copy)]
pub struct PathSource<'a> {
    /// Name of the file: `.glb` and `.gltf` are glTF.
    pub name: &'a Path,
    /// Frames in a second, for time stamps.
    pub fps: Option<f64>,
    /// Camera or node of a glTF file; its only camera, unless given.
    pub node: Option<&'a str>,
    /// Whether the path is that of a picture's own camera, as its gyroscope measured it: of a table by Gyroflow, which has
    /// both, the measured poses are read, and else the smoothed ones.
    pub is_of_input: bool,
    /// Reads a file that this one refers to.
    pub beside: &'a dyn Fn(&Path) -> io::Result<Vec<u8>>,
}

/// Greatest turn from a frame to the next, in degrees, and what may be rounded of it.
const GREATEST_TURN: f64 = 90.0;
const ROUNDING: f64 = 1e-6;

impl CameraPath {
    /// Separates the name of a file of poses from that of a node in it, as in `shot.glb#Camera`.
    pub fn split_node(text: &str) -> (&str, Option<&str>) {
        match text.split_once('#') {
            Some((file, node)) if gltf::is_named(Path::new(file)) => (file, Some(node)),
            _ => (text, None),
        }
    }

    /// Reads a path from the bytes of a file: a table as [`CameraPath::parse`] reads it, or an animated camera of a glTF file.
    ///
    /// # Errors
    /// When [`CameraPath::parse`] fails; when a glTF file is damaged, no rate is given for its times, it does not have the node,
    /// or nothing turns that.
    pub fn read(bytes: &[u8], source: &PathSource) -> Result<Self, CameraPathError> {
        if gltf::is_named(source.name) {
            let path = gltf::path(bytes, source)?;
            check_turns(source.name, &path.poses)?;
            return Ok(path);
        }
        Self::of_table(&table(bytes, source.name)?, source.fps, source.is_of_input)
    }

    /// Reads a table of poses from the bytes of a file. With `fps` it may have time stamps; the frame at a time t is fps·t. `name` is
    /// the file's name in messages.
    ///
    /// The table has a column `frame`, or `time` in seconds, and either `yaw`, `pitch` and `roll` in degrees or a unit
    /// quaternion `qw`, `qx`, `qy` and `qz`; `fov` in degrees is optional. JSON is a list of poses with these names, or an
    /// object with a list of numbers for each name.
    ///
    /// # Errors
    /// When the file is no such table, a number is none, frames are not in order, a quaternion is not of unit length, or the
    /// camera turns by more than 90° from a frame to the next.
    pub fn parse(bytes: &[u8], name: &Path, fps: Option<f64>) -> Result<Self, CameraPathError> {
        Self::of_table(&table(bytes, name)?, fps, false)
    }

    fn of_table(table: &Table, fps: Option<f64>, is_of_input: bool) -> Result<Self, CameraPathError> {
        let columns = table.columns(fps, is_of_input)?;
        let mut poses: Vec<PathPose> = Vec::new();
        let mut remarks = Vec::new();
        for (index, row) in table.rows.iter().enumerate() {
            let pose = columns.pose(table, row)?;
            if let (Some(before), Some(row_before)) =
                (poses.last(), index.checked_sub(1).map(|index| &table.rows[index]))
            {
                check_order(table, row, [before.frame, pose.frame])?;
                let turn = before.orientation.angle_to(&pose.orientation).degrees();
                let frames = pose.frame - before.frame;
                if turn > GREATEST_TURN * frames.max(1.0) + ROUNDING {
                    return Err(table.error(
                        row,
                        &format!(
                            "the camera turns by {turn:.0}° from frame {} to {}; expected at most {GREATEST_TURN:.0}° from a frame \
                             to the next: likely an angle that wraps wrongly, or radians where degrees are expected",
                            before.frame, pose.frame
                        ),
                    ));
                }
                remarks.extend(columns.long_way(table, [row_before, row], frames));
            }
            poses.push(pose);
        }
        if poses.is_empty() {
            return Err(error::wrong(table.name, "no pose in it; expected a line for each frame"));
        }
        remarks.extend(columns.settle(table, &mut poses)?);
        Ok(Self { poses, ignored: columns.ignored, remarks })
    }
}

/// Reads the table in a text.
fn table<'a>(bytes: &[u8], name: &'a Path) -> Result<Table<'a>, CameraPathError> {
    let text = str::from_utf8(bytes).map_err(|_| {
        error::wrong(name, "not a text; expected a path as CSV or JSON, or a glTF file named .glb or .gltf")
    })?;
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.starts_with(['[', '{']) { json::table(text, name) } else { csv::table(text, name) }
}

/// Checks that poses turn by no more than is sensible from a frame to the next.
fn check_turns(name: &Path, poses: &[PathPose]) -> Result<(), CameraPathError> {
    for pair in poses.windows(2) {
        let turn = pair[0].orientation.angle_to(&pair[1].orientation).degrees();
        if turn > GREATEST_TURN * (pair[1].frame - pair[0].frame).max(1.0) + ROUNDING {
            return Err(error::wrong(
                name,
                format!(
                    "the camera turns by {turn:.0}° from frame {} to {}; expected at most {GREATEST_TURN:.0}° from a frame to the next",
                    pair[0].frame, pair[1].frame
                ),
            ));
        }
    }
    Ok(())
}

/// Checks that a pose is later than the one before it.
fn check_order(table: &Table, row: &table::Row, [before, frame]: [f64; 2]) -> Result<(), CameraPathError> {
    if frame > before {
        return Ok(());
    }
    let what = if frame == before {
        format!("frame {frame} is given twice; give each frame once")
    } else {
        format!("frame {frame} comes after frame {before}; sort the poses by frame")
    };
    Err(table.error(row, &what))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<CameraPath, String> {
        CameraPath::parse(text.as_bytes(), Path::new("p"), None).map_err(|error| error.to_string())
    }

    fn angles(pose: &PathPose) -> [f64; 3] {
        pose.orientation.yaw_pitch_roll().map(|angle| (angle.degrees() * 1e6).round() / 1e6)
    }

    #[test]
    fn forms_of_one_path_are_equal() {
        let first = parse("frame,yaw,pitch,roll,fov\n1,10,20,-30,60\n3,40,20,-30,50").unwrap();
        let forms = [
            "1,10,20,-30,60\n3,40,20,-30,50",
            "# a shot\nFrame; Fov; Roll; Pitch; Yaw\n1;60;-30;20;10\n\n3;50;-30;20;40\n",
            "\u{feff}frame\tyaw\tpitch\troll\tfov\r\n1\t10\t20\t-30\t60\r\n3\t40\t20\t-30\t50\r\n",
            r#"[{"frame":1,"yaw":10,"pitch":20,"roll":-30,"fov":60},{"fov":50,"frame":3,"yaw":40,"pitch":20,"roll":-30}]"#,
            r#"{"frame":[1,3],"yaw":[10,40],"pitch":[20,20],"roll":[-30,-30],"fov":[60,50]}"#,
        ];
        for form in forms {
            assert_eq!(parse(form).as_ref(), Ok(&first), "{form}");
        }
        assert_eq!(angles(&first.poses[1]), [40.0, 20.0, -30.0]);
    }

    #[test]
    fn quaternions_take_the_cameras_frame_to_the_worlds() {
        // A quarter of 90° about +Y turns −Z to −X: to the left.
        let half = 0.5_f64.sqrt();
        let path = parse(&format!("frame,qw,qx,qy,qz\n1,1,0,0,0\n2,{half},0,{half},0\n")).unwrap();
        assert_eq!(angles(&path.poses[1]), [-90.0, 0.0, 0.0]);
        assert!(
            parse("frame,qw,qx,qy,qz\n1,1,0,0,0.2").unwrap_err().contains("line 2: the quaternion's length is 1.0198")
        );
    }

    #[test]
    fn times_are_frames_by_the_rate() {
        let text = "time,yaw\n0,0\n0.5,20\n1,40";
        let path = CameraPath::parse(text.as_bytes(), Path::new("p"), Some(24.0)).unwrap();
        assert_eq!(path.poses.iter().map(|pose| pose.frame).collect::<Vec<_>>(), [0.0, 12.0, 24.0]);
        assert!(parse(text).unwrap_err().contains("rate"));
    }

    #[test]
    fn mistakes_are_named_with_their_line() {
        let expected = [
            ("", "no pose in it"),
            ("frame,yaw,pitch,roll\n", "no pose in it"),
            ("frame,yaw,pitch,roll\n1,0,0,nan", "line 2: roll is 'nan'"),
            ("frame,yaw,pitch,roll\n1,0,0", "line 2: 3 values"),
            ("frame,yaw,pitch,roll\n1,0,0,0\n1,1,0,0", "line 3: frame 1 is given twice"),
            ("frame,yaw,pitch,roll\n2,0,0,0\n1,1,0,0", "line 3: frame 1 comes after frame 2"),
            ("frame,yaw,pitch,roll\n1,0,0,0\n2,95,0,0", "line 3: the camera turns by 95° from frame 1 to 2"),
            ("frame,yaw,pitch,roll,fov\n1,0,0,0,0", "line 2: fov is 0"),
            ("frame,pitch,roll\n1,0,0", "line 1: no column yaw"),
            ("yaw,pitch,roll\n1,0,0", "line 1: no column frame"),
            ("frame,yaw,yaw\n1,0,0", "line 1: two columns yaw"),
            ("frame,yaw,qw,qx,qy,qz\n1,0,1,0,0,0", "line 1: both angles and quaternions"),
            ("hello", "line 1: no column frame"),
            ("[{\"frame\":1,\"yaw\":\"x\"}]", "pose 1: yaw is \"x\""),
            ("[{\"frame\":1,\"yaw\":0},{\"frame\":2}]", "pose 2: no yaw"),
            ("[1]", "pose 1: not an object"),
            ("{\"frame\":[1,2],\"yaw\":[0]}", "yaw has 1 numbers, but frame has 2"),
            ("[{", "no valid JSON"),
        ];
        for (text, message) in expected {
            let found = parse(text).unwrap_err();
            assert!(found.contains(message), "{text:?}: {found}");
        }
    }

    #[test]
    fn wraps_and_long_ways() {
        let path = parse("frame,yaw\n1,170\n2,-170\n3,550").unwrap();
        assert!(path.remarks.is_empty(), "{:?}", path.remarks);
        let path = parse("frame,yaw,note\n1,0,0\n240,360,0").unwrap();
        assert!(path.remarks[0].contains("line 3: yaw goes from 0 to 360"), "{:?}", path.remarks);
        assert_eq!(path.ignored, ["note"]);
    }
}
