/// Kinds of diagnostics.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Code {
    /// Settings are wrong, or go neither together nor with the files.
    Settings,
    /// The work cannot be done, for another reason than those below.
    Failed,
    /// Files do not hold what the output shows.
    Uncovered,
    /// More memory is needed than may be used.
    Memory,
    /// Outputs exist already.
    Exists,
    /// A projection was found without being given, and may be another.
    Detected,
    /// A file says that it is something else than it is declared to be.
    Declared,
    /// A setting has no effect.
    NoEffect,
    /// There is one picture for two eyes.
    OneForBothEyes,
    /// There are two pictures for one eye.
    LeftEye,
    /// A file asks for being turned.
    Orientation,
    /// A file's metadata are left out.
    Metadata,
    /// Pixels of the output are not square.
    Aspect,
    /// The output cannot say which part of a panorama it is.
    Panorama,
    /// The output's format holds no alpha.
    AlphaLost,
    /// A later frame has alpha that the first has not.
    AlphaFlattened,
    /// Alpha is full nowhere.
    AlphaThin,
    /// A colour profile is not carried over.
    ProfileLost,
    /// Outputs that were there are made again.
    Remade,
    /// The filter would read beyond what a file holds.
    Frayed,
    /// A face has another shape than the others.
    FaceShape,
    /// Faces do not meet as they lie.
    Arrangement,
    /// Pixels are no numbers.
    NotANumber,
    /// Much of the light comes from suns.
    Suns,
    /// Light is not kept in balance, for lack of memory.
    Unbalanced,
    /// Geometry is computed anew for each frame, for lack of memory.
    PlanAnew,
    /// Letters of the grid are too small to read.
    Letters,
    /// Numbers of a map are coarse.
    Coarse,
    /// What a map relates to is taken from the other side.
    MapBase,
    /// A project says something that is not followed.
    Project,
}
