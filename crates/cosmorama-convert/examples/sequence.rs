//! A sequence of panoramas becomes a sequence of domes: the geometry is computed once, frames follow each other.
//!
//! `cargo run -p cosmorama-convert --example sequence`
#![allow(clippy::print_stdout, reason = "a program that shows something says so")]

use std::error::Error;
use std::ops::ControlFlow;
use std::path::Path;

use cosmorama_convert::{Conversion, Observer, Quiet, Stop};

/// Says what is done, and lets it go on.
struct Watcher;

impl Observer for Watcher {
    fn begin(&mut self, frames: Option<usize>) {
        // Of a stream, nobody knows.
        if let Some(frames) = frames {
            println!("{frames} frames");
        }
    }

    fn frame_done(&mut self, frame: Option<u64>) -> ControlFlow<Stop> {
        println!("frame {} is written", frame.unwrap_or_default());
        ControlFlow::Continue(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).display().to_string();
    for frame in 1..=3 {
        let turned = format!("equirect:yaw={}", 10 * frame);
        let sky = Conversion::new("builtin:demo", path(&format!("sky_{frame}.png"))).to(turned.parse()?);
        sky.size("256".parse()?).check().result?.run(&mut Quiet)?;
    }
    let domes = Conversion::new(path("sky_#.png"), path("dome_#.png")).to("fulldome:tilt=20".parse()?);
    let report = domes.size("128".parse()?).check().result?.run(&mut Watcher)?;
    println!("{} files in {:.1?}", report.outputs.len(), report.wall);
    assert!(report.outputs.iter().map(Path::new).all(Path::exists));
    Ok(())
}
