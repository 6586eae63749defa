use roxmltree::{Document, Node};

use super::words::{Words, name};

/// Greatest depth of nesting.
const DEEPEST: usize = 64;

/// Returns the words of an XML file, by their elements.
pub(super) fn words(text: &str) -> Result<Words, String> {
    let document = Document::parse(text.trim_start_matches('\u{feff}').trim_start())
        .map_err(|error| format!("no XML: {error}"))?;
    let mut words = Words::default();
    let mut lines = Lines { text: document.input_text(), at: 0, line: 1 };
    visit(document.root_element(), &mut Vec::new(), &mut lines, &mut words)?;
    Ok(words)
}

/// Counter of the lines of a text, which is read once from its beginning.
struct Lines<'a> {
    text: &'a str,
    at: usize,
    line: usize,
}

impl Lines<'_> {
    /// Returns the line of a place behind those that were asked for before.
    fn of(&mut self, place: usize) -> usize {
        let passed = self.text.as_bytes().get(self.at..place).unwrap_or_default();
        self.line += passed.iter().filter(|byte| **byte == b'\n').count();
        self.at = place;
        self.line
    }
}

fn visit(node: Node<'_, '_>, path: &mut Vec<String>, lines: &mut Lines<'_>, words: &mut Words) -> Result<(), String> {
    if path.len() > DEEPEST {
        return Err(format!("nested more than {DEEPEST} deep"));
    }
    path.push(name(node.tag_name().name())?);
    for child in node.children() {
        if child.is_element() {
            visit(child, path, lines, words)?;
        } else {
            let first = lines.of(child.range().start);
            for (line, text) in child.text().unwrap_or_default().lines().enumerate() {
                text.split_whitespace().for_each(|word| words.add(path, word, first + line));
            }
        }
    }
    path.pop();
    Ok(())
}
