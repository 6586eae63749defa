use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use data_url::DataUrl;
use gltf::Document;
use gltf::buffer::{Buffer, Source, View};
use percent_encoding::percent_decode_str;

use crate::model::file::beside;
use crate::model::{Model, ModelFault};

/// The bytes of all buffers of a file.
pub(super) struct Buffers {
    data: Vec<Vec<u8>>,
    /// Greatest number of triangles.
    most: usize,
}

impl Buffers {
    /// Reads the buffers of a file: its own part, texts in it, and files beside it.
    pub(super) fn read(
        document: &Document,
        mut blob: Option<Vec<u8>>,
        folder: &Path,
        most: usize,
    ) -> Result<Self, ModelFault> {
        let largest = most.saturating_mul(Model::TRIANGLE_BYTES);
        let mut left = largest;
        let read = |buffer: Buffer| {
            let fault = |why: String| ModelFault::Piece { piece: format!("buffer {}", buffer.index()), why };
            let wrong = || fault(format!("has {} bytes; memory allows {largest}", buffer.length()));
            left = left.checked_sub(buffer.length()).ok_or_else(wrong)?;
            let data = match buffer.source() {
                Source::Bin => {
                    blob.take().ok_or_else(|| fault("is missing: the file has no binary part".to_owned()))?
                }
                Source::Uri(uri) => bytes_of(uri, folder, buffer.length()).map_err(fault)?,
            };
            let (found, expected) = (data.len(), buffer.length());
            if found < expected {
                return Err(fault(format!("has {found} bytes; expected {expected}")));
            }
            Ok(data)
        };
        Ok(Self { data: document.buffers().map(read).collect::<Result<_, _>>()?, most })
    }

    /// Checks that elements are not more than the corners of the triangles that may be read.
    pub(super) fn check_count(&self, count: usize) -> Result<(), ModelFault> {
        let triangles = count / 3;
        if triangles > self.most { Err(ModelFault::TooLarge { count: triangles, most: self.most }) } else { Ok(()) }
    }

    /// Returns the bytes of a view.
    pub(super) fn view(&self, view: &View) -> Result<&[u8], String> {
        let data = self.data.get(view.buffer().index());
        let end = view.offset().checked_add(view.length());
        let bytes = data.zip(end).and_then(|(data, end)| data.get(view.offset()..end));
        bytes.ok_or_else(|| format!("is in view {}, which ends outside buffer {}", view.index(), view.buffer().index()))
    }
}

/// Meaning of a URI.
pub(super) enum Found {
    /// Its own bytes.
    Bytes(Vec<u8>),
    /// A file beside the model's.
    File(PathBuf),
}

impl Found {
    /// Finds what a URI stands for. Nothing is fetched.
    pub(super) fn of(uri: &str, folder: &Path) -> Result<Self, String> {
        if uri.starts_with("data:") {
            let wrong = || "is a data URI that cannot be decoded".to_owned();
            let (data, _) = DataUrl::process(uri).map_err(|_| wrong())?.decode_to_vec().map_err(|_| wrong())?;
            return Ok(Self::Bytes(data));
        }
        if uri.contains("://") {
            return Err(format!("is at '{uri}'; expected a file beside the model's, since nothing is fetched"));
        }
        beside(folder, &percent_decode_str(uri).decode_utf8_lossy()).map(Self::File)
    }
}

/// Returns the bytes that a URI stands for: its own, or the first of a file.
fn bytes_of(uri: &str, folder: &Path, most: usize) -> Result<Vec<u8>, String> {
    let path = match Found::of(uri, folder)? {
        Found::Bytes(bytes) => return Ok(bytes),
        Found::File(path) => path,
    };
    let mut bytes = Vec::new();
    let read = File::open(&path).and_then(|file| file.take(most as u64).read_to_end(&mut bytes));
    read.map(|_| bytes).map_err(|error| format!("cannot be read: {}: {error}", path.display()))
}
