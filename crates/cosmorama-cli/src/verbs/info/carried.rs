//! Report of `info` on attributes, texts, Exif and XMP.

use cosmorama_io::Carried;
use serde_json::{Map, Value, json};

/// Adds the metadata of a file, except those of its pixels and colours, in a section for each kind.
pub(super) fn add(report: &mut Value, carried: &Carried) {
    let attributes = carried.attributes.iter().filter(|attribute| !attribute.is_storage());
    let texts = carried.texts.iter();
    let sections: [(&str, Vec<(String, String)>); 4] = [
        ("attributes", attributes.map(|attribute| (attribute.name.clone(), attribute.value())).collect()),
        ("text", texts.map(|text| (text.keyword(), text.text().unwrap_or_else(|| "damaged".to_owned()))).collect()),
        ("exif", carried.exif.as_ref().map(|exif| exif.told()).unwrap_or_default()),
        ("xmp", carried.xmp()),
    ];
    for (name, entries) in sections.into_iter().filter(|(_, entries)| !entries.is_empty()) {
        let mut section = Map::new();
        for (key, value) in entries {
            // Control characters of a file would be commands to a terminal.
            let value: String = value.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect();
            section.entry(key).or_insert_with(|| json!(value.trim_end()));
        }
        report[name] = Value::Object(section);
    }
    if !carried.unread.is_empty() {
        report["not_read"] = json!(carried.unread);
    }
}
