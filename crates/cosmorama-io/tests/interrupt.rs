//! What an interrupt leaves behind: nothing. In a program of its own, since nothing can be written after it.

#![allow(clippy::unwrap_used)]

mod common;

use std::io::Write;
use std::time::Duration;

use cosmorama_io::pending::{Pending, remove_all};

#[test]
fn after_an_interrupt_no_file_appears() {
    let folder = tempfile::tempdir().unwrap();
    let mut begun = Pending::create(&folder.path().join("begun.png")).unwrap();
    begun.writer().write_all(b"half of it").unwrap();
    assert_eq!(common::files(folder.path()).len(), 1);
    remove_all();
    assert_eq!(common::files(folder.path()).len(), 0);
    let late = folder.path().join("late.png");
    let writers = [
        std::thread::spawn(move || begun.finish().is_ok()),
        std::thread::spawn(move || Pending::create(&late).is_ok()),
    ];
    std::thread::sleep(Duration::from_millis(200));
    // They wait for the end of the program, and tell of no failure meanwhile.
    assert!(writers.iter().all(|writer| !writer.is_finished()));
    assert_eq!(common::files(folder.path()).len(), 0);
}
