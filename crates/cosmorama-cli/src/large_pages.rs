//! The program's allocator: that of the system, which is asked for pages of two megabytes where pictures are held.
//!
//! A fresh picture is touched once, and every page of four kilobytes costs an interruption by the system then: a third of the time
//! that an 8-bit frame of 4096² takes. Many systems give larger pages only to those who ask (`madvise` in
//! `/sys/kernel/mm/transparent_hugepage/enabled`).
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};

/// Bytes from which on memory is that of a picture.
const LARGE: usize = 4 << 20;

pub(crate) struct LargePages;

// SAFETY: all that is given and taken is the system's; what is asked of it changes no contents.
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise is the one that the system's allocator wants, here and below.
        prefer_large_pages(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        prefer_large_pages(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        prefer_large_pages(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Asks for large pages under memory that was just given; if there are none, small ones do.
fn prefer_large_pages(memory: *mut u8, size: usize) -> *mut u8 {
    #[cfg(target_os = "linux")]
    if size >= LARGE && !memory.is_null() {
        use rustix::mm::{Advice, madvise};
        /// Any system's pages are as large or smaller, and so few bytes at the ends do not count.
        const PAGE: usize = 1 << 16;
        let skipped = memory.addr().next_multiple_of(PAGE) - memory.addr();
        let whole = (size - skipped) / PAGE * PAGE;
        // SAFETY: these pages are all within the memory that was given, and this advice changes nothing that they hold.
        let _ = unsafe { madvise(memory.wrapping_add(skipped).cast(), whole, Advice::LinuxHugepage) };
    }
    memory
}
