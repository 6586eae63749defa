//! The program's allocator: that of the system, which is asked for pages of two megabytes where pictures are held, and is not given
//! back what the next frame of a sequence will want.
//!
//! A fresh picture is touched once, and every page of four kilobytes costs an interruption by the system then: a third of the time
//! that an 8-bit frame of 4096² takes. Many systems give larger pages only to those who ask (`madvise` in
//! `/sys/kernel/mm/transparent_hugepage/enabled`). But even those have to be made empty, and where the system is itself a guest, to be
//! asked for from its host: so pictures of a sequence, of whatever kind and whoever makes them, are made in memory that others have
//! left ([`SpareMemory`]), as far as [`keep_spare`] allows. (Images of the outputs need not even be zeroed: the frames hand them on.)
#![allow(unsafe_code)]

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::AtomicPtr;
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};

use crate::spare_memory::{BLOCKS, SpareMemory};

/// Bytes from which on memory is that of a picture, for which large pages are asked.
#[cfg(any(test, target_os = "linux"))]
const LARGE: usize = 4 << 20;

/// Bytes from which on memory is kept for others: that of pictures, of small ones too, and of the parts that codecs cut them into.
const KEPT: usize = 1 << 18;

/// The list of what is kept, which grows by doubling, is in memory that is not: else it would be asked for what it is about to note.
const _: () = assert!(4 * BLOCKS * size_of::<(Layout, AtomicPtr<u8>)>() < KEPT);

pub(crate) struct LargePages;

/// Memory known by where it begins.
type Spare = SpareMemory<AtomicPtr<u8>>;

/// What is kept.
static SPARE: Mutex<Spare> = Mutex::new(SpareMemory::none());

/// Keeps memory of pictures that nobody uses, as long as it and that in use are no more than so many bytes beside what is in use
/// now. What is too much goes back to the system.
pub(crate) fn keep_spare(bytes: u64) {
    keep_nothing_else();
    spare().allow(usize::try_from(bytes).unwrap_or(usize::MAX));
    give_back_surplus();
}

fn spare() -> MutexGuard<'static, Spare> {
    // Nothing in there panics half way. The few small numbers that it holds come from this allocator, which waits for no lock then.
    SPARE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Locks the spare memory unless it is locked already, which may be by the allocation of its own list.
fn spare_if_free() -> Option<MutexGuard<'static, Spare>> {
    match SPARE.try_lock() {
        Ok(spare) => Some(spare),
        Err(TryLockError::Poisoned(spare)) => Some(spare.into_inner()),
        Err(TryLockError::WouldBlock) => None,
    }
}

fn give_back_surplus() {
    give_back(|| spare().surplus());
}

/// Gives back what is chosen of the spare memory, block by block.
fn give_back(choose: impl Fn() -> Option<(Layout, AtomicPtr<u8>)>) {
    while let Some((layout, memory)) = choose() {
        // SAFETY: the system gave it for this layout, whoever used it has given it back, and here it is known no more.
        unsafe { System.dealloc(memory.into_inner(), layout) }
    }
}

/// Has the system's allocator keep no memory of pictures by itself. Once a block was given back, glibc's takes others that are no larger
/// from heaps, one or more for each thread, and what is free in the middle of those is the system's never again: 108 MiB were in
/// use where 82 are so.
#[cfg(all(target_os = "linux", target_env = "gnu"))]
fn keep_nothing_else() {
    // SAFETY: both take any number and concern what comes after; the last leaves alone what is in use.
    unsafe {
        libc::mallopt(libc::M_MMAP_THRESHOLD, KEPT as libc::c_int);
        libc::mallopt(libc::M_TRIM_THRESHOLD, LARGE as libc::c_int);
        libc::malloc_trim(0);
    }
}

/// Other systems' allocators are not asked.
#[cfg(not(all(target_os = "linux", target_env = "gnu")))]
fn keep_nothing_else() {}

fn is_counted(layout: Layout) -> bool {
    layout.size() >= KEPT
}

/// Memory that is spare, holding anything, if there is some. What is asked for is counted in any case, unless it is small.
fn take(layout: Layout) -> Option<*mut u8> {
    if is_counted(layout) { spare().take(layout).map(AtomicPtr::into_inner) } else { None }
}

/// Memory from the system, counted unless it is small. It gets back what would be too much beside that.
fn fresh(layout: Layout, ask: impl Fn() -> *mut u8) -> *mut u8 {
    if is_counted(layout) {
        give_back_surplus();
    }
    let mut memory = ask();
    if memory.is_null() {
        // There may be enough without what is spare.
        give_back(|| spare_if_free()?.oldest());
        memory = ask();
    }
    if !is_counted(layout) {
        return memory;
    }
    if memory.is_null() {
        spare().release(layout);
        return memory;
    }
    prefer_large_pages(memory, layout.size())
}

// SAFETY: all that is given and taken is the system's, for the same layout; what is spare was given back and is given to one; what is
// asked of the system changes no contents.
unsafe impl GlobalAlloc for LargePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: the caller's promise is the one that the system's allocator wants, here and below.
        take(layout).unwrap_or_else(|| fresh(layout, || unsafe { System.alloc(layout) }))
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        let Some(memory) = take(layout) else {
            // SAFETY: as above.
            return fresh(layout, || unsafe { System.alloc_zeroed(layout) });
        };
        // SAFETY: it has as many bytes, and nobody else has it.
        unsafe { memory.write_bytes(0, layout.size()) };
        memory
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: the caller's promise.
        let wanted = unsafe { Layout::from_size_align_unchecked(size, layout.align()) };
        if let Some(found) = take(wanted) {
            // SAFETY: both have at least so many bytes, and nobody else has either.
            unsafe {
                found.copy_from_nonoverlapping(memory, layout.size().min(size));
                self.dealloc(memory, layout);
            }
            return found;
        }
        // The system need not hold both at once.
        if is_counted(layout) {
            spare().release(layout);
        }
        // SAFETY: as above; where there is none, the old memory stays as it is.
        let found = fresh(wanted, || unsafe { System.realloc(memory, layout, size) });
        if is_counted(layout) && found.is_null() {
            spare().count(layout);
        }
        found
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        if is_counted(layout) {
            spare().give(layout, AtomicPtr::new(memory));
            give_back_surplus();
        } else {
            // SAFETY: as above.
            unsafe { System.dealloc(memory, layout) }
        }
    }
}

/// Asks for large pages under memory that was just given, of so many bytes; if there are none, small ones do.
#[cfg(target_os = "linux")]
fn prefer_large_pages(memory: *mut u8, size: usize) -> *mut u8 {
    use rustix::mm::{Advice, madvise};
    /// Any system's pages are as large or smaller, and so few bytes at the ends do not count.
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

/// Other systems are not asked.
#[cfg(not(target_os = "linux"))]
fn prefer_large_pages(memory: *mut u8, _: usize) -> *mut u8 {
    memory
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lists of numbers around the size at which large pages are asked for, in the program's own allocator: tests use it, too.
    const LENGTHS: [usize; 4] = [LARGE / 8 - 1, LARGE / 8, LARGE / 8 + 1, LARGE / 4 + 1234];

    fn numbers(count: usize) -> impl Iterator<Item = u64> {
        (1..=count as u64).map(|k| k.wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }

    /// What is kept is the same for all tests: one after the other.
    fn alone() -> MutexGuard<'static, ()> {
        static ALONE: Mutex<()> = Mutex::new(());
        ALONE.lock().unwrap_or_else(PoisonError::into_inner)
    }

    #[test]
    fn memory_that_was_given_back_is_given_again_and_is_empty() {
        // Of a size that nothing else here asks for.
        const LENGTH: usize = LARGE + 4093;
        let _alone = alone();
        let given = |byte: u8| {
            let list = vec![byte; LENGTH];
            assert!(list.iter().all(|found| *found == byte), "{byte}");
            list.as_ptr().addr()
        };
        keep_spare(64 << 20);
        let first = given(7);
        let places = [given(0), given(9), given(0)];
        keep_spare(0);
        assert_eq!(places, [first; 3]);
    }

    #[test]
    fn where_there_is_no_more_memory_nothing_is_lost() {
        const NEVER: usize = isize::MAX as usize / 2;
        // Much more than other tests use meanwhile, and hardly touched.
        const MUCH: usize = 1 << 28;
        const OTHERS: usize = MUCH / 4;
        let _alone = alone();
        keep_spare(64 << 20);
        let mut list = Vec::with_capacity(MUCH / 8);
        list.extend(numbers(99));
        let spared = Layout::array::<u8>(LARGE + 8191).unwrap();
        drop(vec![1u8; spared.size()]);
        keep_spare(64 << 20);
        let used = spare().used();
        assert!(Vec::<u8>::new().try_reserve_exact(NEVER).is_err());
        assert!(spare().used().abs_diff(used) < OTHERS, "what was not given is not counted");
        assert!(!spare().holds(spared), "what was spare was given back for it");
        assert!(list.try_reserve_exact(NEVER / 8).is_err());
        assert!(spare().used().abs_diff(used) < OTHERS, "what has not grown is counted as before");
        assert!(list.iter().copied().eq(numbers(99)));
        drop(list);
        keep_spare(0);
        assert!(spare().used().abs_diff(used - MUCH) < OTHERS);
    }

    #[test]
    fn memory_for_the_list_of_what_is_spare_is_asked_for_without_waiting_for_it() {
        let _alone = alone();
        let held = spare();
        assert!(fresh(Layout::new::<u64>(), std::ptr::null_mut).is_null());
        drop(held);
    }

    /// All of these tests, with memory kept and without.
    fn kept_and_not(test: impl Fn()) {
        let _alone = alone();
        for bytes in [0, 64 << 20, 0] {
            keep_spare(bytes);
            test();
        }
    }

    #[test]
    fn memory_holds_what_is_written_as_it_grows_and_shrinks() {
        kept_and_not(lists_grow_and_shrink);
    }

    fn lists_grow_and_shrink() {
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
        kept_and_not(lists_are_zero);
    }

    fn lists_are_zero() {
        for length in LENGTHS.into_iter().chain(LENGTHS) {
            let mut list = vec![0_u64; length];
            assert!(list.iter().all(|number| *number == 0), "{length} numbers");
            list.fill(u64::MAX);
            assert!(list.iter().all(|number| *number == u64::MAX), "{length} numbers");
        }
    }
}
