use cosmorama::filter::FilterSettings;
use cosmorama::raster::{Channels, Depth, Rgba};
use cosmorama_builtin::{BuiltinWorld, DirectionMap, Grid};
use cosmorama_io::Format;
use cosmorama_spec::Missing;

use super::options::filter;
use crate::colour::Light;
use crate::diagnostic::{
    ANTI_RINGING, BACKGROUND, CHANNELS, Code, DEPTH, Diagnostic, FILTER, FRAMES, FROM, IN_TRANSFER, KERNEL, MISSING,
    Mark, OCIO, OUT_TRANSFER, OVERWRITE, PART, RESUME, Result, ST_MAP, TRANSFER, usage, usage_as,
};
use crate::input::{Builtin, Input, SAME_FOR_BOTH};
use crate::settings::{Conversion, GeometrySettings};
use crate::source::Access;
use crate::target::{Target, TargetView};

/// Source of the output's pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Content {
    /// Light of files, filtered.
    World,
    /// Places in the input file, for an st map.
    StMap,
    /// Light by a formula.
    Formula(BuiltinWorld),
    /// Directions of pixels.
    Directions(DirectionMap),
}

/// Greatest width that is suggested for the sake of legible letters.
const WIDEST: usize = 1 << 15;

impl Content {
    /// Returns the content that the settings request.
    pub(crate) fn of(settings: &Conversion) -> Result<Self> {
        match Builtin::named(&settings.input)? {
            Some(_) if settings.st_map => {
                Err(usage(format!("{ST_MAP} tells places in an image, but {} is a formula", settings.input)))
            }
            Some(_) if settings.light.is_some() => Err(usage(format!(
                "light is gathered from the pixels of an image, but {} is a formula; convert it to a picture first",
                settings.input
            ))),
            Some(Builtin::World(world)) => Ok(Self::Formula(world)),
            Some(Builtin::DirectionMap(map)) => Ok(Self::Directions(map)),
            None if settings.st_map => Ok(Self::StMap),
            None => Ok(Self::World),
        }
    }

    /// Returns whether there are files to read.
    pub(crate) fn has_files(self) -> bool {
        matches!(self, Self::World | Self::StMap)
    }

    /// Returns the formula, if that is the source.
    pub(crate) fn formula(self) -> Option<BuiltinWorld> {
        if let Self::Formula(world) = self { Some(world) } else { None }
    }

    /// Finds and probes the input's files, if there are any. There may be frames behind it.
    pub(crate) fn input(
        self,
        (settings, has_frames_behind): (&Conversion, bool),
        geometry: &GeometrySettings,
        access: Access,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Input> {
        let moves = geometry.camera.is_some() || geometry.in_path.is_some();
        if self.has_files() {
            // A still under a moving camera has the camera's frames, and one before a sequence has that one's.
            let is_still = (moves || has_frames_behind) && !Input::may_be_sequence(&settings.input);
            let wanted = settings.frames.as_ref().filter(|_| !is_still);
            return Input::find(&settings.input, geometry.from.as_ref(), wanted, access, warnings);
        }
        check_input_options(settings, moves)?;
        if filter(geometry, warnings) != FilterSettings::DEFAULT {
            let name = &settings.input;
            let message = format!("{FILTER}, {KERNEL} and {ANTI_RINGING} have no effect on {name}: a formula");
            warnings.push(Diagnostic::warning(Code::NoEffect, message).about(name));
        }
        Ok(Input::none())
    }

    /// Fits the input to the eyes of the target; a formula shows both eyes the same.
    pub(crate) fn fit_eyes(self, input: &mut Input, target: &Target, warnings: &mut Vec<Diagnostic>) {
        if self.has_files() {
            input.fit_eyes(target.is_stereo(), warnings);
        } else if target.is_stereo() {
            warnings.push(Diagnostic::warning(Code::OneForBothEyes, SAME_FOR_BOTH));
        }
    }

    /// Adapts the outputs' channels and depth to content that is not light, and warns about illegible letters of a
    /// grid.
    pub(crate) fn settle(
        self,
        settings: &Conversion,
        target: &Target,
        light: &mut Light,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<()> {
        match self {
            Self::World => {}
            Self::StMap => {
                light.depth = settings.depth.unwrap_or(Depth::Float);
                light.channels = Channels::Rgb;
            }
            Self::Formula(BuiltinWorld::Grid) => warnings.extend(without_letters(target)),
            Self::Formula(_) => {}
            Self::Directions(_) => {
                check_map(settings, target.format)?;
                // Half floats would turn a direction by as much as a pixel of a large picture.
                light.depth = settings.depth.unwrap_or(Depth::Float);
                light.metadata.primaries = None;
            }
        }
        Ok(())
    }

    /// Checks the settings of an st map, after all others have been checked.
    pub(crate) fn check_last(
        self,
        settings: &Conversion,
        format: Format,
        depth: Depth,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<()> {
        if self != Self::StMap {
            return Ok(());
        }
        check_st_map(settings, format)?;
        if depth == Depth::Half {
            let message = format!(
                "{DEPTH} half: halves of an st map tell places to 1/2048 of the picture's width only; leave it out for floats"
            );
            warnings.push(Diagnostic::warning(Code::Coarse, message));
        }
        Ok(())
    }
}

/// Returns the warning about a grid that is too coarse for letters in its middle.
fn without_letters(target: &Target) -> Option<Diagnostic> {
    let TargetView { name, view, .. } = target.views.first()?;
    Grid::width_for_letters(view).map(|enough| {
        let when = if enough <= WIDEST {
            format!("they show from a width of {enough} on")
        } else {
            "in this projection its middle is too small for any".to_owned()
        };
        let (width, height) = (view.width(), view.height());
        let message = format!(
            "{name}: in {width}x{height} pixels the grid's letters would be too small to read, and are left out; {when}"
        );
        Diagnostic::warning(Code::Letters, message).about(name)
    })
}

/// Refuses settings about input files, which have no effect on a formula.
fn check_input_options(settings: &Conversion, moves: bool) -> Result<()> {
    let given: [(bool, Mark, &str); 7] = [
        (settings.geometry.from.is_some(), FROM, "it is a formula, with no projection of its own"),
        (settings.frames.is_some() && !moves, FRAMES, "it has none"),
        (settings.in_transfer.is_some(), IN_TRANSFER, "it has no code values"),
        (settings.ocio.is_asked(), OCIO, "it has no code values; convert it to a picture first"),
        (settings.part.is_some(), PART, "it has none"),
        (!settings.channels.is_empty(), CHANNELS, "it has one picture"),
        (settings.missing != Missing::Error, MISSING, "it shows something in every direction"),
    ];
    match given.into_iter().find(|(is_given, ..)| *is_given) {
        Some((_, option, why)) => {
            Err(usage(format!("{option} cannot be given for {}: {why}; leave {option} out", settings.input)))
        }
        None => Ok(()),
    }
}

/// Refuses settings about colours, which a map of directions does not have.
fn check_map(settings: &Conversion, format: Format) -> Result<()> {
    let (input, output) = (&settings.input, &settings.output);
    if format != Format::Exr {
        return Err(usage_as(
            Code::OutputFormat,
            format!("{output} is {format}, but the numbers of {input} go into named channels; name the output .exr"),
        ));
    }
    if settings.existing == crate::settings::Existing::Resume {
        return Err(usage(format!(
            "{RESUME} cannot tell whether a file of {input} is complete; replace it with {OVERWRITE}"
        )));
    }
    let is_transferred = settings.transfer.fixed().is_some() || settings.out_transfer.is_some();
    if settings.background.is_some() || is_transferred {
        return Err(usage(format!(
            "{BACKGROUND}, {TRANSFER} and {OUT_TRANSFER} are for light, but {input} has none; leave them out"
        )));
    }
    Ok(())
}

/// Refuses settings about colours, which an st map does not have.
fn check_st_map(settings: &Conversion, format: Format) -> Result<()> {
    if format != Format::Exr {
        let output = &settings.output;
        return Err(usage_as(
            Code::OutputFormat,
            format!("{ST_MAP} writes numbers, but {output} is {format}; name the output .exr"),
        ));
    }
    let geometry = &settings.geometry;
    let is_plain =
        geometry.filter.0 == FilterSettings::DEFAULT.kind && geometry.kernel.kernel == FilterSettings::DEFAULT.kernel;
    if !is_plain || geometry.anti_ringing.is_some() {
        return Err(usage(format!(
            "{FILTER}, {KERNEL} and {ANTI_RINGING} are for texels that are weighed, but an st map has none; leave them out"
        )));
    }
    let transfers = [Some(&settings.transfer), settings.in_transfer.as_ref(), settings.out_transfer.as_ref()];
    let is_transferred = transfers.into_iter().flatten().any(|transfer| transfer.fixed().is_some());
    if settings.background.is_some() || is_transferred {
        return Err(usage(format!(
            "{BACKGROUND}, {TRANSFER}, {IN_TRANSFER} and {OUT_TRANSFER} are for light, but an st map has none; leave them out"
        )));
    }
    if settings.ocio.is_asked() {
        return Err(usage(format!("{OCIO} is for light, but an st map has none; leave it out")));
    }
    if matches!(settings.missing, Missing::Fill(colour) if colour != Rgba::TRANSPARENT) {
        return Err(usage(format!(
            "{MISSING}: an st map has no colours; give {MISSING} transparent, which leaves places without one"
        )));
    }
    Ok(())
}
