use std::path::Path;

use cosmorama::camera::View;
use cosmorama::projection::{ProjectionKind, StMapTable};
use cosmorama::raster::Rgba;
use cosmorama_io::{Format, Header};
use cosmorama_spec::MemorySize;

use crate::diagnostic::{CHANNELS, FILTER, MEMORY, Result, bail};
use crate::input::{Input, InputView};
use crate::job::{FrameMemory, QueueDepth};
use crate::source::system_memory::{all_bytes, free_bytes};
use crate::target::{Sheet, Target};

/// Limit of the memory that a conversion may use.
#[derive(Clone, Copy, Debug)]
pub struct MemoryBudget {
    /// Number of bytes.
    pub bytes: u64,
    /// Requested amount, if it exceeds the machine's memory.
    too_much: Option<u64>,
}

/// Default share of free memory.
const DEFAULT_PART: f64 = 0.75;

/// Assumed free memory where the system does not report it.
const UNKNOWN_FREE: u64 = 4 << 30;

impl MemoryBudget {
    /// Returns the requested limit, or three quarters of free memory; never more than the machine has.
    pub fn new(asked: Option<MemorySize>) -> Self {
        let part = |part: f64| (free_bytes().unwrap_or(UNKNOWN_FREE) as f64 * part) as u64;
        let wanted = match asked {
            Some(MemorySize::Bytes(bytes)) => bytes,
            Some(MemorySize::Part(fraction)) => part(fraction),
            None => part(DEFAULT_PART),
        };
        let all = all_bytes().unwrap_or(u64::MAX);
        Self { bytes: wanted.min(all), too_much: (wanted > all).then_some(wanted) }
    }

    /// Checks that the geometry of whole pictures, and the light of the largest file, fit before memory is allocated. A
    /// small file may declare a huge size, or be a window of a huge canvas.
    pub(crate) fn check_pictures(self, input: &Input) -> Result<()> {
        let texels = |view: &InputView| pixels(&view.nominal);
        let geometry = input.views().map(texels).fold(0, u64::saturating_add).saturating_mul(SOLID_ANGLE);
        let tables = input.views().map(|view| table_bytes(&view.nominal)).fold(0, u64::saturating_add);
        let light = input.present().map(|(_, header, _)| light_bytes(header)).max().unwrap_or(0);
        let needed = geometry.saturating_add(tables).saturating_add(light);
        let largest = input.views().max_by_key(|view| texels(view)).map_or_else(String::new, |view| {
            let (width, height) = (view.nominal.width(), view.nominal.height());
            format!("; the largest whole picture, {}, has {width}x{height} pixels", view.name)
        });
        self.allow(needed, "the input", &largest)
    }

    /// Checks that a mask of this size fits while it is made from a picture of so many bytes per pixel.
    pub(crate) fn check_mask(self, (width, height): (usize, usize), picture: u64) -> Result<()> {
        // Its squared distances in double precision, and those that are kept.
        let bytes = (size_of::<f64>() + size_of::<f32>()) as u64 + picture;
        let needed = (width as u64).saturating_mul(height as u64).saturating_mul(bytes);
        self.allow(needed, "a mask", &format!("; it has {width}x{height} pixels"))
    }

    /// Checks that the table of an st map of this size fits together with the map's own values.
    pub(crate) fn check_table(self, file: &Path, size: (usize, usize), has_places: bool) -> Result<()> {
        let (width, height) = size;
        let numbers = (size_of::<[f32; 2]>() as u64).saturating_mul(width as u64).saturating_mul(height as u64);
        let needed = StMapTable::bytes(size, has_places).saturating_add(numbers);
        self.allow(needed, "an st map", &format!("; {} has {width}x{height} pixels", file.display()))
    }

    /// Checks that the outputs of a frame fit, before anything is made.
    pub(crate) fn check_outputs(self, target: &Target) -> Result<()> {
        self.allow(output_bytes(target), "a frame", &describe(target, "; "))
    }

    /// Checks that pictures of these sizes would fit in a frame, although they are only described.
    pub(crate) fn check_sizes(self, sizes: impl IntoIterator<Item = (usize, usize)>) -> Result<()> {
        let sizes: Vec<(usize, usize)> = sizes.into_iter().collect();
        let largest = sizes.iter().max_by_key(|size| area(**size));
        let why = largest.map_or_else(String::new, |(width, height)| format!("; the output {width}x{height}"));
        self.allow(pixel_bytes(sizes), "a frame", &why)
    }

    /// Checks that a frame with the light of all wanted views fits, before memory is allocated.
    pub(crate) fn check_frame(self, input: &Input, target: &Target) -> Result<()> {
        let largest = input.present().max_by_key(|(_, header, _)| header.width.saturating_mul(header.height));
        let largest = largest.map_or_else(String::new, |(view, header, _)| {
            format!(
                "; the largest input, {}, has {}x{} pixels",
                view.files.path(None).display(),
                header.width,
                header.height
            )
        });
        self.allow(frame_bytes(input, target), "a frame", &(largest + &describe(target, ", and ")))
    }

    /// Returns the budget that is left beside the levels of pyramids, which frames make one after the other. It is an
    /// error if a frame and its levels do not fit.
    pub(crate) fn beside_levels(self, levels: u64, input: &Input, target: &Target) -> Result<Self> {
        let needed = frame_bytes(input, target).saturating_add(levels);
        let why = format!("; smaller copies of the input, for {FILTER} ewa-pyramid, are {} of it", human(levels));
        self.allow(needed, "a frame", &why)?;
        Ok(Self { bytes: self.bytes - levels, ..self })
    }

    /// Returns the budget that is left beside the further channels of a frame. It is an error if they do not fit beside a frame.
    pub(crate) fn beside_channels(self, bytes: u64, input: &Input, target: &Target) -> Result<Self> {
        let needed = frame_bytes(input, target).saturating_add(bytes);
        let why = format!("; its further channels are {} of it, and {CHANNELS} takes fewer", human(bytes));
        self.allow(needed, "a frame", &why)?;
        Ok(Self { bytes: self.bytes - bytes, ..self })
    }

    /// Checks that two pictures fit, with the copies that a comparison needs, before memory is allocated.
    pub fn check_comparison(self, pictures: [(&Path, &Header); 2]) -> Result<()> {
        // Beside its light each picture is blurred, in double precision.
        let bytes = |header: &Header| light_bytes(header).saturating_add(header_pixels(header).saturating_mul(16));
        let needed = pictures.iter().map(|(_, header)| bytes(header)).fold(0, u64::saturating_add);
        let size = |(path, header): (&Path, &Header)| {
            format!("{} has {}x{} pixels", path.display(), header.width, header.height)
        };
        self.allow(needed, "comparing", &format!("; {}, {}", size(pictures[0]), size(pictures[1])))
    }

    fn allow(self, needed: u64, what: &str, why: &str) -> Result<()> {
        if needed <= self.bytes {
            return Ok(());
        }
        if let Some(asked) = self.too_much {
            bail!(
                Memory: "{what} needs about {} of memory, but there are {}, whatever {MEMORY} says ({}){why}; make pictures smaller, or \
                 do it where there is more memory",
                human_at_least(needed),
                human(self.bytes),
                human(asked),
            );
        }
        // Nobody means so few bytes.
        let unit = if self.bytes < 1 << 16 { "; a number without a unit is bytes: 8G is eight gigabytes" } else { "" };
        bail!(
            Memory: "{what} needs about {} of memory, but only {} may be used{why}; if that is right, raise {MEMORY}{unit}",
            human_at_least(needed),
            human(self.bytes),
        );
    }

    /// Returns the memory left for geometry that all frames share.
    pub(crate) fn left_for_plan(self, input: &Input, target: &Target, threads: usize) -> u64 {
        self.beside_program(threads).saturating_sub(frame_bytes(input, target)).saturating_sub(plane_bytes(target))
    }

    /// Returns the memory left beside the program itself. A single frame may use less than is counted here, so it is
    /// not limited by it.
    fn beside_program(self, threads: usize) -> u64 {
        self.bytes.saturating_sub(PROGRAM).saturating_sub(THREAD.saturating_mul(threads as u64))
    }

    /// Returns how many frames may be in flight around the one that is filtered, beside the geometry that they share.
    /// Each frame's files keep a thread busy, so more frames than threads are of no use.
    pub(crate) fn queue_depth(self, input: &Input, target: &Target, plans: u64, threads: usize) -> QueueDepth {
        let moving = input.present().filter(|(view, ..)| view.files.sequence().is_some());
        let (files, read) = moving
            .fold((0, 0_u64), |(files, bytes), (_, header, _)| (files + 1, bytes.saturating_add(read_bytes(header))));
        let wanted = |files: usize| 1 + threads.div_ceil(files.max(1));
        let geometry = geometry_bytes(input, target);
        let planes = plane_bytes(target);
        let frame = FrameMemory {
            all: frame_bytes(input, target).saturating_sub(geometry).saturating_add(planes),
            read,
            written: output_bytes(target).saturating_add(planes),
        };
        let room = self.beside_program(threads).saturating_sub(plans).saturating_sub(geometry);
        QueueDepth::fitting(room, frame, (wanted(files), wanted(target.files.len())))
    }
}

/// Memory of the program without pictures, with its tables.
const PROGRAM: u64 = 8 << 20;

/// Memory of a thread beside the pictures that it works on: bands of geometry, blocks of files, and the allocator's
/// reserve.
const THREAD: u64 = 3 << 20;

/// Bytes of a texel's solid angle.
const SOLID_ANGLE: u64 = size_of::<f32>() as u64;

fn header_pixels(header: &Header) -> u64 {
    area((header.width, header.height))
}

/// Returns the bytes of a pixel's samples.
fn sample_bytes(header: &Header) -> u64 {
    (header.channels.count() * header.depth.bytes()) as u64
}

/// Returns the bytes of a file's samples.
fn read_bytes(header: &Header) -> u64 {
    header_pixels(header).saturating_mul(sample_bytes(header))
}

/// Returns the bytes of a file's samples, and of the light decoded from them.
pub(crate) fn light_bytes(header: &Header) -> u64 {
    header_pixels(header).saturating_mul(sample_bytes(header) + size_of::<Rgba>() as u64)
}

fn pixels(view: &View) -> u64 {
    area((view.width(), view.height()))
}

fn describe(target: &Target, link: &str) -> String {
    let size = |Sheet { size: (width, height), .. }: &Sheet| format!("{link}the output {width}x{height}");
    target.files.first().map_or_else(String::new, |file| size(&file.sheet))
}

/// Returns the bytes of the outputs and their encoded samples.
fn output_bytes(target: &Target) -> u64 {
    pixel_bytes(target.files.iter().flat_map(|file| file.levels()).map(|sheet| sheet.size))
}

/// Returns the bytes of OpenEXR's planes, into which samples are sorted while their pictures are still held.
fn plane_bytes(target: &Target) -> u64 {
    if target.format == Format::Exr { output_bytes(target) / 2 } else { 0 }
}

/// Returns the bytes of pictures of these sizes, with their encoded samples.
fn pixel_bytes(sizes: impl IntoIterator<Item = (usize, usize)>) -> u64 {
    let pixels = sizes.into_iter().map(area).fold(0, u64::saturating_add);
    pixels.saturating_mul(2 * size_of::<Rgba>() as u64)
}

fn area((width, height): (usize, usize)) -> u64 {
    (width as u64).saturating_mul(height as u64)
}

/// Returns the bytes of tables that a view's projection holds.
fn table_bytes(view: &View) -> u64 {
    match &view.projection {
        ProjectionKind::StMap(map) => map.bytes(),
        _ => 0,
    }
}

/// Returns the bytes that all frames share, without plans: the solid angle of every texel, and tables.
fn geometry_bytes(input: &Input, target: &Target) -> u64 {
    let angles = (input.texels() as u64).saturating_mul(SOLID_ANGLE);
    let views = input.views().map(|view| &view.nominal).chain(target.views.iter().map(|target| &target.view));
    let tables = views.map(table_bytes).fold(0, u64::saturating_add);
    angles.saturating_add(tables)
}

/// Returns the bytes of a frame with everything that it shares: its files, their light, and the outputs.
fn frame_bytes(input: &Input, target: &Target) -> u64 {
    let light = input.present().map(|(_, header, _)| light_bytes(header)).fold(0, u64::saturating_add);
    light.saturating_add(geometry_bytes(input, target)).saturating_add(output_bytes(target))
}

/// Formats an amount of memory.
pub(crate) fn human(bytes: u64) -> String {
    told(bytes, |tenths| tenths)
}

/// Formats an amount of memory rounded up, so that the printed amount suffices.
fn human_at_least(bytes: u64) -> String {
    told(bytes, f64::ceil)
}

fn told(bytes: u64, round: fn(f64) -> f64) -> String {
    let units = ["bytes", "KiB", "MiB", "GiB", "TiB"];
    let mut value = bytes as f64;
    let mut unit = 0;
    while value >= 1024.0 && unit + 1 < units.len() {
        value /= 1024.0;
        unit += 1;
    }
    match (unit, bytes) {
        (0, 1) => "1 byte".to_owned(),
        (0, _) => format!("{bytes} bytes"),
        _ => format!("{:.1} {}", round(value * 10.0) / 10.0, units[unit]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn as_much_as_is_told_to_be_needed_is_enough() {
        let mebibyte = 1 << 20;
        assert_eq!([10 * mebibyte, 10 * mebibyte + 1].map(human_at_least), ["10.0 MiB", "10.1 MiB"]);
        assert_eq!([10 * mebibyte, 10 * mebibyte + 1].map(human), ["10.0 MiB", "10.0 MiB"]);
        assert_eq!([0, 1, 1023].map(human_at_least), ["0 bytes", "1 byte", "1023 bytes"]);
    }
}
