//! Prefetch: requests for memory before it is read.
#![allow(unsafe_code)]

/// Requests items from memory that will be read soon.
#[inline(always)]
pub(crate) fn prefetch<T>(items: &[T]) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};

        /// Number of bytes in a cache line.
        const LINE: usize = 64;
        for byte in (0..size_of_val(items) + LINE - 1).step_by(LINE) {
            // SAFETY: a hint reads nothing, whatever the address.
            unsafe { _mm_prefetch::<_MM_HINT_T0>(items.as_ptr().cast::<i8>().wrapping_add(byte)) }
        }
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = items;
}
