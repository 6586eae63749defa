//! A conversion's geometry as an st map for other programs, and back: the map as a lens.
//!
//! `cargo run -p cosmorama-convert --example st_map`
#![allow(clippy::print_stdout, reason = "a program that shows something says so")]

use std::error::Error;

use cosmorama_convert::{Conversion, Quiet};

fn main() -> Result<(), Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    let path = |name: &str| folder.path().join(name).display().to_string();
    let run = |conversion: Conversion| -> Result<(), Box<dyn Error>> {
        conversion.check().result?.run(&mut Quiet)?;
        Ok(())
    };
    run(Conversion::new("builtin:demo", path("dome.png")).to("fulldome".parse()?).size("128".parse()?))?;
    let view = Conversion::new(path("dome.png"), path("map.exr")).from("fulldome".parse()?);
    let view = view.to("perspective:fov=60,pitch=40".parse()?).size("64x48".parse()?);
    run(Conversion { st_map: true, ..view })?;
    let warp = format!("st-map:file={}", path("map.exr"));
    run(Conversion::new(path("dome.png"), path("warped.png")).from(warp.parse()?).to("perspective:fov=60".parse()?))?;
    println!("map.exr and warped.png");
    Ok(())
}
