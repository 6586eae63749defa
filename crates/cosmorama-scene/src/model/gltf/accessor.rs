use gltf::Accessor;
use gltf::accessor::DataType;
use gltf::accessor::sparse::IndexType;
use gltf::buffer::View;

use super::buffers::Buffers;
use crate::model::ModelFault;

/// Place and form of elements in a view of a buffer.
struct Elements {
    offset: usize,
    count: usize,
    kind: DataType,
    is_normalised: bool,
}

/// Reads the elements of an accessor, N numbers each.
pub(super) fn numbers<const N: usize>(accessor: &Accessor, buffers: &Buffers) -> Result<Vec<[f64; N]>, ModelFault> {
    let fault = |why: String| ModelFault::Piece { piece: format!("accessor {}", accessor.index()), why };
    let (found, count) = (accessor.dimensions().multiplicity(), accessor.count());
    if found != N {
        return Err(fault(format!("has elements of {found} numbers; expected {N}")));
    }
    buffers.check_count(count)?;
    let form =
        Elements { offset: accessor.offset(), count, kind: accessor.data_type(), is_normalised: accessor.normalized() };
    let mut all = match accessor.view() {
        Some(view) => elements(&view, &form, buffers).map_err(fault)?,
        None => vec![[0.0; N]; count],
    };
    let Some(sparse) = accessor.sparse() else { return Ok(all) };
    let (places, values) = (sparse.indices(), sparse.values());
    let kind = match places.index_type() {
        IndexType::U8 => DataType::U8,
        IndexType::U16 => DataType::U16,
        IndexType::U32 => DataType::U32,
    };
    buffers.check_count(sparse.count())?;
    let place = Elements { offset: places.offset(), count: sparse.count(), kind, is_normalised: false };
    let value = Elements { offset: values.offset(), count: sparse.count(), ..form };
    let places: Vec<[f64; 1]> = elements(&places.view(), &place, buffers).map_err(fault)?;
    let values: Vec<[f64; N]> = elements(&values.view(), &value, buffers).map_err(fault)?;
    for ([place], value) in places.into_iter().zip(values) {
        let into = all.get_mut(place as usize);
        *into.ok_or_else(|| fault(format!("changes element {place} of {count}")))? = value;
    }
    Ok(all)
}

/// Reads indices: whole numbers, each less than a count.
pub(super) fn indices(accessor: &Accessor, count: usize, buffers: &Buffers) -> Result<Vec<usize>, ModelFault> {
    let numbers = numbers::<1>(accessor, buffers)?;
    let index = |[number]: [f64; 1]| {
        let index = number as usize;
        let why = || format!("names vertex {number}, and there are {count}");
        let fault = || ModelFault::Piece { piece: format!("accessor {}", accessor.index()), why: why() };
        if number >= 0.0 && index < count { Ok(index) } else { Err(fault()) }
    };
    numbers.into_iter().map(index).collect()
}

fn elements<const N: usize>(view: &View, form: &Elements, buffers: &Buffers) -> Result<Vec<[f64; N]>, String> {
    let bytes = buffers.view(view)?;
    let size = form.kind.size();
    let stride = view.stride().unwrap_or(N * size);
    let Some(last) = form.count.checked_sub(1) else { return Ok(Vec::new()) };
    let end = last.checked_mul(stride).and_then(|last| last.checked_add(form.offset)?.checked_add(N * size));
    if end.is_none_or(|end| end > bytes.len()) {
        let (count, length) = (form.count, bytes.len());
        return Err(format!("has {count} elements, which end outside its view of {length} bytes"));
    }
    let number = |start: usize| scalar(&bytes[start..start + size], form);
    let element = |start: usize| std::array::from_fn(|k| number(form.offset + start + k * size));
    Ok((0..form.count).map(|k| element(k * stride)).collect())
}

fn scalar(bytes: &[u8], form: &Elements) -> f64 {
    let (number, most) = match (form.kind, bytes) {
        (DataType::I8, [a]) => (f64::from(*a as i8), f64::from(i8::MAX)),
        (DataType::U8, [a]) => (f64::from(*a), f64::from(u8::MAX)),
        (DataType::I16, [a, b]) => (f64::from(i16::from_le_bytes([*a, *b])), f64::from(i16::MAX)),
        (DataType::U16, [a, b]) => (f64::from(u16::from_le_bytes([*a, *b])), f64::from(u16::MAX)),
        (DataType::U32, [a, b, c, d]) => (f64::from(u32::from_le_bytes([*a, *b, *c, *d])), f64::from(u32::MAX)),
        (DataType::F32, [a, b, c, d]) => (f64::from(f32::from_le_bytes([*a, *b, *c, *d])), 1.0),
        _ => (f64::NAN, 1.0),
    };
    if form.is_normalised { (number / most).max(-1.0) } else { number }
}
