use std::collections::{HashMap, VecDeque};
use std::sync::{Mutex, MutexGuard, PoisonError};

use bytemuck::Pod;
use half::f16;
use half::vec::HalfBitsVecExt;

use self::sealed::Typed;
use crate::raster::{Image, Rgba, Samples};

/// Pool of memory of finished pictures, kept for others of the same size.
///
/// New memory may cost as much as the work in it, since the system clears each page when it is first touched. With a pool
/// shared by reader, filter and writer, frames of a sequence use the same memory one after the other.
///
/// ```
/// use cosmorama::raster::{FramePool, Samples};
///
/// let pool = FramePool::keeping(1 << 20);
/// let samples = pool.take::<u16>(600);
/// let place = samples.as_ptr();
/// pool.give(Samples::U16(samples));
/// assert_eq!(pool.take::<u16>(600).as_ptr(), place);
/// ```
#[derive(Debug, Default)]
pub struct FramePool {
    kept: Mutex<Kept>,
    /// Bytes that unused and used memory may take together.
    allowed: u64,
}

#[derive(Debug, Default)]
struct Kept {
    /// Unused memory, in the order in which it was given back.
    spare: VecDeque<Samples>,
    /// Bytes of unused memory.
    spare_bytes: u64,
    /// Address and size in bytes of memory that was taken and not given back.
    used: HashMap<usize, u64>,
}

/// Sample type of a file: an integer or a float.
pub trait Sample: Copy + Default + Typed {}

impl<S: Copy + Default + Typed> Sample for S {}

/// Pixel type of images whose memory a pool can keep.
pub trait Pixel: Pod {
    /// Type of its samples.
    type Sample: Sample + Pod;
}

impl Pixel for Rgba {
    type Sample = f32;
}

impl Pixel for [u8; 3] {
    type Sample = u8;
}

mod sealed {
    use super::Samples;

    /// Type with a variant of [`Samples`].
    pub trait Typed: Sized {
        /// Returns a list of zeros.
        fn zeros(count: usize) -> Vec<Self>;

        /// Returns a list as samples of its type.
        fn wrap(list: Vec<Self>) -> Samples;

        /// Returns the list in samples of this type, and other samples as the error.
        fn unwrap(samples: Samples) -> Result<Vec<Self>, Samples>;

        /// Returns whether samples have this type and this number.
        fn are(samples: &Samples, count: usize) -> bool;
    }
}

macro_rules! typed {
    ($($sample:ty = $variant:ident of $zeros:expr),*) => {$(
        impl Typed for $sample {
            fn zeros(count: usize) -> Vec<Self> {
                $zeros(count)
            }

            fn wrap(list: Vec<Self>) -> Samples {
                Samples::$variant(list)
            }

            fn unwrap(samples: Samples) -> Result<Vec<Self>, Samples> {
                match samples {
                    Samples::$variant(list) => Ok(list),
                    other => Err(other),
                }
            }

            fn are(samples: &Samples, count: usize) -> bool {
                matches!(samples, Samples::$variant(list) if list.len() == count)
            }
        }
    )*};
}

typed!(
    u8 = U8 of |count| vec![0; count],
    u16 = U16 of |count| vec![0; count],
    // The standard library would write each zero.
    f16 = Half of |count| vec![0_u16; count].reinterpret_into(),
    f32 = Float of |count| vec![0.0; count]
);

impl FramePool {
    /// Creates a pool whose unused and used memory take at most `bytes` together. The default pool keeps nothing.
    pub fn keeping(bytes: u64) -> Self {
        Self { allowed: bytes, ..Self::default() }
    }

    /// Returns the bytes that unused and used memory may take together.
    pub fn allowed(&self) -> u64 {
        self.allowed
    }

    /// Takes samples with arbitrary values.
    pub fn take<S: Sample>(&self, count: usize) -> Vec<S> {
        self.used(self.reused(count).unwrap_or_else(|| S::zeros(count)))
    }

    /// Takes samples that are all zero.
    pub fn take_zeroed<S: Sample>(&self, count: usize) -> Vec<S> {
        let reused = self.reused(count).map(|mut samples| {
            samples.fill(S::default());
            samples
        });
        self.used(reused.unwrap_or_else(|| S::zeros(count)))
    }

    /// Takes an image with arbitrary pixels.
    pub fn take_image<P: Pixel>(&self, width: usize, height: usize) -> Image<P> {
        let samples = self.take::<P::Sample>(width * height * (size_of::<P>() / size_of::<P::Sample>()));
        Image::new(width, height, bytemuck::allocation::cast_vec(samples)).expect("as many pixels")
    }

    /// Gives the memory of an image back.
    pub fn give_image<P: Pixel>(&self, image: Image<P>) {
        self.give(P::Sample::wrap(bytemuck::allocation::cast_vec(image.into_pixels())));
    }

    /// Gives the memory of samples back. It is freed if it was not taken from here; if too much is kept, the oldest is freed.
    pub fn give(&self, samples: Samples) {
        let mut kept = self.kept();
        if kept.used.remove(&samples.address()).is_some() {
            kept.spare_bytes += samples.bytes();
            kept.spare.push_back(samples);
            kept.shrink(self.allowed);
        }
    }

    /// Returns unused memory for samples of this type and number, if there is some.
    fn reused<S: Sample>(&self, count: usize) -> Option<Vec<S>> {
        let mut kept = self.kept();
        // The latest may still be in a cache.
        let found = kept.spare.iter().rposition(|samples| S::are(samples, count))?;
        let samples = kept.spare.remove(found)?;
        kept.spare_bytes -= samples.bytes();
        S::unwrap(samples).ok()
    }

    /// Records samples as used, and frees unused memory beyond what is allowed beside them.
    fn used<S: Sample>(&self, samples: Vec<S>) -> Vec<S> {
        if self.allowed > 0 && !samples.is_empty() {
            let mut kept = self.kept();
            kept.used.insert(samples.as_ptr().addr(), size_of_val(samples.as_slice()) as u64);
            kept.shrink(self.allowed);
        }
        samples
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        // Nothing panics while the lock is held.
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Kept {
    /// Frees the oldest unused memory until no more than `allowed` is left.
    fn shrink(&mut self, allowed: u64) {
        let used: u64 = self.used.values().sum();
        while used + self.spare_bytes > allowed {
            let Some(oldest) = self.spare.pop_front() else { break };
            self.spare_bytes -= oldest.bytes();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a pool in which these lists of bytes are spare.
    fn with_spare(allowed: u64, counts: &[usize]) -> FramePool {
        let pool = FramePool::keeping(allowed);
        let lists: Vec<Vec<u8>> = counts.iter().map(|count| pool.take(*count)).collect();
        lists.into_iter().for_each(|list| pool.give(Samples::U8(list)));
        pool
    }

    fn spare(pool: &FramePool) -> Vec<usize> {
        pool.kept().spare.iter().map(Samples::len).collect()
    }

    #[test]
    fn what_was_given_serves_who_asks_for_the_same_and_nobody_else() {
        let pool = with_spare(100, &[10, 20, 10]);
        assert_eq!(pool.take::<u8>(15).len(), 15);
        assert_eq!(pool.take::<u16>(5), [0; 5], "of another type");
        assert_eq!(spare(&pool), [10, 20, 10]);
        pool.take::<u8>(10);
        assert_eq!(spare(&pool), [10, 20]);
    }

    #[test]
    fn what_is_taken_zeroed_is_zero_whatever_it_was() {
        let pool = FramePool::keeping(100);
        let mut samples = pool.take::<u8>(10);
        samples.fill(7);
        pool.give(Samples::U8(samples));
        let samples = pool.take::<u8>(10);
        assert_eq!(samples, [7; 10]);
        pool.give(Samples::U8(samples));
        assert_eq!(pool.take_zeroed::<u8>(10), [0; 10]);
        assert_eq!(pool.take_zeroed::<u8>(10), [0; 10], "fresh");
    }

    #[test]
    fn no_more_is_kept_than_allowed_with_what_is_used() {
        let pool = with_spare(60, &[10, 20, 30]);
        assert_eq!(spare(&pool), [10, 20, 30]);
        let used = pool.take::<u8>(20);
        let more = pool.take::<u8>(25);
        assert_eq!(spare(&pool), [0; 0], "20 and 25 are used, and 30 beside them would be too much");
        pool.give(Samples::U8(used));
        pool.give(Samples::U8(more));
        assert_eq!(spare(&pool), [20, 25]);
        pool.give(Samples::U8(vec![0; 10]));
        assert_eq!(spare(&pool), [20, 25], "what was never taken is not kept");
    }

    #[test]
    fn where_nothing_is_allowed_nothing_is_kept() {
        let pool = FramePool::default();
        pool.give(Samples::Float(pool.take(8)));
        assert_eq!(spare(&pool), [0; 0]);
    }

    #[test]
    fn pictures_come_back_as_pictures() {
        let pool = FramePool::keeping(1 << 10);
        let mut image = pool.take_image::<Rgba>(3, 2);
        image.pixels_mut().fill(Rgba::BLACK);
        pool.give_image(image);
        assert_eq!(pool.take_image(2, 3), Image::filled(2, 3, Rgba::BLACK));
        let mut samples = pool.take::<u8>(18);
        samples.fill(5);
        pool.give(Samples::U8(samples));
        assert_eq!(pool.take_image(3, 2), Image::filled(3, 2, [5; 3]));
    }
}
