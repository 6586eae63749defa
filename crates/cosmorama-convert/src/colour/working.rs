use cosmorama::raster::{Channels, ColourMatrix, Depth, Primaries, Rgba, Transfer};
use cosmorama_io::{Format, Header, Metadata};

use crate::diagnostic::{Code, Diagnostic, IN_PRIMARIES, PRIMARIES};
use crate::settings::Conversion;

/// Primaries and white of a job's light, to which the light of every file is brought where it is decoded.
#[derive(Clone, Debug)]
pub(crate) struct Working {
    /// Primaries of the light, which are those of the outputs.
    pub(crate) primaries: Primaries,
    /// Luminance of light 1 in cd/m², where it is known.
    pub(crate) white: Option<f64>,
    /// Primaries of files that name none.
    untagged: Primaries,
}

/// Luminance of light 1 in PQ files (ITU-R BT.2408), as [`Transfer::Pq`] has it.
const PQ_WHITE: f64 = 203.0;

impl Working {
    /// Chooses the primaries: those asked for, else those of the first file, if the format can name them.
    pub(crate) fn choose(
        args: &Conversion,
        headers: &[&Header],
        format: Format,
        warnings: &mut Vec<Diagnostic>,
    ) -> Primaries {
        let untagged = args.in_primaries.unwrap_or(Primaries::REC709);
        if args.in_primaries.is_some() && headers.iter().all(|header| header.metadata.primaries.is_some()) {
            let message = format!("{IN_PRIMARIES} has no effect: it is for files that name no primaries, and all do");
            warnings.push(Diagnostic::warning(Code::NoEffect, message));
        }
        let first = headers.first().map_or(Primaries::REC709, |header| header.metadata.primaries.unwrap_or(untagged));
        let wanted = args.primaries.unwrap_or(first);
        if format.holds_primaries(&wanted) {
            return wanted;
        }
        if args.primaries.is_some() {
            let message = format!("{format} files cannot name primaries: nothing says that these are {wanted}");
            warnings.push(Diagnostic::warning(Code::Primaries, message));
            return wanted;
        }
        let message = format!(
            "{format} files cannot name the input's primaries, {wanted}: its light is converted to {}; to keep them unnamed, \
             give {PRIMARIES}",
            Primaries::REC709
        );
        warnings.push(Diagnostic::warning(Code::Primaries, message));
        Primaries::REC709
    }

    /// Creates the working light of outputs of these primaries and this transfer function. White is as bright as in the
    /// first file, unless the outputs' transfer function says how bright it is.
    pub(crate) fn new(args: &Conversion, primaries: Primaries, out: &Transfer, first: Option<f64>) -> Self {
        let untagged = args.in_primaries.unwrap_or(Primaries::REC709);
        let white = if *out == Transfer::Pq { Some(PQ_WHITE) } else { first };
        Self { primaries, white, untagged }
    }

    /// Returns the matrix from a file's light to working light; `None` where nothing has to be done.
    pub(crate) fn matrix(&self, channels: Channels, metadata: &Metadata, transfer: &Transfer) -> Option<ColourMatrix> {
        let own = metadata.primaries.unwrap_or(self.untagged);
        // Grey is the same in all primaries.
        let matrix =
            if channels.is_colour() { ColourMatrix::between(&own, &self.primaries) } else { ColourMatrix::IDENTITY };
        let factor = match (white_of(metadata, transfer), self.white) {
            (Some(white), Some(working)) => white / working,
            _ => 1.0,
        };
        let matrix = if (factor - 1.0).abs() < 1e-6 { matrix } else { matrix.scaled(factor) };
        (!matrix.is_identity()).then_some(matrix)
    }

    /// Returns a colour that was given by name or number, in Rec. 709, in working primaries.
    pub(crate) fn colour(&self, colour: Rgba) -> Rgba {
        let mut light = [colour];
        let matrix = ColourMatrix::between(&Primaries::REC709, &self.primaries);
        if !matrix.is_identity() {
            matrix.convert(&mut light);
        }
        light[0]
    }
}

/// Returns the luminance of a file's white in cd/m², where it says so.
pub(crate) fn white_of(metadata: &Metadata, transfer: &Transfer) -> Option<f64> {
    if *transfer == Transfer::Pq { Some(PQ_WHITE) } else { metadata.white_luminance.map(f64::from) }
}

/// Returns whether negative light is lost in files of this depth.
pub(crate) fn clips(depth: Depth, format: Format) -> bool {
    !depth.is_float() || format == Format::Hdr
}
