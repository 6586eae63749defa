//! ICC profiles of inputs: which are ignored, refused, or passed on unchanged.

use std::borrow::Cow;
use std::path::Path;

use cosmorama::raster::Transfer;
use cosmorama_io::{Header, Metadata, ProfileFault};

use super::working::Working;
use crate::diagnostic::{Code, Diagnostic, IGNORE_PROFILE, Result, failed_as};
use crate::input::Input;
use crate::settings::Conversion;

/// Returns the headers of all files, without the profiles that are ignored, and warns about those.
pub(super) fn headers(args: &Conversion, input: &Input, warnings: &mut Vec<Diagnostic>) -> Vec<Header> {
    let headers: Vec<Header> = input.present().map(|(_, header, _)| header.clone()).collect();
    let count = headers.iter().filter(|header| has_profile(&header.metadata)).count();
    if !args.ignore_profile {
        return headers;
    }
    warnings.push(match count {
        0 => Diagnostic::warning(Code::NoEffect, format!("{IGNORE_PROFILE} has no effect: no file has an ICC profile")),
        _ => Diagnostic::warning(Code::ProfileLost, "ICC profiles are ignored: code values are taken for sRGB"),
    });
    let without = |header: Header| Header { metadata: seen(&header.metadata, true).into_owned(), ..header };
    headers.into_iter().map(without).collect()
}

/// Returns whether a file has a profile, if only a damaged one.
fn has_profile(metadata: &Metadata) -> bool {
    metadata.icc.is_some() || metadata.profile_fault.is_some()
}

/// Returns the metadata that count: those without the profile, if it is ignored.
pub(super) fn seen(metadata: &Metadata, ignores_profiles: bool) -> Cow<'_, Metadata> {
    if !ignores_profiles || !has_profile(metadata) {
        return Cow::Borrowed(metadata);
    }
    let bare = Metadata { icc: None, profile_fault: None, transfer: None, primaries: None, ..metadata.clone() };
    Cow::Owned(bare)
}

/// Returns whether the first file's profile describes the outputs, too. A profile of tables does so if no setting
/// changes colours and all files have it.
pub(super) fn is_kept(
    args: &Conversion,
    headers: &[&Header],
    first: &Metadata,
    (transfer, working): (&Transfer, &Working),
) -> bool {
    match &first.profile_fault {
        None => {
            let same_primaries = first.primaries.is_none_or(|primaries| primaries.is_same(&working.primaries));
            first.transfer.as_ref() == Some(transfer) && same_primaries
        }
        Some(ProfileFault::Tables) => {
            let is_asked = args.primaries.is_some()
                || args.in_transfer.is_some()
                || args.out_transfer.is_some()
                || args.transfer.fixed().is_some();
            !is_asked && headers.iter().all(|header| header.metadata.icc == first.icc)
        }
        Some(ProfileFault::Damaged(_)) => false,
    }
}

/// Refuses a file whose profile cannot be applied.
pub(super) fn check(path: &Path, metadata: &Metadata) -> Result<()> {
    let path = path.display();
    match &metadata.profile_fault {
        None => Ok(()),
        Some(ProfileFault::Damaged(reason)) => Err(failed_as(
            Code::Damaged,
            format!(
                "{path}: its ICC profile is damaged: {reason}; to take the code values for sRGB, give {IGNORE_PROFILE}"
            ),
        )),
        Some(ProfileFault::Tables) => Err(failed_as(
            Code::Unsupported,
            format!(
                "{path}: its ICC profile holds tables of colours; expected curves and primaries. Such a profile goes along \
                 unchanged to PNG, JPEG and TIFF where nothing else is asked of colours and all files have it; convert the \
                 file to sRGB first, or give {IGNORE_PROFILE} to take its code values for sRGB"
            ),
        )),
    }
}
