use anyhow::{Result, bail};
use cosmorama::raster::Image;
use cosmorama::sphere::Direction;
use cosmorama::world::World;

use super::{ConvertJob, Input, InputView, TargetView};

/// The numbers of an st map's pixel: s to the right, t up, and the part of the pixel that shows anything.
pub(crate) type StPixel = [f32; 3];

/// What a pixel holds that shows nothing of the input: a place outside it.
const NOWHERE: StPixel = [-1.0, -1.0, 0.0];

/// Where in the input's file the pixels of an output look.
pub(crate) fn st_pixels(job: &ConvertJob, target: &TargetView) -> Result<Image<StPixel>> {
    check_one_file(&job.input)?;
    let (view, index) = (&target.view, target.world(job.worlds.len()));
    let (world, views) = (&job.worlds[index], &job.input.worlds[index]);
    let mut image = Image::filled(view.width(), view.height(), NOWHERE);
    let width = view.width();
    for (at, numbers) in image.pixels_mut().iter_mut().enumerate() {
        let Some(pixel) = view.screen_pixel(at % width, at / width) else { continue };
        if let Some([s, t]) = place(views, world, pixel.footprint.direction) {
            *numbers = [s as f32, t as f32, pixel.coverage as f32];
        }
    }
    Ok(image)
}

fn check_one_file(input: &Input) -> Result<()> {
    let mut files: Vec<_> = input.paths(input.frames[0]);
    files.dedup();
    match files.len() {
        1 => Ok(()),
        count => bail!(
            "--st-map tells places in one image, but the input has {count}; put them into one first, as with --to \
             cube:layout=3x2"
        ),
    }
}

/// The place in the file, its canvas as a whole, from the lower left corner to the upper right one.
fn place(views: &[InputView], world: &World, direction: Direction) -> Option<[f64; 2]> {
    let (index, pixel) = world.owner(direction)?;
    let (view, header, _) = views.iter().filter_map(InputView::present).nth(index)?;
    let (left, top) = view.part.map_or((0, 0), |part| part.corner);
    let (width, height) = view.part.map_or((header.width, header.height), |part| part.of);
    let ((x, y), (width, height)) = match header.window {
        Some(window) => ((window.x, window.y), (window.canvas_width, window.canvas_height)),
        None => ((0, 0), (width, height)),
    };
    let (x, y) = (pixel.x + (left + x) as f64, pixel.y + (top + y) as f64);
    Some([x / width as f64, 1.0 - y / height as f64])
}
