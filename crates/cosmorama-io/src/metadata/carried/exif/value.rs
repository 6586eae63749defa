//! Values of Exif fields as a TIFF file stores them, in this machine's byte order.

use ::exif::{Rational, SRational, Value};
use bytemuck::{cast_slice, pod_collect_to_vec};

/// Returns the number of bytes of a value.
pub(super) fn bytes(value: &Value) -> usize {
    match value {
        Value::Byte(all) => all.len(),
        Value::Ascii(all) => all.iter().map(|text| text.len() + 1).sum(),
        Value::Short(all) => 2 * all.len(),
        Value::Long(all) => 4 * all.len(),
        Value::Rational(all) => 8 * all.len(),
        Value::SByte(all) => all.len(),
        Value::Undefined(all, _) => all.len(),
        Value::SShort(all) => 2 * all.len(),
        Value::SLong(all) => 4 * all.len(),
        Value::SRational(all) => 8 * all.len(),
        Value::Float(all) => 4 * all.len(),
        Value::Double(all) => 8 * all.len(),
        Value::Unknown(..) => 0,
    }
}

/// Returns the number of a value's type (TIFF 6.0, section 2) and its bytes; `None` for an unknown type.
pub(crate) fn stored(value: &Value) -> Option<(u16, Vec<u8>)> {
    let fractions =
        |all: &[Rational]| all.iter().flat_map(|fraction| [fraction.num, fraction.denom]).collect::<Vec<_>>();
    let signed = |all: &[SRational]| all.iter().flat_map(|fraction| [fraction.num, fraction.denom]).collect::<Vec<_>>();
    Some(match value {
        Value::Byte(all) => (1, all.clone()),
        Value::Ascii(all) => (2, all.iter().flat_map(|text| text.iter().copied().chain([0])).collect()),
        Value::Short(all) => (3, cast_slice(all).to_vec()),
        Value::Long(all) => (4, cast_slice(all).to_vec()),
        Value::Rational(all) => (5, cast_slice(&fractions(all)).to_vec()),
        Value::SByte(all) => (6, cast_slice(all).to_vec()),
        Value::Undefined(all, _) => (7, all.clone()),
        Value::SShort(all) => (8, cast_slice(all).to_vec()),
        Value::SLong(all) => (9, cast_slice(all).to_vec()),
        Value::SRational(all) => (10, cast_slice(&signed(all)).to_vec()),
        Value::Float(all) => (11, cast_slice(all).to_vec()),
        Value::Double(all) => (12, cast_slice(all).to_vec()),
        Value::Unknown(..) => return None,
    })
}

/// Returns the value of a type's number and bytes; `None` for an unknown type.
pub(crate) fn of_stored(kind: u16, bytes: &[u8]) -> Option<Value> {
    let whole = |width: usize| &bytes[..bytes.len() / width * width];
    Some(match kind {
        1 => Value::Byte(bytes.to_vec()),
        2 => {
            let text = bytes.strip_suffix(&[0]).unwrap_or(bytes);
            Value::Ascii(text.split(|byte| *byte == 0).map(<[u8]>::to_vec).collect())
        }
        3 => Value::Short(pod_collect_to_vec(whole(2))),
        4 => Value::Long(pod_collect_to_vec(whole(4))),
        5 => {
            let numbers: Vec<u32> = pod_collect_to_vec(whole(8));
            Value::Rational(numbers.chunks_exact(2).map(|pair| Rational { num: pair[0], denom: pair[1] }).collect())
        }
        6 => Value::SByte(cast_slice(bytes).to_vec()),
        7 => Value::Undefined(bytes.to_vec(), 0),
        8 => Value::SShort(pod_collect_to_vec(whole(2))),
        9 => Value::SLong(pod_collect_to_vec(whole(4))),
        10 => {
            let numbers: Vec<i32> = pod_collect_to_vec(whole(8));
            Value::SRational(numbers.chunks_exact(2).map(|pair| SRational { num: pair[0], denom: pair[1] }).collect())
        }
        11 => Value::Float(pod_collect_to_vec(whole(4))),
        12 => Value::Double(pod_collect_to_vec(whole(8))),
        _ => return None,
    })
}
