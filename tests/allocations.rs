//! That joints are found without asking for memory: once a few frames have been seen, a frame costs no allocation.
//!
//! This file has an allocator that counts, so it holds this one test and nothing that could allocate beside it.
#![allow(unsafe_code, reason = "an allocator that counts is unsafe to write by its nature")]

use std::alloc::{GlobalAlloc, Layout, System};
use std::cell::Cell;
use valet::sim::camera::dataset::Frame;
use valet::vision::{PoseFinder, generic};

thread_local! {
    /// Allocations of this thread: those of the test's own harness do not count.
    static ALLOCATIONS: Cell<usize> = const { Cell::new(0) };
}

/// The system's allocator, counting.
struct Counting;

fn count() {
    // While a thread ends its counter may be gone already: then nobody asks for it either.
    let _ = ALLOCATIONS.try_with(|allocations| allocations.set(allocations.get() + 1));
}

// SAFETY: everything is handed on to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        count();
        // SAFETY: as for this function.
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, place: *mut u8, layout: Layout) {
        // SAFETY: as for this function.
        unsafe { System.dealloc(place, layout) }
    }

    unsafe fn realloc(&self, place: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        count();
        // SAFETY: as for this function.
        unsafe { System.realloc(place, layout, size) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

#[test]
fn a_frame_costs_no_allocation_once_frames_like_it_have_been_seen() {
    let frames: Vec<_> = (0..4).map(|person| Frame { person: (1 << 41) + person, number: 0 }.render()).collect();
    let mut finder = PoseFinder::new(generic::forest().unwrap());
    let mut seen = 0;
    for image in &frames {
        finder.find(&image.rendering.depth, &image.view()).unwrap();
    }
    let before = ALLOCATIONS.get();
    assert!(before > 0, "the allocator counts nothing");
    for image in frames.iter().rev() {
        let joints = finder.find(&image.rendering.depth, &image.view()).unwrap();
        seen += joints.arms.iter().filter(|(_, arm)| arm.joint(valet::body::Joint::Shoulder).is_some()).count();
    }
    assert_eq!(ALLOCATIONS.get() - before, 0);
    assert!(seen > 0, "nobody was seen in any frame");
}
