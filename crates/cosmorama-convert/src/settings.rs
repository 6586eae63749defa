use std::path::{Path, PathBuf};
use std::sync::Arc;

use cosmorama::filter::FilterKind;
use cosmorama::lighting::Lobe;
use cosmorama::motion::{Easing, Ramp, Shutter, Smoothness};
use cosmorama::raster::{Depth, Primaries, Rgba};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_io::pending::Unfinished;
use cosmorama_io::{CameraPath, Compression, FrameList, Remark};
use cosmorama_spec::{FilterName, FrameMap, KernelName, MemorySize, Missing, Size, Spec, TimeRanges, TransferName};

use crate::source::video::{PictureSink, VideoSettings};
use crate::source::{Disk, Files, Name, ViewFiles};

/// Settings of a conversion from an input, in any form, to pictures of another projection.
///
/// ```
/// use cosmorama_convert::{Conversion, Quiet};
///
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// let folder = tempfile::tempdir()?;
/// let dome = folder.path().join("dome.png").display().to_string();
/// let conversion = Conversion::new("builtin:grid", &dome).to("fulldome:tilt=20".parse()?).size("64".parse()?);
/// let report = conversion.check().result?.run(&mut Quiet)?;
/// assert_eq!(report.frames, 1);
/// assert_eq!(cosmorama_io::probe(std::path::Path::new(&dome))?.width, 64);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Debug)]
pub struct Conversion {
    /// Input: an image, a pattern of faces and frames, a world file, a Hugin project, or `builtin:NAME`.
    pub input: Name,
    /// Output: an image or a pattern; the extension chooses the format.
    pub output: Name,
    /// Projections, size, orientation and filter.
    pub geometry: GeometrySettings,
    /// Whether an st map is written instead of a picture.
    pub st_map: bool,
    /// Map of the world's light to make; a picture of the world, unless given.
    pub light: Option<LightSettings>,
    /// Transfer function of integer files.
    pub transfer: TransferName,
    /// Transfer function of the input, including floats; overrides `transfer`.
    pub in_transfer: Option<TransferName>,
    /// Transfer function of the output, including floats; overrides `transfer`.
    pub out_transfer: Option<TransferName>,
    /// Primaries of the output; those of the first input, unless given.
    pub primaries: Option<Primaries>,
    /// Primaries of inputs that name none; Rec. 709, unless given.
    pub in_primaries: Option<Primaries>,
    /// Whether ICC profiles of inputs are ignored.
    pub ignore_profile: bool,
    /// Colour spaces of an OpenColorIO config; files' own tags, unless given.
    pub ocio: OcioSettings,
    /// Part of the input's OpenEXR files, by name or by number from 0; the first with a picture, unless given.
    pub part: Option<String>,
    /// Channels of the input's OpenEXR files, in which `*` stands for any letters; all, unless given.
    pub channels: Vec<String>,
    /// Treatment of channels that hold no light.
    pub layers: LayerSettings,
    /// Sample type of the output; the input's, where the format can hold it, unless given.
    pub depth: Option<Depth>,
    /// Light of pixels outside the lens; black, or transparent if the output has alpha, unless given.
    pub background: Option<Rgba>,
    /// Treatment of directions that no view covers; of those that a backdrop does not cover, if there is one.
    pub missing: Missing,
    /// World behind the input's alpha, and behind what the input does not cover.
    pub backdrop: Option<Backdrop>,
    /// Factor of the input's light and its alpha, from 0 to 1.
    pub opacity: f32,
    /// Frames of a sequence; all that exist, unless given.
    pub frames: Option<FrameList>,
    /// Times of an input that is a video, in place of the numbers of its frames.
    pub times: Option<TimeRanges>,
    /// Settings of videos, read and made.
    pub video: VideoSettings,
    /// Treatment of outputs that exist already.
    pub existing: Existing,
    /// Whether folders of outputs that do not exist are made; else they are an error.
    pub make_folders: bool,
    /// Whether the output goes to a stream, which holds one picture, or the frames of a stream of raw pictures.
    pub to_stream: bool,
    /// Goal of an output that is a stream of raw pictures, to which they are passed on as they are made. Without it they become a file.
    pub sink: Option<PictureSink>,
    /// Whether mip levels are written, in formats that hold them.
    pub mips: bool,
    /// JPEG quality from 1 to 100; that of [`cosmorama_io::WriteOptions`], unless given.
    pub quality: Option<u8>,
    /// Lossless compression; sequences of PNG files are compressed for speed, unless given.
    pub compression: Option<Compression>,
    /// Whether outputs get no metadata of inputs; tags of colours stay.
    pub strip: bool,
    /// Further statements about the outputs, each under a name, where their format has a place for them.
    pub remarks: Vec<Remark>,
    /// Limits of threads and memory.
    pub limits: LimitSettings,
    /// Source of the bytes of inputs; disk by default.
    pub files: Arc<dyn Files>,
    /// Registry of files in progress, which a signal handler removes.
    pub unfinished: Unfinished,
}

/// Projections, size, orientation and filter of a conversion.
#[derive(Clone, Debug)]
pub struct GeometrySettings {
    /// Projection of the input; detected from metadata, names or shape, unless given.
    pub from: Option<Spec>,
    /// Projection of the output; a cube if the output has a name for each face, unless given.
    pub to: Option<Spec>,
    /// Size of the output; as fine as the input at the centre, unless given.
    pub size: Option<Size>,
    /// Orientation of the output.
    pub orientation: Orientation,
    /// Movement of the output's camera, which turns that orientation frame by frame.
    pub camera: Option<CameraMovement>,
    /// Poses of the input, which turn all of it frame by frame.
    pub in_path: Option<PoseFile>,
    /// Blur of what the camera's movement moves; none, unless given.
    pub blur: Option<MotionBlur>,
    /// Filter.
    pub filter: FilterName,
    /// Kernel of the filter.
    pub kernel: KernelName,
    /// Whether pixels are clamped to their texels; the kernel's own default, unless given.
    pub anti_ringing: Option<bool>,
}

impl GeometrySettings {
    /// Visits the files of poses, of the camera and of the input.
    pub(crate) fn pose_files(&self) -> impl Iterator<Item = PathBuf> {
        let path = match &self.camera {
            Some(CameraMovement::Path(path)) => Some(path),
            Some(CameraMovement::Turn { .. }) | None => None,
        };
        path.into_iter().chain(&self.in_path).map(|path| CameraPath::split_node(&path.file).0.into())
    }
}

/// Movement of a camera.
#[derive(Clone, Debug, PartialEq)]
pub enum CameraMovement {
    /// Through the poses in a file. A still input is converted to all frames of the path.
    Path(PoseFile),
    /// From one orientation to another, over all frames.
    Turn {
        /// Yaw, pitch and roll in degrees.
        angles: [Ramp; 3],
        /// Field of view in degrees; the output's own, unless given.
        fov: Option<Ramp>,
        /// Rate of the turn.
        easing: Easing,
    },
}

/// Poses by frame or by time, in a file that [`cosmorama_io::CameraPath`] reads.
#[derive(Clone, Debug, PartialEq)]
pub struct PoseFile {
    /// Name of the file; of glTF perhaps with that of a node in it, as in `shot.glb#Camera`.
    pub file: String,
    /// Frames in a second, for time stamps.
    pub fps: Option<f64>,
    /// Movement from pose to pose.
    pub smoothness: Smoothness,
}

/// A world behind the input's alpha.
#[derive(Clone, Debug)]
pub struct Backdrop {
    /// Files in any form of an input, or `builtin:NAME`.
    pub input: Name,
    /// Its projection; detected from metadata, names or shape, unless given.
    pub from: Option<Spec>,
    /// Its frame for each frame of the output.
    pub frames: FrameMap,
    /// Poses that turn all of it frame by frame.
    pub in_path: Option<PoseFile>,
    /// Factor of its light and its alpha, from 0 to 1.
    pub opacity: f32,
    /// World behind it.
    pub behind: Option<Box<Backdrop>>,
}

impl Backdrop {
    /// Returns a backdrop that stands still, in frames of its own numbers, with nothing behind it.
    pub fn new(input: impl Into<Name>) -> Self {
        Self { input: input.into(), from: None, frames: FrameMap::default(), in_path: None, opacity: 1.0, behind: None }
    }
}

/// Blur of what moves while a shutter is open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionBlur {
    /// Time of each frame's exposure.
    pub shutter: Shutter,
    /// Method by which it is found.
    pub method: BlurMethod,
}

/// Method of motion blur.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum BlurMethod {
    /// The footprint of each pixel is carried along the pixel's own path.
    #[default]
    Swept,
    /// One ellipse for each pixel, as wide as the pixel and its path together (Greene 1986, section 9): an approximation.
    Ellipse,
}

/// A map of a world's light, or a chain of them, one for each roughness.
#[derive(Clone, Debug, PartialEq)]
pub struct LightSettings {
    /// Levels of the chain, the largest first. A single one is an ordinary map.
    pub levels: Vec<LightLevel>,
    /// Unit of the map.
    pub normalisation: LightNormalisation,
    /// Whether every texel is summed for every pixel.
    pub exact: bool,
    /// Frames of a sequence that are computed; all, unless given.
    pub every: Option<Every>,
    /// Scale of the light in the file.
    pub scale: LightScale,
}

/// Scale of the light in a file.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightScale {
    /// Light is written times a factor.
    Factor(f64),
    /// Light is written times the largest power of two, at most 1, with which all of it fits the file's sample type.
    Fitting,
}

impl LightScale {
    /// Light as it is.
    pub const NONE: Self = Self::Factor(1.0);

    /// Returns the statement of a factor for a file; `None` if light is as it is.
    pub(crate) fn remark(factor: f64) -> Option<Remark> {
        (factor != 1.0).then(|| Remark { name: "lightScale", text: factor.to_string().into() })
    }
}

/// Rule by which some frames of a sequence are computed, and the others interpolated between them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Every {
    /// Distance of computed frames. The last is computed, too.
    pub frames: usize,
    /// Whether a frame in the middle of each gap is computed, to tell how far the interpolated one is from it.
    pub measured: bool,
}

/// Level of a chain of maps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightLevel {
    /// The world as a mirror shows it: a picture by the filter.
    Mirror,
    /// Averages under a lobe about each pixel's direction.
    Lobe(Lobe),
    /// Means of two by two pixels of the level before, face by face: a plain mip map.
    Halved,
}

/// Unit of a map of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LightNormalisation {
    /// Irradiance E: a constant world of 1 gives π.
    Irradiance,
    /// Radiance, the lobe's average, which for Lambert's is E/π: a constant world of 1 gives 1.
    Radiance,
}

impl LightSettings {
    /// Returns whether the light is scaled to fit the output's sample type.
    pub(crate) fn fits(&self) -> bool {
        self.scale == LightScale::Fitting
    }

    /// Returns the settings of a single map under a lobe.
    pub fn map(lobe: Lobe, normalisation: LightNormalisation) -> Self {
        let levels = vec![LightLevel::Lobe(lobe)];
        Self { levels, normalisation, exact: false, every: None, scale: LightScale::NONE }
    }

    /// Returns the lobes of its levels.
    pub fn lobes(&self) -> Vec<Lobe> {
        let lobe = |level: &LightLevel| if let LightLevel::Lobe(lobe) = level { Some(*lobe) } else { None };
        self.levels.iter().filter_map(lobe).collect()
    }

    /// Returns the statements of the map's unit and scale for its file, as far as they are known before it is made.
    pub(crate) fn remarks(&self) -> Vec<Remark> {
        let text = match self.normalisation {
            LightNormalisation::Irradiance => "irradiance",
            LightNormalisation::Radiance => "radiance",
        };
        let unit = Remark { name: "lightUnit", text: text.into() };
        let scale = if let LightScale::Factor(factor) = self.scale { LightScale::remark(factor) } else { None };
        std::iter::once(unit).chain(scale).collect()
    }

    /// Returns the factor of an average in the map.
    pub fn factor(&self) -> f64 {
        match self.normalisation {
            LightNormalisation::Irradiance => Lobe::LAMBERT.integral(),
            LightNormalisation::Radiance => 1.0,
        }
    }
}

/// Colour spaces of an OpenColorIO config. They need the feature `ocio`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OcioSettings {
    /// Config: a file (`.ocio`, `.ocioz`), always read from disk, or a built-in one (`ocio://NAME`).
    pub config: Option<String>,
    /// Colour space of the inputs.
    pub in_space: Option<String>,
    /// Colour space of the outputs; the inputs', unless this or `view` is given.
    pub out_space: Option<String>,
    /// Display and view that the outputs are made for, as `DISPLAY/VIEW`.
    pub view: Option<String>,
}

impl OcioSettings {
    /// Returns whether any of them is given.
    pub fn is_asked(&self) -> bool {
        *self != Self::default()
    }
}

/// Treatment of channels that hold no light. The rule for labels is set by the filter.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LayerSettings {
    /// Kind of the input's depth; by its projection, unless given.
    pub depth: Option<DepthKind>,
    /// Frame of normals; the world's, unless given.
    pub normals: Option<NormalSpace>,
}

/// Kind of a depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthKind {
    /// Distance from the plane through the camera, across its axis.
    Planar,
    /// Distance from the camera.
    Radial,
}

/// Coordinate frame of normals, in the input and in the output.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum NormalSpace {
    /// The world's: no view turns them.
    #[default]
    World,
    /// Each view's own: x to the right, y up, z to the viewer.
    Camera,
}

/// Treatment of outputs that exist already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// An error, before any work.
    #[default]
    Refuse,
    /// Replacement.
    Replace,
    /// Complete outputs are kept, others are replaced.
    Resume,
}

/// Limits of a run.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimitSettings {
    /// Number of threads; one for each core, unless given.
    pub threads: Option<usize>,
    /// Memory limit; three quarters of free memory, unless given.
    pub memory: Option<MemorySize>,
}

impl Default for GeometrySettings {
    fn default() -> Self {
        Self {
            from: None,
            to: None,
            size: None,
            orientation: Orientation::IDENTITY,
            camera: None,
            in_path: None,
            blur: None,
            filter: FilterName(FilterKind::Ewa),
            kernel: KernelName::default(),
            anti_ringing: None,
        }
    }
}

/// Returns the default settings, without names of input and output.
impl Default for Conversion {
    fn default() -> Self {
        Self {
            input: Name::default(),
            output: Name::default(),
            geometry: GeometrySettings::default(),
            st_map: false,
            light: None,
            transfer: TransferName::Auto,
            in_transfer: None,
            out_transfer: None,
            primaries: None,
            in_primaries: None,
            ignore_profile: false,
            ocio: OcioSettings::default(),
            part: None,
            channels: Vec::new(),
            layers: LayerSettings::default(),
            depth: None,
            background: None,
            missing: Missing::Error,
            backdrop: None,
            opacity: 1.0,
            frames: None,
            times: None,
            video: VideoSettings::default(),
            existing: Existing::default(),
            make_folders: true,
            to_stream: false,
            sink: None,
            mips: false,
            quality: None,
            compression: None,
            strip: false,
            remarks: Vec::new(),
            limits: LimitSettings::default(),
            files: Arc::new(Disk),
            unfinished: Unfinished::default(),
        }
    }
}

impl Conversion {
    /// Creates default settings for a conversion from an input to an output.
    pub fn new(input: impl Into<Name>, output: impl Into<Name>) -> Self {
        Self { input: input.into(), output: output.into(), ..Self::default() }
    }

    /// Returns whether frames of the input are asked for in order, each once, so that a stream can be read as it comes. Where its end must
    /// be known before, as for a camera that turns over all frames, or a frame be found again, it must be kept.
    pub fn reads_in_order(&self) -> bool {
        let takes_frames = || match ViewFiles::new(Path::new(&self.output)) {
            // Folders are made before the work, for frames that are known.
            ViewFiles::Sequence(pattern) => pattern.path(0).parent() == pattern.path(1).parent(),
            other => other.has_frames(),
        };
        let is_forward = |list: &FrameList| list.frames().windows(2).all(|pair| pair[0] < pair[1]);
        self.light.is_none()
            && !self.st_map
            && self.geometry.camera.is_none()
            && self.geometry.in_path.is_none()
            && self.backdrop.is_none()
            && self.times.is_none()
            && self.existing != Existing::Resume
            && self.frames.as_ref().map_or_else(takes_frames, is_forward)
    }

    /// Returns whether a camera moves, or what is behind its pictures.
    pub(crate) fn moves(&self) -> bool {
        let behind = std::iter::successors(self.backdrop.as_ref(), |backdrop| backdrop.behind.as_deref());
        let Self { geometry: GeometrySettings { camera, in_path, .. }, .. } = self;
        camera.is_some() || in_path.is_some() || behind.into_iter().any(|backdrop| backdrop.in_path.is_some())
    }

    /// Sets the input's projection.
    #[must_use]
    pub fn from(mut self, spec: Spec) -> Self {
        self.geometry.from = Some(spec);
        self
    }

    /// Sets the output's projection.
    #[must_use]
    pub fn to(mut self, spec: Spec) -> Self {
        self.geometry.to = Some(spec);
        self
    }

    /// Sets the output's size.
    #[must_use]
    pub fn size(mut self, size: Size) -> Self {
        self.geometry.size = Some(size);
        self
    }

    /// Turns the output: to the right, up, and clockwise.
    #[must_use]
    pub fn turned(mut self, yaw: Angle, pitch: Angle, roll: Angle) -> Self {
        self.geometry.orientation = Orientation::from_yaw_pitch_roll(yaw, pitch, roll);
        self
    }

    /// Moves the output's camera.
    #[must_use]
    pub fn moved(mut self, camera: CameraMovement) -> Self {
        self.geometry.camera = Some(camera);
        self
    }

    /// Sets the filter.
    #[must_use]
    pub fn filter(mut self, filter: FilterName) -> Self {
        self.geometry.filter = filter;
        self
    }

    /// Makes a map of the world's light instead of a picture.
    #[must_use]
    pub fn light(mut self, light: LightSettings) -> Self {
        self.light = Some(light);
        self
    }

    /// Sets the treatment of directions that no view covers.
    #[must_use]
    pub fn missing(mut self, missing: Missing) -> Self {
        self.missing = missing;
        self
    }

    /// Lays a world behind the input.
    #[must_use]
    pub fn over(mut self, backdrop: Backdrop) -> Self {
        self.backdrop = Some(backdrop);
        self
    }

    /// Selects frames of a sequence.
    #[must_use]
    pub fn frames(mut self, frames: FrameList) -> Self {
        self.frames = Some(frames);
        self
    }

    /// Sets the treatment of outputs that exist already.
    #[must_use]
    pub fn existing(mut self, existing: Existing) -> Self {
        self.existing = existing;
        self
    }

    /// Sets the source of the bytes of inputs.
    #[must_use]
    pub fn files(mut self, files: Arc<dyn Files>) -> Self {
        self.files = files;
        self
    }

    /// Limits the number of threads.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.limits.threads = Some(threads);
        self
    }

    /// Limits the memory.
    #[must_use]
    pub fn memory(mut self, memory: MemorySize) -> Self {
        self.limits.memory = Some(memory);
        self
    }
}
