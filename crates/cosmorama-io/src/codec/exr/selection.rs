use cosmorama::raster::{Channels, Depth};
use exr::meta::attribute::SampleType;
use exr::meta::header::Header as Part;

/// The channels of a file that form its picture.
#[derive(Clone, Debug)]
pub(super) struct Selection {
    /// Index of the part in a multi-part file.
    pub(super) part: usize,
    pub(super) channels: Channels,
    pub(super) depth: Depth,
    /// Number of parts that hold such a picture, including this one.
    pub(super) alike: usize,
    /// Names of all other channels.
    pub(super) others: Vec<String>,
    /// Indices of the channels, in the order of a pixel's samples.
    indices: Vec<usize>,
}

impl Selection {
    /// Selects the first part with plain R, G, B or Y; without one, the first with such channels in a layer
    /// (`beauty.R`); without one, the first with a single channel of any name.
    ///
    /// The error describes what was found instead.
    pub(super) fn of(parts: &[Part]) -> Result<Self, String> {
        let plain = |part: &Part| in_layer(part, "");
        let layered = |part: &Part| layers(part).iter().find_map(|layer| in_layer(part, layer));
        let single = |part: &Part| (part.channels.list.len() == 1).then(|| vec![0]);
        let find = |choose: &dyn Fn(&Part) -> Option<Vec<usize>>| {
            let flat = parts.iter().enumerate().filter(|(_, part)| !part.deep);
            flat.into_iter().find_map(|(index, part)| Some((index, choose(part)?)))
        };
        let (part, indices) = find(&plain)
            .or_else(|| find(&layered))
            .or_else(|| find(&single))
            .ok_or_else(|| format!("the channels {}", names(parts).join(", ")))?;
        let alike = parts.iter().filter(|part| !part.deep && plain(part).is_some()).count().max(1);
        Ok(Self { alike, ..Self::checked(parts, part, indices)? })
    }

    /// Selects the two channels of an st map in the first flat part that has such: R and G, else u and v, s and t, or x
    /// and y, plain or in a layer (`forward.u`); else the only two.
    ///
    /// The error describes what was found instead.
    pub(super) fn pair(parts: &[Part]) -> Result<Self, String> {
        const NAMES: [(&str, &str); 4] = [("R", "G"), ("u", "v"), ("s", "t"), ("x", "y")];
        let flat = || parts.iter().enumerate().filter(|(_, part)| !part.deep);
        let named = |part: &Part, names| {
            let all = std::iter::once(String::new()).chain(layers(part));
            all.into_iter().find_map(|layer| pair_in_layer(part, &layer, names))
        };
        let by_name =
            NAMES.into_iter().find_map(|names| flat().find_map(|(index, part)| Some((index, named(part, names)?))));
        let only = || flat().find(|(_, part)| part.channels.list.len() == 2).map(|(index, _)| (index, vec![0, 1]));
        let (part, indices) =
            by_name.or_else(only).ok_or_else(|| format!("the channels {}", names(parts).join(", ")))?;
        Self::checked(parts, part, indices)
    }

    fn checked(parts: &[Part], part: usize, indices: Vec<usize>) -> Result<Self, String> {
        let list = &parts[part].channels.list;
        let names_of = |index: usize| list[index].name.to_string();
        let has_chroma = list.iter().any(|channel| base_name(&channel.name.to_string()) == "RY");
        if has_chroma && indices.len() < 3 {
            return Err("luminance and chroma (Y, RY, BY)".to_owned());
        }
        let mut depth = Depth::Half;
        for &index in &indices {
            let channel = &list[index];
            if channel.sampling.0 != 1 || channel.sampling.1 != 1 {
                return Err(format!("a subsampled channel {}", names_of(index)));
            }
            match channel.sample_type {
                SampleType::F16 => {}
                SampleType::F32 => depth = Depth::Float,
                SampleType::U32 => return Err(format!("integers in channel {}", names_of(index))),
            }
        }
        let channels = Channels::ALL[indices.len() - 1];
        let used = |name: &String| indices.iter().any(|&index| names_of(index) == *name);
        let mut others = names(parts);
        // Parts of the same picture may name their channels alike: only this part's are used.
        others.retain(|name| !used(name));
        Ok(Self { part, channels, depth, alike: 1, others, indices })
    }

    /// Returns the position of a channel among a pixel's samples.
    pub(super) fn slot(&self, channel: usize) -> Option<usize> {
        self.indices.iter().position(|&index| index == channel)
    }
}

fn names(parts: &[Part]) -> Vec<String> {
    parts.iter().flat_map(|part| part.channels.list.iter().map(|channel| channel.name.to_string())).collect()
}

/// Returns the channel's name without its layer: `R` of `beauty.R`.
fn base_name(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

/// Returns the layers' prefixes in the file's order, each with its final point.
fn layers(part: &Part) -> Vec<String> {
    let mut layers: Vec<String> = Vec::new();
    for channel in &part.channels.list {
        let name = channel.name.to_string();
        let layer = name[..name.len() - base_name(&name).len()].to_owned();
        if !layer.is_empty() && !layers.contains(&layer) {
            layers.push(layer);
        }
    }
    layers
}

fn find_in_layer(part: &Part, layer: &str, name: &str) -> Option<usize> {
    let wanted = format!("{layer}{name}");
    part.channels.list.iter().position(|channel| channel.name.to_string().eq_ignore_ascii_case(&wanted))
}

/// Finds two channels of a layer. With a z beside them, x and y are parts of a vector, as in maps of directions.
fn pair_in_layer(part: &Part, layer: &str, (first, second): (&str, &str)) -> Option<Vec<usize>> {
    if first == "x" && find_in_layer(part, layer, "z").is_some() {
        return None;
    }
    Some(vec![find_in_layer(part, layer, first)?, find_in_layer(part, layer, second)?])
}

/// Finds R, G, B or Y of a layer, with A if there is one. With X and Z beside it, Y is part of a vector and not a
/// luminance.
fn in_layer(part: &Part, layer: &str) -> Option<Vec<usize>> {
    let find = |name: &str| find_in_layer(part, layer, name);
    let colour = match (find("R"), find("G"), find("B")) {
        (Some(red), Some(green), Some(blue)) => vec![red, green, blue],
        _ if find("X").is_some() && find("Z").is_some() => return None,
        _ => vec![find("Y")?],
    };
    Some(colour.into_iter().chain(find("A")).collect())
}
