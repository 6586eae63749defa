use std::cell::RefCell;
use std::collections::HashMap;
use std::io;
use std::path::Path;
use std::rc::Rc;

use data_url::DataUrl;
use gltf::Accessor;
use gltf::accessor::DataType;
use gltf::buffer::Source;
use percent_encoding::percent_decode_str;

use super::wrong;
use crate::sequence::camera_path::CameraPathError;

/// Bytes of a file's numbers.
pub(super) struct Buffers<'a> {
    /// Name of the file.
    pub(super) name: &'a Path,
    /// Bytes in the file itself.
    blob: Option<&'a [u8]>,
    /// Reads a file by its name.
    beside: &'a dyn Fn(&Path) -> io::Result<Vec<u8>>,
    /// Buffers that have been read, by their numbers.
    read: RefCell<HashMap<usize, Rc<[u8]>>>,
}

impl<'a> Buffers<'a> {
    /// Creates the buffers of a file, which are read when they are asked for.
    pub(super) fn new(
        name: &'a Path,
        blob: Option<&'a [u8]>,
        beside: &'a dyn Fn(&Path) -> io::Result<Vec<u8>>,
    ) -> Self {
        Self { name, blob, beside, read: RefCell::default() }
    }

    /// Reads all numbers of an accessor. Integers are parts of their greatest value.
    pub(super) fn numbers(&self, accessor: &Accessor) -> Result<Vec<f64>, CameraPathError> {
        let Some(view) = accessor.view().filter(|_| accessor.sparse().is_none()) else {
            return Err(wrong(self.name, "an animation has no numbers, or sparse ones, which are not read"));
        };
        let buffer = self.bytes(&view.buffer())?;
        let kind = accessor.data_type();
        let (each, size) = (accessor.dimensions().multiplicity(), accessor.size());
        let stride = view.stride().unwrap_or(size);
        let element = |index: usize| {
            let start = index.checked_mul(stride)?.checked_add(view.offset())?.checked_add(accessor.offset())?;
            buffer.get(start..start.checked_add(size)?)
        };
        let damaged =
            || wrong(self.name, "an animation's numbers lie beyond the end of their buffer: the file is damaged");
        if accessor.count() > buffer.len() {
            return Err(damaged());
        }
        let mut numbers = Vec::with_capacity(accessor.count() * each);
        for index in 0..accessor.count() {
            let bytes = element(index).ok_or_else(damaged)?;
            numbers.extend(bytes.chunks(size / each).map(|bytes| number(kind, bytes)));
        }
        Ok(numbers)
    }

    fn bytes(&self, buffer: &gltf::Buffer) -> Result<Rc<[u8]>, CameraPathError> {
        if let Some(read) = self.read.borrow().get(&buffer.index()) {
            return Ok(Rc::clone(read));
        }
        let bytes: Rc<[u8]> = self.bytes_of(buffer)?.into();
        self.read.borrow_mut().insert(buffer.index(), Rc::clone(&bytes));
        Ok(bytes)
    }

    fn bytes_of(&self, buffer: &gltf::Buffer) -> Result<Vec<u8>, CameraPathError> {
        let uri = match buffer.source() {
            Source::Bin => {
                return self.blob.map(<[u8]>::to_vec).ok_or_else(|| wrong(self.name, "no binary part in it"));
            }
            Source::Uri(uri) => uri,
        };
        if let Ok(inside) = DataUrl::process(uri) {
            let bytes = inside.decode_to_vec().map(|(bytes, _)| bytes);
            return bytes.map_err(|error| wrong(self.name, format!("a buffer inside of it is damaged ({error:?})")));
        }
        if uri.contains("://") {
            return Err(wrong(
                self.name,
                format!("its buffer is at '{uri}'; expected a file beside it: nothing is fetched"),
            ));
        }
        let file = percent_decode_str(uri).decode_utf8_lossy();
        let path = self.name.parent().unwrap_or(Path::new("")).join(&*file);
        (self.beside)(&path)
            .map_err(|error| wrong(self.name, format!("cannot open its buffer {} ({error})", path.display())))
    }
}

/// Returns a number of a kind; NaN if its bytes are too few.
fn number(kind: DataType, bytes: &[u8]) -> f64 {
    let pair = || bytes.first_chunk::<2>().copied().unwrap_or_default();
    let part = |value: f64, greatest: f64| (value / greatest).max(-1.0);
    match (kind, bytes) {
        (DataType::F32, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        (DataType::I8, &[a]) => part(f64::from(a as i8), 127.0),
        (DataType::U8, &[a]) => part(f64::from(a), 255.0),
        (DataType::I16, _) => part(f64::from(i16::from_le_bytes(pair())), 32767.0),
        (DataType::U16, _) => part(f64::from(u16::from_le_bytes(pair())), 65535.0),
        _ => f64::NAN,
    }
}
