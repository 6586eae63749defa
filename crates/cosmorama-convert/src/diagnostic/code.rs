/// Kind of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Code {
    /// Settings are wrong, or do not fit together or to the files, in a way without a kind of its own.
    Settings,
    /// A required setting is missing.
    MissingSetting,
    /// The kind of an input cannot be detected; a setting has to name it.
    Ambiguous,
    /// The work cannot be done, for a reason without a kind of its own.
    Failed,
    /// A file, a face or a frame does not exist.
    NotFound,
    /// A file exists but cannot be opened or read.
    Unreadable,
    /// A file is empty, breaks the rules of its format, or ends too early.
    Damaged,
    /// A file is intact but of an unsupported kind.
    Unsupported,
    /// A world file, a Hugin project, a calibration or an st map lacks what it needs or contradicts itself.
    Malformed,
    /// A picture does not have the expected size or shape.
    WrongSize,
    /// A file changed while it was read.
    Changed,
    /// A projection, a layout or a world of views is impossible as described.
    Geometry,
    /// An output cannot be written.
    Unwritable,
    /// The output's format cannot hold what is asked for, or its name has no known extension.
    OutputFormat,
    /// An output would replace an input or another output.
    SameFile,
    /// Files do not cover what the output shows.
    Uncovered,
    /// The disk may not have room for all outputs.
    DiskSpace,
    /// More memory is needed than permitted.
    Memory,
    /// An observer stopped the conversion early.
    Stopped,
    /// Outputs exist already.
    Exists,
    /// The frame rate of a video is assumed, or varies.
    FrameRate,
    /// Frames of a video are damaged, and others are shown in their places, or it has more than it announces.
    DamagedFrames,
    /// A projection was detected, and may be another.
    Detected,
    /// A file's metadata contradicts its declaration.
    Declared,
    /// A setting has no effect.
    NoEffect,
    /// One picture is used for both eyes.
    OneForBothEyes,
    /// Of two pictures, only the left eye's is used.
    LeftEye,
    /// A file asks to be turned, and is.
    Orientation,
    /// A file's metadata is ignored.
    Metadata,
    /// Pixels of the output are not square.
    Aspect,
    /// The output cannot record which part of a panorama it is.
    Panorama,
    /// The output's format has no alpha.
    AlphaLost,
    /// A later frame has alpha although the first has none.
    AlphaFlattened,
    /// Alpha is nowhere full.
    AlphaThin,
    /// Colours exceed alpha, as if they were not premultiplied.
    AlphaStraight,
    /// Alpha is below 0 or above 1.
    AlphaRange,
    /// Labels have alpha; where it is 0, they become one.
    AlphaOfLabels,
    /// A colour profile is not carried over.
    ProfileLost,
    /// Metadata are not carried over.
    MetadataLost,
    /// The output cannot name the input's primaries or transfer function.
    Primaries,
    /// Colours lie outside of the output's primaries, and are clipped.
    OutOfGamut,
    /// Existing outputs are made again.
    Remade,
    /// The filter reads beyond what a file holds.
    Frayed,
    /// A face has another shape than the others.
    FaceShape,
    /// The borders of faces do not match.
    Arrangement,
    /// A picture is a single pixel.
    OnePixel,
    /// A lens's circle is elsewhere than assumed.
    Circle,
    /// Pixels are NaN.
    NotANumber,
    /// Much of the light comes from bright, small sources.
    Suns,
    /// Light is brighter than the output can hold.
    TooBright,
    /// A file cannot say what its samples are.
    Unit,
    /// The total light is not kept, for lack of memory.
    Unbalanced,
    /// Geometry is computed again for each frame, for lack of memory.
    PlanAnew,
    /// Letters of the grid are too small to read.
    Letters,
    /// The values of a map are coarse.
    Coarse,
    /// The picture to which a map relates is taken from the other side of the conversion.
    MapBase,
    /// A statement of a project is ignored.
    Project,
    /// A path may not be what was meant, or has more than is used.
    CameraPath,
    /// A file has several parts, of which one is read.
    Parts,
    /// Channels are not carried over.
    ChannelsLost,
    /// The content of a channel is guessed.
    Guessed,
}
