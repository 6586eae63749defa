use roxmltree::{Document, Node};

use super::words::{Words, name};

/// Greatest depth of nesting.
const DEEPEST: usize = 64;

/// Returns the words of an XML file, by their elements.
pub(super) fn words(text: &str) -> Result<Words, String> {
    let document = Document::parse(text.trim_start_matches('\u{feff}').trim_start())
        .map_err(|error| format!("no XML: {error}"))?;
    let mut words = Words::default();
    visit(document.root_element(), &mut Vec::new(), &mut words)?;
    Ok(words)
}

fn visit(node: Node<'_, '_>, path: &mut Vec<String>, words: &mut Words) -> Result<(), String> {
    if path.len() > DEEPEST {
        return Err(format!("nested more than {DEEPEST} deep"));
    }
    path.push(name(node.tag_name().name())?);
    for child in node.children() {
        if child.is_element() {
            visit(child, path, words)?;
        } else {
            child.text().unwrap_or_default().split_whitespace().for_each(|word| words.add(path, word));
        }
    }
    path.pop();
    Ok(())
}
