//! The table of projections and their keys.

use cosmorama::camera::{CameraModel, CylinderKind, WorldMapCamera};

use super::camera::{dome, hugin, lens, pinhole};
use super::fields::Fields;
use super::keys::Keys;
use super::map::world_map;
use super::{Cube, Dual, Shape, StMapSpec};
use crate::SpecError;

/// A projection's name with its keys.
pub(crate) struct Kind {
    /// Name that users type.
    pub(crate) name: &'static str,
    /// Description.
    pub(crate) about: &'static str,
    /// Keys of this projection alone.
    pub(crate) keys: &'static [Key],
    /// Common keys that the projection refuses.
    pub(crate) refused: &'static [Refused],
    /// Builds the shape from the keys.
    pub(crate) build: fn(&Fields) -> Result<Shape, SpecError>,
    /// Returns the keys that describe a shape; `None` if the shape belongs to another projection.
    pub(crate) write: fn(&Shape) -> Option<Keys>,
}

/// A common key that a projection refuses.
pub(crate) struct Refused {
    /// Name that users type.
    pub(crate) key: &'static str,
    /// Reason.
    pub(crate) why: &'static str,
}

const FITS: Refused = Refused {
    key: "aspect",
    why: "what it shows is given both ways, so that its pixels fit the image, whatever its size",
};
const NO_CANVAS: Refused =
    Refused { key: "canvas", why: "both circles are found in a whole image; place them by center" };
const NO_EYES: Refused = Refused { key: "stereo", why: "a map is for one picture; convert that of each eye by itself" };

const SQUARE: Refused = Refused { key: "aspect", why: "Hugin's pixels are square" };

/// A key of a SPEC, for help.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Key {
    /// Name that users type.
    pub name: &'static str,
    /// Form of the key's values.
    pub value: &'static str,
    /// Effect, with the default.
    pub about: &'static str,
}

const fn key(name: &'static str, value: &'static str, about: &'static str) -> Key {
    Key { name, value, about }
}

const CYLINDER_KEYS: [Key; 2] = [
    key("hfov", "DEGREES", "longitudes shown (360)"),
    key("vfov", "DEGREES", "latitudes shown (by the size, square pixels at the equator)"),
];

/// All projections.
pub(crate) static KINDS: &[Kind] = &[
    Kind {
        name: "cube",
        about: "faces of a cube, one file each or in one image, whatever the pixels (1024x960 is as good as 1024x1024)",
        keys: &[
            key(
                "layout",
                "faces|strip-h|strip-v|3x2|2x3|cross-h|cross-v|eac",
                "a file each (faces), or where they lie in one",
            ),
            key("order", "rludfb|PRESET", "faces in reading order: six letters, six words or a preset (below)"),
            key("rotate", "000000", "quarter turns clockwise of each picture, in the same order"),
            key("fov", "DEGREES", "what a face sees both ways (90); of more, neighbours overlap and are blended"),
            key(
                "overlap",
                "COLUMNS",
                "layout=eac: the outer faces lie as halves that share so many columns, as in GoPro MAX's frames (0)",
            ),
            key("feather", "DEGREES", "the band at a face's border over which it fades out (all that overlaps)"),
            key(
                "half",
                "up|down|left|right|front|back",
                "half a cube: the half around a face (top and bottom are up and down)",
            ),
            key(
                "samples",
                "centres|edges",
                "where the outermost samples of a face lie (centres; order=openexr and OpenEXR's envmap: edges)",
            ),
            key("naming", "PRESET", "how files are named: a preset (below)"),
            key("faces", "front,left,right,up", "use (or write) only these (top and bottom are up and down)"),
            key("canvas.FACE", "WxH+X+Y", "as canvas=, for one face; needed where a file is a crop"),
        ],
        refused: &[FITS],
        build: |fields| Cube::build(fields).map(Shape::Cube),
        write: Cube::write,
    },
    Kind {
        name: "perspective",
        about: "a pinhole camera",
        keys: &[
            key("fov", "DEGREES", "horizontal field of view (90)"),
            key("vfov", "DEGREES", "vertical field of view; with fov=, the pixels fit"),
            key("dfov", "DEGREES", "diagonal field of view"),
            key(
                "calibration",
                "FILE",
                "a camera measured by OpenCV (YAML, JSON, XML: k1 k2 p1 p2 k3 …); with fov=, only so wide a cone counts",
            ),
        ],
        refused: &[],
        build: pinhole::perspective,
        write: pinhole::write_perspective,
    },
    Kind {
        name: "equirect",
        about: "a panorama of longitude by latitude",
        keys: &[
            key("hfov", "DEGREES", "longitudes shown (360)"),
            key("vfov", "DEGREES", "latitudes shown (180)"),
            key(
                "samples",
                "centres|edges",
                "where the outermost samples lie (centres; files with OpenEXR's envmap attribute: edges, which writes it)",
            ),
            key(
                "pose",
                "yes|no",
                "inputs: turn it by the camera's pose in its GPano metadata, level and north ahead (no)",
            ),
        ],
        refused: &[FITS],
        build: world_map::equirect,
        write: world_map::write_equirect,
    },
    Kind {
        name: "fisheye",
        about: "a fisheye lens that looks ahead",
        keys: &[
            key("fov", "DEGREES", "across the circle (180)"),
            key(
                "lens",
                "NAME",
                "how the angle goes with the radius (equidistant): equisolid, stereographic, orthographic, polynomial \
                 (Blender), kannala-brandt (OpenCV), ocam (OCamCalib), ucm, eucm, double-sphere, fov",
            ),
            key("k", "A:B:C…", "coefficients of a measured lens, in its program's own order"),
            key("fit", "short|long|width|height|diagonal", "which length of the image the circle spans (short)"),
            key("focal", "PIXELS", "instead of fit=: the focal length (for ocam: 1)"),
            key("sensor", "MM", "instead of fit=: the image's width in millimetres (polynomial)"),
            key("center", "X:Y", "the circle's centre in pixels"),
            key("radius", "PIXELS", "the circle's radius in pixels"),
            key(
                "calibration",
                "FILE",
                "a lens measured by OpenCV's fisheye model (YAML, JSON, XML) or OCamCalib; with fov=, only so much counts",
            ),
        ],
        refused: &[],
        build: lens::fisheye,
        write: lens::write_fisheye,
    },
    Kind {
        name: "stereographic",
        about: "stereographic, without a circle; with pitch=-90 a little planet",
        keys: &[key("fov", "DEGREES", "horizontal field of view (270)")],
        refused: &[],
        build: pinhole::stereographic,
        write: pinhole::write_stereographic,
    },
    Kind {
        name: "hugin",
        about: "a picture by a lens that Hugin measured: an image (i) of a .pto",
        keys: &[
            key(
                "lens",
                "NAME",
                "its f: rectilinear (0; the default), fisheye (2, 3), orthographic (8), stereographic (10), equisolid (21)",
            ),
            key("fov", "DEGREES", "its v: across the image's width, by the lens before correction (90; fisheyes 180)"),
            key(
                "a",
                "A",
                "with b and c: r becomes r (a r^3 + b r^2 + c r + 1 - a - b - c), 1 at half the shorter side (0)",
            ),
            key("b", "B", "(0)"),
            key("c", "C", "(0)"),
            key("d", "PIXELS", "the axis is so far to the right of the image's middle (0)"),
            key("e", "PIXELS", "and so far below it (0)"),
        ],
        refused: &[SQUARE],
        build: hugin::hugin,
        write: hugin::write,
    },
    Kind {
        name: "fulldome",
        about: "a domemaster: equidistant fisheye that looks up, the front at the bottom",
        keys: &[
            key("fov", "DEGREES", "across the circle (180)"),
            key("tilt", "DEGREES", "how far the dome leans to the front (0)"),
        ],
        refused: &[],
        build: dome::fulldome,
        write: dome::write_fulldome,
    },
    Kind {
        name: "dual-fisheye",
        about: "two fisheyes in one image, one ahead and one back, blended where both see; LENS is front or back",
        keys: &[
            key("fov", "DEGREES", "across each circle (195)"),
            key("layout", "side-by-side|top-bottom", "how they share the image (side-by-side)"),
            key("order", "fb|bf", "which comes first, the front or the back (fb; ffmpeg's dfisheye: bf)"),
            key("feather", "DEGREES", "the band at a circle over which it fades out (all that both see)"),
            key("lens", "NAME", "as for fisheye, with k="),
            key("k", "A:B:C…", "as for fisheye"),
            key("fit", "short|long|width|height|diagonal", "which length of its half a circle spans (short)"),
            key("LENS.fov", "DEGREES", "across one circle, as in back.fov=192"),
            key("LENS.yaw", "DEGREES", "one camera turned to its own right"),
            key("LENS.pitch", "DEGREES", "turned up"),
            key("LENS.roll", "DEGREES", "turned clockwise, as that camera sees it"),
            key("LENS.center", "X:Y", "one circle's centre in pixels of the whole image"),
            key("LENS.radius", "PIXELS", "one circle's radius in pixels"),
        ],
        refused: &[NO_CANVAS],
        build: |fields| Dual::build(fields).map(Box::new).map(Shape::Dual),
        write: Dual::write,
    },
    Kind {
        name: "omnimax",
        about: "an Omnimax film frame",
        keys: &[
            key("framing", "fit|circle", "the circle cut off below to fill the frame, or whole (fit)"),
            key("lower", "DEGREES|none", "the bottom is cut off so far below the axis (45)"),
            key("center", "X:Y", "the circle's centre in pixels"),
            key("radius", "PIXELS", "the circle's radius in pixels"),
            key("axis", "DEGREES", "elevation of the axis of projection (0; theatre: 11)"),
        ],
        refused: &[],
        build: dome::omnimax,
        write: dome::write_omnimax,
    },
    Kind {
        name: "mercator",
        about: "Mercator's map",
        keys: &[
            key("hfov", "DEGREES", "longitudes shown (360)"),
            key("lat", "DEGREES", "latitude of the upper edge (by the size, square pixels; else 85.051129)"),
        ],
        refused: &[],
        build: |fields| world_map::cylinder(fields, CylinderKind::Mercator),
        write: |shape| world_map::write_cylinder(shape, CylinderKind::Mercator),
    },
    Kind {
        name: "cylinder",
        about: "a central cylinder: upright lines stay straight",
        keys: &CYLINDER_KEYS,
        refused: &[],
        build: |fields| world_map::cylinder(fields, CylinderKind::Central),
        write: |shape| world_map::write_cylinder(shape, CylinderKind::Central),
    },
    Kind {
        name: "equal-area",
        about: "Lambert's equal-area cylinder",
        keys: &CYLINDER_KEYS,
        refused: &[],
        build: |fields| world_map::cylinder(fields, CylinderKind::EqualArea),
        write: |shape| world_map::write_cylinder(shape, CylinderKind::EqualArea),
    },
    Kind {
        name: "mirror-ball",
        about: "a mirror ball as photographed, the camera looking ahead at it",
        keys: &[
            key("distance", "RADII|inf", "from the camera to the ball's centre, in ball radii (inf)"),
            key("center", "X:Y", "the centre of its outline in pixels"),
            key("radius", "PIXELS", "the radius of its outline in pixels"),
        ],
        refused: &[],
        build: world_map::mirror_ball,
        write: world_map::write_mirror_ball,
    },
    Kind {
        name: "angular-map",
        about: "a light probe: equidistant, 360 degrees, the front in its middle",
        keys: &[
            key("center", "X:Y", "the circle's centre in pixels"),
            key("radius", "PIXELS", "the circle's radius in pixels"),
        ],
        refused: &[],
        build: lens::angular_map,
        write: lens::write_angular_map,
    },
    Kind {
        name: "hammer",
        about: "Hammer's equal-area map of the world",
        keys: &[],
        refused: &[FITS],
        build: |fields| Shape::single(fields, CameraModel::WorldMap(WorldMapCamera::Hammer)),
        write: |shape| world_map::write_whole(shape, WorldMapCamera::Hammer),
    },
    Kind {
        name: "mollweide",
        about: "Mollweide's equal-area map of the world",
        keys: &[],
        refused: &[FITS],
        build: |fields| Shape::single(fields, CameraModel::WorldMap(WorldMapCamera::Mollweide)),
        write: |shape| world_map::write_whole(shape, WorldMapCamera::Mollweide),
    },
    Kind {
        name: "sinusoidal",
        about: "the sinusoidal equal-area map of the world",
        keys: &[],
        refused: &[FITS],
        build: |fields| Shape::single(fields, CameraModel::WorldMap(WorldMapCamera::Sinusoidal)),
        write: |shape| world_map::write_whole(shape, WorldMapCamera::Sinusoidal),
    },
    Kind {
        name: "pannini",
        about: "a wide view in which upright lines stay straight",
        keys: &[
            key("fov", "DEGREES", "horizontal field of view (180)"),
            key("d", "D", "0 is a pinhole camera, 1 Pannini's own, more squeezes the sides further (1)"),
        ],
        refused: &[],
        build: world_map::pannini,
        write: world_map::write_pannini,
    },
    Kind {
        name: "octahedral",
        about: "the sphere on an octahedron, unfolded; with pitch=90 the zenith is in the middle, as in pbrt",
        keys: &[key("kind", "equal-area|plain", "Clarberg's, as pbrt stores environments, or along rays (equal-area)")],
        refused: &[FITS],
        build: world_map::octahedral,
        write: world_map::write_octahedral,
    },
    Kind {
        name: "st-map",
        about: "a warp of other programs: pixels of MAP are pixels of the output and hold where in the input each looks, red to \
                the right, green up, 0 to 1",
        keys: &[
            key("file", "MAP", "the map: OpenEXR, or another format of 16 bits or more"),
            key("invert", "yes|no", "the other way: pixels of MAP are the input's, and lie there in the output (no)"),
            key(
                "base",
                "SPEC",
                "what the picture at the map's other end is, colons for commas: perspective:fov=60:yaw=9 (that of the \
                 other side of the conversion)",
            ),
        ],
        refused: &[FITS, NO_EYES],
        build: |fields| StMapSpec::build(fields).map(Shape::StMap),
        write: StMapSpec::write,
    },
];

/// Keys of every SPEC, except those of projections that refuse them.
pub(crate) const COMMON: [Key; 9] = [
    key("yaw", "DEGREES", "turns the view to the right"),
    key("pitch", "DEGREES", "turns it up"),
    key("roll", "DEGREES", "turns the camera clockwise"),
    key("flip", "x|y|xy", "the picture is mirrored left to right, top to bottom, both"),
    key("canvas", "WxH+X+Y", "the image is a window of a canvas, its corner at X, Y"),
    key("aspect", "A", "a pixel's width over its height (1)"),
    key(
        "stereo",
        "sbs|tb|sbs-half|tb-half",
        "two of them, for the left and the right eye; half: squeezed to the size of one",
    ),
    key("swap", "yes|no", "the right eye's comes first (no)"),
    key("eye", "left|right", "of a stereo input only this eye's is used"),
];

impl Kind {
    /// Returns the projection of this name.
    pub(crate) fn named(name: &str) -> Option<&'static Self> {
        KINDS.iter().find(|kind| kind.name == name)
    }

    /// Returns every key that the projection takes.
    pub(crate) fn all_keys(&'static self) -> impl Iterator<Item = &'static Key> {
        self.keys.iter().chain(COMMON.iter().filter(|key| self.refusal(key.name).is_none()))
    }

    /// Returns the reason why the projection refuses a common key; `None` if it does not.
    pub(crate) fn refusal(&self, key: &str) -> Option<&'static str> {
        self.refused.iter().find(|refused| refused.key == key).map(|refused| refused.why)
    }
}
