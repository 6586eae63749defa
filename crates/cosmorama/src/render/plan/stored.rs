//! Numbers as they are kept outside of memory: little-endian, one after the other.

/// What can be kept so.
pub(crate) trait Stored: Sized {
    /// Bytes that one takes at least: more than there are bytes for is not even begun.
    const LEAST: usize;

    /// Appends it.
    fn store(&self, into: &mut Vec<u8>);

    /// Takes it from the beginning; `None` if bytes are missing or make no sense.
    fn load(from: &mut &[u8]) -> Option<Self>;

    /// Takes so many.
    fn load_many(from: &mut &[u8], count: usize) -> Option<Vec<Self>> {
        // As much room as there are: the caller has seen bytes for all of them.
        let mut all = Vec::with_capacity(count);
        for _ in 0..count {
            all.push(Self::load(from)?);
        }
        Some(all)
    }
}

/// Plain numbers.
macro_rules! numbers {
    ($($number:ty),*) => {$(
        impl Stored for $number {
            const LEAST: usize = size_of::<$number>();

            fn store(&self, into: &mut Vec<u8>) {
                into.extend_from_slice(&self.to_le_bytes());
            }

            fn load(from: &mut &[u8]) -> Option<Self> {
                let (bytes, rest) = from.split_first_chunk()?;
                *from = rest;
                Some(Self::from_le_bytes(*bytes))
            }

            // All at once: nearly all of a plan are such lists.
            fn load_many(from: &mut &[u8], count: usize) -> Option<Vec<Self>> {
                let (bytes, rest) = from.split_at_checked(count.checked_mul(size_of::<$number>())?)?;
                *from = rest;
                let (numbers, _) = bytes.as_chunks();
                Some(numbers.iter().map(|bytes| Self::from_le_bytes(*bytes)).collect())
            }
        }
    )*};
}

numbers!(u8, u16, u32, u64, u128, i16, f32);

/// As 64 bits.
impl Stored for usize {
    const LEAST: usize = u64::LEAST;

    fn store(&self, into: &mut Vec<u8>) {
        (*self as u64).store(into);
    }

    fn load(from: &mut &[u8]) -> Option<Self> {
        Self::try_from(u64::load(from)?).ok()
    }
}

impl<T: Stored + Copy + Default, const N: usize> Stored for [T; N] {
    const LEAST: usize = N * T::LEAST;

    fn store(&self, into: &mut Vec<u8>) {
        self.iter().for_each(|number| number.store(into));
    }

    fn load(from: &mut &[u8]) -> Option<Self> {
        let mut numbers = [T::default(); N];
        for number in &mut numbers {
            *number = T::load(from)?;
        }
        Some(numbers)
    }

    fn load_many(from: &mut &[u8], count: usize) -> Option<Vec<Self>> {
        let numbers = T::load_many(from, count.checked_mul(N)?)?;
        Some(numbers.as_chunks().0.to_vec())
    }
}

/// How many, then each.
impl<T: Stored> Stored for Vec<T> {
    const LEAST: usize = u64::LEAST;

    fn store(&self, into: &mut Vec<u8>) {
        (self.len() as u64).store(into);
        self.iter().for_each(|number| number.store(into));
    }

    fn load(from: &mut &[u8]) -> Option<Self> {
        let count = usize::try_from(u64::load(from)?).ok()?;
        if count.checked_mul(T::LEAST)? > from.len() {
            return None;
        }
        T::load_many(from, count)
    }
}

/// A structure: its fields, in the order given.
macro_rules! stored {
    ($name:ty { $($field:ident: $kind:ty),* $(,)? }) => {
        impl super::stored::Stored for $name {
            const LEAST: usize = 0 $(+ <$kind as super::stored::Stored>::LEAST)*;

            fn store(&self, into: &mut Vec<u8>) {
                $(<$kind as super::stored::Stored>::store(&self.$field, into);)*
            }

            fn load(from: &mut &[u8]) -> Option<Self> {
                $(let $field = <$kind as super::stored::Stored>::load(from)?;)*
                Some(Self { $($field),* })
            }
        }
    };
}
pub(crate) use stored;
