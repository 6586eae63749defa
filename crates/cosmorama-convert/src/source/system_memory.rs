//! Memory as reported by the operating system, where it does.

use std::fs;
use std::path::{Path, PathBuf};

/// Returns the most memory that this process has held.
pub fn peak_bytes() -> Option<u64> {
    kilobytes("/proc/self/status", "VmHWM:")
}

/// Returns the memory that could be allocated now.
pub(crate) fn free_bytes() -> Option<u64> {
    let group = groups().iter().filter_map(Group::free).min();
    [kilobytes("/proc/meminfo", "MemAvailable:"), group, addresses_left()].into_iter().flatten().min()
}

/// Returns all memory of the machine or container; a process that asks for more fails or is killed.
pub(crate) fn all_bytes() -> Option<u64> {
    let swap = kilobytes("/proc/meminfo", "SwapTotal:").unwrap_or(0);
    let machine = kilobytes("/proc/meminfo", "MemTotal:").map(|memory| memory.saturating_add(swap));
    let group = groups().iter().filter_map(Group::limit).min();
    [machine, group, addresses_left()].into_iter().flatten().min()
}

/// A control group of processes, whose memory may be limited.
#[derive(Debug, PartialEq, Eq)]
struct Group {
    /// Folder in which the system tells of it.
    folder: PathBuf,
    /// Names in it.
    names: &'static Names,
}

/// Names by which a version of control groups tells of memory.
#[derive(Debug, PartialEq, Eq)]
struct Names {
    /// Folder of all groups.
    root: &'static str,
    limit: &'static str,
    held: &'static str,
    /// Copies of files that nobody uses: they count as held, and are given up for whoever asks.
    unused: &'static str,
}

/// Version 1, of which each resource has groups of its own.
const FIRST: Names = Names {
    root: "sys/fs/cgroup/memory",
    limit: "memory.limit_in_bytes",
    held: "memory.usage_in_bytes",
    unused: "total_inactive_file",
};

/// Version 2.
const SECOND: Names =
    Names { root: "sys/fs/cgroup", limit: "memory.max", held: "memory.current", unused: "inactive_file" };

/// Returns the groups of this process: its own, and those that hold it. Each limits all that is in it.
fn groups() -> Vec<Group> {
    groups_in(Path::new("/"))
}

/// Returns the groups of this process, by the files below a folder.
fn groups_in(top: &Path) -> Vec<Group> {
    let list = fs::read_to_string(top.join("proc/self/cgroup")).unwrap_or_default();
    let mut groups: Vec<Group> =
        list.lines().filter_map(own_group).flat_map(|(names, own)| above(top, names, own)).collect();
    // In a container, the list may name a place outside, of which it sees its own part alone.
    for names in [&FIRST, &SECOND] {
        let root = Group { folder: top.join(names.root), names };
        if !groups.contains(&root) {
            groups.push(root);
        }
    }
    groups
}

/// Reads a line `NUMBER:RESOURCES:PATH` of the list of a process's groups; `None` if memory is not limited by it.
fn own_group(line: &str) -> Option<(&'static Names, &str)> {
    let (_, rest) = line.split_once(':')?;
    let (resources, path) = rest.split_once(':')?;
    let names = match resources {
        "" => &SECOND,
        _ if resources.split(',').any(|resource| resource == "memory") => &FIRST,
        _ => return None,
    };
    Some((names, path.trim_start_matches('/')))
}

/// Returns a group, and all above it.
fn above<'a>(top: &Path, names: &'static Names, own: &'a str) -> impl Iterator<Item = Group> + use<'a> {
    let root = top.join(names.root);
    Path::new(own).ancestors().map(move |path| Group { folder: root.join(path), names })
}

impl Group {
    fn number(&self, name: &str) -> Option<u64> {
        fs::read_to_string(self.folder.join(name)).ok()?.trim().parse().ok()
    }

    /// Returns the most memory that its processes may hold; `None` where it is not limited.
    fn limit(&self) -> Option<u64> {
        self.number(self.names.limit)
    }

    /// Returns the memory that its processes may still take.
    fn free(&self) -> Option<u64> {
        let held = self.number(self.names.held).unwrap_or(0).saturating_sub(self.unused());
        Some(self.limit()?.saturating_sub(held))
    }

    /// Returns the bytes of copies of files that nobody uses.
    fn unused(&self) -> u64 {
        let told = fs::read_to_string(self.folder.join("memory.stat")).unwrap_or_default();
        let number = |line: &str| line.strip_prefix(self.names.unused)?.trim().parse().ok();
        told.lines().find_map(number).unwrap_or(0)
    }
}

/// Returns the bytes that may still be mapped by the limit of `ulimit -v`, in which the program itself has a part.
pub(crate) fn addresses_left() -> Option<u64> {
    let held = kilobytes("/proc/self/status", "VmSize:").unwrap_or(0);
    Some(address_space()?.saturating_sub(held))
}

/// Returns the limit of `ulimit -v`, in bytes.
fn address_space() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    limit.split_whitespace().next()?.parse().ok()
}

/// Reads a line of one of Linux's tables, in bytes.
fn kilobytes(file: &str, label: &str) -> Option<u64> {
    let text = fs::read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(label))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| kilobytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Makes a system that says this in its files.
    fn system(files: &[(&str, &str)]) -> tempfile::TempDir {
        let top = tempfile::tempdir().unwrap();
        for (name, text) in files {
            let path = top.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        top
    }

    fn least(top: &Path) -> [Option<u64>; 2] {
        let groups = groups_in(top);
        [groups.iter().filter_map(Group::limit).min(), groups.iter().filter_map(Group::free).min()]
    }

    #[test]
    fn the_least_limit_of_a_group_and_those_above_holds() {
        let top = system(&[
            ("proc/self/cgroup", "0::/slice/job/step\n"),
            ("sys/fs/cgroup/slice/memory.max", "700\n"),
            ("sys/fs/cgroup/slice/memory.current", "600\n"),
            ("sys/fs/cgroup/slice/memory.stat", "anon 500\ninactive_file 50\n"),
            ("sys/fs/cgroup/slice/job/memory.max", "400\n"),
            ("sys/fs/cgroup/slice/job/memory.current", "30\n"),
            ("sys/fs/cgroup/slice/job/step/memory.max", "max\n"),
            ("sys/fs/cgroup/other/memory.max", "1\n"),
        ]);
        assert_eq!(least(top.path()), [Some(400), Some(150)]);
    }

    #[test]
    fn groups_of_the_first_version_are_those_of_memory() {
        let top = system(&[
            ("proc/self/cgroup", "5:cpu,cpuacct:/few\n4:memory:/job/step\n0::/\n"),
            ("sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n"),
            ("sys/fs/cgroup/memory/job/memory.limit_in_bytes", "300\n"),
            ("sys/fs/cgroup/memory/job/memory.usage_in_bytes", "90\n"),
            ("sys/fs/cgroup/memory/job/memory.stat", "inactive_file 1\ntotal_inactive_file 40\n"),
            ("sys/fs/cgroup/memory/few/memory.limit_in_bytes", "1\n"),
        ]);
        assert_eq!(least(top.path()), [Some(300), Some(250)]);
    }

    #[test]
    fn a_container_that_sees_its_own_part_alone_has_its_limit() {
        let top = system(&[("proc/self/cgroup", "0::/outside/of/it\n"), ("sys/fs/cgroup/memory.max", "80\n")]);
        assert_eq!(least(top.path()), [Some(80), Some(80)]);
        assert_eq!(least(system(&[]).path()), [None, None]);
    }
}
