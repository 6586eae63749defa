use super::Mark;

/// Declares each setting once: its meaning, its variant, its plain name, and the constant that formats as its mark.
macro_rules! settings {
    ($(#[doc = $meaning:literal] $setting:ident $name:literal $mark:ident,)+) => {
        /// A setting of a conversion, for reference in messages.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum Setting {
            $(#[doc = $meaning] $setting,)+
        }

        impl Setting {
            /// All settings.
            pub const ALL: &[Self] = &[$(Self::$setting),+];

            /// Returns the plain name, with words joined by `-`.
            pub fn name(self) -> &'static str {
                match self {
                    $(Self::$setting => $name,)+
                }
            }
        }

        $(
            #[cfg_attr(not(feature = "video"), allow(dead_code, reason = "some settings are of videos alone"))]
            pub(crate) const $mark: Mark = Mark(Setting::$setting);
        )+
    };
}

settings! {
    /// The input's projection.
    From "from" FROM,
    /// The output's projection.
    To "to" TO,
    /// Size of the output in pixels.
    Size "size" SIZE,
    /// Rotation of the output to the right.
    Yaw "yaw" YAW,
    /// Rotation of the output upwards.
    Pitch "pitch" PITCH,
    /// Clockwise rotation of the output's camera.
    Roll "roll" ROLL,
    /// Path of the output's camera.
    Path "path" PATH,
    /// Path of the input.
    InPath "in-path" IN_PATH,
    /// Field of view that changes.
    Fov "fov" FOV,
    /// Distance of the camera from the place where the world was made.
    Travel "travel" TRAVEL,
    /// Distance of the nearest thing in the world.
    Nearest "nearest" NEAREST,
    /// Time for which a shutter is open.
    Shutter "shutter" SHUTTER,
    /// Method of motion blur.
    Motion "motion" MOTION,
    /// Scale of a map of light in its file.
    Scale "scale" SCALE,
    /// Distance of the frames whose maps of light are computed, or that a contact sheet shows.
    Every "every" EVERY,
    /// Answer to damaged frames of a video.
    Damaged "damaged" DAMAGED,
    /// Filter.
    Filter "filter" FILTER,
    /// Rule by which labels are chosen.
    Labels "labels" LABELS,
    /// Kernel of the filter.
    Kernel "kernel" KERNEL,
    /// Whether pixels are clamped to their texels.
    AntiRinging "anti-ringing" ANTI_RINGING,
    /// Transfer function of both sides.
    Transfer "transfer" TRANSFER,
    /// Transfer function of the input.
    InTransfer "in-transfer" IN_TRANSFER,
    /// Transfer function of the output.
    OutTransfer "out-transfer" OUT_TRANSFER,
    /// Primaries of the output.
    Primaries "primaries" PRIMARIES,
    /// Primaries of inputs that name none.
    InPrimaries "in-primaries" IN_PRIMARIES,
    /// Whether ICC profiles of inputs are ignored.
    IgnoreProfile "ignore-profile" IGNORE_PROFILE,
    /// OpenColorIO config.
    Ocio "ocio" OCIO,
    /// Colour space of the input in the config.
    InSpace "in-space" IN_SPACE,
    /// Colour space of the output in the config.
    OutSpace "out-space" OUT_SPACE,
    /// View of the config that the output is made for.
    View "view" VIEW,
    /// Sample type of the output.
    Depth "depth" DEPTH,
    /// Colour outside the lens.
    Background "background" BACKGROUND,
    /// Treatment of directions that no view covers.
    Missing "missing" MISSING,
    /// World behind the input's alpha.
    Backdrop "backdrop" BACKDROP,
    /// Projection of the backdrop.
    BackdropFrom "backdrop-from" BACKDROP_FROM,
    /// Frame of the backdrop for each frame.
    BackdropFrames "backdrop-frames" BACKDROP_FRAMES,
    /// Frames of a sequence.
    Frames "frames" FRAMES,
    /// Frames a second of a path by time, and of a video.
    Fps "fps" FPS,
    /// Codec of a video.
    VideoCodec "video-codec" VIDEO_CODEC,
    /// Further arguments of a video's encoder.
    VideoArgs "video-args" VIDEO_ARGS,
    /// Whether existing outputs are replaced.
    Overwrite "overwrite" OVERWRITE,
    /// Whether complete outputs are kept.
    Resume "resume" RESUME,
    /// Whether mip levels are written.
    Mips "mips" MIPS,
    /// Number of levels in a chain of light.
    Levels "levels" LEVELS,
    /// JPEG quality.
    Quality "quality" QUALITY,
    /// Effort of lossless compression.
    Compression "compression" COMPRESSION,
    /// Whether outputs get no metadata of inputs.
    Strip "strip" STRIP,
    /// Limit of memory.
    Memory "memory" MEMORY,
    /// Number of threads.
    Threads "threads" THREADS,
    /// Whether an st map is written instead of a picture.
    StMap "st-map" ST_MAP,
    /// Part of OpenEXR files.
    Part "part" PART,
    /// Channels of OpenEXR files.
    Channels "channels" CHANNELS,
    /// Kind of the input's depth.
    DepthKind "depth-kind" DEPTH_KIND,
    /// Frame of normals.
    Normals "normals" NORMALS,
}
