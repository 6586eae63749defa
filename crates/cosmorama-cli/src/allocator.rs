//! Allocator of the program: the system's, with pages of two megabytes for pictures, and with a note of what it could not have.
//!
//! A fresh picture is touched once, and every page of four kilobytes then costs an interruption by the system. Together
//! they take a third of the time of an 8-bit frame of 4096². Many systems give larger pages only on request (`madvise`
//! in `/sys/kernel/mm/transparent_hugepage/enabled`). Frames of a sequence hand their memory on
//! ([`cosmorama::raster::FramePool`]), so that only the first ones take any.
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;

/// Number of bytes from which memory belongs to a picture and gets large pages.
#[cfg(any(test, target_os = "linux"))]
const LARGE: usize = 4 << 20;

pub(crate) struct Allocator;

thread_local! {
    /// Whether the system has refused the memory that this thread asked for last.
    static IS_REFUSED: Cell<bool> = const { Cell::new(false) };
    /// Whether it has ever done so. Rust's own report about it takes memory, and the signal follows.
    static WAS_REFUSED: Cell<bool> = const { Cell::new(false) };
}

/// Returns whether the system has refused the memory that this thread asked for last: what fails now fails for want of it.
pub(crate) fn is_refused() -> bool {
    IS_REFUSED.get()
}

// SAFETY: all memory comes from the system's allocator and returns to it with the same layout. Requests for large pages
// change no contents.
unsafe impl GlobalAlloc for Allocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller promises what the system's allocator requires, here and below.
        noted(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as above.
        noted(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as above.
        noted(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as above.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Error of a program to which the system has refused memory.
pub(crate) const OUT_OF_MEMORY: &str =
    "error: memory ran out; close other programs, raise limits, or give less to --memory or --threads";

/// Makes the program end with exit code 1, not by a signal, where Rust aborts it because memory was refused.
#[cfg(target_os = "linux")]
pub(crate) fn end_where_memory_lacks() {
    use signal_hook::consts::SIGABRT;
    use signal_hook::low_level;
    let end = || {
        if WAS_REFUSED.get() {
            for part in [OUT_OF_MEMORY, "\n"] {
                let _ = rustix::io::write(rustix::stdio::stderr(), part.as_bytes());
            }
            low_level::exit(1);
        }
        // Others may have sent the signal.
        let _ = low_level::emulate_default_handler(SIGABRT);
    };
    // Where the signal cannot be watched for, it ends the program as before.
    // SAFETY: what runs reads a flag, writes to an open file and ends the process: no lock and no memory is taken.
    let _ = unsafe { low_level::register(SIGABRT, end) };
}

/// Does nothing: the system's own signal ends the program.
#[cfg(not(target_os = "linux"))]
pub(crate) fn end_where_memory_lacks() {}

/// Notes whether memory was refused, and requests large pages for what was not.
fn noted(memory: *mut u8, size: usize) -> *mut u8 {
    let is_refused = memory.is_null();
    IS_REFUSED.set(is_refused);
    if is_refused {
        WAS_REFUSED.set(true);
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
    if limit_of_addresses().is_some() {
        // Each thread's heap would reserve 64 MiB of addresses, used or not, which pictures then lack.
        // SAFETY: as above.
        unsafe { libc::mallopt(libc::M_ARENA_MAX, 1) };
    }
}

/// Returns the bytes of addresses that `ulimit -v` leaves, if it holds.
#[cfg(target_os = "linux")]
fn limit_of_addresses() -> Option<u64> {
    rustix::process::getrlimit(rustix::process::Resource::As).current
}

/// Refuses fewer addresses than the program with its threads takes, beside pictures.
///
/// # Errors
/// When `ulimit -v` leaves fewer.
#[cfg(target_os = "linux")]
pub(crate) fn check_addresses() -> anyhow::Result<()> {
    const LEAST: u64 = 64 << 20;
    match limit_of_addresses().filter(|bytes| *bytes < LEAST) {
        Some(bytes) => {
            anyhow::bail!("ulimit -v leaves {} KiB; the program takes {} and more", bytes >> 10, LEAST >> 10)
        }
        None => Ok(()),
    }
}

/// Does nothing: other systems have no such limit.
#[cfg(not(target_os = "linux"))]
pub(crate) fn check_addresses() -> anyhow::Result<()> {
    Ok(())
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
        assert!(is_refused());
        list.push(1);
        list.shrink_to_fit();
        drop(vec![0_u8; 9]);
        assert!(!is_refused());
        list.pop();
        assert!(list.iter().copied().eq(numbers(99)));
    }

    /// Ends this process in a way.
    #[cfg(target_os = "linux")]
    fn end(way: &str) {
        end_where_memory_lacks();
        if way == "memory" {
            drop(std::hint::black_box(Vec::<u64>::with_capacity(isize::MAX as usize / 16)));
        }
        signal_hook::low_level::raise(signal_hook::consts::SIGABRT).unwrap();
    }

    #[test]
    #[cfg(target_os = "linux")]
    fn only_a_lack_of_memory_ends_the_program_with_an_exit_code_where_it_is_aborted() {
        const NAME: &str = "only_a_lack_of_memory_ends_the_program_with_an_exit_code_where_it_is_aborted";
        const ENDING: &str = "COSMORAMA_TEST_ENDING";
        // The processes that this test starts are itself, and are told so.
        if let Ok(way) = std::env::var(ENDING) {
            end(&way);
        }
        for (way, code) in [("memory", Some(1)), ("signal", None)] {
            let mut this = std::process::Command::new(std::env::current_exe().unwrap());
            this.args(["--exact", &format!("{}::{NAME}", module_path!().split_once("::").unwrap().1), "--nocapture"]);
            this.env(ENDING, way).env("RUST_BACKTRACE", "1");
            let ended = this.output().unwrap();
            let said = String::from_utf8_lossy(&ended.stderr).into_owned();
            assert_eq!(ended.status.code(), code, "{said}");
            assert_eq!(said.contains(OUT_OF_MEMORY), code.is_some(), "{said}");
        }
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
