use std::fmt::Debug;
use std::path::Path;
use std::sync::Arc;

use cosmorama::raster::{Channels, Depth, Primaries, Rgba, Transfer};
use cosmorama_io::{Format, Header, Metadata};
use cosmorama_spec::{Missing, TransferName};

use super::carried::carried;
use super::conversion::LightConversion;
use super::ocio::ColourConfig;
use super::profile;
use super::working::{Working, clips, white_of};
use crate::diagnostic::{BACKGROUND, Code, DEPTH, Diagnostic, MISSING, Result, usage_as};
use crate::input::Input;
use crate::settings::{Conversion, LightNormalisation, LightScale, LightSettings};
use crate::target::Target;

/// Transfer functions and primaries of inputs and outputs, and the outputs' channels and depth.
#[derive(Clone, Debug)]
pub(crate) struct Light {
    /// Requested transfer function of the inputs; without one, files decide.
    input: InputTransfer,
    /// Whether any input has alpha; then transparent parts stay transparent.
    pub(crate) input_alpha: bool,
    /// Channels of the outputs.
    pub(crate) channels: Channels,
    /// Sample type of the outputs.
    pub(crate) depth: Depth,
    /// Transfer function of the outputs.
    pub(crate) transfer: Transfer,
    /// Metadata of the outputs.
    pub(crate) metadata: Metadata,
    /// Colour outside the lens, in working primaries.
    pub(crate) background: Rgba,
    /// Primaries and white of the light.
    pub(crate) working: Working,
    /// Whether negative light is lost in the outputs.
    pub(crate) clips: bool,
    /// Format of the outputs if they take over metadata of inputs, else `None`.
    pub(super) carries: Option<Format>,
    /// Whether ICC profiles of inputs are ignored.
    ignores_profiles: bool,
    /// Spaces of the OpenColorIO config that says what colours are, instead of files.
    config: Option<Arc<ColourConfig>>,
}

/// Conversion of a file's code values to working light.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct FileColours {
    pub(crate) transfer: Transfer,
    /// Conversion of the decoded light; `None` where nothing has to be done.
    pub(crate) conversion: Option<LightConversion>,
}

/// Requested transfer functions of the input.
#[derive(Clone, Debug)]
pub struct InputTransfer {
    /// For integer files only.
    integers: Option<Transfer>,
    /// For all files.
    all: Option<Transfer>,
}

impl InputTransfer {
    /// Combines `--transfer`, which applies to integer files since floats are linear, with `--in-transfer`, which
    /// applies to all.
    pub fn new(both: &TransferName, side: Option<&TransferName>) -> Self {
        match side {
            Some(side) => Self { integers: side.fixed(), all: side.fixed() },
            None => Self { integers: both.fixed(), all: None },
        }
    }

    /// Returns the transfer function of a file of this depth with this metadata.
    pub fn of(&self, depth: Depth, metadata: &Metadata) -> Transfer {
        if depth.is_float() {
            // Profiles beside floats speak of other programs' displays; other tags speak of the values.
            let said = || metadata.transfer.clone().filter(|_| metadata.icc.is_none());
            return self.all.clone().or_else(said).unwrap_or(Transfer::Linear);
        }
        self.integers.clone().or_else(|| metadata.transfer.clone()).unwrap_or_default()
    }
}

impl Light {
    /// Returns all that decides on the samples of a file, for comparisons.
    pub(crate) fn definition(&self) -> impl Debug {
        let Self { input, channels, depth, transfer, background, working, .. } = self;
        (input, channels, depth, transfer, background, working)
    }

    /// Resolves the settings for an input. Outputs show the backdrop behind it, too, if there is one.
    pub(crate) fn resolve(
        args: &Conversion,
        input: &Input,
        target: &Target,
        behind: Option<&Self>,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let headers = profile::headers(args, input, warnings);
        let headers: Vec<&Header> = headers.iter().collect();
        let own = depth(args, &headers, target)?;
        let (channels, depth) = match behind {
            // What is behind shows wherever the input is transparent.
            Some(behind) => {
                let is_colour = behind.channels.is_colour() || headers.iter().any(|header| header.channels.is_colour());
                let plain = if is_colour { Channels::Rgb } else { Channels::Grey };
                let wanted = if behind.channels.has_alpha() { plain.with_alpha() } else { plain };
                (target.format.nearest_channels(wanted), deeper(own, behind.depth))
            }
            None => (channels(args, &headers, target, warnings)?, own),
        };
        let side = InputTransfer::new(&args.transfer, args.in_transfer.as_ref());
        let primaries = Working::choose(args, &headers, target.format, warnings);
        // A profile for such primaries holds any transfer function, too.
        let has_profile = target.format.holds_icc() && channels.is_colour() && !primaries.is_same(&Primaries::REC709);
        let keeps = |transfer: &Transfer| has_profile || target.format.keeps_transfer(transfer, channels);
        let kind = (depth, channels, target.format);
        let transfer = output_transfer(args, &headers, &side, kind, keeps, warnings);
        let first = headers.first().and_then(|first| white_of(&first.metadata, &side.of(first.depth, &first.metadata)));
        let working = Working::new(args, primaries, &transfer, first);
        let metadata = metadata(args, &headers, target, (&transfer, &working, depth), warnings);
        if target.format == Format::Exr && transfer != Transfer::Linear {
            let message = "OpenEXR files hold linear light for most programs, whatever their attributes say: these values \
                           are encoded";
            warnings.push(Diagnostic::warning(Code::Primaries, message));
        }
        let default = if channels.has_alpha() { Rgba::TRANSPARENT } else { Rgba::BLACK };
        let light = Self {
            input: side,
            input_alpha: headers.iter().any(|header| header.channels.has_alpha()),
            channels,
            depth,
            transfer,
            metadata,
            background: args.background.map_or(default, |colour| working.colour(colour)),
            working,
            clips: clips(depth, target.format),
            carries: (!args.strip).then_some(target.format),
            ignores_profiles: args.ignore_profile,
            config: None,
        };
        let light = match ColourConfig::open(args, &headers, warnings)? {
            Some(config) => light.with_config(args, config, target.format, warnings)?,
            None => light,
        };
        for (view, header, _) in input.present() {
            light.check_profile(&view.files.path(input.frames.first().copied().flatten()), &header.metadata)?;
        }
        Ok(light)
    }

    /// Returns light of an OpenColorIO config instead: code values are those of its spaces.
    fn with_config(
        self,
        args: &Conversion,
        config: ColourConfig,
        format: Format,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let background = args.background.map_or(Ok(self.background), |colour| config.colour(colour))?;
        let metadata = config.tagged(self.metadata, format, self.depth, warnings);
        // Negative light of inputs is the config's business.
        Ok(Self {
            transfer: Transfer::Linear,
            metadata,
            background,
            clips: false,
            config: Some(Arc::new(config)),
            ..self
        })
    }

    /// Refuses a file whose ICC profile can neither be applied nor be passed on unchanged.
    pub(crate) fn check_profile(&self, path: &Path, metadata: &Metadata) -> Result<()> {
        let goes_along = metadata.icc.is_some() && metadata.icc == self.metadata.icc;
        if self.ignores_profiles || goes_along || self.config.is_some() {
            Ok(())
        } else {
            profile::check(path, metadata)
        }
    }

    /// Returns whether outputs say nothing of what they were made of.
    pub(crate) fn is_stripped(&self) -> bool {
        self.carries.is_none()
    }

    /// Returns the bytes of an output's samples.
    pub(crate) fn file_bytes(&self, (width, height): (usize, usize)) -> u64 {
        let samples = (self.channels.count() * self.depth.bytes()) as u64;
        (width as u64).saturating_mul(height as u64).saturating_mul(samples)
    }

    /// Returns how an input file's code values become light.
    pub(crate) fn colours(&self, channels: Channels, depth: Depth, metadata: &Metadata) -> FileColours {
        if let Some(config) = &self.config {
            return FileColours { transfer: Transfer::Linear, conversion: Some(config.input()) };
        }
        let seen = profile::seen(metadata, self.ignores_profiles);
        let transfer = self.input.of(depth, &seen);
        let conversion = self.working.matrix(channels, &seen, &transfer).map(LightConversion::Matrix);
        FileColours { conversion, transfer }
    }

    /// Returns what brings working light to the outputs' colour space, before it is encoded; `None` where nothing has to be done.
    pub(crate) fn output(&self) -> Option<LightConversion> {
        self.config.as_ref().map(|config| config.output())
    }

    /// Returns a colour that was given by name or number, in Rec. 709, as working light.
    pub(crate) fn colour(&self, colour: Rgba) -> Result<Rgba> {
        match &self.config {
            Some(config) => config.colour(colour),
            None => Ok(self.working.colour(colour)),
        }
    }
}

/// Returns the input's channels, with alpha added if the input has it or something must be transparent.
fn channels(
    args: &Conversion,
    headers: &[&Header],
    target: &Target,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Channels> {
    let background = args.background;
    let coloured = |light: Rgba| light.0[0] != light.0[1] || light.0[1] != light.0[2];
    let fill = match args.missing {
        Missing::Error | Missing::Continue(_) => None,
        Missing::Fill(colour) => Some(colour),
    };
    // Light by a formula is coloured.
    let colour = headers.is_empty()
        || args.ocio.is_asked()
        || headers.iter().any(|header| header.channels.is_colour())
        || [background, fill].into_iter().flatten().any(coloured);
    let transparent = args.opacity < 1.0 || [background, fill].into_iter().flatten().any(|light| light.alpha() < 1.0);
    let alpha = transparent || headers.iter().any(|header| header.channels.has_alpha());
    let plain = if colour { Channels::Rgb } else { Channels::Grey };
    let wanted = if alpha { plain.with_alpha() } else { plain };
    let is_deep = headers.iter().map(|header| header.depth).chain(args.depth).any(|depth| depth != Depth::Eight);
    let possible = if wanted.has_alpha() && target.is_video_with_alpha(args, is_deep) {
        Channels::Rgba
    } else {
        target.format.nearest_channels(wanted)
    };
    if wanted.has_alpha() && !possible.has_alpha() {
        if transparent {
            return Err(usage_as(
                Code::OutputFormat,
                format!(
                    "{} files cannot be transparent; write PNG, TIFF, TGA or OpenEXR, or give {BACKGROUND} and {MISSING} an \
                 opaque colour",
                    target.format
                ),
            ));
        }
        let message = format!("{} files hold no alpha: the input's is laid over the background", target.format);
        warnings.push(Diagnostic::warning(Code::AlphaLost, message));
    }
    Ok(possible)
}

/// Returns the deeper of two sample types.
fn deeper(a: Depth, b: Depth) -> Depth {
    let rank = |depth: Depth| Depth::ALL.iter().position(|other| *other == depth);
    if rank(b) > rank(a) { b } else { a }
}

fn depth(args: &Conversion, headers: &[&Header], target: &Target) -> Result<Depth> {
    let Some(asked) = args.depth else {
        if args.light.is_some() {
            // Light is not bounded by white, whatever the input was.
            return Ok(target.format.nearest_depth(Depth::Float));
        }
        let deepest = headers.iter().map(|header| header.depth).fold(Depth::Eight, deeper);
        return Ok(target.format.nearest_depth(deepest));
    };
    if target.format.depths().contains(&asked) {
        return Ok(asked);
    }
    let known: Vec<_> = target.format.depths().iter().map(ToString::to_string).collect();
    let holds = |format: &&Format| format.is_built() && format.depths().contains(&asked);
    let other = Format::ALL.iter().filter(holds).flat_map(|format| format.own_extensions().first());
    let other: Vec<String> = other.map(|extension| format!(".{extension}")).collect();
    Err(usage_as(
        Code::OutputFormat,
        format!(
            "{DEPTH} {asked}: {} files hold {}; leave {DEPTH} out, or name the output {}",
            target.format,
            known.join(", "),
            other.join(" or ")
        ),
    ))
}

/// Returns the output's transfer function: that of an integer input for an integer output, linear for floats.
fn output_transfer(
    args: &Conversion,
    headers: &[&Header],
    side: &InputTransfer,
    (depth, channels, format): (Depth, Channels, Format),
    keeps: impl Fn(&Transfer) -> bool,
    warnings: &mut Vec<Diagnostic>,
) -> Transfer {
    if let Some(out) = &args.out_transfer {
        if let Some(transfer) = out.fixed() {
            return transfer;
        }
    } else if let (Some(transfer), false) = (args.transfer.fixed(), depth.is_float()) {
        return transfer;
    }
    let input = match headers.first() {
        _ if depth.is_float() => return Transfer::Linear,
        Some(header) if !header.depth.is_float() => side.of(header.depth, &header.metadata),
        _ => return Transfer::Srgb,
    };
    // A transfer function that the file cannot name would be taken for sRGB.
    if input == Transfer::Srgb || keeps(&input) {
        return input;
    }
    if let Transfer::Pq | Transfer::Hlg = input {
        let name = if input == Transfer::Pq { "PQ" } else { "HLG" };
        let message = format!(
            "{} {} files cannot name {name}: light is encoded as sRGB, and what is brighter than white, 203 cd/m², is \
             clipped; a format of floats keeps it",
            if channels.is_colour() { "coloured" } else { "grey" },
            format
        );
        warnings.push(Diagnostic::warning(Code::Primaries, message));
    }
    Transfer::Srgb
}

/// Returns the diagnostic that a map's file does not say what its samples are. Where they are plain radiance, it is a note.
fn unsaid(light: &LightSettings, format: Format) -> Diagnostic {
    let unit = match light.normalisation {
        LightNormalisation::Irradiance => "irradiance: a world of 1 gives π",
        LightNormalisation::Radiance => "radiance: a world of 1 gives 1",
    };
    let scale = match light.scale {
        LightScale::Factor(1.0) => String::new(),
        LightScale::Factor(factor) => format!(", times {factor}"),
        LightScale::Fitting => ", times the factor that is told".to_owned(),
    };
    let message = format!("{format} has no place for the unit of a map of light; samples are {unit}{scale}");
    let is_plain = light.normalisation == LightNormalisation::Radiance && scale.is_empty();
    if is_plain { Diagnostic::note(Code::Unit, message) } else { Diagnostic::warning(Code::Unit, message) }
}

fn metadata(
    args: &Conversion,
    headers: &[&Header],
    target: &Target,
    (transfer, working, depth): (&Transfer, &Working, Depth),
    warnings: &mut Vec<Diagnostic>,
) -> Metadata {
    let first = headers.first().map(|header| &header.metadata);
    let icc = first.and_then(|metadata| metadata.icc.clone());
    let goes_along = first.is_some_and(|metadata| profile::is_kept(args, headers, metadata, (transfer, working)));
    let keep = target.format.holds_icc() && goes_along && !depth.is_float();
    if icc.is_some() && !keep {
        let message = "the input's ICC profile is not carried over: the output is encoded differently";
        warnings.push(Diagnostic::warning(Code::ProfileLost, message));
    }
    if let (Some(light), false) = (&args.light, target.format.holds_remarks()) {
        warnings.push(unsaid(light, target.format));
    }
    // Rec. 709 is usual, and is named only where the input names its primaries in the same format.
    let is_named = !working.primaries.is_same(&Primaries::REC709)
        || headers.first().is_some_and(|header| header.format == target.format && header.metadata.primaries.is_some());
    Metadata {
        remarks: args.light.iter().flat_map(LightSettings::remarks).chain(args.remarks.iter().cloned()).collect(),
        transfer: Some(transfer.clone()),
        icc: icc.filter(|_| keep),
        envmap: target.envmap,
        panorama: target.panorama,
        primaries: is_named.then_some(working.primaries),
        white_luminance: working
            .white
            .filter(|_| target.format == Format::Exr && !matches!(transfer, Transfer::Pq | Transfer::Hlg))
            .map(|white| white as f32),
        carried: match first.filter(|_| !args.strip) {
            Some(first) => carried(first, target.format, warnings),
            None => Arc::default(),
        },
        ..Metadata::default()
    }
}
