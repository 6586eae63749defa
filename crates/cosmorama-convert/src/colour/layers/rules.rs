//! Content of channels, by their names and types.

use std::collections::HashMap;

use cosmorama_io::{Metadata, NamedChannel, SampleKind};

/// Channels that are filtered together by one rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct LayerGroup {
    /// Channels, in the order that the rule asks for.
    pub(crate) channels: Vec<NamedChannel>,
    /// Content of the channels.
    pub(crate) content: LayerContent,
}

/// Content of channels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum LayerContent {
    /// Light: red, green, blue.
    Light,
    /// Numbers that mix like light: alpha, masks, positions, up to three.
    Numbers,
    /// One distance.
    Depth,
    /// A surface's normal: x, y, z.
    Normal,
    /// Identifiers: all channels of a layer belong to one texel.
    Labels,
}

impl LayerContent {
    /// Returns the content in a word.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Light => "light",
            Self::Numbers => "numbers",
            Self::Depth => "depth",
            Self::Normal => "normals",
            Self::Labels => "labels",
        }
    }
}

/// Returns the content of each of some channels in a word, by their names and types: light, numbers, depth, normals or
/// labels. All channels that belong together must be given at once, with the metadata of their file.
pub fn contents(channels: &[NamedChannel], metadata: &Metadata) -> Vec<(NamedChannel, &'static str)> {
    let groups = grouped(channels, &mattes(metadata)).into_iter();
    groups.flat_map(|group| group.channels.into_iter().map(move |channel| (channel, group.content.word()))).collect()
}

/// Most channels that are filtered at once: the fourth number of a pixel is the part of it that is covered.
const AT_ONCE: usize = 3;

/// Returns the names that a file's attributes give its cryptomattes, whose layers are called `NAME00`, `NAME01`, and so on
/// (Friedman, "Cryptomatte Specification" 1.2.0).
pub(super) fn mattes(metadata: &Metadata) -> Vec<String> {
    let names = metadata.carried.attributes.iter().filter(|attribute| {
        attribute.name.starts_with("cryptomatte/") && attribute.name.ends_with("/name") && attribute.kind == "string"
    });
    names.map(cosmorama_io::Attribute::value).filter(|name| !name.is_empty()).collect()
}

/// Sorts channels into groups, in their order. `mattes` are the names of cryptomattes that names alone do not tell.
pub(crate) fn grouped(channels: &[NamedChannel], mattes: &[String]) -> Vec<LayerGroup> {
    let mut groups = Vec::new();
    let mut numbers: Vec<NamedChannel> = Vec::new();
    let mut layers: Vec<&str> = Vec::new();
    let mut members: HashMap<&str, Vec<&NamedChannel>> = HashMap::new();
    for channel in channels {
        let layer = stem(&channel.name, mattes);
        let of_layer = members.entry(layer).or_default();
        if of_layer.is_empty() {
            layers.push(layer);
        }
        of_layer.push(channel);
    }
    for layer in layers {
        let of_layer = members.remove(layer).unwrap_or_default();
        sort((layer, mattes), of_layer, &mut groups, &mut numbers);
    }
    groups.extend(numbers.chunks(AT_ONCE).map(|some| group(some.iter(), LayerContent::Numbers)));
    groups
}

/// Sorts the channels of one layer into groups. Channels without a rule of their own go to `numbers`.
fn sort(
    (layer, mattes): (&str, &[String]),
    channels: Vec<&NamedChannel>,
    groups: &mut Vec<LayerGroup>,
    numbers: &mut Vec<NamedChannel>,
) {
    let last = base(layer);
    let names_labels = is_cryptomatte(layer, mattes) || is_identifier(last);
    let is_label =
        |channel: &NamedChannel| names_labels || channel.kind == SampleKind::Uint || is_identifier(base(&channel.name));
    let (labels, mut rest): (Vec<_>, Vec<_>) = channels.into_iter().partition(|channel| is_label(channel));
    if names_labels {
        groups.extend((!labels.is_empty()).then(|| group(labels.into_iter(), LayerContent::Labels)));
    } else {
        // Each channel is a label of its own.
        groups.extend(labels.into_iter().map(|label| group([label].into_iter(), LayerContent::Labels)));
    }
    for names in [["X", "Y", "Z"], ["R", "G", "B"]] {
        let Some(vector) = three(&rest, names) else { continue };
        rest.retain(|channel| !vector.contains(channel));
        let content = match (is_normal(last), names[0]) {
            (true, _) => LayerContent::Normal,
            (false, "R") if !is_depth(last) => LayerContent::Light,
            _ if is_depth(last) => {
                groups.extend(vector.into_iter().map(|one| group([one].into_iter(), LayerContent::Depth)));
                continue;
            }
            _ => LayerContent::Numbers,
        };
        groups.push(group(vector.into_iter(), content));
    }
    for channel in rest {
        let name = base(&channel.name);
        let is_alpha = name.eq_ignore_ascii_case("A");
        // Mist is a share from 0 to 1, whatever its channel is called.
        let is_distance = is_depth(name) && !last.eq_ignore_ascii_case("mist") || is_depth(last) && !is_alpha;
        if is_distance {
            groups.push(group([channel].into_iter(), LayerContent::Depth));
        } else {
            numbers.push(channel.clone());
        }
    }
}

fn group<'a>(channels: impl Iterator<Item = &'a NamedChannel>, content: LayerContent) -> LayerGroup {
    LayerGroup { channels: channels.cloned().collect(), content }
}

/// Finds three channels of a layer by their last letters, in this order.
fn three<'a>(channels: &[&'a NamedChannel], names: [&str; 3]) -> Option<Vec<&'a NamedChannel>> {
    let find = |name: &&str| channels.iter().find(|channel| base(&channel.name).eq_ignore_ascii_case(name)).copied();
    names.iter().map(find).collect()
}

/// Returns the layer of a channel's name: `a.b` of `a.b.R`.
fn layer_of(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(layer, _)| layer)
}

/// Returns a channel's name without its layer.
fn base(name: &str) -> &str {
    name.rsplit('.').next().unwrap_or(name)
}

/// Returns the layer of a channel; the layers of a cryptomatte, which rank what one pixel sees, are one.
fn stem<'a>(name: &'a str, mattes: &[String]) -> &'a str {
    let layer = layer_of(name);
    let unnumbered = layer.trim_end_matches(|c: char| c.is_ascii_digit());
    if is_cryptomatte(unnumbered, mattes) { unnumbered } else { layer }
}

fn is_cryptomatte(layer: &str, mattes: &[String]) -> bool {
    base(layer).to_lowercase().contains("crypto") || mattes.iter().any(|matte| matte == layer)
}

/// Returns whether a word names a normal, as renderers do: N, Normal, normals, WorldNormal, shading_normal, Nn, Ng, Ns.
fn is_normal(word: &str) -> bool {
    let word = word.to_lowercase();
    ["n", "nn", "ng", "ns"].contains(&word.as_str()) || word.contains("normal")
}

/// Returns whether a word names a distance.
fn is_depth(word: &str) -> bool {
    let word = word.to_lowercase();
    ["z", "zback", "distance"].contains(&word.as_str()) || word.contains("depth")
}

/// Returns whether a word names identifiers: `id`, `objectId`, `material_id`, `IndexOB`, `labels`; not `solid`.
fn is_identifier(word: &str) -> bool {
    let ends = |end: &str| {
        word.strip_suffix(end).is_some_and(|rest| rest.is_empty() || rest.ends_with(|c: char| !c.is_uppercase()))
    };
    let whole = word.to_lowercase();
    let plain = ["id", "ids", "label", "labels", "indexob", "indexma", "segmentation", "instance", "class"];
    plain.contains(&whole.as_str())
        || [ends("Id"), ends("ID"), ends("IDs"), ends("Ids")].contains(&true)
        || ["_id", "_ids", "-id"].iter().any(|end| whole.ends_with(end))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sorted(names: &[&str]) -> Vec<(LayerContent, String)> {
        let channel = |name: &&str| {
            let kind = if name.starts_with("u:") { SampleKind::Uint } else { SampleKind::Float };
            NamedChannel { name: name.trim_start_matches("u:").to_owned(), kind, is_full: true }
        };
        let channels: Vec<_> = names.iter().map(channel).collect();
        let told = |group: LayerGroup| {
            let names: Vec<_> = group.channels.into_iter().map(|channel| channel.name).collect();
            (group.content, names.join(" "))
        };
        grouped(&channels, &["UserObj".to_owned()]).into_iter().map(told).collect()
    }

    #[test]
    fn names_of_many_renderers() {
        use LayerContent::{Depth, Labels, Light, Normal, Numbers};
        let group = |content, names: &str| (content, names.to_owned());
        // Blender, Arnold, V-Ray and Nuke.
        assert_eq!(
            sorted(&[
                "VL.Depth.Z",
                "VL.Mist.Z",
                "VL.Normal.X",
                "VL.Normal.Y",
                "VL.Normal.Z",
                "VL.IndexOB.X",
                "depth.A"
            ]),
            [
                group(Depth, "VL.Depth.Z"),
                group(Normal, "VL.Normal.X VL.Normal.Y VL.Normal.Z"),
                group(Labels, "VL.IndexOB.X"),
                group(Numbers, "VL.Mist.Z depth.A"),
            ]
        );
        assert_eq!(
            sorted(&[
                "A",
                "N.X",
                "N.Y",
                "N.Z",
                "P.X",
                "P.Y",
                "P.Z",
                "Z",
                "diffuse.A",
                "diffuse.B",
                "diffuse.G",
                "diffuse.R"
            ]),
            [
                group(Depth, "Z"),
                group(Normal, "N.X N.Y N.Z"),
                group(Numbers, "P.X P.Y P.Z"),
                group(Light, "diffuse.R diffuse.G diffuse.B"),
                group(Numbers, "A diffuse.A"),
            ]
        );
        assert_eq!(
            sorted(&[
                "u:count",
                "crypto_object00.A",
                "crypto_object00.R",
                "objectId",
                "solid",
                "normals.b",
                "normals.g",
                "normals.r"
            ]),
            [
                group(Labels, "count"),
                group(Labels, "objectId"),
                group(Labels, "crypto_object00.A crypto_object00.R"),
                group(Normal, "normals.r normals.g normals.b"),
                group(Numbers, "solid"),
            ]
        );
        // Ranks of one cryptomatte; the second is known by its attribute alone.
        assert_eq!(
            sorted(&["crypto00.R", "crypto01.R", "UserObj00.R", "UserObj01.R", "UserObj.R", "User00.R"]),
            [
                group(Labels, "crypto00.R crypto01.R"),
                group(Labels, "UserObj00.R UserObj01.R UserObj.R"),
                group(Numbers, "User00.R"),
            ]
        );
    }
}
