use cosmorama::raster::{Channels, Depth, Rgba, Transfer};
use cosmorama_io::{Header, Metadata};
use cosmorama_spec::{Missing, TransferName};

use crate::diagnostic::{BACKGROUND, Code, DEPTH, Diagnostic, MISSING, Result, usage_as};
use crate::input::Input;
use crate::settings::Conversion;
use crate::target::Target;

/// Transfer functions of inputs and outputs, and the outputs' channels and depth.
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
    /// Colour outside the lens.
    pub(crate) background: Rgba,
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
            return self.all.clone().unwrap_or(Transfer::Linear);
        }
        self.integers.clone().or_else(|| metadata.transfer.clone()).unwrap_or_default()
    }
}

impl Light {
    pub(crate) fn resolve(
        args: &Conversion,
        input: &Input,
        target: &Target,
        warnings: &mut Vec<Diagnostic>,
    ) -> Result<Self> {
        let headers: Vec<&Header> = input.present().map(|(_, header, _)| header).collect();
        let channels = channels(args, &headers, target, warnings)?;
        let depth = depth(args, &headers, target)?;
        let side = InputTransfer::new(&args.transfer, args.in_transfer.as_ref());
        let transfer = output_transfer(args, &headers, &side, depth, target);
        let metadata = metadata(&headers, target, &transfer, depth, warnings);
        let background = args.background;
        let default = if channels.has_alpha() { Rgba::TRANSPARENT } else { Rgba::BLACK };
        Ok(Self {
            input: side,
            input_alpha: headers.iter().any(|header| header.channels.has_alpha()),
            channels,
            depth,
            transfer,
            metadata,
            background: background.unwrap_or(default),
        })
    }

    /// Returns the bytes of an output's samples.
    pub(crate) fn file_bytes(&self, (width, height): (usize, usize)) -> u64 {
        let samples = (self.channels.count() * self.depth.bytes()) as u64;
        (width as u64).saturating_mul(height as u64).saturating_mul(samples)
    }

    /// Returns the transfer function of an input file.
    pub(crate) fn input_transfer(&self, depth: Depth, metadata: &Metadata) -> Transfer {
        self.input.of(depth, metadata)
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
        Missing::Error => None,
        Missing::Fill(colour) => Some(colour),
    };
    // Light that comes from no file is coloured.
    let colour = headers.is_empty()
        || headers.iter().any(|header| header.channels.is_colour())
        || [background, fill].into_iter().flatten().any(coloured);
    let transparent = [background, fill].into_iter().flatten().any(|light| light.alpha() < 1.0);
    let alpha = transparent || headers.iter().any(|header| header.channels.has_alpha());
    let plain = if colour { Channels::Rgb } else { Channels::Grey };
    let wanted = if alpha { plain.with_alpha() } else { plain };
    let possible = target.format.nearest_channels(wanted);
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

fn depth(args: &Conversion, headers: &[&Header], target: &Target) -> Result<Depth> {
    let Some(asked) = args.depth else {
        if args.light.is_some() {
            // Light is not bounded by white, whatever the input was.
            return Ok(target.format.nearest_depth(Depth::Float));
        }
        let rank = |depth: &Depth| Depth::ALL.iter().position(|other| other == depth);
        let deepest = headers.iter().map(|header| header.depth).max_by_key(rank).unwrap_or(Depth::Eight);
        return Ok(target.format.nearest_depth(deepest));
    };
    if target.format.depths().contains(&asked) {
        return Ok(asked);
    }
    let known: Vec<_> = target.format.depths().iter().map(ToString::to_string).collect();
    Err(usage_as(Code::OutputFormat, format!("{DEPTH} {asked}: {} files hold {}", target.format, known.join(", "))))
}

/// Returns the output's transfer function: that of an integer input for an integer output, linear for floats.
fn output_transfer(
    args: &Conversion,
    headers: &[&Header],
    side: &InputTransfer,
    depth: Depth,
    target: &Target,
) -> Transfer {
    if let Some(out) = &args.out_transfer {
        if let Some(transfer) = out.fixed() {
            return transfer;
        }
    } else if let (Some(transfer), false) = (args.transfer.fixed(), depth.is_float()) {
        return transfer;
    }
    match headers.first() {
        _ if depth.is_float() => Transfer::Linear,
        Some(header) if !header.depth.is_float() => match side.of(header.depth, &header.metadata) {
            // What the file cannot say of itself would be taken for sRGB.
            Transfer::Curve(_) if target.format.holds_icc() => side.of(header.depth, &header.metadata),
            transfer if transfer != Transfer::Srgb && !target.format.names_transfer() => Transfer::Srgb,
            transfer => transfer,
        },
        _ => Transfer::Srgb,
    }
}

fn metadata(
    headers: &[&Header],
    target: &Target,
    transfer: &Transfer,
    depth: Depth,
    warnings: &mut Vec<Diagnostic>,
) -> Metadata {
    let first = headers.first().map(|header| &header.metadata);
    let icc = first.and_then(|metadata| metadata.icc.clone());
    // The profile goes along while its own curve is what the output is encoded with.
    let same_curve = first.is_some_and(|metadata| metadata.transfer.as_ref() == Some(transfer));
    let keep = target.format.holds_icc() && same_curve && !depth.is_float();
    if icc.is_some() && !keep {
        let message = "the input's ICC profile is not carried over: the output is encoded differently";
        warnings.push(Diagnostic::warning(Code::ProfileLost, message));
    }
    Metadata {
        transfer: Some(transfer.clone()),
        icc: icc.filter(|_| keep),
        envmap: target.envmap,
        panorama: target.panorama,
        complaints: Vec::new(),
        notes: Vec::new(),
        other_channels: Vec::new(),
        primaries: first.and_then(|metadata| metadata.primaries),
        orientation: None,
        software: Some(concat!("cosmorama ", env!("CARGO_PKG_VERSION")).to_owned()),
    }
}
