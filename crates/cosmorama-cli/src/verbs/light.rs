use std::process::ExitCode;

use anyhow::Result;
use cosmorama::lighting::Lobe;
use cosmorama_convert::{Conversion, LightNormalisation, LightSettings};

use super::{convert, harmonics};
use crate::args::{DiffuseArgs, LightArgs, LightVerb, MapArgs, SpecularArgs, Unit};
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::KeptStreams;
use crate::report;

/// Makes light of a world.
pub(super) fn run(args: LightArgs, console: &mut Console) -> Result<ExitCode> {
    match args.verb {
        LightVerb::Diffuse(args) => diffuse(*args, console),
        LightVerb::Specular(args) => specular(*args, console),
        LightVerb::Harmonics(args) => harmonics::run(*args, console),
    }
}

fn diffuse(DiffuseArgs { map, normalise }: DiffuseArgs, console: &mut Console) -> Result<ExitCode> {
    let normalisation = match normalise {
        Unit::Irradiance => LightNormalisation::Irradiance,
        Unit::Radiance => LightNormalisation::Radiance,
    };
    let exact = map.exact;
    make(map, LightSettings { lobe: Lobe::LAMBERT, normalisation, exact }, console)
}

fn specular(SpecularArgs { map, lobe, alpha }: SpecularArgs, console: &mut Console) -> Result<ExitCode> {
    let lobe = lobe.lobe(alpha).map_err(usage)?;
    let exact = map.exact;
    make(map, LightSettings { lobe, normalisation: LightNormalisation::Radiance, exact }, console)
}

/// Makes maps, and reports the result.
fn make(mut map: MapArgs, light: LightSettings, console: &mut Console) -> Result<ExitCode> {
    if map.output == "-" {
        return Err(usage("maps of light are files; name one, as in light.exr"));
    }
    let mut kept = KeptStreams::default();
    map.input = kept.input(&map.input)?;
    let (progress, as_json) = (map.progress, map.json);
    let conversion: Conversion = map.into();
    let conversion = conversion.light(light).files(kept.files());
    let report = convert::convert(conversion, progress, console)?;
    if as_json {
        console.print(&report::to_json(&report)?)?;
    } else if progress.is_for_people() {
        report::tell(&report, console);
    }
    Ok(ExitCode::SUCCESS)
}
