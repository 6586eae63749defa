//! Parts and channels of a file among which a [`Choice`] lets the reader select.

use std::path::Path;

use exr::meta::attribute::{ChannelDescription, SampleType};
use exr::meta::header::Header as Part;

use crate::header::matches;
use crate::{Choice, FilePart, IoError, NamedChannel, SampleKind};

/// Channels of a part that may be read.
pub(super) struct Offer<'a> {
    /// Index of the part.
    pub(super) index: usize,
    /// The part.
    pub(super) part: &'a Part,
    /// Indices of the channels.
    pub(super) channels: Vec<usize>,
}

impl<'a> Offer<'a> {
    /// Lists what every flat part of a file offers.
    pub(super) fn all(parts: &'a [Part]) -> Vec<Self> {
        let flat = parts.iter().enumerate().filter(|(_, part)| !part.deep);
        flat.map(|(index, part)| Self { index, part, channels: (0..part.channels.list.len()).collect() }).collect()
    }

    /// Lists the parts and channels that a choice permits: a single part if the choice names a part or channels.
    pub(super) fn chosen(path: &Path, parts: &'a [Part], choice: &Choice) -> Result<Vec<Self>, IoError> {
        let mut offers = Self::all(parts);
        if let Some(wanted) = &choice.part {
            let index = part_named(path, parts, wanted)?;
            offers.retain(|offer| offer.index == index);
        }
        if choice.channels.is_empty() {
            return Ok(offers);
        }
        let lacks = |offer: &Self, pattern: &String| !offer.names().any(|name| matches(pattern, &name));
        let has_all = |offer: &&mut Self| !choice.channels.iter().any(|pattern| lacks(offer, pattern));
        if let Some(offer) = offers.iter_mut().find(has_all) {
            offer.restrict(path, choice)?;
            let Self { index, part, channels } = offer;
            return Ok(vec![Self { index: *index, part, channels: std::mem::take(channels) }]);
        }
        let missing = choice.channels.iter().find(|pattern| offers.iter().all(|offer| lacks(offer, pattern)));
        Err(IoError::NoSuchChannel {
            path: path.to_owned(),
            asked: missing.map_or_else(|| format!("{} in one part", choice.channels.join(", ")), Clone::clone),
            existing: offers.iter().flat_map(Self::names).collect::<Vec<_>>().join(", "),
        })
    }

    /// Removes the channels that a choice does not name. Each remaining channel may be named only once.
    fn restrict(&mut self, path: &Path, choice: &Choice) -> Result<(), IoError> {
        for name in self.names() {
            let mut naming = choice.channels.iter().filter(|pattern| matches(pattern, &name));
            if let (Some(first), Some(second)) = (naming.next(), naming.next()) {
                let (first, second) = (first.clone(), second.clone());
                return Err(IoError::ChannelTwice { path: path.to_owned(), channel: name, first, second });
            }
        }
        let list = &self.part.channels.list;
        self.channels.retain(|index| choice.takes(&list[*index].name.to_string()));
        Ok(())
    }

    /// Visits the names of the channels.
    pub(super) fn names(&self) -> impl Iterator<Item = String> + use<'_> {
        self.channels.iter().map(|index| self.part.channels.list[*index].name.to_string())
    }
}

/// Finds a part by its name, else by its number.
fn part_named(path: &Path, parts: &[Part], wanted: &str) -> Result<usize, IoError> {
    let by_name = || parts.iter().position(|part| name(part).is_some_and(|name| name == wanted));
    let by_number = || wanted.parse().ok().filter(|index| *index < parts.len());
    let found = by_name().or_else(by_number);
    found.filter(|index| !parts[*index].deep).ok_or_else(|| {
        let flat = described(parts).into_iter().enumerate().filter(|(_, part)| !part.is_deep);
        let existing = flat.map(|(index, part)| part.label(index)).collect::<Vec<_>>().join(", ");
        IoError::NoSuchPart { path: path.to_owned(), asked: wanted.to_owned(), existing }
    })
}

fn name(part: &Part) -> Option<String> {
    part.own_attributes.layer_name.as_ref().map(ToString::to_string)
}

/// Describes the parts of a file.
pub(super) fn described(parts: &[Part]) -> Vec<FilePart> {
    let describe = |part: &Part| FilePart {
        name: name(part),
        channels: part.channels.list.iter().map(named).collect(),
        is_deep: part.deep,
    };
    parts.iter().map(describe).collect()
}

/// Describes a channel.
pub(super) fn named(channel: &ChannelDescription) -> NamedChannel {
    let kind = match channel.sample_type {
        SampleType::F16 => SampleKind::Half,
        SampleType::F32 => SampleKind::Float,
        SampleType::U32 => SampleKind::Uint,
    };
    NamedChannel { name: channel.name.to_string(), kind, is_full: (channel.sampling.0, channel.sampling.1) == (1, 1) }
}
