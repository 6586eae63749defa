//! Plan of further channels, which are those beside the picture's own: which the output gets, and by which rules.

use cosmorama::filter::LabelRule;
use cosmorama::raster::{Channels, Rgba};
use cosmorama_io::{Header, Layers, NamedChannel, SampleKind};

use super::rules::{LayerContent, LayerGroup, grouped, mattes};
use crate::settings::{DepthKind, NormalSpace};

/// Channels that the output gets beside the picture's own.
#[derive(Clone, Debug, Default)]
pub(crate) struct LayerPlan {
    /// Groups of further channels.
    pub(crate) groups: Vec<LayerGroup>,
    /// Names of the picture's own channels.
    pub(crate) picture: PictureNames,
    /// Rules by which further channels are filtered.
    pub(crate) rules: LayerRules,
    /// Bytes that may be read at once.
    pub(crate) room: u64,
}

/// Names under which the picture's own channels are written.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) enum PictureNames {
    /// R, G, B, Y and A.
    #[default]
    Usual,
    /// These names.
    Given(Vec<String>),
    /// None. The picture is no light: it is one of the further channels, or stands in for them.
    LeftOut,
}

/// Rules for channels that hold no light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LayerRules {
    /// Rule by which a pixel of labels takes one texel's value.
    pub labels: LabelRule,
    /// Kind of the input's depth; by its projection, unless given.
    pub depth: Option<DepthKind>,
    /// Coordinate frame of normals.
    pub normals: NormalSpace,
}

impl LayerPlan {
    /// Returns whether only a picture with its usual names is made.
    pub(crate) fn is_plain(&self) -> bool {
        self.groups.is_empty() && self.picture == PictureNames::Usual
    }

    /// Returns whether the picture is not written.
    pub(crate) fn leaves_picture_out(&self) -> bool {
        self.picture == PictureNames::LeftOut
    }

    /// Returns whether a file has exactly these further channels.
    pub(crate) fn are_in(&self, header: &Header) -> bool {
        let own = &header.metadata.layers.picture;
        let is_further = |channel: &NamedChannel| self.leaves_picture_out() || !own.contains(&channel.name);
        let mut found = all_channels(header);
        found.retain(is_further);
        let planned: Vec<&NamedChannel> = self.groups.iter().flat_map(|group| &group.channels).collect();
        found.len() == planned.len() && planned.into_iter().all(|channel| found.contains(channel))
    }

    /// Returns the channels of a kind.
    pub(crate) fn of(&self, content: LayerContent) -> Vec<&str> {
        let groups = self.groups.iter().filter(|group| group.content == content);
        groups.flat_map(|group| &group.channels).map(|channel| channel.name.as_str()).collect()
    }

    /// Splits the groups into batches that are read at once, from files of so many pixels together.
    pub(crate) fn batches(&self, pixels: u64) -> Vec<&[LayerGroup]> {
        let (mut batches, mut first, mut bytes) = (Vec::new(), 0, 0);
        for (index, group) in self.groups.iter().enumerate() {
            let more = bytes_of(group).saturating_mul(pixels);
            if index > first && bytes + more > self.room {
                batches.push(&self.groups[first..index]);
                (first, bytes) = (index, 0);
            }
            bytes = more.saturating_add(bytes);
        }
        batches.extend((first < self.groups.len()).then(|| &self.groups[first..]));
        batches
    }

    /// Returns the bytes of the further channels in a file.
    pub(crate) fn file_bytes(&self, (width, height): (usize, usize)) -> u64 {
        let pixel = self.groups.iter().map(bytes_of).fold(0, u64::saturating_add);
        pixel.saturating_mul(width as u64).saturating_mul(height as u64)
    }

    /// Returns the bytes of the largest group in so many pixels: the least that is read at once.
    pub(crate) fn largest_bytes(&self, pixels: u64) -> u64 {
        self.groups.iter().map(bytes_of).max().unwrap_or(0).saturating_mul(pixels)
    }

    /// Returns the bytes that further channels take at once in a frame whose input and outputs have so many pixels: the
    /// channels read together, their numbers while they are filtered, and all channels made.
    pub(crate) fn bytes(&self, input: u64, output: u64) -> u64 {
        if self.groups.is_empty() {
            return 0;
        }
        let read = |batch: &[LayerGroup]| batch.iter().map(bytes_of).fold(0, u64::saturating_add).saturating_mul(input);
        let read = self.batches(input).into_iter().map(read).max().unwrap_or(0);
        let made = self.groups.iter().map(bytes_of).fold(0, u64::saturating_add).saturating_mul(output);
        read.saturating_add(made).saturating_add(input.saturating_mul(size_of::<Rgba>() as u64))
    }

    /// Chooses the channels that all files have. Also returns names of those that some files lack, or have with fewer
    /// samples than pixels.
    pub(crate) fn of_files(headers: &[&Header], channels: Channels, rules: LayerRules) -> (Self, Vec<String>) {
        let Some((first, others)) = headers.split_first() else { return (Self::default(), Vec::new()) };
        let all = |header: &&Header| all_channels(header);
        let others: Vec<Vec<NamedChannel>> = others.iter().map(all).collect();
        let mut left_out: Vec<String> = Vec::new();
        let mut carried = Vec::new();
        let own = &first.metadata.layers;
        let is_data = data_in(first).is_some();
        for channel in all_channels(first) {
            // The picture's own channels are written with the picture.
            if own.picture.contains(&channel.name) && !is_data {
                continue;
            }
            match merged(&channel, &others) {
                Some(channel) => carried.push(channel),
                None => left_out.push(channel.name),
            }
        }
        let known = |name: &String| all_channels(first).iter().any(|channel| channel.name == *name);
        for channel in others.iter().flatten() {
            if !known(&channel.name) && !left_out.contains(&channel.name) {
                left_out.push(channel.name.clone());
            }
        }
        let picture = if is_data { PictureNames::LeftOut } else { names(headers, channels) };
        (Self { groups: grouped(&carried, &mattes(&first.metadata)), picture, rules, room: 0 }, left_out)
    }
}

/// Returns the bytes of a group's samples in a pixel.
fn bytes_of(group: &LayerGroup) -> u64 {
    group.channels.iter().map(|channel| channel.kind.bytes() as u64).sum()
}

/// Returns all channels of a part, including the picture's.
fn all_channels(header: &Header) -> Vec<NamedChannel> {
    let layers = &header.metadata.layers;
    let kind = SampleKind::from(header.depth);
    let own = layers.picture.iter().map(|name| NamedChannel { name: name.clone(), kind, is_full: true });
    own.chain(layers.further.iter().cloned()).collect()
}

/// Returns the content of a file without a picture of light: of channels that form no picture, or of a picture's own
/// channels that hold depth, normals or labels.
pub(super) fn data_in(header: &Header) -> Option<LayerContent> {
    let Layers { picture, no_picture, .. } = &header.metadata.layers;
    if no_picture.is_some() {
        return Some(LayerContent::Numbers);
    }
    let own: Vec<NamedChannel> = all_channels(header).into_iter().take(picture.len()).collect();
    let mut contents = grouped(&own, &mattes(&header.metadata)).into_iter().map(|group| group.content);
    contents.find(|content| !matches!(content, LayerContent::Numbers | LayerContent::Light))
}

/// Returns a channel in the finest of all files' sample types. `None` if some file lacks it, or if integers stand
/// beside floats.
fn merged(channel: &NamedChannel, others: &[Vec<NamedChannel>]) -> Option<NamedChannel> {
    let mut merged = channel.clone();
    for other in others {
        let other = other.iter().find(|other| other.name == channel.name)?;
        merged.is_full &= other.is_full;
        merged.kind = match (merged.kind, other.kind) {
            (one, two) if one == two => one,
            (SampleKind::Uint, _) | (_, SampleKind::Uint) => return None,
            _ => SampleKind::Float,
        };
    }
    merged.is_full.then_some(merged)
}

/// Returns the names for a picture of these channels: those that all files give it, with its layer's alpha where they
/// have none.
fn names(headers: &[&Header], channels: Channels) -> PictureNames {
    let given = |header: &&Header| header.metadata.layers.picture.clone();
    let Some(mut names) = headers.first().map(given).filter(|names| !names.is_empty()) else {
        return PictureNames::Usual;
    };
    let colours = if channels.is_colour() { 3 } else { 1 };
    let alike = headers.iter().all(|header| given(header) == names);
    let has_alpha = headers[0].channels.has_alpha();
    if !alike || names.len() - usize::from(has_alpha) != colours {
        return PictureNames::Usual;
    }
    if channels.has_alpha() && !has_alpha {
        let layer = names[0].rfind('.').map_or("", |point| &names[0][..=point]).to_owned();
        names.push(layer + "A");
    }
    names.truncate(channels.count());
    let usual = ["Y", "R", "G", "B", "A"];
    if names.iter().all(|name| usual.contains(&name.as_str())) {
        PictureNames::Usual
    } else {
        PictureNames::Given(names)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_are_read_together_as_far_as_there_is_room() {
        let channel = |name: &str| NamedChannel { name: name.to_owned(), kind: SampleKind::Float, is_full: true };
        let channels: Vec<_> = ["a.Z", "b.Z", "c.Z", "d.Z"].map(channel).into();
        let plan = |room| LayerPlan { groups: grouped(&channels, &[]), room, ..LayerPlan::default() };
        let sizes = |room| plan(room).batches(10).iter().map(|batch| batch.len()).collect::<Vec<_>>();
        assert_eq!(sizes(1000), [4]);
        assert_eq!(sizes(80), [2, 2]);
        assert_eq!(sizes(120), [3, 1]);
        assert_eq!(sizes(0), [1, 1, 1, 1], "one at least");
        // Two groups read, four made, and the numbers of one.
        assert_eq!(plan(80).bytes(10, 5), 2 * 40 + 4 * 20 + 160);
        assert_eq!(LayerPlan::default().bytes(10, 5), 0);
    }

    #[test]
    fn files_share_the_channels_that_all_have() {
        let channel = |name: &str, kind| NamedChannel { name: name.to_owned(), kind, is_full: true };
        let merge = |one, other| merged(&channel("Z", one), &[vec![channel("Z", other)]]).map(|channel| channel.kind);
        assert_eq!(merge(SampleKind::Half, SampleKind::Half), Some(SampleKind::Half));
        assert_eq!(merge(SampleKind::Half, SampleKind::Float), Some(SampleKind::Float));
        assert_eq!(merge(SampleKind::Uint, SampleKind::Float), None);
        assert_eq!(merged(&channel("Z", SampleKind::Half), &[vec![channel("A", SampleKind::Half)]]), None);
    }
}
