use cosmorama::filter::{FilterKind, FilterSettings, Kernel, Labels};
use cosmorama_io::{Compression, Format, WriteOptions};

use crate::colour::Light;
use crate::diagnostic::{
    ANTI_RINGING, COMPRESSION, Code, Diagnostic, FILTER, IN_TRANSFER, KERNEL, OUT_TRANSFER, QUALITY, Result, TRANSFER,
    usage,
};
use crate::job::Outputs;
use crate::settings::{Conversion, GeometrySettings};

/// Checks that every file option has an effect on this format; otherwise another format or option was intended.
pub(crate) fn check_file_options(settings: &Conversion, format: Format) -> Result<()> {
    let output = &settings.output;
    if settings.quality.is_some() && format != Format::Jpeg {
        return Err(usage(format!(
            "{QUALITY} is for JPEG, but {output} is {format}; leave it out, or name the output .jpg"
        )));
    }
    if settings.compression.is_some() && (!format.has_compression() || settings.st_map) {
        let what = if settings.st_map { "an st map".to_owned() } else { format.to_string() };
        let instead = if format == Format::Jpeg { format!(", or choose a {QUALITY}") } else { String::new() };
        return Err(usage(format!(
            "{COMPRESSION} is for pictures in PNG, TIFF and OpenEXR, but {output} is {what}; leave it out{instead}"
        )));
    }
    if settings.transfer.fixed().is_some() && settings.in_transfer.is_some() && settings.out_transfer.is_some() {
        return Err(usage(format!(
            "{TRANSFER} has no effect beside {IN_TRANSFER} and {OUT_TRANSFER}; leave it or one of them out"
        )));
    }
    Ok(())
}

/// Returns the options for writing outputs. PNG sequences are written for speed by default, because their frames are
/// many and are read again.
pub(crate) fn write_options(settings: &Conversion, format: Format, outputs: &Outputs, light: &Light) -> WriteOptions {
    let default = WriteOptions::default();
    let usual = if format == Format::Png && outputs.is_sequence() { Compression::Fast } else { default.compression };
    WriteOptions {
        quality: settings.quality.unwrap_or(default.quality),
        compression: settings.compression.unwrap_or(usual),
        metadata: light.metadata.clone(),
        unfinished: settings.unfinished.clone(),
        ..default
    }
}

/// Returns the requested filter.
pub(crate) fn filter(geometry: &GeometrySettings, warnings: &mut Vec<Diagnostic>) -> FilterSettings {
    let (kind, kernel) = (geometry.filter.0, geometry.kernel.kernel);
    if let FilterKind::Labels(_) = kind {
        return FilterSettings { kind, kernel: Labels::KERNEL, anti_ringing: false };
    }
    let is_kernel_idle = kernel != Kernel::ADAPTIVE && !kind.uses_kernel(&kernel);
    if is_kernel_idle || (geometry.anti_ringing.is_some() && !kind.uses_anti_ringing()) {
        let without = match kind {
            FilterKind::Classic(_) => geometry.filter.to_string(),
            _ => "point and bilinear".to_owned(),
        };
        let message = format!("{KERNEL} and {ANTI_RINGING} have no effect on {FILTER} {without}");
        warnings.push(Diagnostic::warning(Code::NoEffect, message));
    }
    FilterSettings { kind, kernel, anti_ringing: geometry.anti_ringing.unwrap_or(geometry.kernel.anti_ringing) }
}
