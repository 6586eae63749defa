//! Frames under an open shutter.

use std::path::PathBuf;

use cosmorama::camera::View;
use cosmorama::filter::Ewa;
use cosmorama::motion::{Exposure, LightSum, Moment};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Progress, Share, Stopped};

use super::pictures::{Making, assemble_in};
use crate::diagnostic::{Result, bail};
use crate::engine::{BalancedLight, Engine, FrameLight, Levels, Posed, Shares, Texels};
use crate::job::FrameOutputs;
use crate::settings::{BlurMethod, MotionBlur};
use crate::target::{Movement, TargetView, time};

impl Engine<'_> {
    /// Returns the moments of a frame's exposure; `None` where nothing is blurred.
    pub(super) fn blur_of(&self, frame: &FrameOutputs) -> Result<Option<Vec<Moment>>> {
        if self.job.is_blurred && !self.job.layers.leaves_picture_out() {
            self.job.moments(frame.frame)
        } else {
            Ok(None)
        }
    }

    /// Renders the pictures of a frame under an open shutter. Further channels are those of the frame's own time: a mean of
    /// distances or of names would be neither.
    pub(super) fn render_blurred(
        &self,
        frame: &FrameOutputs,
        (light, moments): (&FrameLight, &[Moment]),
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let job = self.job;
        let Some((movement, blur)) = job.movement.as_ref().and_then(|movement| Some((movement, movement.blur?))) else {
            bail!("a camera without movement cannot blur")
        };
        let passes = job.layers.groups.len();
        let share = Share { whole: progress, from: 0.0, to: 1.0 / (1 + passes) as f64 };
        let pictures = match blur.method {
            BlurMethod::Swept => self.swept(frame, (light, moments), movement, &share)?,
            BlurMethod::Ellipse => self.ellipse(frame, (light, moments), (movement, blur), &share)?,
        };
        if job.layers.is_plain() {
            return Ok(pictures);
        }
        let posed = self.posed(frame, progress)?;
        let rest = Share { whole: progress, from: share.to, to: 1.0 };
        let views = self.views_of(frame, &posed.views);
        let shares = Shares::new(&rest, views.iter().copied().cycle().take(passes * views.len()));
        let mut making = Making { posed: &posed, balanced: BalancedLight::default(), shares };
        self.with_channels(frame, pictures, &mut making)
    }

    /// Returns the views of a frame's files, in the order in which they are made.
    fn views_of<'v>(&self, frame: &FrameOutputs, views: &'v [TargetView]) -> Vec<&'v View> {
        let sheets = frame.files.iter().flat_map(|(file, _)| self.job.target.files[*file].levels());
        sheets.flat_map(|sheet| &sheet.pieces).map(|(index, _)| &views[*index].view).collect()
    }

    /// Sums the pictures of all moments, each weighed by its part of the light: every pixel goes its own way.
    fn swept(
        &self,
        frame: &FrameOutputs,
        (light, moments): (&FrameLight, &[Moment]),
        movement: &Movement,
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let mut sums: Vec<Vec<LightSum>> = Vec::new();
        for (k, moment) in moments.iter().enumerate() {
            let part = |k: usize| k as f64 / moments.len() as f64;
            let share = Share { whole: progress, from: part(k), to: part(k + 1) };
            let pose = movement.pose(moment.time);
            let views = movement.views(&self.job.target.views, &pose)?;
            let beginning = Share { to: share.from, ..share };
            let made =
                Posed::new(self.job, (Some(pose), views, false), &beginning).map_err(|Stopped| self.stopped())?;
            let posed = made.0;
            let shares = Shares::new(&share, self.views_of(frame, &posed.views).into_iter());
            let mut making = Making { posed: &posed, balanced: BalancedLight::default(), shares };
            for (place, (file, _)) in frame.files.iter().enumerate() {
                let Levels::Light(images) = self.render_file(*file, (frame.frame, light), &mut making)? else {
                    bail!("code values where light was expected")
                };
                self.gather(&mut sums, place, images, moment.weight as f32);
            }
        }
        let levels = |sums: Vec<LightSum>| Levels::Light(sums.into_iter().map(LightSum::into_image).collect());
        Ok(sums.into_iter().map(levels).collect())
    }

    /// Adds the pictures of a moment to the sums of a file.
    fn gather(&self, sums: &mut Vec<Vec<LightSum>>, place: usize, images: Vec<Image<Rgba>>, weight: f32) {
        match sums.get_mut(place) {
            Some(sums) => sums.iter_mut().zip(images).for_each(|(sum, image)| {
                sum.add(&image, weight);
                self.pool.give_image(image);
            }),
            None => sums.push(images.into_iter().map(|image| LightSum::new(image, weight)).collect()),
        }
    }

    /// Averages the world once for each pixel, over its footprint and its path together.
    fn ellipse(
        &self,
        frame: &FrameOutputs,
        (light, moments): (&FrameLight, &[Moment]),
        (movement, blur): (&Movement, MotionBlur),
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let times: Vec<f64> = moments.iter().map(|moment| moment.time).collect();
        let views = movement.views_at(&self.job.target.views, &times)?;
        let posed = self.posed(frame, progress)?;
        let mut shares = Shares::new(progress, self.views_of(frame, &posed.views).into_iter());
        let mut view = |index: usize| {
            let share = shares.next(&posed.views[index].view);
            let seen: Vec<(Moment, View)> =
                moments.iter().zip(&views).map(|(moment, views)| (*moment, views[index].view.clone())).collect();
            let exposure = Exposure::of_moments(&seen, &blur.shutter, time(frame.frame.unwrap_or_default()));
            let image = self.widened((&posed, index), (frame.frame, light), &exposure)?;
            if share.advance(1.0).is_break() { Err(self.stopped()) } else { Ok(image) }
        };
        let background = self.job.light.background;
        let file = |(file, _): &(usize, PathBuf)| {
            let sheets = self.job.target.files[*file].levels();
            let images = sheets.map(|sheet| assemble_in(&self.pool, sheet, background, &mut view));
            Ok(Levels::Light(images.collect::<Result<_>>()?))
        };
        frame.files.iter().map(file).collect()
    }

    fn widened(
        &self,
        (posed, index): (&Posed, usize),
        (frame, light): (Option<u64>, &FrameLight),
        exposure: &Exposure,
    ) -> Result<Image<Rgba>> {
        let target = &posed.views[index];
        let Texels::Float(worlds) = light.texels() else { bail!("light of 8 bits where floats were expected") };
        let filter = Ewa { kernel: Exposure::KERNEL, anti_ringing: false };
        let prepared = filter.of_texels(self.job.world(target), &worlds[target.world(worlds.len())]);
        let mut image = exposure.ellipse(&*prepared);
        self.close_holes((posed, index), (frame, light), &mut image)?;
        self.complete((posed, index), &mut image);
        Ok(image)
    }
}
