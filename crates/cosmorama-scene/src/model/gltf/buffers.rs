use std::path::Path;

use data_url::DataUrl;
use gltf::Document;
use gltf::buffer::{Buffer, Source, View};

use crate::model::ModelFault;

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
        let read = |buffer: Buffer| {
            let fault = |why: String| ModelFault::Piece { piece: format!("buffer {}", buffer.index()), why };
            let data = match buffer.source() {
                Source::Bin => {
                    blob.take().ok_or_else(|| fault("is missing: the file has no binary part".to_owned()))?
                }
                Source::Uri(uri) => bytes_of(uri, folder).map_err(fault)?,
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

/// Returns the bytes that a URI stands for: its own, or those of a file.
pub(super) fn bytes_of(uri: &str, folder: &Path) -> Result<Vec<u8>, String> {
    if uri.starts_with("data:") {
        let wrong = || "is a data URI that cannot be decoded".to_owned();
        return DataUrl::process(uri).map_err(|_| wrong())?.decode_to_vec().map(|(data, _)| data).map_err(|_| wrong());
    }
    if uri.contains("://") {
        return Err(format!("is at '{uri}'; expected a file beside the model's, since nothing is fetched"));
    }
    let path = folder.join(decoded(uri));
    std::fs::read(&path).map_err(|error| format!("cannot be read: {}: {error}", path.display()))
}

/// Returns a text in which `%20` and its like are the characters that they stand for.
fn decoded(uri: &str) -> String {
    let (mut bytes, mut rest) = (Vec::new(), uri.as_bytes());
    while let [first, others @ ..] = rest {
        let code = others.get(..2).and_then(|code| std::str::from_utf8(code).ok());
        let byte = code.filter(|_| *first == b'%').and_then(|code| u8::from_str_radix(code, 16).ok());
        bytes.push(byte.unwrap_or(*first));
        rest = if byte.is_some() { &others[2..] } else { others };
    }
    String::from_utf8_lossy(&bytes).into_owned()
}
