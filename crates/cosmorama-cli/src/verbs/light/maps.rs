use std::process::ExitCode;

use anyhow::Result;
use cosmorama::lighting::{ChainLevel, Lobe, RoughnessMap, SMOOTHEST};
use cosmorama_convert::{
    CHAIN_EDGE, Conversion, Every, LightLevel, LightNormalisation, LightSettings, is_cube_of_light,
};

use crate::args::light::lobe::LobeName;
use crate::args::{DiffuseArgs, MapArgs, Method, SpecularArgs, Unit};
use crate::console::Console;
use crate::failure::usage;
use crate::pipe::KeptStreams;
use crate::report;
use crate::verbs::convert;

/// Makes a map of the light on matt surfaces.
pub(super) fn diffuse(args: DiffuseArgs, console: &mut Console) -> Result<ExitCode> {
    let DiffuseArgs { map, normalise, every, every_error } = args;
    let normalisation = match normalise {
        Unit::Irradiance => LightNormalisation::Irradiance,
        Unit::Radiance => LightNormalisation::Radiance,
    };
    let (exact, scale) = (map.exact, map.scale);
    let every = every.map(|frames| Every { frames, measured: every_error });
    make(map, LightSettings { exact, every, scale, ..LightSettings::map(Lobe::LAMBERT, normalisation) }, console)
}

/// Makes a map of reflections, or a chain of them.
pub(super) fn specular(args: SpecularArgs, console: &mut Console) -> Result<ExitCode> {
    let levels = levels(&args)?;
    let (exact, scale) = (args.map.exact, args.map.scale);
    let light = LightSettings { levels, normalisation: LightNormalisation::Radiance, exact, every: None, scale };
    make(args.map, light, console)
}

/// Returns the levels of a chain; a single one for an ordinary map.
fn levels(args: &SpecularArgs) -> Result<Vec<LightLevel>> {
    if args.method == Method::Mipmap {
        return mipmap(args);
    }
    match (&args.alpha[..], args.levels) {
        (alphas, None) if args.roughness_map.is_some() => Err(usage(if alphas.is_empty() {
            "--roughness-map is for chains: give the number of levels, as in --levels 5"
        } else {
            "--alpha says how rough each level is; leave --roughness-map out, or give --levels instead of --alpha"
        })),
        ([], None) => Ok(vec![LightLevel::Lobe(args.lobe.lobe(None).map_err(usage)?)]),
        ([], Some(levels)) => chain(args, levels),
        (alphas, levels) if levels.is_none_or(|levels| levels == alphas.len()) => {
            alphas.iter().map(|alpha| level(args.lobe, *alpha)).collect()
        }
        (alphas, levels) => Err(usage(format!(
            "--levels is {}, but --alpha has {} values; give one for each level, or leave one of both options out",
            levels.unwrap_or_default(),
            alphas.len()
        ))),
    }
}

/// Returns the levels of plain mip maps.
fn mipmap(args: &SpecularArgs) -> Result<Vec<LightLevel>> {
    if !args.alpha.is_empty() || args.roughness_map.is_some() || args.lobe != LobeName::Ggx || args.map.exact {
        return Err(usage(
            "--method mipmap knows no lobes: each level is the one before, halved; leave out --lobe, --alpha, --roughness-map and --exact",
        ));
    }
    let Some(levels) = args.levels else {
        return Err(usage("--method mipmap needs the number of levels, as in --levels 5"));
    };
    let further = (1..levels).map(|_| LightLevel::Halved);
    Ok(std::iter::once(LightLevel::Mirror).chain(further).collect())
}

/// Returns the levels of a chain by a rule.
fn chain(args: &SpecularArgs, levels: usize) -> Result<Vec<LightLevel>> {
    if !matches!(args.lobe, LobeName::Ggx | LobeName::Charlie) {
        return Err(usage(
            "--levels is for ggx and charlie, which have a roughness; phong and blinn have one exponent",
        ));
    }
    let map = args.roughness_map.map_or(RoughnessMap::Squared, RoughnessMap::from);
    if map.goes_by_faces() && !is_cube_of_light(args.map.to.as_ref(), &args.map.output) {
        return Err(usage(
            "--roughness-map unreal and three go by the size of a cube's faces; name the output .ktx2 or .dds, or put {face} into it",
        ));
    }
    let edge = args.map.size.map_or(CHAIN_EDGE, |size| size.width);
    levels_by(args.lobe, map, (levels, edge))
}

/// Returns the levels of a chain of lobes by a rule.
pub(super) fn levels_by(lobe: LobeName, map: RoughnessMap, (levels, edge): (usize, usize)) -> Result<Vec<LightLevel>> {
    let alpha = |level: usize| map.alpha(ChainLevel { level, levels, edge });
    // A roughness below that of any lobe makes a mirror.
    (0..levels).map(|at| level(lobe, if alpha(at) < SMOOTHEST { 0.0 } else { alpha(at) })).collect()
}

/// Returns the level of a roughness.
fn level(lobe: LobeName, alpha: f64) -> Result<LightLevel> {
    if alpha == 0.0 && matches!(lobe, LobeName::Ggx | LobeName::Charlie) {
        return Ok(LightLevel::Mirror);
    }
    lobe.lobe(Some(alpha)).map(LightLevel::Lobe).map_err(usage)
}

/// Makes maps, and reports the result.
fn make(mut map: MapArgs, light: LightSettings, console: &mut Console) -> Result<ExitCode> {
    if *map.output == *"-" {
        return Err(usage("maps of light are files; name one, as in light.exr"));
    }
    let mut kept = KeptStreams::default();
    map.input = kept.input(&map.input)?;
    let (progress, as_json) = (map.run.progress, map.run.json);
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
