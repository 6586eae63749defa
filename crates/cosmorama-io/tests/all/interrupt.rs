//! What an interrupt leaves behind: nothing. In a program of its own, since nothing can be written after it.

use std::io::Write;
use std::process::Command;
use std::time::Duration;

use cosmorama_io::pending::{Pending, Unfinished};

use crate::common::files;

/// Set where this program was started to be interrupted.
const INTERRUPTED: &str = "COSMORAMA_TEST_IS_INTERRUPTED";

#[test]
fn after_an_interrupt_no_file_appears() {
    if std::env::var_os(INTERRUPTED).is_some() {
        return interrupt();
    }
    let test = ["interrupt::after_an_interrupt_no_file_appears", "--exact", "--nocapture"];
    let program = std::env::current_exe().unwrap();
    let output = Command::new(program).args(test).env(INTERRUPTED, "yes").output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout);
    assert!(output.status.success() && said.contains("1 passed"), "{said}{}", String::from_utf8_lossy(&output.stderr));
}

fn interrupt() {
    let folder = tempfile::tempdir().unwrap();
    let unfinished = Unfinished::default();
    let mut begun = Pending::create(&folder.path().join("begun.png"), &unfinished).unwrap();
    begun.writer().write_all(b"half of it").unwrap();
    assert_eq!(files(folder.path()).len(), 1);
    let other = Pending::create(&folder.path().join("other.png"), &Unfinished::default()).unwrap();
    unfinished.remove_all();
    assert_eq!(files(folder.path()).len(), 1, "another list has its own");
    drop(other);
    assert_eq!(files(folder.path()).len(), 0);
    let late = folder.path().join("late.png");
    let writers = [
        std::thread::spawn(move || begun.finish().is_ok()),
        std::thread::spawn(move || Pending::create(&late, &unfinished).is_ok()),
    ];
    std::thread::sleep(Duration::from_millis(200));
    // They wait for the end of the program, and tell of no failure meanwhile.
    assert!(writers.iter().all(|writer| !writer.is_finished()));
    assert_eq!(files(folder.path()).len(), 0);
}
