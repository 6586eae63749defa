//! Colour spaces of an OpenColorIO config: what settings ask for, and what the outputs say of their colours.
//!
//! Code values of inputs are brought to the config's `scene_linear` role where they are decoded, so that light is filtered
//! as light, and from there to the outputs' space or view before they are encoded.

#[cfg(not(feature = "ocio"))]
mod absent;
#[cfg(feature = "ocio")]
mod names;
#[cfg(feature = "ocio")]
mod spaces;
mod tag;

use std::sync::Arc;

use cosmorama::raster::{Channels, Depth, Primaries, Rgba, Transfer};
use cosmorama_io::{Format, Header, Metadata};

#[cfg(not(feature = "ocio"))]
pub(crate) use absent::SpaceConversion;
#[cfg(feature = "ocio")]
pub(crate) use spaces::SpaceConversion;

use super::conversion::LightConversion;
use crate::diagnostic::{
    Code, Diagnostic, IGNORE_PROFILE, IN_PRIMARIES, IN_SPACE, IN_TRANSFER, OCIO, OUT_SPACE, OUT_TRANSFER, PRIMARIES,
    Result, TRANSFER, VIEW, usage, usage_as,
};
use crate::settings::Conversion;

/// Spaces of a config between which a job converts.
#[derive(Debug)]
pub(crate) struct ColourConfig {
    /// From the inputs' space to working light.
    input: Arc<SpaceConversion>,
    /// From working light to the outputs' space.
    output: Arc<SpaceConversion>,
    /// From linear Rec. 709 to working light; the reason where the config does not tell.
    named_colours: Result<Arc<SpaceConversion>, String>,
    /// Name of the outputs' space.
    out_space: String,
    /// Primaries and transfer function of the outputs' space, if it is a common one.
    tag: Option<(Primaries, Transfer)>,
}

/// Spaces that a job needs of a config.
struct Spaces {
    input: Arc<SpaceConversion>,
    output: Arc<SpaceConversion>,
    named_colours: Result<Arc<SpaceConversion>, String>,
    /// Name of the outputs' space, for messages.
    out_space: String,
    /// Other names of the outputs' space.
    out_names: Vec<String>,
}

/// Requests of a job to a config.
struct Wanted<'a> {
    config: &'a str,
    in_space: &'a str,
    out: WantedOutput<'a>,
}

/// Space or view of the outputs.
#[derive(Clone, Copy)]
enum WantedOutput<'a> {
    Space(&'a str),
    /// `DISPLAY/VIEW`.
    View(&'a str),
}

impl ColourConfig {
    /// Opens the config that settings name; `None` where they ask for none.
    ///
    /// # Errors
    /// When settings do not fit together, the config cannot be read, or it does not have what they name.
    pub(super) fn open(args: &Conversion, headers: &[&Header], warnings: &mut Vec<Diagnostic>) -> Result<Option<Self>> {
        let Some(wanted) = wanted(args)? else { return Ok(None) };
        let Spaces { input, output, named_colours, out_space, out_names } = Spaces::open(&wanted, warnings)?;
        let says = |metadata: &Metadata| metadata.primaries.is_some() || metadata.icc.is_some();
        if headers.iter().any(|header| says(&header.metadata)) {
            let message = format!("{IN_SPACE} says what colours are: the files' own tags of colours are ignored");
            warnings.push(Diagnostic::note(Code::Metadata, message));
        }
        let tag = out_names.iter().find_map(|name| tag::of(name));
        Ok(Some(Self { input, output, named_colours, out_space, tag }))
    }

    /// Returns what brings the inputs' code values to working light.
    pub(super) fn input(&self) -> LightConversion {
        LightConversion::Spaces(Arc::clone(&self.input))
    }

    /// Returns what brings working light to the outputs' code values.
    pub(super) fn output(&self) -> LightConversion {
        LightConversion::Spaces(Arc::clone(&self.output))
    }

    /// Returns a colour that was given by name or number, in Rec. 709, as working light.
    ///
    /// # Errors
    /// When the config does not say what its colours are in others' spaces, and the colour is no grey.
    pub(super) fn colour(&self, colour: Rgba) -> Result<Rgba> {
        let [red, green, blue, _] = colour.0;
        if red == green && green == blue {
            return Ok(colour);
        }
        match &self.named_colours {
            Ok(conversion) => {
                let mut light = [colour];
                conversion.convert(&mut light);
                Ok(light[0])
            }
            Err(reason) => Err(usage(format!(
                "{OCIO}: the config does not say which of its colours are those of Rec. 709, in which colours are given here \
                 ({reason}); give a grey, or add the role aces_interchange to the config"
            ))),
        }
    }

    /// Returns metadata that say what the outputs' colours are, as far as files of this format and depth can.
    pub(super) fn tagged(
        &self,
        metadata: Metadata,
        format: Format,
        depth: Depth,
        warnings: &mut Vec<Diagnostic>,
    ) -> Metadata {
        let said = self.tag.clone().filter(|(primaries, transfer)| {
            // A profile for such primaries holds any transfer function, too.
            let has_profile = format.holds_icc() && !primaries.is_same(&Primaries::REC709);
            let holds_transfer = match depth.is_float() {
                true => *transfer == Transfer::Linear,
                false => has_profile || format.keeps_transfer(transfer, Channels::Rgb),
            };
            holds_transfer && format.holds_primaries(primaries)
        });
        if said.is_none() {
            let taken = if depth.is_float() { "linear Rec. 709" } else { "sRGB" };
            let message = format!(
                "{format} files cannot say that their colours are {}: programs will take them for {taken} unless told",
                self.out_space
            );
            warnings.push(Diagnostic::warning(Code::Primaries, message));
        }
        let (primaries, transfer) = said.unzip();
        let is_usual = primaries.is_some_and(|primaries| primaries.is_same(&Primaries::REC709));
        Metadata { transfer, primaries: primaries.filter(|_| !is_usual), icc: None, white_luminance: None, ..metadata }
    }
}

/// Returns what settings ask for.
fn wanted(args: &Conversion) -> Result<Option<Wanted<'_>>> {
    let asked = &args.ocio;
    if !asked.is_asked() {
        return Ok(None);
    }
    let beside = [
        (args.transfer.fixed().is_some(), TRANSFER),
        (args.in_transfer.is_some(), IN_TRANSFER),
        (args.out_transfer.is_some(), OUT_TRANSFER),
        (args.primaries.is_some(), PRIMARIES),
        (args.in_primaries.is_some(), IN_PRIMARIES),
        (args.ignore_profile, IGNORE_PROFILE),
    ];
    if let Some((_, other)) = beside.iter().find(|(is_given, _)| *is_given) {
        return Err(usage(format!(
            "{other} has no place beside {OCIO}: the config says what colours are; leave one out"
        )));
    }
    let Some(config) = &asked.config else {
        return Err(usage_as(
            Code::MissingSetting,
            format!(
                "{IN_SPACE}, {OUT_SPACE} and {VIEW} are names in an OpenColorIO config; give {OCIO} CONFIG, or set $OCIO"
            ),
        ));
    };
    let Some(in_space) = &asked.in_space else {
        return Err(usage_as(
            Code::MissingSetting,
            format!(
                "{OCIO} says nothing of the input's colours by itself; name their space in {config} with {IN_SPACE}"
            ),
        ));
    };
    let out = match (&asked.out_space, &asked.view) {
        (Some(_), Some(_)) => {
            return Err(usage(format!("the output has {OUT_SPACE} or {VIEW}, but not both; leave one out")));
        }
        (None, Some(view)) => WantedOutput::View(view),
        (Some(space), None) => WantedOutput::Space(space),
        (None, None) => WantedOutput::Space(in_space),
    };
    Ok(Some(Wanted { config, in_space, out }))
}
