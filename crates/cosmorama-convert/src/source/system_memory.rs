//! Memory as reported by the operating system, where it does.

/// Returns the most memory that this process has held.
pub fn peak_bytes() -> Option<u64> {
    kilobytes("/proc/self/status", "VmHWM:")
}

/// Returns the memory that could be allocated now.
pub(crate) fn free_bytes() -> Option<u64> {
    let group = group("memory.max").map(|limit| limit.saturating_sub(group("memory.current").unwrap_or(0)));
    let held = || kilobytes("/proc/self/status", "VmSize:").unwrap_or(0);
    let addresses = address_space().map(|limit| limit.saturating_sub(held()));
    [kilobytes("/proc/meminfo", "MemAvailable:"), group, addresses].into_iter().flatten().min()
}

/// Returns all memory of the machine or container; a process that asks for more fails or is killed.
pub(crate) fn all_bytes() -> Option<u64> {
    let swap = kilobytes("/proc/meminfo", "SwapTotal:").unwrap_or(0);
    let machine = kilobytes("/proc/meminfo", "MemTotal:").map(|memory| memory.saturating_add(swap));
    [machine, group("memory.max"), address_space()].into_iter().flatten().min()
}

/// Reads a limit of the control group, which in a container may be less than the machine's memory.
fn group(name: &str) -> Option<u64> {
    std::fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse().ok()
}

/// Returns the limit of `ulimit -v`, in bytes.
fn address_space() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let limit = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    limit.split_whitespace().next()?.parse().ok()
}

/// Reads a line of one of Linux's tables, in bytes.
fn kilobytes(file: &str, label: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(label))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| kilobytes * 1024)
}
