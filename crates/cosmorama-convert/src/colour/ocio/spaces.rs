//! Spaces of a config by the crate `ocio`.

use std::sync::Arc;

use cosmorama::raster::Rgba;
use ocio::builtins::configs::BuiltinConfigRegistry;
use ocio::config::logging::LogGuard;
use ocio::{Config, CpuProcessor, LoggingLevel, Processor};

use super::{Spaces, Wanted, WantedOutput, names};
use crate::diagnostic::{Code, Diagnostic, IN_SPACE, OCIO, OUT_SPACE, Result, failed_as, usage};

/// Conversion from one space of a config to another.
#[derive(Debug)]
pub(crate) struct SpaceConversion(CpuProcessor);

/// Role of the space in which light is filtered.
const WORKING: &str = "scene_linear";

/// Name of linear Rec. 709 in OpenColorIO's built-in configs.
const LINEAR_REC709: &str = "lin_rec709";

/// Number of pixels that are converted at once.
const CHUNK: usize = 256;

impl SpaceConversion {
    /// Converts light in place. Colours are converted as they are without alpha, since curves hold for nothing else. Black that is
    /// transparent stays black.
    pub(crate) fn convert(&self, light: &mut [Rgba]) {
        let mut straight: Vec<[f32; 4]> = Vec::with_capacity(CHUNK.min(light.len()));
        for piece in light.chunks_mut(CHUNK) {
            straight.clear();
            straight.extend(piece.iter().map(|pixel| {
                let [red, green, blue] = if has_shade(*pixel) { pixel.unpremultiplied() } else { colour_of(*pixel) };
                [red, green, blue, 1.0]
            }));
            self.0.apply_pixels(&mut straight);
            for (pixel, [red, green, blue, _]) in piece.iter_mut().zip(&straight) {
                if *pixel == Rgba::TRANSPARENT {
                    continue;
                }
                let alpha = pixel.alpha();
                let share = if has_shade(*pixel) { alpha } else { 1.0 };
                *pixel = Rgba([share * red, share * green, share * blue, alpha]).finite();
            }
        }
    }
}

/// Returns whether a pixel's light has been made less by its alpha. Light without alpha, as of a flame, is its own.
fn has_shade(pixel: Rgba) -> bool {
    pixel.alpha() > 0.0 && pixel.alpha() != 1.0
}

fn colour_of(Rgba([red, green, blue, _]): Rgba) -> [f32; 3] {
    [red, green, blue]
}

impl Spaces {
    /// Opens a config and prepares the conversions that are wanted. What OpenColorIO warns of becomes warnings.
    pub(super) fn open(wanted: &Wanted<'_>, warnings: &mut Vec<Diagnostic>) -> Result<Self> {
        let log = LogGuard::with_level(LoggingLevel::Warning);
        let made = Self::prepare(wanted);
        for line in log.output().lines() {
            let message = format!("{}: {line}", wanted.config);
            warnings.push(Diagnostic::warning(Code::Metadata, message).about(wanted.config));
        }
        made
    }

    fn prepare(wanted: &Wanted<'_>) -> Result<Self> {
        let config = open(wanted.config)?;
        if !config.has_role(WORKING) {
            return Err(usage(format!(
                "{OCIO} {}: it has no role {WORKING}, in whose space light is filtered; name one among its roles",
                wanted.config
            )));
        }
        let failed = |error: ocio::Error| {
            failed_as(Code::Malformed, format!("{}: OpenColorIO cannot convert these colours: {error}", wanted.config))
        };
        let in_space = names::space(&config, (IN_SPACE, wanted.in_space), wanted.config)?;
        let input = conversion(config.get_processor(&in_space, WORKING).map_err(failed)?);
        let (output, out_space, space_name) = match wanted.out {
            WantedOutput::Space(name) => {
                let name = names::space(&config, (OUT_SPACE, name), wanted.config)?;
                (config.get_processor(WORKING, &name).map_err(failed)?, name.clone(), name)
            }
            WantedOutput::View(name) => {
                let (display, view) = names::display_and_view(&config, name, wanted.config)?;
                let processor = config.get_display_view_processor(WORKING, &display, &view).map_err(failed)?;
                let own = config.display_view_color_space_name(&display, &view);
                let space_name =
                    if own.eq_ignore_ascii_case("<USE_DISPLAY_NAME>") { display.clone() } else { own.to_owned() };
                (processor, format!("{display}/{view}"), space_name)
            }
        };
        let named = Config::get_processor_from_builtin_color_space(LINEAR_REC709, &config, WORKING);
        Ok(Self {
            input,
            output: conversion(output),
            named_colours: named.map(conversion).map_err(|error| error.to_string()),
            out_space,
            out_names: other_names(&config, &space_name),
        })
    }
}

/// Opens a config: a file, an archive, or a built-in one.
fn open(name: &str) -> Result<Config> {
    Config::create_from_file(ocio::builtins::configs::resolve_config_path(name)).map_err(|error| {
        let registry = BuiltinConfigRegistry::get();
        let known: Vec<&str> =
            (0..registry.num_builtin_configs()).filter_map(|index| registry.builtin_config_name(index).ok()).collect();
        let expected = if name.starts_with("ocio://") {
            format!("built in are ocio://{}", known.join(", ocio://"))
        } else {
            "expected a file of OpenColorIO, .ocio or .ocioz, or ocio://default".to_owned()
        };
        failed_as(Code::Malformed, format!("{OCIO} {name}: {error}; {expected}"))
    })
}

fn conversion(processor: Processor) -> Arc<SpaceConversion> {
    Arc::new(SpaceConversion(processor.default_cpu_processor()))
}

/// Returns the names by which others know a space.
fn other_names(config: &Config, space: &str) -> Vec<String> {
    let Some(space) = config.get_color_space(space) else { return Vec::new() };
    let mut names = vec![space.interop_id().to_owned(), space.name().to_owned()];
    names.extend(space.aliases().iter().cloned());
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spaces(in_space: &str, out: WantedOutput<'_>) -> Spaces {
        let config = "ocio://cg-config-v2.2.0_aces-v1.3_ocio-v2.4";
        Spaces::open(&Wanted { config, in_space, out }, &mut Vec::new()).expect("spaces of the config")
    }

    #[test]
    fn colours_are_converted_without_their_alpha() {
        let spaces = spaces("sRGB - Texture", WantedOutput::Space("ACEScct"));
        let (colour, alpha) = ([0.8_f32, 0.4, 0.1], 0.25);
        let mut light = [Rgba::opaque(colour[0], colour[1], colour[2]), Rgba(with(colour.map(|c| c * alpha), alpha))];
        for conversion in [&spaces.input, &spaces.output] {
            conversion.convert(&mut light);
            let [opaque, thin] = light;
            assert_eq!(thin.alpha(), alpha);
            for (one, other) in thin.unpremultiplied().into_iter().zip(opaque.0) {
                assert!((one - other).abs() < 1e-6, "{light:?}");
            }
        }
    }

    #[test]
    fn what_is_transparent_and_black_stays_so() {
        // Black of ACEScct is 0.0729.
        let spaces = spaces("ACEScg", WantedOutput::Space("ACEScct"));
        let mut light = [Rgba::TRANSPARENT, Rgba::BLACK];
        spaces.output.convert(&mut light);
        assert_eq!(light[0], Rgba::TRANSPARENT);
        assert!((light[1].0[0] - 0.0729).abs() < 1e-4, "{light:?}");
    }

    #[test]
    fn what_is_no_number_can_be_weighed() {
        // ACEScct's code 3 is brighter than any float of OpenColorIO's curve says.
        let spaces = spaces("ACEScct", WantedOutput::Space("ACEScg"));
        let mut light = [Rgba::opaque(f32::NAN, f32::INFINITY, 1e30)];
        spaces.input.convert(&mut light);
        assert!(light[0].0.iter().all(|sample| sample.is_finite()), "{light:?}");
    }

    fn with([red, green, blue]: [f32; 3], alpha: f32) -> [f32; 4] {
        [red, green, blue, alpha]
    }
}
