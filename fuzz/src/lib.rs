//! Parts that the fuzz targets share.

use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_io::Limits;
use tempfile::TempDir;

/// Memory that a file of a few kilobytes may take.
pub const MEMORY: Limits = Limits::memory(1 << 20);

/// Name of the environment variable with the folder that seeds are written to.
const SEEDS: &str = "COSMORAMA_SEEDS";

/// Prepares a target. Its thread is the only one: handing small work to others would take longer than the work. Panics are reported
/// as libFuzzer does, unless a decoder's caller is going to catch them, as in the program.
/// Seeds, each with its name, are written to the folder that `COSMORAMA_SEEDS` names: before libFuzzer reads it.
pub fn prepare(seeds: impl FnOnce() -> Vec<(String, Vec<u8>)>) {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("no other pool is there yet");
    let report = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        if !cosmorama_io::is_contained() {
            report(panic);
        }
    }));
    let Some(folder) = std::env::var_os(SEEDS).map(PathBuf::from) else { return };
    for (name, bytes) in seeds() {
        std::fs::write(folder.join(name), bytes).expect("the folder of seeds is there and takes files");
    }
}

/// Returns the path of a file for readers that open files by name, in a folder of this process.
pub fn path(name: &str) -> PathBuf {
    static FOLDER: LazyLock<TempDir> = LazyLock::new(|| tempfile::tempdir().expect("temporary folders can be made"));
    FOLDER.path().join(name)
}

/// Writes a file of this process, and returns its path.
pub fn written(name: &str, bytes: &[u8]) -> PathBuf {
    let path = path(name);
    std::fs::write(&path, bytes).expect("the temporary folder takes files");
    path
}

/// Reads a file that a writer made.
pub fn bytes_of(path: &Path) -> Vec<u8> {
    std::fs::read(path).expect("the file was written before")
}

/// Makes a picture with something in every sample.
pub fn picture((width, height): (usize, usize), channels: Channels, depth: Depth) -> EncodedImage {
    let codes = (0..width * height * channels.count()).map(|at| (at * 37 % 251) as u8);
    let samples = match depth {
        Depth::Eight => Samples::U8(codes.collect()),
        Depth::Half | Depth::Float => Samples::Float(codes.map(|code| f32::from(code) / 255.0).collect()),
        _ => Samples::U16(codes.map(|code| u16::from(code) * 257).collect()),
    };
    EncodedImage::new(width, height, channels, depth, samples).expect("as many samples as the size says")
}
