//! What would a conversion need? Asked before there is any input.
//!
//! `cargo run -p cosmorama-convert --example explain`
#![allow(clippy::print_stdout, reason = "a program that shows something says so")]

use std::error::Error;

use cosmorama_convert::{ExplanationSettings, GeometrySettings};

fn main() -> Result<(), Box<dyn Error>> {
    let geometry = GeometrySettings {
        from: Some("cube".parse()?),
        to: Some("fulldome:tilt=20".parse()?),
        size: Some("1024".parse()?),
        ..GeometrySettings::default()
    };
    let settings = ExplanationSettings { geometry, input_size: Some("512".parse()?), ..ExplanationSettings::default() };
    let explanation = settings.check().result?;
    let worlds = explanation.worlds()?;
    for picture in explanation.pictures() {
        println!("{}", explanation.report(&worlds, picture));
    }
    Ok(())
}
