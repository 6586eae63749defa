use std::cell::Cell;

use cosmorama::filter::FilterKind;
use cosmorama::raster::{Channels, Depth, FixedCodec, FixedDecoder, FixedLight, Image, Rgba};
use cosmorama::render::{FixedPlan, Plan, PyramidPlan, Resampler, SavedPlan};

use super::balance::{self, Balance, BalancedLight};
use super::plan_cache::PlanCache;
use crate::job::{ConvertJob, Coverage, TargetView};

/// The geometry of a job, in the form that its light needs: compiled by target view, where that pays and fits into memory.
pub(super) enum Geometry {
    /// For light of any range, and how it is kept.
    Float(Vec<Option<Plan>>, Balance),
    /// For opaque pictures of 8 bits, in and out.
    Fixed(Vec<Option<FixedPlan>>, FixedCodec),
    /// For light of any range, by a pyramid of it.
    Pyramid(Vec<Option<PyramidPlan>>),
}

const UNBALANCED: &str = "--kernel light: there is not memory enough for all of the geometry; near poles, seams and the corners \
                          of faces light may be added or lost. Give more with --memory";

const UNKEPT: &str = "--plan-cache: plans of pyramids and of the reference are not kept; with --filter ewa they are";

/// Where there is no room for geometry that would be used again: in this run, and in the next.
const ANEW: &str =
    "there is not memory enough to hold the geometry: it is computed anew for each frame; give more with --memory";
const NO_ROOM: &str =
    "--plan-cache: there is not memory enough to hold the plan: none is kept; give more with --memory";

impl Geometry {
    /// That of a job, and what should be known of it.
    pub(super) fn compile(job: &ConvertJob) -> (Self, Vec<String>) {
        let mut warnings = Vec::new();
        if job.filter.kind == FilterKind::EwaPyramid {
            if job.plan_cache.is_some() {
                warnings.push(UNKEPT.to_owned());
            }
            let lacks_room = Cell::new(false);
            let plan =
                |r: &Resampler, left| fitting(r, left, |r| r.plan_bytes_estimate(), |r| r.pyramid_plan(), &lacks_room);
            let plans = plans(job, 0, |r, left| if pays(job) { plan(r, left) } else { None }, PyramidPlan::bytes);
            warnings.extend(lacks_room.get().then(|| ANEW.to_owned()));
            return (Self::Pyramid(plans), warnings);
        }
        let geometry = match codec(job) {
            Some(codec) => {
                let plans =
                    kept(job, (pays(job), 0), |r| r.fixed_plan_bytes_estimate(), |r| r.fixed_plan(), &mut warnings);
                Self::Fixed(plans, codec)
            }
            None => {
                let groups = balance::groups(job);
                let taken = balance::bytes_of(job, &groups);
                // What is balanced needs its plan, even for one picture.
                let is_kept = pays(job) || !groups.is_empty();
                let plans = kept(job, (is_kept, taken), |r| r.plan_bytes_estimate(), |r| r.plan(), &mut warnings);
                if groups.iter().flatten().any(|view| plans[*view].is_none()) {
                    warnings.push(UNBALANCED.to_owned());
                }
                let balance = Balance::of(job, groups, &plans);
                Self::Float(plans, balance)
            }
        };
        (geometry, warnings)
    }

    /// From 15 bits to 8, where the job works in those.
    pub(super) fn codec(&self) -> Option<&FixedCodec> {
        match self {
            Self::Float(..) | Self::Pyramid(_) => None,
            Self::Fixed(_, codec) => Some(codec),
        }
    }

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::Float(plans, balance) => {
                plans.iter().flatten().map(|plan| plan.bytes() as u64).sum::<u64>() + balance.bytes()
            }
            Self::Fixed(plans, _) => plans.iter().flatten().map(|plan| plan.bytes() as u64).sum(),
            Self::Pyramid(plans) => plans.iter().flatten().map(|plan| plan.bytes() as u64).sum(),
        }
    }

    /// The pixels of a target view, of any light, in front of a background. What has holes is in no balance; `last` is of the same
    /// frame. By a plan they are made in `used`, an image that nobody uses any more, if it is as large.
    pub(super) fn light(
        &self,
        index: usize,
        resampler: Resampler,
        (texels, has_holes): (&[Rgba], bool),
        background: Rgba,
        used: Option<Image<Rgba>>,
        last: &mut BalancedLight,
    ) -> Image<Rgba> {
        // What does not serve goes before anything is made.
        let used = used.filter(|image| matches!(self, Self::Float(..)) && fits(image, &resampler));
        let made = match self {
            Self::Float(plans, balance) => plans[index].as_ref().map(|plan| {
                let over = |texels: &[Rgba], background: Rgba| match used {
                    Some(mut image) => {
                        plan.apply_into(texels, background, &mut image);
                        image
                    }
                    None => plan.apply_over(texels, background),
                };
                let balanced = if has_holes { None } else { balance.light(index, texels, last) };
                let Some(balanced) = balanced else { return over(texels, background) };
                let mut image = over(balanced, Rgba::TRANSPARENT);
                balance.complete(index, &mut image);
                image.lay_over(background);
                image
            }),
            Self::Pyramid(plans) => plans[index].as_ref().map(|plan| plan.apply_over(texels, background)),
            Self::Fixed(..) => None,
        };
        made.unwrap_or_else(|| resampler.render_over(texels, background))
    }

    /// The code values of a target view; by a plan in `used`, as [`Geometry::light`] makes its pixels.
    pub(super) fn codes(
        &self,
        index: usize,
        resampler: Resampler,
        (light, codec): (&FixedLight, &FixedCodec),
        used: Option<Image<[u8; 3]>>,
    ) -> Image<[u8; 3]> {
        let plan = match self {
            Self::Float(..) | Self::Pyramid(_) => None,
            Self::Fixed(plans, _) => plans[index].as_ref(),
        };
        let used = used.filter(|image| plan.is_some() && fits(image, &resampler));
        match (plan, used) {
            (Some(plan), Some(mut image)) => {
                plan.apply_into(light, codec, &mut image);
                image
            }
            (Some(plan), None) => plan.apply(light, codec),
            (None, _) => resampler.render_fixed(light, codec),
        }
    }
}

/// Whether an image is as large as a conversion's target.
fn fits<P>(image: &Image<P>, resampler: &Resampler) -> bool {
    (image.width(), image.height()) == (resampler.target.width(), resampler.target.height())
}

/// Whether geometry that is computed is used more than once.
fn pays(job: &ConvertJob) -> bool {
    job.outputs.frames.len() > 1
}

/// The plans of all target views; `plan_of` is told how many bytes are left for them beside what is `taken`.
fn plans<P>(
    job: &ConvertJob,
    taken: u64,
    mut plan_of: impl FnMut(&Resampler, u64) -> Option<P>,
    bytes: impl Fn(&P) -> usize,
) -> Vec<Option<P>> {
    let left = job.memory.left_for_plan(&job.input, &job.target, rayon::current_num_threads());
    let mut left = left.saturating_sub(taken);
    let plan_of = |target: &TargetView| {
        let plan = plan_of(&job.resampler(target), left)?;
        left = left.saturating_sub(bytes(&plan) as u64);
        Some(plan)
    };
    job.target.views.iter().map(plan_of).collect()
}

/// A plan, if it fits into so many bytes; if not, that is noted.
fn fitting<P>(
    resampler: &Resampler,
    left: u64,
    estimate: impl Fn(&Resampler) -> usize,
    plan: impl Fn(&Resampler) -> Option<P>,
    lacks_room: &Cell<bool>,
) -> Option<P> {
    if estimate(resampler) as u64 > left {
        lacks_room.set(true);
        return None;
    }
    plan(resampler)
}

/// Geometry for many frames is computed once, and once for many runs where it is kept, as far as it fits into memory.
fn kept<P: SavedPlan>(
    job: &ConvertJob,
    (is_kept, taken): (bool, u64),
    estimate: impl Fn(&Resampler) -> usize,
    plan: impl Fn(&Resampler) -> Option<P>,
    warnings: &mut Vec<String>,
) -> Vec<Option<P>> {
    let lacks_room = Cell::new(false);
    let plan_of = |resampler: &Resampler, left: u64| {
        let compute = || fitting(resampler, left, &estimate, &plan, &lacks_room);
        match &job.plan_cache {
            Some(folder) if !job.outputs.frames.is_empty() => {
                let mut cache = PlanCache::new(folder, left);
                let plan = cache.plan(resampler, compute);
                warnings.append(&mut cache.warnings);
                plan
            }
            _ if is_kept => compute(),
            _ => None,
        }
    };
    let plans = plans(job, taken, plan_of, P::bytes);
    let is_complete = job.outputs.frames.is_empty() || plans.iter().all(Option::is_some);
    match (&job.plan_cache, lacks_room.get()) {
        (Some(_), true) => warnings.push(NO_ROOM.to_owned()),
        (Some(_), false) if !is_complete => warnings.push(UNKEPT.to_owned()),
        (None, true) if pays(job) => warnings.push(ANEW.to_owned()),
        _ => {}
    }
    plans
}

/// That of a job whose inputs and outputs are opaque pictures of 8 bits that 15 bits of light are enough for.
fn codec(job: &ConvertJob) -> Option<FixedCodec> {
    let light = &job.light;
    let is_possible = !matches!(job.filter.kind, FilterKind::Reference { .. } | FilterKind::EwaPyramid)
        // A factor may take a texel beyond white.
        && !balance::is_asked_for(job)
        && light.channels == Channels::Rgb
        && light.depth == Depth::Eight
        && light.background.alpha() >= 1.0
        && matches!(job.coverage, Coverage::Complete)
        && job.input.present().all(|(_, header, _)| {
            let transfer = light.input_transfer(header.depth, &header.metadata);
            header.depth == Depth::Eight && !header.channels.has_alpha() && FixedDecoder::new(&transfer).is_some()
        });
    is_possible.then(|| FixedCodec::new(&light.transfer, light.background)).flatten()
}

#[cfg(test)]
mod tests {
    use cosmorama::raster::{EncodedImage, Transfer};
    use testkit::Dome;

    use super::*;

    /// An image in more memory than it needs, by which it is known again: a fresh one may be given the place of one that has gone.
    fn roomy<P: Copy>(pixel: P) -> Image<P> {
        let mut pixels = Vec::with_capacity(2 * 64 * 64);
        pixels.resize(64 * 64, pixel);
        Image::new(64, 64, pixels).expect("as many pixels")
    }

    fn is_roomy<P>(image: Image<P>) -> bool {
        image.into_pixels().capacity() >= 2 * 64 * 64
    }

    #[test]
    fn pictures_are_made_in_images_that_nobody_uses_any_more() {
        let dome = Dome::new(64);
        let plan = dome.resampler().fixed_plan().expect("a plan");
        let expected = plan.apply(&dome.light, &dome.codec);
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
        let geometry = Geometry::Fixed(vec![Some(plan)], codec);
        let codes = |used| geometry.codes(0, dome.resampler(), (&dome.light, &dome.codec), used);
        let made = codes(Some(roomy([9; 3])));
        assert!(made == expected);
        // As handed on by what writes them.
        let made = EncodedImage::of_codes(made).into_codes().expect("codes");
        assert!(made == expected && is_roomy(made));
        assert!(codes(Some(Image::filled(64, 63, [9; 3]))) == expected && codes(None) == expected, "of no other size");

        let texels: Vec<Rgba> = (0..dome.world.texel_count()).map(|texel| dome.light.rgba(texel)).collect();
        let plan = dome.resampler().plan().expect("a plan");
        let expected = plan.apply_over(&texels, Rgba::BLACK);
        let geometry = Geometry::Float(vec![Some(plan)], Balance::default());
        let light = |used| {
            geometry.light(0, dome.resampler(), (&texels, false), Rgba::BLACK, used, &mut BalancedLight::default())
        };
        let made = light(Some(roomy(Rgba::TRANSPARENT)));
        assert!(made == expected && is_roomy(made));
        assert!(light(Some(Image::filled(63, 64, Rgba::BLACK))) == expected && light(None) == expected);
    }
}
