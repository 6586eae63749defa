//! Allocator of the program: the system's, with pages of two megabytes for pictures, and with a note of what it could not have.
//!
//! A fresh picture is touched once, and every page of four kilobytes then costs an interruption by the system. Together
//! they take a third of the time of an 8-bit frame of 4096². Many systems give larger pages only on request (`madvise`
//! in `/sys/kernel/mm/transparent_hugepage/enabled`). Frames of a sequence hand their memory on
//! ([`cosmorama::raster::FramePool`]), so that only the first ones take any.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Number of bytes from which memory belongs to a picture and gets large pages.
#[cfg(any(test, target_os = "linux"))]
const LARGE: usize = 4 << 20;

pub(crate) struct LargePages;

/// Bytes that were asked for last without being had.
static LACKING: AtomicUsize = AtomicUsize::new(0);

/// Returns the bytes that the system has last refused, if it has.
pub(crate) fn lacking() -> Option<usize> {
    Some(LACKING.load(Ordering::Relaxed)).filter(|bytes| *bytes > 0)
}

// SAFETY: all memory comes from the system's allocator and returns to it with the same layout. Requests for large pages
// change no contents.
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller promises what the system's allocator requires, here and below.
        had(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        had(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        had(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Advice for where memory runs out.
pub(crate) const TAKE_LESS: &str = "close other programs, or give less to --memory or --threads";

/// Makes the program end with exit code 1, not by a signal, where Rust aborts it for want of memory, and has told the bytes.
#[cfg(target_os = "linux")]
pub(crate) fn end_where_memory_lacks() {
    let end = || {
        if lacking().is_some() {
            let said = [b"error: memory ran out; ", TAKE_LESS.as_bytes(), b"\n"];
            for part in said {
                let _ = rustix::io::write(rustix::stdio::stderr(), part);
            }
            signal_hook::low_level::exit(1);
        }
    };
    // Where this may not be, the signal ends the program as before.
    // SAFETY: what runs reads a number, writes to an open file and ends the process: no lock and no memory is taken.
    let _ = unsafe { signal_hook::low_level::register(signal_hook::consts::SIGABRT, end) };
}

/// Does nothing: other systems have limits of their own.
#[cfg(not(target_os = "linux"))]
pub(crate) fn end_where_memory_lacks() {}

/// Notes a refusal, and requests large pages for other memory.
fn had(memory: *mut u8, size: usize) -> *mut u8 {
    if memory.is_null() {
        LACKING.store(size, Ordering::Relaxed);
        return memory;
    }
    prefer_large_pages(memory, size)
}

/// Requests large pages for fresh memory of this size. Where the system refuses, small pages serve.
#[cfg(target_os = "linux")]
fn prefer_large_pages(memory: *mut u8, size: usize) -> *mut u8 {
    use rustix::mm::{Advice, madvise};
    /// Size of a page that all systems' pages divide; the bytes left over at the ends are too few to matter.
    const PAGE: usize = 1 << 16;
    if size < LARGE {
        return memory;
    }
    let skipped = memory.addr().next_multiple_of(PAGE) - memory.addr();
    let whole = (size - skipped) / PAGE * PAGE;
    // SAFETY: these pages are all within the memory that was given, and this advice changes nothing that they hold.
    let _ = unsafe { madvise(memory.wrapping_add(skipped).cast(), whole, Advice::LinuxHugepage) };
    memory
}

/// Returns the memory unchanged: only Linux takes such requests.
#[cfg(not(target_os = "linux"))]
fn prefer_large_pages(memory: *mut u8, _: usize) -> *mut u8 {
    memory
}

/// Makes the allocator return the memory of pictures to the system at once. Otherwise, once a large block has been
/// freed, glibc takes blocks up to its size from heaps, of which each thread has one or more. Free memory in the middle
/// of a heap is never returned to the system.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
pub(crate) fn give_back_pictures() {
    // SAFETY: `mallopt` takes any number, and affects only later allocations.
    unsafe { libc::mallopt(libc::M_MMAP_THRESHOLD, LARGE as libc::c_int) };
    if has_limit_of_addresses() {
        // Each thread's heap would reserve 64 MiB of addresses, used or not, which pictures then lack.
        // SAFETY: as above.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, 1) };
    }
}

/// Returns whether `ulimit -v` holds.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn has_limit_of_addresses() -> bool {
    rustix::process::getrlimit(rustix::process::Resource::As).current.is_some()
}

/// Does nothing: only glibc needs this.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
pub(crate) fn give_back_pictures() {}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lengths around the size at which large pages are requested. The tests themselves run with the program's
    /// allocator.
    const LENGTHS: [usize; 4] = [LARGE / 8 - 1, LARGE / 8, LARGE / 8 + 1, LARGE / 4 + 1234];

    fn numbers(count: usize) -> impl Iterator<Item = u64> {
        (1..=count as u64).map(|k| k.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    #[test]
    fn memory_that_there_is_not_is_an_error() {
        let mut list: Vec<u64> = numbers(99).collect();
        assert!(list.try_reserve_exact(isize::MAX as usize / 16).is_err());
        assert!(lacking().is_some());
        assert!(list.iter().copied().eq(numbers(99)));
    }

    /// Runs in a process of its own: see below.
    #[test]
    #[ignore = "ends the process"]
    fn takes_more_than_there_is() {
        end_where_memory_lacks();
        drop(Vec::<u64>::with_capacity(isize::MAX as usize / 16));
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn memory_that_there_is_not_ends_the_program_with_an_exit_code() {
        let this = std::env::current_exe().unwrap();
        let arguments = ["--exact", "allocator::tests::takes_more_than_there_is", "--ignored", "--nocapture"];
        let ended = std::process::Command::new(this).args(arguments).output().unwrap();
        let said = String::from_utf8_lossy(&ended.stderr).into_owned();
        assert_eq!(ended.status.code(), Some(1), "{said}");
        assert!(said.contains("error: memory ran out; close"), "{said}");
    }

    #[test]
    fn memory_holds_what_is_written_as_it_grows_and_shrinks() {
        for length in LENGTHS {
            let mut list = Vec::with_capacity(length);
            list.extend(numbers(length));
            assert!(list.iter().copied().eq(numbers(length)), "{length} numbers");
            for other in LENGTHS {
                list.truncate(other);
                list.shrink_to_fit();
                list.reserve_exact(other - list.len());
                list.extend(numbers(other).skip(list.len()));
                assert!(list.iter().copied().eq(numbers(other)), "{length} numbers, and then {other}");
            }
        }
    }

    #[test]
    fn zeroed_memory_is_zero_where_there_was_something_before() {
        for length in LENGTHS.into_iter().chain(LENGTHS) {
            let mut list = vec![0_u64; length];
            assert!(list.iter().all(|number| *number == 0), "{length} numbers");
            list.fill(u64::MAX);
            assert!(list.iter().all(|number| *number == u64::MAX), "{length} numbers");
        }
    }
}
