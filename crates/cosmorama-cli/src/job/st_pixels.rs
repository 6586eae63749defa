use anyhow::{Result, bail};
use cosmorama::camera::Canvas;
use cosmorama::raster::Image;
use cosmorama::world::StPixel;
use cosmorama_io::Header;

use super::{ConvertJob, Input, InputView, Place, TargetView};

/// Where in the input's file the pixels of an output look.
pub(crate) fn st_pixels(job: &ConvertJob, target: &TargetView) -> Result<Image<StPixel>> {
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
            "--st-map tells places in one image, but the input has {count}; put them into one first, as with --to \
             cube:layout=3x2"
        ),
    }
}

/// The part of its file that a view is, and of the canvas that the file may be a window of.
fn canvas_in_file(view: &InputView, header: &Header) -> Canvas {
    let Place { corner: (left, top), of: (width, height) } =
        view.part.unwrap_or(Place::whole((header.width, header.height)));
    let ((x, y), (width, height)) = match header.window {
        Some(window) => ((window.x, window.y), (window.canvas_width, window.canvas_height)),
        None => ((0, 0), (width, height)),
    };
    Canvas { width, height, left: (left + x) as i64, top: (top + y) as i64 }
}
