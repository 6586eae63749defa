use std::path::Path;

use cosmorama::projection::StMapTable;
use cosmorama::raster::Rgba;
use cosmorama_io::Header;
use cosmorama_spec::MemorySize;

use crate::diagnostic::{MEMORY, Result, bail};
use crate::source::system_memory::{addresses_left, all_bytes, free_bytes};

/// Limit of the memory that a conversion may use.
#[derive(Clone, Copy, Debug)]
pub struct MemoryBudget {
    /// Number of bytes.
    pub bytes: u64,
    /// Requested amount, if it exceeds the machine's memory.
    too_much: Option<u64>,
    /// Whether it is what `ulimit -v` leaves: a program that needs a little more is aborted.
    pub(crate) is_of_addresses: bool,
    /// Bytes that ffmpeg's codecs hold beside, of the same memory.
    pub(crate) codecs: u64,
}

/// Memory from which budgets hold for the program and all its threads, too. Smaller ones hold for pictures: nobody means that the program
/// itself is too large.
pub(crate) const SMALL: u64 = 64 << 20;

/// Default share of free memory.
const DEFAULT_PART: f64 = 0.75;

/// Assumed free memory where the system does not report it.
const UNKNOWN_FREE: u64 = 4 << 30;

/// Returns the bytes in which an st map of so many is read: first the file's samples and its numbers, then the map and what its trees
/// are made of.
pub(crate) fn map_reading_bytes(map: u64) -> u64 {
    map.saturating_mul(8) / 5
}

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
        let is_of_addresses = asked.is_none() && addresses_left().is_some_and(|left| part(DEFAULT_PART) >= left / 2);
        Self { bytes: wanted.min(all), too_much: (wanted > all).then_some(wanted), is_of_addresses, codecs: 0 }
    }

    /// Checks that a mask of this size fits while it is made from a picture of so many bytes per pixel.
    pub(crate) fn check_mask(self, (width, height): (usize, usize), picture: u64) -> Result<()> {
        // Squared distances in double precision, and the ones that are kept.
        let bytes = (size_of::<f64>() + size_of::<f32>()) as u64 + picture;
        let needed = (width as u64).saturating_mul(height as u64).saturating_mul(bytes);
        self.allow(needed, "a mask", &format!("; it has {width}x{height} pixels"))
    }

    /// Checks that an st map of this size can be read, in however many pieces it is.
    pub(crate) fn check_table(self, file: &Path, size: (usize, usize), has_places: bool) -> Result<()> {
        let (width, height) = size;
        self.allow(
            map_reading_bytes(StMapTable::bytes_at_most(size, has_places)),
            "an st map",
            &format!("; {} has {width}x{height} pixels", file.display()),
        )
    }

    /// Checks that two pictures fit, with the copies that a comparison needs, before memory is allocated.
    pub fn check_comparison(self, pictures: [(&Path, &Header); 2]) -> Result<()> {
        // Beside its light, each picture has a blurred copy in double precision.
        let bytes = |header: &Header| light_bytes(header).saturating_add(header_pixels(header).saturating_mul(16));
        let needed = pictures.iter().map(|(_, header)| bytes(header)).fold(0, u64::saturating_add);
        let size = |(path, header): (&Path, &Header)| {
            format!("{} has {}x{} pixels", path.display(), header.width, header.height)
        };
        self.allow(needed, "comparing", &format!("; {}, {}", size(pictures[0]), size(pictures[1])))
    }

    /// Checks that the light of a picture of this size fits.
    ///
    /// # Errors
    /// When it does not.
    pub fn check_picture(self, size: (usize, usize)) -> Result<()> {
        let needed = area(size).saturating_mul(size_of::<Rgba>() as u64);
        self.allow(needed, "a picture", &format!("; it has {}x{} pixels", size.0, size.1))
    }

    /// Returns how many things of so many bytes fit.
    pub fn count_of(self, bytes: usize) -> usize {
        usize::try_from(self.bytes / bytes.max(1) as u64).unwrap_or(usize::MAX)
    }

    /// Returns the budget with no more bytes than so many.
    pub(crate) fn at_most(self, bytes: u64) -> Self {
        Self { bytes: self.bytes.min(bytes), ..self }
    }

    /// Returns the budget that is left when so many bytes are taken.
    pub(crate) fn beside(self, taken: u64) -> Self {
        Self { bytes: self.bytes.saturating_sub(taken), ..self }
    }

    /// Returns the budget that is left beside ffmpeg's codecs. A limit of addresses is each program's own.
    ///
    /// # Errors
    /// When they hold more; `why` says of what.
    pub(crate) fn beside_codecs(self, codecs: u64, why: &str) -> Result<Self> {
        if self.is_of_addresses || codecs == 0 {
            return Ok(self);
        }
        self.allow(codecs, "ffmpeg, which reads and makes films,", why)?;
        Ok(Self { codecs, ..self.beside(codecs) })
    }

    /// Checks that so many bytes may be used for something, and otherwise says why it needs them.
    pub(crate) fn allow(self, needed: u64, what: &str, why: &str) -> Result<()> {
        if needed <= self.bytes {
            return Ok(());
        }
        let needed = human_at_least(needed.saturating_add(self.codecs));
        let (all, with) = (self.bytes.saturating_add(self.codecs), self.with_codecs());
        if let Some(asked) = self.too_much {
            bail!(
                Memory: "{what} needs about {needed} of memory{with}, but there are {}, whatever {MEMORY} says ({}){why}; make pictures \
                 smaller, or do it where there is more memory",
                human(all),
                human(asked),
            );
        }
        // Nobody means so few bytes.
        let unit = if all < 1 << 16 { "; a number without a unit is bytes: 8G is eight gigabytes" } else { "" };
        bail!(
            Memory: "{what} needs about {needed} of memory{with}, but only {} may be used{why}; if that is right, raise {MEMORY}{unit}",
            human(all),
        );
    }

    /// Returns words about what ffmpeg's codecs hold; none where they hold nothing.
    pub(crate) fn with_codecs(self) -> String {
        match self.codecs {
            0 => String::new(),
            codecs => format!(" with ffmpeg's codecs, which hold about {}", human(codecs)),
        }
    }
}

fn header_pixels(header: &Header) -> u64 {
    area((header.width, header.height))
}

/// Returns the bytes of a pixel's samples.
fn sample_bytes(header: &Header) -> u64 {
    (header.channels.count() * header.depth.bytes()) as u64
}

/// Returns the bytes of a file's samples.
pub(crate) fn read_bytes(header: &Header) -> u64 {
    header_pixels(header).saturating_mul(sample_bytes(header))
}

/// Returns the bytes of a file's samples, and of the light decoded from them.
pub(crate) fn light_bytes(header: &Header) -> u64 {
    header_pixels(header).saturating_mul(sample_bytes(header) + size_of::<Rgba>() as u64)
}

/// Returns the pixels of a picture of this size.
pub(crate) fn area((width, height): (usize, usize)) -> u64 {
    (width as u64).saturating_mul(height as u64)
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
