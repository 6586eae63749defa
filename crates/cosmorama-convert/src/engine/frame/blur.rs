//! Frames under an open shutter.

use std::path::PathBuf;

use cosmorama::camera::View;
use cosmorama::filter::FilterKind;
use cosmorama::motion::{Exposure, LightSum, Moment};
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Progress, Share, Stopped};
use cosmorama::world::World;

use super::pictures::{Layer, Making};
use crate::diagnostic::{Result, bail};
use crate::engine::{Engine, FrameLight, Levels, Shares, Texels};
use crate::job::FrameOutputs;
use crate::settings::{BlurMethod, MotionBlur};
use crate::target::{TargetView, time};

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
        let Some(blur) = job.movement.as_ref().and_then(|movement| movement.blur) else {
            bail!("a camera without movement cannot blur")
        };
        let passes = job.layers.groups.len();
        let share = Share { whole: progress, from: 0.0, to: 1.0 / (1 + passes) as f64 };
        let exposed = Exposed { moments, blur, time: time(frame.frame.unwrap_or_default()) };
        let is_at_once = || self.is_swept_at_once((job.place(frame.frame), light), moments);
        let pictures = match blur.method {
            BlurMethod::Swept if job.has_room_for_rings && is_at_once()? => {
                self.swept_at_once(frame, light, &exposed, &share)?
            }
            BlurMethod::Swept => self.swept(frame, (light, moments), &share)?,
            BlurMethod::Ellipse => self.ellipse(frame, light, &exposed, &share)?,
        };
        if job.layers.is_plain() {
            return Ok(pictures);
        }
        let layer = self.layer(frame, progress)?;
        let rest = Share { whole: progress, from: share.to, to: 1.0 };
        let shares = self.shares(&rest, frame, passes);
        self.with_channels(frame, pictures, &mut Making { layer, shares })
    }

    /// Splits the progress of a frame whose views are made so many times.
    fn shares<'p>(&self, progress: &'p dyn Progress, frame: &FrameOutputs, times: usize) -> Shares<'p> {
        let views = self.views_of(frame);
        Shares::new(progress, views.iter().copied().cycle().take(times * views.len()))
    }

    /// Returns the views of a frame's files, in the order in which they are made.
    fn views_of(&self, frame: &FrameOutputs) -> Vec<&View> {
        let sheets = frame.files.iter().flat_map(|(file, _)| self.job.target.files[*file].levels());
        sheets.flat_map(|sheet| &sheet.pieces).map(|(index, _)| &self.job.target.views[*index].view).collect()
    }

    /// Returns whether the moments of a frame may be rendered together: nothing is done with their pictures but to sum them, and to lay
    /// what goes with the camera before them. `place` is that of the frame among all.
    fn is_swept_at_once(&self, (place, light): (usize, &FrameLight), moments: &[Moment]) -> Result<bool> {
        let job = self.job;
        if let Some(behind) = &self.behind {
            let rests = self.rests(moments);
            return Ok(rests && behind.ask(place, |engine, light| engine.is_swept_at_once((place, light), moments))?);
        }
        let is_sampled = job.filter.kind == FilterKind::Ewa && job.formula().is_none() && !job.is_balance_asked_for();
        Ok(is_sampled && self.is_solid() && self.is_complete(light))
    }

    /// Returns whether the camera sees the input in one pose at all moments.
    fn rests(&self, moments: &[Moment]) -> bool {
        let Some(movement) = &self.job.movement else { return true };
        moments.windows(2).all(|pair| movement.pose(pair[0].time) == movement.pose(pair[1].time))
    }

    /// Renders each view through the open shutter.
    fn swept_at_once(
        &self,
        frame: &FrameOutputs,
        light: &FrameLight,
        exposed: &Exposed,
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let mut layer = self.layer(frame, progress)?;
        let mut shares = self.shares(progress, frame, self.layers());
        self.pictures_of(frame, |index| {
            let mut image = self.swept_view(index, (frame.frame, light), (&mut layer, exposed), &mut shares)?;
            self.lay_background((&layer.posed, index), &mut image);
            Ok(image)
        })
    }

    /// Renders a view of the target through the open shutter, with what lies behind it, over nothing. What goes with the camera is
    /// rendered once: the mean of what it lets through is the mean of what lies behind, let through once.
    fn swept_view(
        &self,
        index: usize,
        (frame, light): (Option<u64>, &FrameLight),
        (layer, exposed): (&mut Layer, &Exposed),
        shares: &mut Shares,
    ) -> Result<Image<Rgba>> {
        if let Some(behind) = &self.behind {
            let mut image = self.alone(index, (frame, light), layer, shares)?;
            if let Some(layer) = &mut layer.behind {
                let view = &self.job.target.views[index].view;
                behind.lay_under((view, &mut image), layer.place, |engine, light| {
                    engine.swept_view(index, light, (layer, exposed), shares)
                })?;
            }
            return Ok(image);
        }
        let target = &layer.posed.views[index];
        let share = shares.next(&target.view);
        let (world, texels) = self.world_of(target, light)?;
        let made = self.exposure(index, exposed)?.swept((world, self.job.filter), texels, &share);
        made.map_err(|Stopped| self.stopped())
    }

    /// Sums the pictures of all moments, each weighed by its part of the light: every pixel goes its own way.
    fn swept(
        &self,
        frame: &FrameOutputs,
        (light, moments): (&FrameLight, &[Moment]),
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let mut sums: Vec<Vec<LightSum>> = Vec::new();
        for (k, moment) in moments.iter().enumerate() {
            let part = |k: usize| k as f64 / moments.len() as f64;
            let share = Share { whole: progress, from: part(k), to: part(k + 1) };
            let layer = self.layer_at(moment.time, frame, &Share { to: share.from, ..share })?;
            let mut making = Making { layer, shares: self.shares(&share, frame, self.layers()) };
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
        light: &FrameLight,
        exposed: &Exposed,
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let layer = self.layer(frame, progress)?;
        let mut shares = self.shares(progress, frame, 1);
        self.pictures_of(frame, |index| {
            let share = shares.next(&layer.posed.views[index].view);
            let mut image = self.widened(index, (frame.frame, light), (&layer, exposed), &share)?;
            self.lay_background((&layer.posed, index), &mut image);
            Ok(image)
        })
    }

    /// Assembles the files of a frame from pictures of the target's views.
    fn pictures_of(
        &self,
        frame: &FrameOutputs,
        mut view: impl FnMut(usize) -> Result<Image<Rgba>>,
    ) -> Result<Vec<Levels>> {
        let background = self.job.light.background;
        let file = |(file, _): &(usize, PathBuf)| {
            let sheets = self.job.target.files[*file].levels();
            let images = sheets.map(|sheet| sheet.assemble_in(&self.pool, background, &mut view));
            Ok(Levels::Light(images.collect::<Result<_>>()?))
        };
        frame.files.iter().map(file).collect()
    }

    /// Renders a view of the target by ellipses, with what lies behind it, over nothing.
    fn widened(
        &self,
        index: usize,
        (frame, light): (Option<u64>, &FrameLight),
        (layer, exposed): (&Layer, &Exposed),
        progress: &dyn Progress,
    ) -> Result<Image<Rgba>> {
        let (posed, target) = (&layer.posed, &layer.posed.views[index]);
        let own = Share { whole: progress, from: 0.0, to: if layer.behind.is_some() { 0.5 } else { 1.0 } };
        let (world, texels) = self.world_of(target, light)?;
        let exposure = self.exposure(index, exposed)?;
        let mut image = if self.job.has_room_for_rings {
            exposure.ellipses(world, texels, &own).map_err(|Stopped| self.stopped())?
        } else {
            exposure.ellipse(&*Exposure::FILTER.of_texels(world, texels))
        };
        self.close_holes((posed, index), (frame, light), &mut image)?;
        self.fill_unseen((posed, index), light, &mut image)?;
        self.thin(&mut image);
        if let (Some(behind), Some(layer)) = (&self.behind, &layer.behind) {
            behind.lay_under((&target.view, &mut image), layer.place, |engine, light| {
                engine.widened(index, light, (layer, exposed), &Share { from: own.to, to: 1.0, ..own })
            })?;
        }
        Ok(image)
    }

    /// Returns the exposure of a view of the target.
    fn exposure(&self, index: usize, exposed: &Exposed) -> Result<Exposure> {
        let job = self.job;
        let seen = |moment: &Moment| {
            let pose = job.movement.as_ref().map(|movement| movement.pose(moment.time));
            Ok((*moment, job.views_in(pose.as_ref())?[index].view.clone()))
        };
        let seen: Vec<(Moment, View)> = exposed.moments.iter().map(seen).collect::<Result<_>>()?;
        Ok(Exposure::of_moments(&seen, &exposed.blur.shutter, exposed.time))
    }

    /// Returns the world that a target shows, and its light.
    fn world_of<'l>(&'l self, target: &TargetView, light: &'l FrameLight) -> Result<(&'l World, &'l [Rgba])> {
        let Texels::Float(worlds) = light.texels() else { bail!("light of 8 bits where floats were expected") };
        Ok((self.job.world(target), &worlds[target.world(worlds.len())]))
    }
}

/// An exposure of all views.
struct Exposed<'a> {
    moments: &'a [Moment],
    blur: MotionBlur,
    /// Time of the frame.
    time: f64,
}
