use yaml_rust2::parser::{Event, Parser};

use super::words::{Words, name};

/// Greatest depth of nesting.
const DEEPEST: usize = 64;

/// An open collection of a YAML (or JSON) file.
enum Open {
    Sequence,
    /// A mapping, and whether its next scalar is a name.
    Mapping {
        name_is_next: bool,
    },
}

/// Returns the words of a YAML file; a JSON file is one, too.
pub(super) fn words(text: &str) -> Result<Words, String> {
    let mut reader = Reader::default();
    let body = without_directive(text);
    let mut parser = Parser::new_from_str(&body);
    loop {
        let (event, mark) = parser
            .next_token()
            .map_err(|error| format!("no calibration by OpenCV (YAML, JSON or XML) or OCamCalib; as YAML: {error}"))?;
        match event {
            Event::StreamEnd => return Ok(reader.words),
            event => reader.read(event, mark.line()).map_err(|reason| format!("line {}: {reason}", mark.line()))?,
        }
    }
}

/// Replaces OpenCV's first line `%YAML:1.0`, which is not valid YAML.
fn without_directive(text: &str) -> String {
    match text.split_once('\n') {
        Some((first, rest)) if first.starts_with("%YAML:") => format!("\n{rest}"),
        _ => text.to_owned(),
    }
}

#[derive(Default)]
struct Reader {
    words: Words,
    open: Vec<Open>,
    /// Names of the open mappings, from the outermost to the innermost.
    path: Vec<String>,
}

impl Reader {
    fn read(&mut self, event: Event, line: usize) -> Result<(), String> {
        match event {
            Event::Alias(_) => return Err("an alias (*NAME); write the values themselves".to_owned()),
            Event::Scalar(text, ..) => self.scalar(text, line)?,
            Event::SequenceStart(..) | Event::MappingStart(..) if self.name_is_next() => {
                return Err("a name that is a list or a mapping; expected a word".to_owned());
            }
            Event::SequenceStart(..) => self.open.push(Open::Sequence),
            Event::MappingStart(..) => self.open.push(Open::Mapping { name_is_next: true }),
            Event::SequenceEnd | Event::MappingEnd => {
                self.open.pop();
                self.value_is_complete();
            }
            _ => {}
        }
        if self.open.len() > DEEPEST {
            return Err(format!("nested more than {DEEPEST} deep"));
        }
        Ok(())
    }

    fn name_is_next(&self) -> bool {
        matches!(self.open.last(), Some(Open::Mapping { name_is_next: true }))
    }

    fn scalar(&mut self, text: String, line: usize) -> Result<(), String> {
        if let Some(Open::Mapping { name_is_next }) = self.open.last_mut()
            && *name_is_next
        {
            *name_is_next = false;
            self.path.push(name(&text)?);
            return Ok(());
        }
        self.words.add(&self.path, &text, line);
        self.value_is_complete();
        Ok(())
    }

    fn value_is_complete(&mut self) {
        if let Some(Open::Mapping { name_is_next }) = self.open.last_mut() {
            *name_is_next = true;
            self.path.pop();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nested_lists_are_laid_flat() {
        let found = words("{\"a\": {\"K\": [[1, 2], [3, 4]], \"n\": 5}, \"b\": 6}").expect("JSON");
        let of = |name: &str| {
            let (path, words) = found.find(&[name]).expect("a name");
            (path, words.iter().map(|word| word.text.as_str()).collect::<Vec<_>>())
        };
        assert_eq!(of("k"), ("a.k", vec!["1", "2", "3", "4"]));
        assert_eq!(of("n"), ("a.n", vec!["5"]));
        assert_eq!(of("b"), ("b", vec!["6"]));
    }

    #[test]
    fn what_never_ends_is_refused() {
        assert!(words(&"[".repeat(100_000)).is_err());
        assert!(words(&"- ".repeat(5000)).is_err_and(|error| error.contains("nested")));
        assert!(words("? [a, b]\n: 1\n").is_err_and(|error| error.contains("a name that is a list")));
        assert!(words("a: &x [1]\nb: *x\n").is_err_and(|error| error.contains("line 2")));
    }
}
