//! Outputs without a filter: worlds by formula, maps of directions, and st maps.

pub(crate) mod formula;
pub(crate) mod st_map;

use std::ops::Range;
use std::path::Path;

use cosmorama::raster::{Depth, Image};
use cosmorama_io::pending::Unfinished;
use cosmorama_io::{
    LayeredRows, MadeLayers, Metadata, Plane, PlaneSamples, SampleKind, WriteOptions, write_layer_rows_hidden,
};

use crate::diagnostic::{ConvertError, Result};
use crate::engine::{Stage, Stages};
use crate::job::{ConvertJob, STRIP};
use crate::target::{Strip, TargetView};

/// A file to make, and what is needed for it.
pub(crate) struct OutputFile<'a> {
    pub(crate) job: &'a ConvertJob,
    /// Number of the frame, if it has one.
    pub(crate) frame: Option<u64>,
    /// Place of the frame among all that are made, from 0.
    pub(crate) place: usize,
    /// Target's views in the frame.
    pub(crate) views: &'a [TargetView],
    pub(crate) stages: &'a Stages,
    /// Target's views at the moments of the frame's exposure, each with its part of the light.
    pub(crate) exposure: &'a [(Vec<TargetView>, f32)],
    /// Registry of files in progress.
    pub(crate) unfinished: &'a Unfinished,
    /// Index among the target's files.
    pub(crate) index: usize,
    /// Path of the file.
    pub(crate) path: &'a Path,
}

/// Named numbers of a pixel.
struct Numbers<'n, const N: usize> {
    names: &'n [&'n str],
    /// Numbers where no view of the target lies.
    nowhere: [f32; N],
    metadata: Metadata,
}

impl OutputFile<'_> {
    /// Writes a plane for each number of its pixels, as `make` computes them for a view. Rows are made while others are written.
    fn write_numbers<const N: usize>(
        &self,
        numbers: Numbers<'_, N>,
        make: impl Fn(&TargetView) -> Result<Image<[f32; N]>> + Send + Sync,
    ) -> Result<()> {
        let Self { job, views, index, path, .. } = *self;
        let Numbers { names, nowhere, metadata } = numbers;
        let depth = job.light.depth;
        let mut failed = None;
        let rows = &mut |rows: Range<usize>| {
            let strip = Strip::of(&job.target, index, rows);
            let views = strip.views(views);
            let image = strip.sheet.assemble(nowhere, |view| make(&views[view]));
            let image = image.map_err(|error: ConvertError| failed = Some(error)).ok()?;
            let plane =
                |(number, name): (usize, &&str)| plane(name, depth, image.pixels().iter().map(|pixel| pixel[number]));
            Some(LayeredRows { picture: None, planes: names.iter().enumerate().map(plane).collect() })
        };
        let planes = names.iter().map(|name| ((*name).to_owned(), SampleKind::from(depth))).collect();
        let size = job.target.files[index].sheet.size;
        let layers = MadeLayers { size, picture: None, names: Vec::new(), planes, at_once: STRIP, make: rows };
        let options = WriteOptions { unfinished: self.unfinished.clone(), ..WriteOptions::with_metadata(metadata) };
        let written = self.stages.alone(Stage::Filter, || write_layer_rows_hidden(path, layers, &options));
        match failed {
            Some(error) => Err(error),
            None => Ok(written?.appear()?),
        }
    }
}

/// Returns a plane of numbers, as halves or as floats.
fn plane(name: &str, depth: Depth, numbers: impl Iterator<Item = f32>) -> Plane {
    let numbers: Vec<f32> = numbers.collect();
    let mut samples = PlaneSamples::zeros(SampleKind::from(depth), numbers.len());
    numbers.into_iter().enumerate().for_each(|(at, number)| samples.set_number(at, number));
    Plane { name: name.to_owned(), samples }
}
