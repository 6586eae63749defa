use std::ffi::{OsStr, OsString};
use std::fmt::{Display, Formatter};
use std::ops::Deref;
use std::path::{Path, PathBuf};

use cosmorama_io::{FacePattern, FramePattern};

use crate::diagnostic::{Result, usage};

/// Name of an input or an output: a file, a pattern, or a word such as `builtin:demo`.
///
/// It is text where it is that, and dereferences to it. A file whose name is no UTF-8 has a text for messages alone, in which bytes that are
/// none of it have a sign in their place.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Name {
    path: PathBuf,
    text: String,
}

impl Name {
    /// Returns the path that it is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the name in which some text is replaced. One that is no UTF-8 stays as it is.
    pub(crate) fn replacing(&self, from: &str, to: &str) -> Self {
        if self.path.to_str().is_some() { self.text.replace(from, to).into() } else { self.clone() }
    }

    /// Refuses marks for frames and faces in a name that is no UTF-8, unless it is that of a file: what they stand for could not be found.
    pub(crate) fn check(&self) -> Result<()> {
        let is_pattern = FramePattern::parse(self).is_some() || FacePattern::parse(self).is_some();
        if self.path.to_str().is_none() && is_pattern && !self.path.is_file() {
            return Err(usage(format!(
                "{self}: its bytes are no UTF-8, so that it can be the name of one file, but no pattern; rename the files, or the folder"
            )));
        }
        Ok(())
    }
}

impl Deref for Name {
    type Target = str;

    fn deref(&self) -> &str {
        &self.text
    }
}

impl Display for Name {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.text)
    }
}

impl From<PathBuf> for Name {
    fn from(path: PathBuf) -> Self {
        Self { text: path.to_string_lossy().into_owned(), path }
    }
}

impl From<OsString> for Name {
    fn from(name: OsString) -> Self {
        PathBuf::from(name).into()
    }
}

impl From<&Path> for Name {
    fn from(path: &Path) -> Self {
        path.to_owned().into()
    }
}

impl From<String> for Name {
    fn from(text: String) -> Self {
        Self { path: PathBuf::from(&text), text }
    }
}

impl From<&String> for Name {
    fn from(text: &String) -> Self {
        text.as_str().into()
    }
}

impl From<&str> for Name {
    fn from(text: &str) -> Self {
        text.to_owned().into()
    }
}

impl AsRef<OsStr> for Name {
    fn as_ref(&self) -> &OsStr {
        self.path.as_os_str()
    }
}
