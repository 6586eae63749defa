use cosmorama_convert::{CostedFiles, CostedMemory, SequenceCost};
use serde_json::{Value, json};

/// Frames of a show, for which hours and disk are told where no others are known.
const SHOW: usize = 50_000;

/// Tells the costs of so many frames, two lines for each kind of files.
pub(super) fn text(costs: &[SequenceCost], frames: Option<usize>) -> String {
    let frames = frames.unwrap_or(SHOW);
    let of = |cost: &SequenceCost| {
        format!(
            "cost     {}: {} for a picture, {} for a sequence; about {} frames a core-hour; {} of disk for 1,000 frames\n         {frames} {}: \
             about {} core-hours, {} of disk\n",
            name(cost.files),
            memory(cost.picture),
            memory(cost.sequence),
            about(cost.frames_a_core_hour()),
            gigabytes(1000 * cost.frame_bytes),
            if frames == 1 { "frame" } else { "frames" },
            about(core_hours(cost, frames)),
            gigabytes((frames as u64).saturating_mul(cost.frame_bytes))
        )
    };
    "\n".to_owned() + &costs.iter().map(of).collect::<String>()
}

/// Returns the costs of so many frames for programs.
pub(super) fn json(costs: &[SequenceCost], frames: Option<usize>) -> Value {
    let frames = frames.unwrap_or(SHOW);
    let of = |cost: &SequenceCost| {
        json!({
            "files": name(cost.files),
            "picture_memory_bytes": cost.picture.bytes,
            "picture_memory_is_allowed": cost.picture.is_allowed,
            "sequence_memory_bytes": cost.sequence.bytes,
            "sequence_memory_is_allowed": cost.sequence.is_allowed,
            "cpu_seconds_a_frame": cost.cpu_seconds,
            "frames_a_core_hour": cost.frames_a_core_hour(),
            "disk_bytes_a_frame": cost.frame_bytes,
            "frames": frames,
            "core_hours": core_hours(cost, frames),
            "disk_bytes": (frames as u64).saturating_mul(cost.frame_bytes),
        })
    };
    costs.iter().map(of).collect()
}

fn core_hours(cost: &SequenceCost, frames: usize) -> f64 {
    frames as f64 * cost.cpu_seconds / 3600.0
}

fn memory(memory: CostedMemory) -> String {
    let refused = if memory.is_allowed { "" } else { " (refused: more than --memory allows)" };
    format!("{} MiB{refused}", memory.bytes.div_ceil(1 << 20))
}

fn name(files: CostedFiles) -> &'static str {
    match files {
        CostedFiles::EightBits => "PNG of 8 bits",
        CostedFiles::Halves => "OpenEXR halves",
    }
}

/// Formats an amount with two significant digits at least.
fn about(amount: f64) -> String {
    // That of the second digit.
    let decimals = 1.0 - amount.max(1e-9).log10().floor();
    format!("{amount:.*}", decimals.max(0.0) as usize)
}

/// Formats an amount of disk in units of powers of ten, as disks are sold.
fn gigabytes(bytes: u64) -> String {
    let gigabytes = bytes as f64 / 1e9;
    if gigabytes < 1.0 { format!("{} GB", about(gigabytes)) } else { format!("{gigabytes:.1} GB") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_amounts_are_not_nothing() {
        let told = [0.000_042, 0.26, 1.26, 12.6, 1260.4].map(about);
        assert_eq!(told, ["0.000042", "0.26", "1.3", "13", "1260"]);
        assert_eq!([3_000_000, 1_260_000_000].map(gigabytes), ["0.0030 GB", "1.3 GB"]);
    }
}
