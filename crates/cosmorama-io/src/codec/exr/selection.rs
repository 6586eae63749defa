use cosmorama::raster::{Channels, Depth};
use exr::meta::attribute::SampleType;
use exr::meta::header::Header as Part;

use super::offer::{Offer, described, named};
use crate::{Layers, SampleKind};

/// The channels of a file that form its picture.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    /// Index of the part in a multi-part file.
    pub(super) part: usize,
    pub(super) channels: Channels,
    pub(super) depth: Depth,
    /// Names of all other channels.
    pub(super) others: Vec<String>,
    /// Channels beside the picture's, and parts of the file.
    pub(super) layers: Layers,
    /// Whether some of the picture's channels are halves and others floats.
    pub(super) is_mixed: bool,
    /// Indices of the channels, in the order of a pixel's samples.
    indices: Vec<usize>,
}

impl Selection {
    /// Selects the first part with plain R, G, B or Y; without one, the first with such channels in a layer
    /// (`beauty.R`); without one, the first with a single channel of any name.
    ///
    /// The error describes what was found instead.
    pub(super) fn of(parts: &[Part], offers: &[Offer<'_>]) -> Result<Self, String> {
        let plain = |offer: &Offer<'_>| in_layer(offer, "");
        let layered = |offer: &Offer<'_>| layers(offer).iter().find_map(|layer| in_layer(offer, layer));
        let single = |offer: &Offer<'_>| (offer.channels.len() == 1).then(|| offer.channels.clone());
        let find = |choose: &dyn Fn(&Offer<'_>) -> Option<Vec<usize>>| {
            offers.iter().find_map(|offer| Some((offer, choose(offer)?)))
        };
        let (offer, indices) = find(&plain)
            .or_else(|| find(&layered))
            .or_else(|| find(&single))
            .ok_or_else(|| format!("the channels {}", offered(parts, offers).join(", ")))?;
        Self::checked(parts, offer, indices)
    }

    /// Selects one channel, of any type, that stands in for a picture, in the first part that has a full channel.
    /// `found` describes what there is instead of a picture.
    pub(super) fn stand_in(parts: &[Part], offers: &[Offer<'_>], found: String) -> Result<Self, String> {
        let full = |offer: &Offer<'_>, index: usize| named(&offer.part.channels.list[index]).is_full;
        let of = |offer: &Offer<'_>| offer.channels.iter().copied().find(|index| full(offer, *index));
        let (offer, index) = offers.iter().find_map(|offer| Some((offer, of(offer)?))).ok_or_else(|| found.clone())?;
        let list = &offer.part.channels.list;
        let further = offer.channels.iter().map(|index| named(&list[*index])).collect();
        let layers = Layers { no_picture: Some(found), further, picture: Vec::new(), ..layers_of(parts, offer) };
        let depth = if list[index].sample_type == SampleType::F16 { Depth::Half } else { Depth::Float };
        let (part, channels) = (offer.index, Channels::Grey);
        Ok(Self { part, channels, depth, others: names(parts), layers, is_mixed: false, indices: vec![index] })
    }

    /// Selects the two channels of an st map in the first flat part that has such: R and G, else u and v, s and t, or x
    /// and y, plain or in a layer (`forward.u`); else the only two.
    ///
    /// The error describes what was found instead.
    pub(super) fn pair(parts: &[Part]) -> Result<Self, String> {
        const NAMES: [(&str, &str); 4] = [("R", "G"), ("u", "v"), ("s", "t"), ("x", "y")];
        let offers = Offer::all(parts);
        let named = |offer: &Offer<'_>, names| {
            let all = std::iter::once(String::new()).chain(layers(offer));
            all.into_iter().find_map(|layer| pair_in_layer(offer, &layer, names))
        };
        let by_name =
            NAMES.into_iter().find_map(|names| offers.iter().find_map(|offer| Some((offer, named(offer, names)?))));
        let only = || offers.iter().find(|offer| offer.channels.len() == 2).map(|offer| (offer, vec![0, 1]));
        let (offer, indices) =
            by_name.or_else(only).ok_or_else(|| format!("the channels {}", names(parts).join(", ")))?;
        Self::checked(parts, offer, indices)
    }

    fn checked(parts: &[Part], offer: &Offer<'_>, indices: Vec<usize>) -> Result<Self, String> {
        let list = &offer.part.channels.list;
        let name_of = |index: usize| list[index].name.to_string();
        let has_chroma = list.iter().any(|channel| base_name(&channel.name.to_string()) == "RY");
        if has_chroma && indices.len() < 3 {
            return Err("luminance and chroma (Y, RY, BY)".to_owned());
        }
        let mut depth = Depth::Half;
        for &index in &indices {
            let channel = named(&list[index]);
            if !channel.is_full {
                return Err(format!("a subsampled channel {}", channel.name));
            }
            match channel.kind {
                SampleKind::Half => {}
                SampleKind::Float => depth = Depth::Float,
                SampleKind::Uint => return Err(format!("integers in channel {}", channel.name)),
            }
        }
        let is_half = |index: &usize| list[*index].sample_type == SampleType::F16;
        let is_mixed = depth == Depth::Float && indices.iter().any(is_half);
        let channels = Channels::ALL[indices.len() - 1];
        let used = |name: &String| indices.iter().any(|&index| name_of(index) == *name);
        let mut others = names(parts);
        // Parts of one picture may have channels of the same name, of which only this part's are used.
        others.retain(|name| !used(name));
        let further = offer.channels.iter().filter(|index| !indices.contains(index));
        let further = further.map(|index| named(&list[*index])).collect();
        let picture = indices.iter().map(|index| name_of(*index)).collect();
        let layers = Layers { picture, further, ..layers_of(parts, offer) };
        Ok(Self { part: offer.index, channels, depth, others, layers, is_mixed, indices })
    }

    /// Returns the position of a channel among a pixel's samples.
    pub(super) fn slot(&self, channel: usize) -> Option<usize> {
        self.indices.iter().position(|&index| index == channel)
    }
}

/// Describes the parts of a file, of which one is offered.
fn layers_of(parts: &[Part], offer: &Offer<'_>) -> Layers {
    let parts = if parts.len() > 1 { described(parts) } else { Vec::new() };
    Layers { parts, part: offer.index, ..Layers::default() }
}

/// Returns the names of the channels that are offered, or of all channels if none is offered.
fn offered(parts: &[Part], offers: &[Offer<'_>]) -> Vec<String> {
    if offers.is_empty() { names(parts) } else { offers.iter().flat_map(Offer::names).collect() }
}

fn names(parts: &[Part]) -> Vec<String> {
    parts.iter().flat_map(|part| part.channels.list.iter().map(|channel| channel.name.to_string())).collect()
}

/// Returns the channel's name without its layer: `R` of `beauty.R`.
fn base_name(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

/// Returns the layers' prefixes in the file's order, each with its final point.
fn layers(offer: &Offer<'_>) -> Vec<String> {
    let mut layers: Vec<String> = Vec::new();
    for index in &offer.channels {
        let name = offer.part.channels.list[*index].name.to_string();
        let layer = name[..name.len() - base_name(&name).len()].to_owned();
        if !layer.is_empty() && !layers.contains(&layer) {
            layers.push(layer);
        }
    }
    layers
}

fn find_in_layer(offer: &Offer<'_>, layer: &str, name: &str) -> Option<usize> {
    let wanted = format!("{layer}{name}");
    let list = &offer.part.channels.list;
    offer.channels.iter().copied().find(|index| list[*index].name.to_string().eq_ignore_ascii_case(&wanted))
}

/// Finds two channels of a layer. With a z beside them, x and y are parts of a vector, as in maps of directions.
fn pair_in_layer(offer: &Offer<'_>, layer: &str, (first, second): (&str, &str)) -> Option<Vec<usize>> {
    if first == "x" && find_in_layer(offer, layer, "z").is_some() {
        return None;
    }
    Some(vec![find_in_layer(offer, layer, first)?, find_in_layer(offer, layer, second)?])
}

/// Finds R, G, B or Y of a layer, with A if there is one. With X and Z beside it, Y is part of a vector and not a
/// luminance.
fn in_layer(offer: &Offer<'_>, layer: &str) -> Option<Vec<usize>> {
    let find = |name: &str| find_in_layer(offer, layer, name);
    let colour = match (find("R"), find("G"), find("B")) {
        (Some(red), Some(green), Some(blue)) => vec![red, green, blue],
        _ if find("X").is_some() && find("Z").is_some() => return None,
        _ => vec![find("Y")?],
    };
    Some(colour.into_iter().chain(find("A")).collect())
}
