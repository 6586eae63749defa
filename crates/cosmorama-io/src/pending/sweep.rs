//! Removal of temporary files that killed programs have left.

use std::fs::{self, DirEntry};
use std::path::Path;
use std::time::Duration;

use super::{PREFIX, SUFFIX};

/// Time without a change after which a file counts as left, whoever makes it.
const LONG: Duration = Duration::from_secs(24 * 60 * 60);

/// Owner of temporary files: a process, as its files' names and the system tell it.
#[derive(Debug)]
pub(super) struct Owner {
    /// Name of the machine since its start, and of the name space of its processes; `None` where the system tells none.
    /// There, a process that is not found is gone.
    machine: Option<String>,
    /// Number of the process, in its name space.
    process: Option<String>,
    /// User, of whose processes none is hidden.
    user: Option<u32>,
}

impl Owner {
    /// Returns this process.
    pub(super) fn this() -> Self {
        Self { machine: machine(), process: this_process(), user: user() }
    }

    /// Returns the beginning of the names of its temporary files.
    pub(super) fn prefix(&self) -> String {
        let both = self.machine.as_ref().zip(self.process.as_ref());
        both.map_or_else(|| PREFIX.to_owned(), |(machine, process)| format!("{PREFIX}{machine}-{process}-"))
    }

    /// Removes from a folder the temporary files, and folders of such, whose process is gone. Files of other machines go after a day
    /// without a change. What cannot be removed stays.
    pub(super) fn sweep(&self, folder: &Path) {
        let entries = fs::read_dir(folder).into_iter().flatten().flatten();
        for entry in entries.filter(|entry| self.is_left(entry)) {
            let _ = match entry.file_type() {
                Ok(kind) if kind.is_dir() => fs::remove_dir_all(entry.path()),
                _ => fs::remove_file(entry.path()),
            };
        }
    }

    fn is_left(&self, entry: &DirEntry) -> bool {
        let name = entry.file_name();
        let middle = name.to_str().and_then(|name| name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX));
        let is_ours = || entry.metadata().is_ok_and(|found| self.is_user_of(&found));
        middle.is_some_and(|middle| is_ours() && (self.is_beside_gone(middle) || is_old(entry)))
    }

    /// Returns whether a file belongs to this process's user.
    #[cfg(unix)]
    fn is_user_of(&self, found: &fs::Metadata) -> bool {
        use std::os::unix::fs::MetadataExt;
        self.user.is_none_or(|user| found.uid() == user)
    }

    #[cfg(not(unix))]
    fn is_user_of(&self, _: &fs::Metadata) -> bool {
        self.user.is_none()
    }

    /// Returns whether a name is that of a file of this machine, whose process is gone.
    fn is_beside_gone(&self, middle: &str) -> bool {
        let of = |machine: &String| {
            middle.strip_prefix(machine.as_str())?.strip_prefix('-')?.split('-').next()?.parse::<u32>().ok()
        };
        let process = self.machine.as_ref().and_then(of);
        process.is_some_and(|process| !Path::new("/proc").join(process.to_string()).exists())
    }
}

fn this_process() -> Option<String> {
    fs::read_link("/proc/self").ok()?.into_os_string().into_string().ok()
}

fn machine() -> Option<String> {
    let start = fs::read_to_string("/proc/sys/kernel/random/boot_id").ok()?;
    let space = fs::read_link("/proc/self/ns/pid").ok()?;
    let hexadecimal = start.chars().filter(char::is_ascii_hexdigit).take(12);
    let digits = space.to_string_lossy().chars().filter(char::is_ascii_digit).collect::<String>();
    Some(hexadecimal.collect::<String>() + "." + &digits)
}

#[cfg(unix)]
fn user() -> Option<u32> {
    use std::os::unix::fs::MetadataExt;
    Some(fs::metadata("/proc/self").ok()?.uid())
}

#[cfg(not(unix))]
fn user() -> Option<u32> {
    None
}

/// Returns whether a file has not been changed for long. A folder does not change when the files in it do.
fn is_old(entry: &DirEntry) -> bool {
    let age = |found: fs::Metadata| found.modified().ok()?.elapsed().ok();
    entry.metadata().ok().filter(fs::Metadata::is_file).and_then(age).is_some_and(|age| age > LONG)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use std::collections::BTreeSet;
    use std::fs::File;
    use std::time::SystemTime;

    use super::*;
    use crate::pending::{Pending, Unfinished};

    #[test]
    fn files_of_processes_that_are_gone_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let make = |name: &str| File::create(folder.path().join(name)).unwrap();
        let machine = machine().unwrap();
        // Numbers of processes are smaller.
        let gone = format!(".cosmorama-{machine}-4194305-abcdef.part");
        let alive = format!(".cosmorama-{machine}-{}-abcdef.part", this_process().unwrap());
        let (elsewhere, old) = (".cosmorama-0123.45-4194305-abcdef.part", ".cosmorama-abcdef.part");
        make(&gone);
        fs::create_dir(folder.path().join(gone.replace("abcdef", "folder"))).unwrap();
        std::os::unix::fs::symlink("/", folder.path().join(gone.replace("abcdef", "linked"))).unwrap();
        for name in [&alive, elsewhere, "mine.part", ".cosmorama-mine"] {
            make(name);
        }
        make(old).set_modified(SystemTime::now() - 2 * LONG).unwrap();
        let begun = Pending::create(&folder.path().join("out.png"), &Unfinished::default()).unwrap();
        drop(begun);
        let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let expected = [alive.as_str(), elsewhere, "mine.part", ".cosmorama-mine"].map(str::to_owned);
        assert_eq!(names.collect::<BTreeSet<_>>(), BTreeSet::from(expected));
    }
}
