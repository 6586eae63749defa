/// The content of a file of names and values, nested or not: the words under each path of names.
#[derive(Debug, Default, PartialEq)]
pub(super) struct Words(Vec<(String, Vec<Word>)>);

/// A word, and its line in the file, from 1.
#[derive(Debug, PartialEq)]
pub(super) struct Word {
    pub(super) text: String,
    pub(super) line: usize,
}

impl Words {
    /// Adds a word of a line under a path of [`name`]s.
    pub(super) fn add(&mut self, path: &[String], word: &str, line: usize) {
        let path = path.join(".");
        let word = Word { text: word.to_owned(), line };
        match self.0.last_mut().filter(|(last, _)| *last == path) {
            Some((_, words)) => words.push(word),
            None => self.0.push((path, vec![word])),
        }
    }

    /// Finds the words under the first of some names that occurs, or under its `data`, at any depth. Names are
    /// normalised as by [`name`].
    pub(super) fn find(&self, names: &[&str]) -> Option<(&str, &[Word])> {
        let is = |path: &str, name: &str| {
            let path = path.strip_suffix(".data").unwrap_or(path);
            path == name || path.strip_suffix(name).is_some_and(|outer| outer.ends_with('.'))
        };
        let found = names.iter().find_map(|name| self.0.iter().find(|(path, _)| is(path, name)));
        found.map(|(path, words)| (path.as_str(), words.as_slice()))
    }
}

/// Greatest length of a name in bytes.
const LONGEST: usize = 256;

/// Normalises a name: `cameraMatrix`, `camera_matrix` and `Camera_Matrix` become equal.
///
/// # Errors
/// When the name is too long. Each word repeats the names above it, so that long names would take much memory.
pub(super) fn name(text: &str) -> Result<String, String> {
    if text.len() > LONGEST {
        return Err(format!("a name of {} bytes; expected a calibration's names", text.len()));
    }
    Ok(text.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_found_however_they_are_written_and_nested() {
        let mut words = Words::default();
        let path = |names: &[&str]| names.iter().map(|text| name(text).expect("short")).collect::<Vec<_>>();
        for word in ["1", "2"] {
            words.add(&path(&["opencv_storage", "Camera_Matrix", "data"]), word, 3);
        }
        words.add(&path(&["mask"]), "7", 4);
        let word = |text: &str| Word { text: text.to_owned(), line: 3 };
        assert_eq!(words.find(&["k", "cameramatrix"]).map(|(_, words)| words), Some(&[word("1"), word("2")][..]));
        assert_eq!(words.find(&["matrix"]), None);
        assert!(name(&"k".repeat(1000)).is_err());
    }
}
