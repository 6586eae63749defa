//! Named channels, each as a plane of its own.

use std::path::Path;

use exr::block::lines::LineRef;
use exr::error::Error;

use super::offer::named;
use super::reader::{BATCH_BYTES, Wanted, announce, block_bytes, damaged, each_block, open};
use super::window::Crop;
use crate::codec::interface::Source;
use crate::{Choice, IoError, Limits, NamedChannel, Plane, PlaneSamples};

/// Reads channels of the part that holds the chosen picture, each in its own sample type.
pub(crate) fn read_planes(
    path: &Path,
    source: Source<'_>,
    limits: &Limits,
    (choice, names): (&Choice, &[&str]),
) -> Result<Vec<Plane>, IoError> {
    let reader = open(path, source)?;
    let (header, selection, crop) = announce(path, reader.headers(), Wanted::Picture(choice))?;
    let part = &reader.headers()[selection.part];
    let channels: Vec<NamedChannel> = part.channels.list.iter().map(named).collect();
    let wanted: Vec<&NamedChannel> = names.iter().map(|name| full(path, &channels, name)).collect::<Result<_, _>>()?;
    let pixel: u128 = wanted.iter().map(|channel| channel.kind.bytes() as u128).sum();
    let needed = (crop.width as u128) * (crop.height as u128) * pixel + block_bytes(part);
    let size = (crop.width as u64, crop.height as u64);
    limits.check_bytes(path, size, header.channels, header.depth, needed)?;
    let blank = |channel: &&NamedChannel| Plane {
        name: channel.name.clone(),
        samples: PlaneSamples::zeros(channel.kind, crop.width * crop.height),
    };
    let mut planes: Vec<Plane> = wanted.iter().map(blank).collect();
    let slot = |channel: &NamedChannel| names.iter().position(|name| *name == channel.name);
    let slots: Vec<_> = channels.iter().map(slot).collect();
    each_block(reader, selection.part, BATCH_BYTES, |block, part| {
        for line in block.lines(&part.channels) {
            let Some(slot) = slots[line.location.channel] else { continue };
            let Some(row) = crop.row(line.location.position.y()) else { continue };
            copy_line(&line, &crop, row, &mut planes[slot].samples)?;
        }
        Ok(())
    })
    .map_err(|error| damaged(path, error))?;
    Ok(planes)
}

/// Finds a channel that has a sample for each pixel.
fn full<'a>(path: &Path, channels: &'a [NamedChannel], name: &str) -> Result<&'a NamedChannel, IoError> {
    channels.iter().find(|channel| channel.name == name && channel.is_full).ok_or_else(|| IoError::NoSuchChannel {
        path: path.to_owned(),
        asked: name.to_owned(),
        existing: channels.iter().map(|channel| channel.name.clone()).collect::<Vec<_>>().join(", "),
    })
}

/// Copies a line of a channel into a row of its plane.
fn copy_line(line: &LineRef<'_>, crop: &Crop, row: usize, into: &mut PlaneSamples) -> Result<(), Error> {
    fn copy<S: exr::io::Data>(line: &LineRef<'_>, crop: &Crop, row: &mut [S]) -> Result<(), Error> {
        let first = line.location.position.x();
        for (i, sample) in line.read_samples::<S>().enumerate() {
            let sample = sample?;
            if let Some(column) = crop.column(first + i) {
                row[column] = sample;
            }
        }
        Ok(())
    }
    let range = row * crop.width..(row + 1) * crop.width;
    match into {
        PlaneSamples::Half(samples) => copy(line, crop, &mut samples[range]),
        PlaneSamples::Float(samples) => copy(line, crop, &mut samples[range]),
        PlaneSamples::Uint(samples) => copy(line, crop, &mut samples[range]),
    }
}
