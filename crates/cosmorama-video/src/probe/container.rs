//! Kinds of containers, by ffprobe's names of them, where what is known of them differs.

/// Name of AVI.
pub(crate) const AVI: &str = "avi";

/// Name of GIF.
pub(crate) const GIF: &str = "gif";

/// Name of FLV.
pub(super) const FLV: &str = "flv";

/// Name of MXF.
pub(super) const MXF: &str = "mxf";

/// Name of NUT.
pub(super) const NUT: &str = "nut";

/// Name of Ogg.
pub(super) const OGG: &str = "ogg";

/// Name of ASF, which WMV is, too.
pub(super) const ASF: &str = "asf";

/// Returns whether a container is MP4 or MOV.
pub(crate) fn is_boxes(container: &str) -> bool {
    container.split(',').any(|name| name == "mov" || name == "mp4")
}

/// Returns whether a container is Matroska or WebM.
pub(super) fn is_matroska(container: &str) -> bool {
    container.starts_with("matroska")
}

/// Returns whether the duration of a container is the time at which its file ends, wherever that is.
pub(super) fn ends_with_its_file(container: &str) -> bool {
    ["dv", NUT, OGG].contains(&container)
}

/// Returns whether streams of a container may begin between key frames: those that are cut anywhere. Of bare H.264
/// ffmpeg does not tell the numbers of frames then, and its decoder complains of each that it lacks.
pub(super) fn begins_anywhere(container: &str) -> bool {
    ["mpegts", "mpeg", "mpegvideo", "m4v", "hevc"].contains(&container)
}

/// Returns whether a stream is bare: no frame has a time, and where it tells no rate, ffprobe takes 25 frames a second.
pub(super) fn is_bare(container: &str, codec: &str) -> bool {
    ["h264", "hevc", "obu"].contains(&container) || is_bare_mpeg1(container, codec)
}

/// Returns whether a stream is bare MPEG-1, of whose first frames ffmpeg guesses times with holes between.
pub(super) fn is_bare_mpeg1(container: &str, codec: &str) -> bool {
    container == "mpegvideo" && codec == MPEG1
}

/// Name of the codec MPEG-1.
pub(super) const MPEG1: &str = "mpeg1video";
