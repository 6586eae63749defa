use cosmorama::camera::View;
use cosmorama::raster::{Channels, Depth, Rgba};
use cosmorama::sphere::Orientation;
use cosmorama::world::World;
use rayon::prelude::*;

use super::ViewPlanes;
use crate::colour::{LayerContent, LightConversion};
use crate::job::ConvertJob;
use crate::settings::{DepthKind, NormalSpace};

/// A view's numbers, on their way to texels.
struct Reading<'a> {
    content: LayerContent,
    view: &'a View,
    planes: &'a ViewPlanes<'a>,
    /// Whether depths are planar.
    is_planar: bool,
    /// Frame of normals in the world.
    frame: Orientation,
    /// Conversion to working light.
    conversion: Option<LightConversion>,
}

/// Fills the texels of all worlds with a group's numbers. Light has the part that counts in the place of alpha, depths
/// become distances from the camera, and normals are turned to the world's frame.
pub(super) fn fill(job: &ConvertJob, content: LayerContent, views: &[ViewPlanes<'_>], worlds: &mut [Vec<Rgba>]) {
    let mut present = job.input.present().zip(views);
    for (world, texels) in job.worlds.iter().zip(worlds) {
        for source in World::sources(world) {
            let Some(((_, header, _), planes)) = present.next() else { return };
            let rules = job.layers.rules;
            let in_camera = content == LayerContent::Normal && rules.normals == NormalSpace::Camera;
            // Layers are coloured beside a grey picture, too.
            let colours = job.light.colours(Channels::Rgb, header.depth, &header.metadata);
            let reading = Reading {
                content,
                view: &source.view,
                planes,
                is_planar: rules.depth_of(&source.view) == DepthKind::Planar,
                frame: if in_camera { source.view.orientation } else { Orientation::IDENTITY },
                conversion: colours.conversion.filter(|_| content == LayerContent::Light),
            };
            let width = source.view.width();
            let rows = texels[source.texels()].par_chunks_mut(width.max(1)).enumerate();
            rows.for_each(|(j, row)| reading.fill_row(j, row));
        }
    }
}

impl Reading<'_> {
    fn fill_row(&self, j: usize, row: &mut [Rgba]) {
        let first = self.planes.row(j);
        let number = |channel: usize, i: usize| self.planes.planes.get(channel).map_or(0.0, |p| p.number(first + i));
        match self.content {
            LayerContent::Light | LayerContent::Numbers => {
                for (i, texel) in row.iter_mut().enumerate() {
                    let [a, b, c] = [0, 1, 2].map(|channel| number(channel, i));
                    *texel = Rgba::opaque(a, b, c).finite();
                }
                if let Some(conversion) = &self.conversion {
                    conversion.convert(row);
                }
            }
            LayerContent::Depth => {
                for (i, texel) in row.iter_mut().enumerate() {
                    *texel = distance(number(0, i));
                }
                if self.is_planar {
                    self.view.row_planar_depths(j, |i, share| row[i].0[0] /= share);
                }
            }
            LayerContent::Normal => {
                for (i, texel) in row.iter_mut().enumerate() {
                    let normal = self.frame.normal_to_world([0, 1, 2].map(|channel| number(channel, i)));
                    *texel = normal.map_or(Rgba::TRANSPARENT, |[x, y, z]| Rgba::opaque(x, y, z));
                }
            }
            // Labels are no numbers.
            LayerContent::Labels => {}
        }
    }
}

/// Least number by which renderers say that there is nothing: Blender's is 1e10, Arnold's 1e30.
const NOTHING: f32 = 1e9;

/// Returns a texel's distance, whether it counts, what stands for nothing (1 for infinity, else the number), and 1, since
/// every texel is seen.
fn distance(number: f32) -> Rgba {
    match number {
        f32::INFINITY => Rgba([0.0, 0.0, 1.0, 1.0]),
        _ if !number.is_finite() => Rgba([0.0, 0.0, 0.0, 1.0]),
        _ if number >= NOTHING || number == Depth::Half.most() => Rgba([0.0, 0.0, number, 1.0]),
        _ => Rgba([number, 1.0, 0.0, 1.0]),
    }
}
