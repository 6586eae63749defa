//! Options of other programs, and options that people try, with what to type for them.

use crate::args;

/// Words tried for options of one verb: the verb, the words, and what to write.
const OF_VERB: [(&str, &[&str], &str); 23] = [
    ("info", &["format", "print-format", "output-format", "of", "o"], "--json, which prints the same as JSON"),
    ("info", &["verify", "validate", "deep", "damaged", "all-frames", "all"], "--check, which decodes every frame"),
    ("info", &["i", "in", "input", "file", "f"], "the input without an option: cosmorama info INPUT"),
    ("explain", &["dry-run", "n", "preview"], "nothing: explain makes no picture, it is the dry run of convert"),
    ("explain", &["i", "in", "src"], "the input without an option: cosmorama explain INPUT --to SPEC"),
    ("explain", &["o", "out", "diagrams", "dir"], "--output DIR, the folder of the diagrams"),
    (
        "compare",
        &["metric", "ssim", "psnr", "mse", "rmse", "mae", "ms-ssim", "lpips", "vmaf", "dssim"],
        "nothing: PSNR, rms, the largest difference and the shift are always printed; --min-psnr DB and --max-shift PX make \
         them a check",
    ),
    (
        "compare",
        &["mask", "roi", "area", "crop", "circle", "disc"],
        "--region disc, or --region omnimax: the pixels inside a lens; other masks are not on offer",
    ),
    (
        "compare",
        &["peak", "max", "white", "max-value", "data-range", "range"],
        "nothing: PSNR is of a peak of 1; where a picture is brighter, a second PSNR is of its own peak",
    ),
    ("compare", &["output", "o", "out", "difference", "diff-image", "save"], "--diff FILE, as in --diff diff.png"),
    (
        "compare",
        &["i", "in", "input", "a", "b", "ref", "reference"],
        "the two pictures without options: cosmorama compare PICTURE REFERENCE",
    ),
    ("compare", &["fail-under", "min", "assert"], "--min-psnr DB, as in --min-psnr 36"),
    ("demo", &["list", "l"], "nothing: there is one demo; 'cosmorama help builtins' lists worlds by formula"),
    ("demo", &["output", "o", "out", "dir", "folder", "d"], "the folder without an option: cosmorama demo DIR"),
    (
        "demo",
        &["size", "to", "width", "s"],
        "nothing: the demo is always the same; for other pictures of its world: cosmorama convert builtin:demo OUTPUT --to \
         SPEC --size N",
    ),
    ("completions", &["shell", "s"], "the shell without an option: cosmorama completions bash"),
    ("man", &["output", "o", "out", "dir", "folder", "d"], "the folder without an option: cosmorama man DIR"),
    ("light", &["i", "in", "input"], "the input without an option: cosmorama light diffuse INPUT OUTPUT"),
    ("light", &["o", "out", "output"], "the output without an option: cosmorama light diffuse INPUT OUTPUT"),
    ("light", &["roughness", "rough", "r"], "--alpha A, the square of the roughness that most programs show"),
    (
        "convert",
        &["exposure", "tonemap", "tone-map", "lut", "ev", "brightness", "contrast", "saturation", "ocio"],
        "nothing: light stays as it is; other programs grade pictures, as oiiotool --mulc does",
    ),
    (
        "convert",
        &["list", "list-projections", "projections", "help-spec"],
        "cosmorama help spec, which lists every projection, or cosmorama help kernels, formats, naming or builtins",
    ),
    ("convert", &["verify", "check", "validate"], "cosmorama info OUTPUT --check, which decodes what was made"),
];

/// Options of other programs, and what to type for them.
const OF_OTHERS: [(&[&str], &str); 29] = [
    (
        &[
            "width",
            "height",
            "w",
            "h",
            "s",
            "res",
            "resolution",
            "dimensions",
            "resize",
            "geometry",
            "output-size",
            "out-size",
            "image-size",
        ],
        "--size WxH, as in --size 4096x2048, or the width alone, as in --size 4096",
    ),
    (
        &["output", "out", "o", "dest", "destination"],
        "the output without an option, after the input: cosmorama convert INPUT OUTPUT --to SPEC",
    ),
    (
        &["input", "in", "i", "src"],
        "the input without an option, before the output: cosmorama convert INPUT OUTPUT --to SPEC",
    ),
    (&["source", "input-projection", "in-projection", "from-projection"], "--from SPEC, as in --from equirect"),
    (
        &["target", "projection", "proj", "output-projection", "out-projection", "to-projection", "type"],
        "--to SPEC, as in --to fulldome",
    ),
    (&["force", "replace", "yes", "clobber", "y"], "-y, which replaces existing outputs"),
    (
        &["interpolation", "interp", "resample", "resampling", "sampling", "method"],
        "--filter NAME, as in --filter bilinear, or --kernel NAME, as in --kernel catmull-rom",
    ),
    (&["jobs", "j", "cores", "workers", "cpus", "t"], "--threads N, as in --threads 4"),
    (&["bits", "bit-depth", "bitdepth", "bpp", "pix-fmt"], "--depth DEPTH, as in --depth 16"),
    (
        &["gamma", "colorspace", "colourspace", "color-space", "colour-space", "color", "colour"],
        "--transfer T, as in --transfer gamma:2.2",
    ),
    (
        &["bg", "fill", "background-color", "background-colour", "bgcolor"],
        "--background COLOR, as in --background black",
    ),
    (&["frame", "start", "end", "range", "first", "last", "start-number"], "--frames LIST, as in --frames 1-10"),
    (&["quiet", "q", "silent", "loglevel"], "--progress none"),
    (&["ram", "mem", "max-memory"], "--memory SIZE, as in --memory 8G"),
    (&["pan", "heading", "azimuth", "longitude", "lon"], "--yaw D, as in --yaw 30"),
    (&["elevation", "latitude"], "--pitch D, as in --pitch 10"),
    (&["rotation", "orientation", "ypr", "rpy", "angle"], "--yaw D, --pitch D and --roll D"),
    (
        &["antialias", "aa", "supersample", "supersampling", "ss", "oversample"],
        "nothing: the default filter averages all that a pixel sees",
    ),
    (&["dry-run", "n", "preview"], "cosmorama explain INPUT --to SPEC, which tells what a conversion will do"),
    (
        &["framerate", "frame-rate", "r"],
        "nothing: pictures have no frame rate; ffmpeg is told it when it makes the video (docs/video.md)",
    ),
    (&["f", "vf", "filter-complex"], "--from SPEC and --to SPEC: ffmpeg's v360=e:flat is --from e --to flat"),
    (
        &["threshold", "tolerance", "fuzz", "epsilon"],
        "--min-psnr DB, as in --min-psnr 36, or --max-shift PX, as in --max-shift 0.01",
    ),
    (&["amplify", "multiply", "exposure"], "--gain FACTOR, as in --gain 10"),
    (&["mkdir", "parents", "p"], "nothing: folders that do not exist are made"),
    (
        &["recursive", "batch", "glob"],
        "one pattern in quotes: '####' where frame numbers stand, '{face}' where faces' names do",
    ),
    (&["look", "look-at", "direction", "target-direction"], "--yaw D and --pitch D, as in --yaw 30 --pitch 10"),
    (
        &["undistort", "rectify", "unwarp", "dewarp"],
        "--from fisheye:calibration=FILE or perspective:calibration=FILE, and --to perspective",
    ),
    (&["rotate-x", "rotate-y", "rotate-z", "rx", "ry", "rz"], "--yaw D, --pitch D and --roll D"),
    (&["face", "only", "select"], "--to cube:faces=front,up: only these faces are made"),
];

/// Returns what to write in place of a word, if the verb has such an option.
pub(super) fn advice(word: &str, verb: Option<&str>) -> Option<String> {
    let own = OF_VERB.iter().find(|(of, words, _)| Some(*of) == verb && words.contains(&word));
    if let Some((_, _, write)) = own {
        return Some(in_words(write));
    }
    let (_, write) = OF_OTHERS.iter().find(|(words, _)| words.contains(&word))?;
    let option = write.split([' ', ',']).next().unwrap_or_default();
    let option = if option == "-y" { "overwrite" } else { option.trim_start_matches('-') };
    let has = |verb| match write.starts_with('-') {
        true => args::options(verb).iter().any(|name| name == option),
        false => verb == "convert",
    };
    verb.is_none_or(has).then(|| in_words(write))
}

/// Returns the advice to write something, or to leave the option out.
fn in_words(write: &str) -> String {
    match write.strip_prefix("nothing: ") {
        Some(why) => format!("leave it out: {why}"),
        None => format!("write {write}"),
    }
}
