//! Memory on huge pages where Linux has them, as numpy has for its own arrays.

use std::alloc::{GlobalAlloc, Layout, System};

/// The system's allocator; large memory is advised to lie on huge pages.
pub(crate) struct HugePages;

// SAFETY: all memory is that of the system's allocator, with the caller's layouts.
unsafe impl GlobalAlloc for HugePages {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller guarantees.
        advised(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller guarantees.
        advised(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, memory: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        // SAFETY: as the caller guarantees.
        advised(unsafe { System.realloc(memory, layout, size) }, size)
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        // SAFETY: as the caller guarantees.
        unsafe { System.dealloc(memory, layout) }
    }
}

/// Returns memory of a size, which the system is advised to put on huge pages if it is large.
fn advised(memory: *mut u8, size: usize) -> *mut u8 {
    /// Size in bytes from which the first touch of small pages takes longer than filling the columns of a table.
    const LARGE: usize = 4 << 20;
    /// Granularity of advice. Where pages are larger, advice is refused, and nothing depends on it.
    const PAGE: usize = 4096;
    if size >= LARGE && !memory.is_null() {
        let before = memory.align_offset(PAGE);
        let within = (size - before) / PAGE * PAGE;
        // SAFETY: the range lies within the memory, and the advice changes no byte.
        unsafe {
            libc::madvise(memory.add(before).cast(), within, libc::MADV_HUGEPAGE);
        }
    }
    memory
}
