use cosmorama::filter::{FilterKind, FilterSettings};
use cosmorama_io::Format;

use super::{FileColours, Light};
use crate::diagnostic::{Code, DEPTH, Diagnostic, LABELS, Result, usage, usage_as};
use crate::input::Input;

/// Checks that every value of an input of labels can go to the output unchanged: all inputs and the output are integers
/// of one depth and one encoding. Warns where codes are spread when they are read.
///
/// # Errors
/// When an input holds floats, or something between it and the output would change values.
pub(crate) fn check_labels(
    filter: &FilterSettings,
    input: &Input,
    (light, format): (&Light, Format),
    warnings: &mut Vec<Diagnostic>,
) -> Result<()> {
    if !matches!(filter.kind, FilterKind::Labels(_)) {
        return Ok(());
    }
    if format == Format::Jpeg {
        let message = format!("{LABELS}: JPEG changes values; write PNG, TIFF or TGA");
        return Err(usage_as(Code::OutputFormat, message));
    }
    for (view, header, _) in input.present() {
        let path = view.files.path(None).display().to_string();
        if header.depth.is_float() {
            let holds = format!("{LABELS}: {path} holds {} samples", header.depth);
            return Err(usage(format!("{holds}; labels are integers of 8 or 16 bits")));
        }
        if header.depth != light.depth {
            let found = format!("{LABELS}: {path} has {} bits and the output {}", header.depth, light.depth);
            if !format.depths().contains(&header.depth) {
                return Err(usage_as(Code::OutputFormat, format!("{found}; write PNG or TIFF, which have as many")));
            }
            return Err(usage(format!("{found}; give {DEPTH} {}, and inputs of one depth", header.depth)));
        }
        if header.channels.has_alpha() {
            let message = format!("{LABELS}: {path} has alpha: labels where it is 0 all become transparent black");
            warnings.push(Diagnostic::warning(Code::AlphaOfLabels, message));
        }
        if let Some(codes) = &header.metadata.rescaled {
            let message =
                format!("{LABELS}: the codes of {path} are {codes}: labels are those that they become by full range");
            warnings.push(Diagnostic::warning(Code::Guessed, message));
        }
        let unchanged = FileColours { transfer: light.transfer.clone(), conversion: None };
        if light.colours(header.channels, header.depth, &header.metadata) != unchanged {
            let found = format!("{LABELS}: the output would be encoded otherwise than {path}");
            let remedy = "leave transfer functions and primaries alone, and give inputs of one kind";
            return Err(usage(format!("{found}; {remedy}")));
        }
    }
    Ok(())
}
