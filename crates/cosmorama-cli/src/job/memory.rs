use anyhow::{Result, bail};
use cosmorama::raster::Rgba;

use super::{Input, Target, TargetView};
use crate::args::MemorySize;

/// How much memory may be used.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MemoryBudget {
    /// Bytes.
    pub(crate) bytes: u64,
}

/// What is used where nothing else is asked for.
const DEFAULT_PART: f64 = 0.75;

/// Where the system does not tell how much memory is free.
const UNKNOWN_FREE: u64 = 4 << 30;

impl MemoryBudget {
    /// What was asked for, or three quarters of free memory.
    pub(crate) fn new(asked: Option<MemorySize>) -> Self {
        let part = |part: f64| (free_bytes().unwrap_or(UNKNOWN_FREE) as f64 * part) as u64;
        let bytes = match asked {
            Some(MemorySize::Bytes(bytes)) => bytes,
            Some(MemorySize::Part(fraction)) => part(fraction),
            None => part(DEFAULT_PART),
        };
        Self { bytes }
    }

    /// Whether a frame fits, before memory is taken.
    pub(crate) fn check(self, input: &Input, target: &Target) -> Result<()> {
        let needed = frame_bytes(input, target);
        if needed <= self.bytes {
            return Ok(());
        }
        let largest = input.present().max_by_key(|(_, header, _)| header.width.saturating_mul(header.height));
        let largest = largest.map_or_else(String::new, |(view, header, _)| {
            format!(
                "; the largest input, {}, has {}x{} pixels",
                view.files.path(None).display(),
                header.width,
                header.height
            )
        });
        let out = target.views.first().map_or_else(String::new, |target| {
            format!(" and the output {}x{}", target.view.width(), target.view.height())
        });
        bail!(
            "a frame needs about {} of memory, but {} are allowed{largest}{out}; if that is right, raise --memory",
            human(needed),
            human(self.bytes),
        );
    }

    /// What is left for the geometry that all frames share.
    pub(crate) fn left_for_plan(self, input: &Input, target: &Target) -> u64 {
        self.bytes.saturating_sub(frame_bytes(input, target))
    }

    /// How many frames fit beside the geometry that they share.
    pub(crate) fn frames_beside(self, input: &Input, target: &Target, plans: u64) -> usize {
        (self.bytes.saturating_sub(plans) / frame_bytes(input, target).max(1)) as usize
    }
}

/// Light and solid angle of every texel, the files beside them, and the outputs with their encoded twins.
fn frame_bytes(input: &Input, target: &Target) -> u64 {
    let texel = (size_of::<Rgba>() + size_of::<f32>()) as u64;
    let encoded = input
        .present()
        .map(|(_, header, _)| {
            let samples = header.channels.count() * header.depth.bytes();
            (header.width as u64).saturating_mul(header.height as u64).saturating_mul(samples as u64)
        })
        .fold(0, u64::saturating_add);
    let pixels = |target: &TargetView| (target.view.width() as u64).saturating_mul(target.view.height() as u64);
    let output = target.views.iter().map(pixels).fold(0, u64::saturating_add);
    let output = output.saturating_mul(2 * size_of::<Rgba>() as u64);
    (input.texels() as u64).saturating_mul(texel).saturating_add(encoded).saturating_add(output)
}

/// An amount of memory as people say it.
pub(crate) fn human(bytes: u64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < units.len() {
        value /= 1024.0;
        unit += 1;
    }
    if unit == 0 { format!("{bytes} bytes") } else { format!("{value:.1} {}", units[unit]) }
}

/// The most memory that this process has held, where the system tells.
pub(crate) fn peak_bytes() -> Option<u64> {
    kilobytes("/proc/self/status", "VmHWM:")
}

fn free_bytes() -> Option<u64> {
    let machine = kilobytes("/proc/meminfo", "MemAvailable:");
    // In a container the limit of its control group may be lower.
    let read = |name: &str| std::fs::read_to_string(format!("/sys/fs/cgroup/{name}")).ok()?.trim().parse::<u64>().ok();
    let group = read("memory.max").map(|limit| limit.saturating_sub(read("memory.current").unwrap_or(0)));
    [machine, group].into_iter().flatten().min()
}

/// A line of one of Linux's tables, in bytes.
fn kilobytes(file: &str, label: &str) -> Option<u64> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find(|line| line.starts_with(label))?;
    line.split_whitespace().nth(1)?.parse::<u64>().ok().map(|kilobytes| kilobytes * 1024)
}
