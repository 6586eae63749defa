use std::sync::OnceLock;

use cosmorama::filter::{ClassicTables, FilterKind, FilterSettings, Labels};
use cosmorama::raster::{FramePool, Image, Rgba, Threads};
use cosmorama::render::{Resampler, Stopped};
use cosmorama_io::{Plane, PlaneSamples};
use rayon::prelude::*;

use super::fill::fill;
use super::finish::finish;
use super::labels::LabelTexels;
use super::{FilePlanes, FurtherFiles, ViewPlanes};
use crate::colour::{LayerContent, LayerGroup};
use crate::diagnostic::{ConvertError, Result, bail};
use crate::engine::Shares;
use crate::engine::{BalancedLight, Posed, WorldLight};
use crate::job::ConvertJob;
use crate::job::coverage::Coverage;
use crate::packing::Place;
use crate::target::Sheet;

/// Makes the further channels of frames.
#[derive(Clone, Copy)]
pub(crate) struct LayerPass<'a> {
    pub(crate) job: &'a ConvertJob,
    pub(crate) posed: &'a Posed,
    pub(crate) pool: &'a FramePool,
}

/// Numbers of a group's channels in a frame, at the texels of each world.
struct GroupTexels<'a> {
    group: &'a LayerGroup,
    worlds: &'a [Vec<Rgba>],
    /// Tables that the filter makes of them once for all pictures, as soon as one asks for them.
    tables: Vec<OnceLock<Option<ClassicTables>>>,
    labels: Option<LabelTexels<'a>>,
}

impl LayerPass<'_> {
    /// Makes the channels of each sheet. Groups are made one after the other.
    pub(crate) fn make(
        &self,
        files: &FurtherFiles<'_>,
        sheets: &[&Sheet],
        shares: &mut Shares<'_>,
    ) -> Result<Vec<Vec<Plane>>> {
        let job = self.job;
        let mut made: Vec<Vec<Plane>> = sheets.iter().map(|_| Vec::new()).collect();
        let mut worlds: Vec<Vec<Rgba>> =
            job.worlds.iter().map(|world| bytemuck::zeroed_vec(world.texel_count())).collect();
        for batch in job.layers.batches(job.input.texels() as u64) {
            let files = files.of(batch)?;
            let mut first = 0;
            for group in batch {
                let views = self.views(&files, first..first + group.channels.len())?;
                first += group.channels.len();
                let labels = (group.content == LayerContent::Labels).then(|| LabelTexels::new(job, &views));
                match &labels {
                    Some(labels) => labels.fill(job.layers.rules.labels, &mut worlds),
                    None => fill(job, group.content, &views, &mut worlds),
                }
                let tables = vec![OnceLock::new(); worlds.len()];
                let texels = GroupTexels { group, worlds: &worlds, tables, labels };
                for (sheet, planes) in sheets.iter().zip(&mut made) {
                    planes.extend(self.planes(sheet, &texels, shares)?);
                }
            }
        }
        Ok(made)
    }

    /// Returns the channels `range` of what was read, for each view.
    fn views<'f>(&self, files: &'f [FilePlanes], range: std::ops::Range<usize>) -> Result<Vec<ViewPlanes<'f>>> {
        let view = |(index, (input, header, _)): (usize, _)| {
            let (input, header): (&crate::input::InputView, &cosmorama_io::Header) = (input, header);
            let Some(file) = files.iter().find(|file| file.views.contains(&index)) else {
                bail!("{}: its channels were not read", input.name)
            };
            let place = input.part.unwrap_or(Place::whole((header.width, header.height)));
            let planes: Vec<&PlaneSamples> = file.planes[range.clone()].iter().map(|plane| &plane.samples).collect();
            if planes.iter().any(|plane| plane.len() != place.of.0 * place.of.1) {
                let path = file.path.display();
                bail!(Changed: "{path}: its size has changed; leave files alone while they are read");
            }
            Ok(ViewPlanes { planes, place })
        };
        self.job.input.present().enumerate().map(view).collect()
    }

    /// Makes the planes of a file for a group of channels.
    fn planes(&self, sheet: &Sheet, texels: &GroupTexels<'_>, shares: &mut Shares<'_>) -> Result<Vec<Plane>> {
        let (width, height) = sheet.size;
        let output = self.job.light.output();
        let channels = texels.group.channels.iter();
        let blank = |channel: &cosmorama_io::NamedChannel| Plane {
            name: channel.name.clone(),
            samples: PlaneSamples::zeros(channel.kind, width * height),
        };
        let mut planes: Vec<Plane> = channels.map(blank).collect();
        for &(index, (left, top)) in &sheet.pieces {
            let mut image = self.render(index, texels, shares)?;
            let target = &self.posed.views[index];
            if let Coverage::Fill(_) = self.job.coverage {
                self.posed.mask(self.job, index).fill_unseen(&mut image, Rgba::TRANSPARENT);
            }
            finish((texels.group.content, self.job.layers.rules), &target.view, &mut image);
            if let (LayerContent::Light, Some(output)) = (texels.group.content, &output) {
                output.convert_all(image.pixels_mut(), Threads::All);
            }
            let world = target.world(texels.worlds.len());
            planes.par_iter_mut().enumerate().for_each(|(channel, plane)| {
                let mut at = 0;
                for j in 0..image.height() {
                    let into = (top + j) * width + left;
                    for i in 0..image.width() {
                        let pixel = image.pixels()[at];
                        at += 1;
                        match &texels.labels {
                            Some(labels) => labels.copy((world, pixel), channel, (&mut plane.samples, into + i)),
                            None => plane.samples.set_number(into + i, pixel.0[channel]),
                        }
                    }
                }
            });
            self.pool.give_image(image);
        }
        Ok(planes)
    }

    /// Filters a group for a view of the target.
    fn render(&self, index: usize, texels: &GroupTexels<'_>, shares: &mut Shares<'_>) -> Result<Image<Rgba>> {
        let job = self.job;
        let target = &self.posed.views[index];
        let share = shares.next(&target.view);
        let place = target.world(texels.worlds.len());
        let light = &texels.worlds[place];
        let resampler = job.resampler(target);
        let made = if texels.labels.is_some() {
            let kind = FilterKind::Labels(job.layers.rules.labels);
            let filter = FilterSettings { kind, kernel: Labels::KERNEL, anti_ringing: false };
            Resampler { filter, ..resampler }.watched(&share).render_over(light, Rgba::TRANSPARENT)
        } else {
            // Numbers that are no light have no total to keep, so that nothing is balanced, as with holes.
            let (watched, mut balanced) = (resampler.watched(&share), BalancedLight::default());
            let tables = texels.tables[place].get_or_init(|| job.filter.tables(&job.worlds[place], light)).as_ref();
            let light = WorldLight { texels: light, tables, has_holes: true };
            self.posed.geometry.light(index, watched, light, Rgba::TRANSPARENT, self.pool, &mut balanced)
        };
        made.map_err(|Stopped| ConvertError::Stopped { done: 0, frames: job.outputs.count() })
    }
}
