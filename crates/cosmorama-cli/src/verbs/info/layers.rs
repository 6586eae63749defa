use cosmorama_convert::contents;
use cosmorama_io::{Header, Metadata, NamedChannel, SampleKind};
use serde_json::{Map, Value, json};

/// Name for channels outside of any layer.
const NO_LAYER: &str = "(no layer)";

/// Adds the layers of the part that is read, with the types and the content of their channels. If a file has several
/// parts, all of them are added as well.
pub(super) fn add_layers(report: &mut Value, header: &Header) {
    let layers = &header.metadata.layers;
    let is_usual = layers.picture.iter().all(|name| ["R", "G", "B", "Y", "A"].contains(&name.as_str()));
    if layers.further.is_empty() && layers.parts.is_empty() && is_usual {
        return;
    }
    let kind = SampleKind::from(header.depth);
    let own = layers.picture.iter().map(|name| NamedChannel { name: name.clone(), kind, is_full: true });
    let all: Vec<NamedChannel> = own.chain(layers.further.iter().cloned()).collect();
    if let Some(found) = &layers.no_picture {
        report["channels"] = json!(format!("no picture: {found}"));
    } else {
        report["picture"] = json!(layers.picture.join(", "));
    }
    report["layers"] = by_layer(&all, &header.metadata);
    if !layers.parts.is_empty() {
        report["part"] = json!(layers.parts[layers.part].label(layers.part));
        let label = |(index, part): (usize, &cosmorama_io::FilePart)| {
            let channels =
                if part.is_deep { json!("deep: not read") } else { by_layer(&part.channels, &header.metadata) };
            (part.label(index), channels)
        };
        report["parts"] = Value::Object(layers.parts.iter().enumerate().map(label).collect());
    }
}

/// Returns channels by their layers.
fn by_layer(channels: &[NamedChannel], metadata: &Metadata) -> Value {
    let mut layers: Map<String, Value> = Map::new();
    let held = contents(channels, metadata);
    for channel in channels {
        let (layer, name) = channel.name.rsplit_once('.').unwrap_or((NO_LAYER, &channel.name));
        let holds = held.iter().find(|(other, _)| other.name == channel.name).map_or("numbers", |(_, word)| word);
        let layer = layers.entry(layer).or_insert_with(|| json!({}));
        layer[name] = json!({ "type": channel.kind.to_string(), "holds": holds });
    }
    Value::Object(layers)
}
