//! Frames under an open shutter.

use std::borrow::Cow;
use std::sync::Arc;

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
use crate::target::{Sheet, Strip, TargetView, time};

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
        part: FramePart,
        (light, moments): (&FrameLight, &[Moment]),
        progress: &dyn Progress,
    ) -> Result<Vec<Levels>> {
        let (job, frame) = (self.job, part.frame);
        // A strip gets them beside its picture.
        let has_channels = part.strip.is_none() && !job.layers.is_plain();
        let Some(blur) = job.movement.as_ref().and_then(|movement| movement.blur) else {
            bail!("a camera without movement cannot blur")
        };
        let passes = if has_channels { job.layers.groups.len() } else { 0 };
        let share = Share { whole: progress, from: 0.0, to: 1.0 / (1 + passes) as f64 };
        let exposed = Exposed { part, moments, blur, time: time(frame.frame.unwrap_or_default()) };
        let is_at_once = || self.is_swept_at_once((job.place(frame.frame), light), moments);
        let pictures = match blur.method {
            BlurMethod::Swept if job.has_room_for_rings && is_at_once()? => {
                self.swept_at_once(light, &exposed, &share)?
            }
            BlurMethod::Swept => self.swept(light, &exposed, &share)?,
            BlurMethod::Ellipse => self.ellipse(light, &exposed, &share)?,
        };
        if !has_channels {
            return Ok(pictures);
        }
        let layer = self.layer(frame, progress)?;
        let rest = Share { whole: progress, from: share.to, to: 1.0 };
        let shares = self.shares(&rest, part, passes);
        self.with_channels(frame, pictures, &mut Making { layer, shares })
    }

    /// Splits the progress of views that are made so many times.
    fn shares<'p>(&self, progress: &'p dyn Progress, part: FramePart, times: usize) -> Shares<'p> {
        let views = part.views(&self.job.target.views);
        let sheets = self.sheets_of(part).into_iter().flatten();
        let views: Vec<&View> = sheets.flat_map(|sheet| &sheet.pieces).map(|(index, _)| &views[*index].view).collect();
        Shares::new(progress, views.iter().copied().cycle().take(times * views.len()))
    }

    /// Returns the sheets of each file.
    fn sheets_of<'p>(&'p self, part: FramePart<'p>) -> Vec<Vec<&'p Sheet>> {
        match part.strip {
            Some(strip) => vec![vec![&strip.sheet]],
            None => part.frame.files.iter().map(|(file, _)| self.job.target.files[*file].levels().collect()).collect(),
        }
    }

    /// Returns the geometry of a part of a frame, of that of the whole.
    fn layer_of_part(&self, part: FramePart, whole: Layer) -> Result<Layer> {
        if let Some(strip) = part.strip { self.layer_of_strip(&whole, strip) } else { Ok(whole) }
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
    fn swept_at_once(&self, light: &FrameLight, exposed: &Exposed, progress: &dyn Progress) -> Result<Vec<Levels>> {
        let (part, frame) = (exposed.part, exposed.part.frame);
        let mut layer = self.layer_of_part(part, self.layer(frame, progress)?)?;
        let mut shares = self.shares(progress, part, self.layers());
        self.pictures_of(part, |index| {
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
            let posed = Arc::clone(&layer.posed);
            if let Some(layer) = &mut layer.behind {
                behind.lay_under((&posed.views[index].view, &mut image), layer.place, |engine, light| {
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
    fn swept(&self, light: &FrameLight, exposed: &Exposed, progress: &dyn Progress) -> Result<Vec<Levels>> {
        let Exposed { part, moments, .. } = *exposed;
        let (frame, sheets) = (part.frame, self.sheets_of(part));
        let mut sums: Vec<Vec<LightSum>> = Vec::new();
        for (k, moment) in moments.iter().enumerate() {
            let at = |k: usize| k as f64 / moments.len() as f64;
            let share = Share { whole: progress, from: at(k), to: at(k + 1) };
            let layer = self.layer_at(moment.time, frame, &Share { to: share.from, ..share })?;
            let layer = self.layer_of_part(part, layer)?;
            let mut making = Making { layer, shares: self.shares(&share, part, self.layers()) };
            for (place, sheets) in sheets.iter().enumerate() {
                let Levels::Light(images) = self.render_sheets(sheets, (frame.frame, light), &mut making)? else {
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
    fn ellipse(&self, light: &FrameLight, exposed: &Exposed, progress: &dyn Progress) -> Result<Vec<Levels>> {
        let (part, frame) = (exposed.part, exposed.part.frame);
        let layer = self.layer_of_part(part, self.layer(frame, progress)?)?;
        let mut shares = self.shares(progress, part, 1);
        self.pictures_of(part, |index| {
            let share = shares.next(&layer.posed.views[index].view);
            let mut image = self.widened(index, (frame.frame, light), (&layer, exposed), &share)?;
            self.lay_background((&layer.posed, index), &mut image);
            Ok(image)
        })
    }

    /// Assembles files from pictures of views.
    fn pictures_of(&self, part: FramePart, mut view: impl FnMut(usize) -> Result<Image<Rgba>>) -> Result<Vec<Levels>> {
        let background = self.job.light.background;
        let file = |sheets: Vec<&Sheet>| {
            let images = sheets.iter().map(|sheet| sheet.assemble_in(&self.pool, background, &mut view));
            Ok(Levels::Light(images.collect::<Result<_>>()?))
        };
        self.sheets_of(part).into_iter().map(file).collect()
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
            Ok((*moment, exposed.part.views(&job.views_in(pose.as_ref())?)[index].view.clone()))
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

/// Part of a frame that is made at once.
#[derive(Clone, Copy)]
pub(super) struct FramePart<'a> {
    pub(super) frame: &'a FrameOutputs,
    /// Strip of one of its files; all of them if there is none.
    pub(super) strip: Option<&'a Strip>,
}

impl FramePart<'_> {
    /// Returns what it shows of the target's views, in whatever pose these are.
    fn views<'v>(&self, whole: &'v [TargetView]) -> Cow<'v, [TargetView]> {
        self.strip.map_or(Cow::Borrowed(whole), |strip| Cow::Owned(strip.views(whole)))
    }
}

/// An exposure of all views.
struct Exposed<'a> {
    part: FramePart<'a>,
    moments: &'a [Moment],
    blur: MotionBlur,
    /// Time of the frame.
    time: f64,
}
