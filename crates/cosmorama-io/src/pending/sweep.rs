//! Removal of temporary files that killed programs have left.

use std::fs::{self, DirEntry};
use std::path::Path;
use std::time::Duration;

use super::{PREFIX, SUFFIX};

/// Time without a change after which a file counts as left, whoever makes it.
const LONG: Duration = Duration::from_secs(24 * 60 * 60);

/// Random characters in a name, of which `tempfile` takes so many.
const RANDOM: usize = 6;

/// Machine in names where the system tells none.
const UNKNOWN: &str = "0.0";

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

    /// Returns the beginning of the names of its temporary files. Random characters and [`SUFFIX`] follow.
    pub(super) fn prefix(&self) -> String {
        let both = self.machine.as_deref().zip(self.process.as_deref());
        let (machine, process) = both.unwrap_or((UNKNOWN, "0"));
        format!("{PREFIX}{machine}-{process}-")
    }

    /// Removes from a folder the temporary files, and folders of such, whose process is gone. Files of other machines go after a day
    /// without a change. What cannot be removed stays, and so does what has another name than temporary files have.
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
        let maker = name.to_str().and_then(Maker::of_name);
        let is_ours = || entry.metadata().is_ok_and(|found| self.is_user_of(&found));
        maker.is_some_and(|maker| is_ours() && (self.is_beside_gone(&maker) || is_old(entry)))
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

    /// Returns whether a file was made on this machine, by a process that is gone.
    fn is_beside_gone(&self, maker: &Maker<'_>) -> bool {
        let is_beside = self.machine.as_deref() == Some(maker.machine);
        is_beside && !runs(maker.process)
    }
}

/// Machine and process that a temporary file's name tells.
struct Maker<'a> {
    machine: &'a str,
    process: u32,
}

impl<'a> Maker<'a> {
    /// Reads a name; `None` if it is not of the whole form that [`Owner::prefix`] begins, and may be a file of the user's own.
    fn of_name(name: &'a str) -> Option<Self> {
        let (maker, random) = name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX)?.rsplit_once('-')?;
        let (machine, process) = maker.rsplit_once('-')?;
        let (start, space) = machine.split_once('.')?;
        let is_made = is_all(start, char::is_ascii_hexdigit)
            && is_all(space, char::is_ascii_digit)
            && random.len() == RANDOM
            && is_all(random, char::is_ascii_alphanumeric);
        Some(Self { machine, process: process.parse().ok()? }).filter(|_| is_made)
    }
}

/// Returns whether a process runs. One that has ended, and that its parent has not asked about, does not.
fn runs(process: u32) -> bool {
    let process = Path::new("/proc").join(process.to_string());
    match fs::read_to_string(process.join("stat")) {
        Ok(stat) => !has_ended(&stat),
        Err(_) => process.exists(),
    }
}

/// Returns whether a process has ended, by what Linux tells of it: its state follows its name, which may hold anything, in parentheses.
fn has_ended(stat: &str) -> bool {
    stat.rsplit(')').next().is_some_and(|state| state.trim_start().starts_with(['Z', 'X']))
}

/// Returns whether a text is of such characters alone, and not empty.
fn is_all(text: &str, of: fn(&char) -> bool) -> bool {
    !text.is_empty() && text.chars().all(|letter| of(&letter))
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
    fn a_process_that_only_waits_for_its_parent_has_ended() {
        assert!(has_ended("17 (cosmorama) Z 1 17") && has_ended("17 (a (b) S) X 1 17"));
        assert!(!has_ended("17 (cosmorama) S 1 17") && !has_ended("17 (Z) R 1 17"));
        assert!(runs(std::fs::read_link("/proc/self").unwrap().to_str().unwrap().parse().unwrap()));
    }

    #[test]
    fn files_of_processes_that_are_gone_are_removed() {
        let folder = tempfile::tempdir().unwrap();
        let make = |name: &str| File::create(folder.path().join(name)).unwrap();
        let machine = machine().unwrap();
        // Numbers of processes are smaller.
        let gone = format!(".cosmorama-{machine}-4194305-abcdef.part");
        let alive = format!(".cosmorama-{machine}-{}-abcdef.part", this_process().unwrap());
        let (elsewhere, old) = (".cosmorama-0123.45-4194305-abcdef.part", ".cosmorama-0123.45-7-abcdef.part");
        let own = [".cosmorama-abcdef.part", ".cosmorama-my-4194305-notes.part"].map(str::to_owned);
        let almost = [gone.replace("abcdef", "abcdefg"), gone.replace("4194305", "4194305x")];
        make(&gone);
        fs::create_dir(folder.path().join(gone.replace("abcdef", "folder"))).unwrap();
        std::os::unix::fs::symlink("/", folder.path().join(gone.replace("abcdef", "linked"))).unwrap();
        for name in [&alive, elsewhere, "mine.part", ".cosmorama-mine"] {
            make(name);
        }
        // Names of another form are the user's own, however old.
        for name in own.iter().chain(&almost).map(String::as_str).chain([old]) {
            make(name).set_modified(SystemTime::now() - 2 * LONG).unwrap();
        }
        let begun = Pending::create(&folder.path().join("out.png"), &Unfinished::default()).unwrap();
        drop(begun);
        let names = fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let expected = [alive.as_str(), elsewhere, "mine.part", ".cosmorama-mine"].map(str::to_owned);
        assert_eq!(names.collect::<BTreeSet<_>>(), expected.into_iter().chain(own).chain(almost).collect());
    }
}
