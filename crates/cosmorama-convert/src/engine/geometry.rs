use cosmorama::filter::FilterKind;
use cosmorama::raster::{Channels, Depth, FixedCodec, FixedDecoder, FixedLight, Image, Rgba};
use cosmorama::render::{FixedPlan, Plan, PyramidPlan, Resampler};

use crate::conversion::ConvertJob;
use crate::coverage::Coverage;
use crate::diagnostic::{Code, Diagnostic, KERNEL, MEMORY};
use crate::engine::{Balance, BalancedLight, balance};
use crate::target::TargetView;

/// The geometry of a job, in the form that its light needs: compiled by target view, where that pays and fits into memory.
pub(crate) enum Geometry {
    /// For light of any range, and how it is kept.
    Float(Vec<Option<Plan>>, Balance),
    /// For opaque pictures of 8 bits, in and out.
    Fixed(Vec<Option<FixedPlan>>, FixedCodec),
    /// For light of any range, by a pyramid of it.
    Pyramid(Vec<Option<PyramidPlan>>),
}

fn unbalanced() -> Diagnostic {
    let message = format!(
        "{KERNEL} light: there is not memory enough for all of the geometry; near poles, seams and the corners of faces light \
         may be added or lost. Give more with {MEMORY}"
    );
    Diagnostic::warning(Code::Unbalanced, message)
}

/// Where there is no room for geometry that would be used again.
fn anew() -> Diagnostic {
    let message = format!(
        "there is not memory enough to hold the geometry: it is computed anew for each frame; give more with {MEMORY}"
    );
    Diagnostic::warning(Code::PlanAnew, message)
}

impl Geometry {
    /// Compiles the geometry of a job, and returns it with its warnings.
    pub(crate) fn compile(job: &ConvertJob) -> (Self, Vec<Diagnostic>) {
        let mut warnings = Vec::new();
        if job.filter.kind == FilterKind::EwaPyramid {
            let compile = Compile {
                estimate: |r| r.plan_bytes_estimate(),
                plan: |r| r.pyramid_plan(),
                bytes: PyramidPlan::bytes,
            };
            let plans = plans(job, (pays(job), 0), &compile, &mut warnings);
            return (Self::Pyramid(plans), warnings);
        }
        let geometry = match codec(job) {
            Some(codec) => {
                let compile = Compile {
                    estimate: |r| r.fixed_plan_bytes_estimate(),
                    plan: |r| r.fixed_plan(),
                    bytes: FixedPlan::bytes,
                };
                Self::Fixed(plans(job, (pays(job), 0), &compile, &mut warnings), codec)
            }
            None => {
                let groups = balance::groups(job);
                let taken = balance::bytes_of(job, &groups);
                // What is balanced needs its plan, even for one picture.
                let is_kept = pays(job) || !groups.is_empty();
                let compile = Compile { estimate: |r| r.plan_bytes_estimate(), plan: |r| r.plan(), bytes: Plan::bytes };
                let plans = plans(job, (is_kept, taken), &compile, &mut warnings);
                if groups.iter().flatten().any(|view| plans[*view].is_none()) {
                    warnings.push(unbalanced());
                }
                let balance = Balance::of(job, groups, &plans);
                Self::Float(plans, balance)
            }
        };
        (geometry, warnings)
    }

    /// From 15 bits to 8, where the job works in those.
    pub(crate) fn codec(&self) -> Option<&FixedCodec> {
        match self {
            Self::Float(..) | Self::Pyramid(_) => None,
            Self::Fixed(_, codec) => Some(codec),
        }
    }

    /// Bytes that it holds.
    pub(crate) fn bytes(&self) -> u64 {
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
    pub(crate) fn light(
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
    pub(crate) fn codes(
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

/// How plans of one kind are made.
struct Compile<P> {
    /// About how many bytes one would hold.
    estimate: fn(&Resampler) -> usize,
    plan: fn(&Resampler) -> Option<P>,
    /// How many it holds.
    bytes: fn(&P) -> usize,
}

/// The plans of all target views, if they are to be kept, as far as they fit into memory beside what is `taken`.
fn plans<P>(
    job: &ConvertJob,
    (is_kept, taken): (bool, u64),
    compile: &Compile<P>,
    warnings: &mut Vec<Diagnostic>,
) -> Vec<Option<P>> {
    let left = job.memory.left_for_plan(&job.input, &job.target, rayon::current_num_threads());
    let (mut left, mut lacks_room) = (left.saturating_sub(taken), false);
    let plan_of = |target: &TargetView| {
        let resampler = job.resampler(target);
        if !is_kept {
            return None;
        }
        if (compile.estimate)(&resampler) as u64 > left {
            lacks_room = true;
            return None;
        }
        let plan = (compile.plan)(&resampler)?;
        left = left.saturating_sub((compile.bytes)(&plan) as u64);
        Some(plan)
    };
    let plans = job.target.views.iter().map(plan_of).collect();
    if lacks_room && pays(job) {
        warnings.push(anew());
    }
    plans
}

/// Returns the integer codec of a job; `None` unless its pictures are opaque, of 8 bits, and fit 15-bit light.
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
