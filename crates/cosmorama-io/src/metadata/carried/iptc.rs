//! IPTC metadata, which are not carried: whether they name the picture's author or owner.

/// Name of metadata that name the author or the owner.
pub(crate) const OF_OWNER: &str = "IPTC with the author's or owner's name";

/// Beginnings of the fields that do (IPTC-NAA Information Interchange Model 4, 2:80, 2:110 and 2:116): By-line, Credit and
/// CopyrightNotice.
const OWNERS: [&[u8]; 3] = [&[0x1c, 2, 80], &[0x1c, 2, 110], &[0x1c, 2, 116]];

/// Returns what to call a block of IPTC metadata.
pub(crate) fn kind(block: &[u8]) -> &'static str {
    let names_owner = block.windows(3).any(|start| OWNERS.contains(&start));
    if names_owner { OF_OWNER } else { "IPTC" }
}
