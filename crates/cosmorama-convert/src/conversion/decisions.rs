//! Decisions of a conversion in words: what was found, what is made of it, and why.

use cosmorama::raster::Transfer;
use cosmorama_io::{EnvMap, FacePattern, Header};
use cosmorama_spec::{DepthName, FilterName, TransferName};

use super::Checked;
use crate::diagnostic::{
    Code, Decision, FROM, IN_PRIMARIES, IN_TRANSFER, MEMORY, Mark, OCIO, OUT_TRANSFER, PRIMARIES, SIZE, THREADS, TO,
    TRANSFER, Topic,
};
use crate::engine::{FrameFile, Which};
use crate::input::InputView;
use crate::input::lists::{hugin, world_file};
use crate::job::{ConvertJob, FrameOutputs, Space};
use crate::source::memory_budget::human;

/// Number of files that are told of one by one.
const TOLD: usize = 100;

impl Checked {
    /// Returns the decisions that the check has made.
    pub fn decisions(&self) -> Vec<Decision> {
        let mut told = Vec::new();
        if self.content.has_files() {
            told.extend(self.of_input());
        }
        told.push(self.of_output());
        told.extend(self.of_colour());
        if self.content.has_files() {
            told.push(self.of_filter());
        }
        told.push(self.of_memory());
        told.push(self.of_frames());
        told
    }

    /// Returns the files, and the projection with its reason.
    fn of_input(&self) -> Vec<Decision> {
        let (input, name) = (&self.job.input, &self.settings.input);
        let (views, present) = (input.views().count(), input.present().count());
        let (views, worlds) = (counted(views, "view"), counted(input.worlds.len(), "world"));
        let used = format!("{name}: {views} of {worlds}, {present} used, {} texels", input.texels());
        let mut told = vec![Decision::new(Topic::Input, used)];
        let first = input.frames.first().copied().flatten();
        told.extend(input.present().take(TOLD).map(|(view, header, _)| {
            let path = view.files.path(first);
            Decision::detail(Topic::Input, format!("{}: {}: {}", view.name, path.display(), described(header)))
        }));
        let unused: Vec<&InputView> = input.views().filter(|view| view.present().is_none()).take(TOLD).collect();
        told.extend(unused.into_iter().map(|view| {
            let why = if view.wanted { "it has no file" } else { "the output shows nothing of it" };
            Decision::detail(Topic::Input, format!("{}: not read, because {why}", view.name))
        }));
        told.push(Decision::new(Topic::Projection, self.found()));
        told
    }

    /// Tells the projection of the input, and what says so.
    fn found(&self) -> String {
        let name = &self.settings.input;
        if let Some(from) = &self.settings.geometry.from {
            return format!("{name} is {from}, as {FROM} says");
        }
        if world_file::is_world_file(name) || hugin::is_project(name) {
            return format!("{name} lists its views with their projections");
        }
        if let Some(guess) = self.diagnostics.iter().find(|diagnostic| diagnostic.code == Code::Detected) {
            return guess.message.marked().to_owned();
        }
        if FacePattern::parse(name).is_some() {
            return format!("{name} is the faces of a cube, because its name has a place for that of a face");
        }
        let header = self.job.input.present().next().map(|(_, header, _)| header);
        let said = header.and_then(|header| header.metadata.envmap);
        match (said, header.and_then(|header| header.metadata.panorama)) {
            (Some(EnvMap::LatLong), _) => format!("{name} is a panorama, as its envmap attribute says"),
            (Some(EnvMap::Cube | EnvMap::GlCube), _) => format!("{name} is a cube, as its format or its envmap says"),
            (None, Some(_)) => format!("{name} is a panorama or part of one, as its GPano metadata say"),
            (None, None) => format!("{name}: its projection follows from its shape"),
        }
    }

    /// Returns the pictures to make.
    fn of_output(&self) -> Decision {
        let (geometry, target) = (&self.settings.geometry, &self.job.target);
        let sizes: Vec<String> =
            target.files.iter().map(|file| format!("{}x{}", file.sheet.size.0, file.sheet.size.1)).collect();
        let size = match &sizes[..] {
            [first, rest @ ..] if rest.iter().all(|size| size == first) && !rest.is_empty() => {
                format!("{} files of {first}", sizes.len())
            }
            all => all.join(", "),
        };
        let to = match &geometry.to {
            Some(to) => format!("{to}, as {TO} says"),
            None if self.settings.output.contains("{face}") => "cube, because its name has faces".to_owned(),
            None if target.views.len() > 1 => "cube, as its format is".to_owned(),
            None => format!("equirect, since {TO} says nothing else"),
        };
        let why = match geometry.size {
            Some(_) => format!("as {SIZE} says"),
            None if self.content.has_files() => "as fine as the input at the centre".to_owned(),
            None => "the usual one".to_owned(),
        };
        let coverage = if self.job.is_complete() { "" } else { "; parts that no view covers are filled" };
        Decision::new(Topic::Projection, format!("{} is {to}; size {size}, {why}{coverage}", self.settings.output))
    }

    /// Returns the colours of the first input, of inputs that differ from it, and of the outputs.
    fn of_colour(&self) -> Vec<Decision> {
        let job = &self.job;
        let first = job.input.frames.first().copied().flatten();
        let mut told: Vec<Decision> = Vec::new();
        let mut before: Option<String> = None;
        for (view, header, _) in job.input.present().take(TOLD) {
            let text = self.colour_of(header);
            if before.as_ref() != Some(&text) {
                let message = format!("{}: {text}", view.files.path(first).display());
                told.push(if before.is_none() {
                    Decision::new(Topic::Colour, message)
                } else {
                    Decision::detail(Topic::Colour, message)
                });
            }
            before = Some(text);
        }
        let light = &job.light;
        let why = if self.settings.ocio.is_asked() {
            format!("by {OCIO}")
        } else if let Some(mark) = asked([
            (self.settings.out_transfer.is_some(), OUT_TRANSFER),
            (self.settings.transfer != TransferName::Auto && !light.depth.is_float(), TRANSFER),
            (self.settings.primaries.is_some(), PRIMARIES),
        ]) {
            format!("by {mark}")
        } else {
            "as the first input, as far as the format can say it".to_owned()
        };
        let message = format!(
            "{}: {} of {}, {}, {}, {why}",
            self.settings.output,
            light.channels,
            DepthName(light.depth),
            transfer(&light.transfer),
            light.working.primaries
        );
        told.push(Decision::new(Topic::Colour, message));
        told
    }

    /// Tells how code values of a file become light, and what says so.
    fn colour_of(&self, header: &Header) -> String {
        let (settings, metadata) = (&self.settings, &header.metadata);
        let colours = self.job.light.colours(header.channels, header.depth, metadata);
        if settings.ocio.is_asked() {
            return format!("{}, by {OCIO}", described(header));
        }
        let why = if let Some(mark) = asked([
            (settings.in_transfer.is_some(), IN_TRANSFER),
            (settings.transfer != TransferName::Auto && !header.depth.is_float(), TRANSFER),
        ]) {
            format!("by {mark}")
        } else if metadata.icc.is_some() && !settings.ignore_profile {
            "by its ICC profile".to_owned()
        } else if metadata.transfer.is_some() {
            "as it says".to_owned()
        } else {
            "since it says nothing else".to_owned()
        };
        let primaries = match (metadata.primaries, settings.in_primaries) {
            (Some(primaries), _) => format!("{primaries}, as it says"),
            (None, Some(primaries)) => format!("{primaries}, by {IN_PRIMARIES}"),
            (None, None) => "Rec. 709, since it names no primaries".to_owned(),
        };
        let converted = if colours.conversion.is_some() { "; converted to the output's" } else { "" };
        format!("{}, {} {why}, {primaries}{converted}", described(header), transfer(&colours.transfer))
    }

    fn of_filter(&self) -> Decision {
        let filter = self.job.filter;
        let name = FilterName(filter.kind);
        let kernel = self.settings.geometry.kernel;
        let ringing = if filter.anti_ringing { "on" } else { "off" };
        let numbers = if self.job.lighting.is_some() {
            "in floats, for what of the light is resampled"
        } else if self.job.fixed_codec().is_some() {
            "in integers, because inputs and outputs are opaque and of 8 bits"
        } else {
            "in floats"
        };
        Decision::new(Topic::Filter, format!("{name}, kernel {kernel}, anti-ringing {ringing}, {numbers}"))
    }

    fn of_memory(&self) -> Decision {
        let limits = &self.settings.limits;
        let why = match limits.memory {
            Some(_) => format!("as {MEMORY} says"),
            None => "three quarters of what is free".to_owned(),
        };
        let threads = self.pool.current_num_threads();
        let needed = self.job.estimated_bytes(threads);
        let codecs = self.job.memory.with_codecs();
        let why_threads = if limits.threads.is_some() { format!("as {THREADS} says") } else { "one a core".to_owned() };
        let message = format!(
            "{} may be used{codecs}, {why}, and about {} are needed for a frame; {}, {why_threads}",
            human(self.allowed.bytes),
            human(needed),
            counted(threads, "thread")
        );
        Decision::new(Topic::Memory, message)
    }

    fn of_frames(&self) -> Decision {
        let outputs = &self.job.outputs;
        let count = outputs.count().map(|count| format!("{} to make", counted(count, "frame")));
        let mut message = count.unwrap_or_else(|| "a frame to make for each that comes".to_owned());
        if outputs.skipped > 0 {
            let alike = if outputs.resumed.untold == 0 { " and made alike" } else { "" };
            message += &format!(", {} kept, because they are whole{alike}", counted(outputs.skipped, "output"));
        }
        let remade = outputs.resumed.remade.len();
        if remade > 0 {
            message += &format!(", {} made anew, because something else is there", counted(remade, "output"));
        }
        let Space { all, free, .. } = Space::of(&self.job, &self.settings);
        let each = if outputs.go_on { " a frame" } else { "" };
        message += &format!("; about {}{each} of disk", human(all));
        message += &free.map_or_else(String::new, |free| format!(", of which {} are free", human(free)));
        Decision::new(Topic::Frames, message)
    }
}

/// Returns the files of a frame that is done.
pub(super) fn of_done(job: &ConvertJob, frame: &FrameOutputs) -> Vec<Decision> {
    let read = FrameFile::all(job, frame.frame, Which::All);
    let read: Vec<String> = read.iter().take(TOLD).map(|file| file.path.display().to_string()).collect();
    let name = frame.frame.map_or_else(|| "the picture".to_owned(), |number| format!("frame {number}"));
    let written = |(_, path): &(usize, std::path::PathBuf)| {
        let bytes = std::fs::metadata(path).map_or(0, |file| file.len());
        Decision::detail(
            Topic::Frames,
            format!("{name}: {} ({}) from {}", path.display(), human(bytes), read.join(", ")),
        )
    };
    frame.files.iter().map(written).collect()
}

/// Returns the first of some settings that was given.
fn asked<const N: usize>(settings: [(bool, Mark); N]) -> Option<Mark> {
    settings.into_iter().find(|(is_given, _)| *is_given).map(|(_, mark)| mark)
}

fn described(header: &Header) -> String {
    let Header { format, width, height, channels, depth, .. } = header;
    format!("{format}, {width}x{height}, {channels} of {}", DepthName(*depth))
}

/// Names a transfer function; the curves of a profile have no name.
fn transfer(transfer: &Transfer) -> String {
    match transfer {
        Transfer::Curve(_) => "the profile's curves".to_owned(),
        other => TransferName::Fixed(other.clone()).to_string(),
    }
}

/// Counts things.
pub(super) fn counted(count: usize, noun: &str) -> String {
    if count == 1 { format!("1 {noun}") } else { format!("{count} {noun}s") }
}
