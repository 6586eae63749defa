use std::sync::Arc;

use cosmorama::filter::FilterKind;
use cosmorama::raster::{Depth, Rgba};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_io::pending::Unfinished;
use cosmorama_io::{Compression, FrameList};
use cosmorama_spec::{FilterName, KernelName, MemorySize, Missing, Size, Spec, TransferName};

use crate::input::{Disk, Files};

/// Settings of a conversion: from an input, in whatever form, to pictures of another projection.
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
    /// An image, a pattern of faces and frames, a world file, a Hugin project, or `builtin:NAME`.
    pub input: String,
    /// An image or a pattern; the extension chooses the format.
    pub output: String,
    /// What light comes from where and goes where.
    pub geometry: GeometrySettings,
    /// Whether places in the input are written instead of light.
    pub st_map: bool,
    /// How integer code values relate to light.
    pub transfer: TransferName,
    /// How the input's code values relate to light, those of floats too.
    pub in_transfer: Option<TransferName>,
    /// How the output's code values relate to light, those of floats too.
    pub out_transfer: Option<TransferName>,
    /// Sample type of the output; as the input's, where the format can, unless given.
    pub depth: Option<Depth>,
    /// Light of pixels outside the lens; black, or transparent where the output has alpha, unless given.
    pub background: Option<Rgba>,
    /// What becomes of directions that no view covers.
    pub missing: Missing,
    /// Frames of a sequence; all that exist, unless given.
    pub frames: Option<FrameList>,
    /// What becomes of outputs that exist already.
    pub existing: Existing,
    /// Whether the output stands for a stream, which takes one picture.
    pub to_stream: bool,
    /// Whether smaller copies are added, in formats that hold them.
    pub mips: bool,
    /// JPEG quality from 1 to 100; that of [`cosmorama_io::WriteOptions`], unless given.
    pub quality: Option<u8>,
    /// How hard files are pressed, without loss; sequences of PNG files for speed, unless given.
    pub compression: Option<Compression>,
    /// What the run may take.
    pub limits: LimitSettings,
    /// Where the bytes of pictures come from: disk, unless given.
    pub files: Arc<dyn Files>,
    /// List of the files that are being written, for whoever has to remove them.
    pub unfinished: Unfinished,
}

/// What light comes from where and goes where.
#[derive(Clone, Debug)]
pub struct GeometrySettings {
    /// The input's projection; found from metadata, names or shape, unless given.
    pub from: Option<Spec>,
    /// The output's projection; a cube, unless given, where the output has a name for each face.
    pub to: Option<Spec>,
    /// Pixels of the output; parity with the input at the centre, unless given.
    pub size: Option<Size>,
    /// Where the output looks.
    pub orientation: Orientation,
    /// What pixels average.
    pub filter: FilterName,
    /// The weights of that average.
    pub kernel: KernelName,
    /// Whether pixels are clamped to their texels; as the kernel has it, unless given.
    pub anti_ringing: Option<bool>,
}

/// What becomes of outputs that exist already.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Existing {
    /// They are an error, before any work.
    #[default]
    Refuse,
    /// They are replaced.
    Replace,
    /// Complete ones are kept, others replaced.
    Resume,
}

/// What a run may take.
#[derive(Clone, Copy, Debug, Default)]
pub struct LimitSettings {
    /// Threads to work with; one for each core, unless given.
    pub threads: Option<usize>,
    /// Memory to use at most; three quarters of what is free, unless given.
    pub memory: Option<MemorySize>,
}

impl Default for GeometrySettings {
    fn default() -> Self {
        Self {
            from: None,
            to: None,
            size: None,
            orientation: Orientation::IDENTITY,
            filter: FilterName(FilterKind::Ewa),
            kernel: KernelName::default(),
            anti_ringing: None,
        }
    }
}

/// The settings that hold unless others are given; input and output have no names yet.
impl Default for Conversion {
    fn default() -> Self {
        Self {
            input: String::new(),
            output: String::new(),
            geometry: GeometrySettings::default(),
            st_map: false,
            transfer: TransferName::Auto,
            in_transfer: None,
            out_transfer: None,
            depth: None,
            background: None,
            missing: Missing::Error,
            frames: None,
            existing: Existing::default(),
            to_stream: false,
            mips: false,
            quality: None,
            compression: None,
            limits: LimitSettings::default(),
            files: Arc::new(Disk),
            unfinished: Unfinished::default(),
        }
    }
}

impl Conversion {
    /// Creates the settings of a conversion between these, all others as they are by default.
    pub fn new(input: impl Into<String>, output: impl Into<String>) -> Self {
        Self { input: input.into(), output: output.into(), ..Self::default() }
    }

    /// Gives the input's projection.
    #[must_use]
    pub fn from(mut self, spec: Spec) -> Self {
        self.geometry.from = Some(spec);
        self
    }

    /// Gives the output's projection.
    #[must_use]
    pub fn to(mut self, spec: Spec) -> Self {
        self.geometry.to = Some(spec);
        self
    }

    /// Gives the output's size.
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

    /// Gives the filter.
    #[must_use]
    pub fn filter(mut self, filter: FilterName) -> Self {
        self.geometry.filter = filter;
        self
    }

    /// Says what becomes of directions that no view covers.
    #[must_use]
    pub fn missing(mut self, missing: Missing) -> Self {
        self.missing = missing;
        self
    }

    /// Chooses frames of a sequence.
    #[must_use]
    pub fn frames(mut self, frames: FrameList) -> Self {
        self.frames = Some(frames);
        self
    }

    /// Says what becomes of outputs that exist already.
    #[must_use]
    pub fn existing(mut self, existing: Existing) -> Self {
        self.existing = existing;
        self
    }

    /// Says where the bytes of pictures come from.
    #[must_use]
    pub fn files(mut self, files: Arc<dyn Files>) -> Self {
        self.files = files;
        self
    }

    /// Limits the threads to work with.
    #[must_use]
    pub fn threads(mut self, threads: usize) -> Self {
        self.limits.threads = Some(threads);
        self
    }

    /// Limits the memory to use.
    #[must_use]
    pub fn memory(mut self, memory: MemorySize) -> Self {
        self.limits.memory = Some(memory);
        self
    }
}
