//! Readable text of a report.

use std::fmt::{Display, Formatter, Result};

use super::{Magnification, Report, ViewReport};

impl Display for Report {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (width, height) = self.size;
        writeln!(f, "target   {width}x{height}, {} of its pixels show something", Percent(self.shown))?;
        if let Some(centre) = &self.centre {
            let (yaw, pitch) = centre.direction.longitude_latitude();
            write!(f, "centre   yaw {:.1}°, pitch {:.1}°", yaw.degrees(), pitch.degrees())?;
            if let Some((index, magnification)) = centre.view {
                write!(f, ": {}, {magnification}", self.views[index].need.name)?;
            }
            writeln!(f)?;
        }
        writeln!(f, "gathers  {:.1} texels a pixel, {} at most", self.gathered.mean, self.gathered.most)?;
        writeln!(f, "uses     {} of the texels given", Percent(self.used()))?;
        let memory = self.memory;
        let (texels, pixels) = (Bytes(memory.texels), Bytes(memory.pixels));
        let levels = match memory.levels {
            0 => String::new(),
            levels => format!(", the filter's own tables {}", Bytes(levels)),
        };
        let plan = match (Bytes(memory.plan), memory.fixed_plan) {
            (Bytes(0), _) => "no plan is kept".to_owned(),
            (plan, 0) => format!("plan of a sequence about {plan}"),
            (plan, fixed) => format!("plan of a sequence about {plan}, in 8 bits without alpha {}", Bytes(fixed)),
        };
        writeln!(f, "memory   texels {texels}{levels}, pixels {pixels}, {plan}")?;
        if let Some(uncovered) = &self.uncovered {
            writeln!(f, "missing  {uncovered}")?;
        }
        writeln!(f)?;
        let name_width = self.views.iter().map(|view| view.need.name.chars().count()).max().unwrap_or(0);
        for view in &self.views {
            writeln!(f, "{:name_width$}  {view}", view.need.name)?;
        }
        self.write_advice(f)
    }
}

impl Report {
    /// Writes one line for all views with the same advice.
    fn write_advice(&self, f: &mut Formatter<'_>) -> Result {
        let mut seen = Vec::new();
        for advised in self.views.iter().filter_map(|view| view.advised) {
            if seen.contains(&(advised.parity, advised.two_thirds)) {
                continue;
            }
            seen.push((advised.parity, advised.two_thirds));
            let ((width, height), (less_wide, less_high)) = (advised.parity, advised.two_thirds);
            let (across, down) = advised.ratio;
            write!(f, "\nadvised  {width}x{height}: one texel a pixel at the centre; now {across:.3} by {down:.3}.")?;
            write!(f, " {less_wide}x{less_high} is 2:3 (Greene & Heckbert 1986)")?;
        }
        if seen.is_empty() { Ok(()) } else { writeln!(f) }
    }
}

impl Display for ViewReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let (width, height) = self.size;
        write!(f, "{width}x{height}  ")?;
        match (self.need.seen, self.need.read) {
            // The text asks for all texels that are read: then the rest of the image may hold anything.
            (Some(seen), read) => write!(f, "needs {}, uses {}", read.unwrap_or(seen), Percent(self.used))?,
            (None, Some(read)) => write!(f, "not needed (the filter touches {read})")?,
            (None, None) => write!(f, "not needed")?,
        }
        if self.share > 0.0 {
            write!(f, ", gives {} of the picture", Percent(self.share))?;
        }
        self.magnification.map_or(Ok(()), |magnification| write!(f, ", {magnification}"))
    }
}

impl Display for Magnification {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        if self.greatest > Self::MANY {
            return write!(f, "{:.2} to any number of texels a pixel", self.least);
        }
        write!(f, "{:.2} to {:.2} texels a pixel", self.least, self.greatest)
    }
}

/// A fraction as a percentage.
pub(super) struct Percent(pub(super) f64);

impl Display for Percent {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        write!(f, "{:.1} %", 100.0 * self.0)
    }
}

/// An amount of memory.
struct Bytes(usize);

impl Display for Bytes {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        let size = self.0 as f64;
        match self.0 {
            0..1024 => write!(f, "{} B", self.0),
            1024..1_048_576 => write!(f, "{:.0} KiB", size / 1024.0),
            1_048_576..1_073_741_824 => write!(f, "{:.0} MiB", size / 1_048_576.0),
            _ => write!(f, "{:.1} GiB", size / 1_073_741_824.0),
        }
    }
}
