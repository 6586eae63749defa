//! St maps: the place in the input's file at which each pixel of an output looks.

use cosmorama::camera::Canvas;
use cosmorama::raster::Image;
use cosmorama::world::{ST_NOWHERE, StPixel};
use cosmorama_io::{Header, Metadata};

use crate::diagnostic::{Result, ST_MAP, TO, bail};
use crate::engine::unfiltered::{Numbers, OutputFile};
use crate::input::{Input, InputView};
use crate::job::ConvertJob;
use crate::packing::Place;
use crate::target::TargetView;

/// Channel names of an st map, in order.
const CHANNELS: [&str; 3] = ["R", "G", "B"];

/// Writes the st map of a file.
pub(crate) fn make(output: &OutputFile) -> Result<()> {
    let numbers = Numbers { names: &CHANNELS, nowhere: ST_NOWHERE, metadata: Metadata::default() };
    output.write_numbers(numbers, |target| st_pixels(output.job, target))
}

/// Computes the places in the input's file at which the pixels of an output look.
fn st_pixels(job: &ConvertJob, target: &TargetView) -> Result<Image<StPixel>> {
    check_one_file(&job.input)?;
    let index = target.world(job.worlds.len());
    let present = job.input.worlds[index].iter().filter_map(InputView::present);
    let canvases: Vec<Canvas> = present.map(|(view, header, _)| canvas_in_file(view, header)).collect();
    Ok(job.worlds[index].st_pixels(&target.view, &canvases))
}

fn check_one_file(input: &Input) -> Result<()> {
    let mut files: Vec<_> = input.paths(input.frames[0]);
    files.sort_unstable();
    files.dedup();
    match files.len() {
        1 => Ok(()),
        count => bail!(
            "{ST_MAP} tells places in one image, but the input has {count}; put them into one first, as with {TO} \
             cube:layout=3x2"
        ),
    }
}

/// Returns the place of a view in its file, or in the canvas of which the file is a window.
fn canvas_in_file(view: &InputView, header: &Header) -> Canvas {
    let Place { corner: (left, top), of: (width, height) } =
        view.part.unwrap_or(Place::whole((header.width, header.height)));
    let ((x, y), (width, height)) = match header.window {
        Some(window) => ((window.x, window.y), (window.canvas_width, window.canvas_height)),
        None => ((0, 0), (width, height)),
    };
    Canvas { width, height, left: (left + x) as i64, top: (top + y) as i64 }
}
