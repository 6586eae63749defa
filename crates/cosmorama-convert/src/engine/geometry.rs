use cosmorama::filter::FilterKind;
use cosmorama::raster::{Channels, Depth, FixedCodec, FixedDecoder, FixedLight, Image, Rgba};
use cosmorama::render::{Arithmetic, Plan, Resampler};

use crate::conversion::ConvertJob;
use crate::coverage::Coverage;
use crate::diagnostic::{Code, Diagnostic, KERNEL, MEMORY};
use crate::engine::{Balance, BalancedLight, balance};
use crate::target::TargetView;

/// Geometry of a job, compiled for each target view where that pays and fits into memory.
pub(crate) struct Geometry {
    plans: Vec<Option<Plan>>,
    /// Encoder from 15 bits to 8, for jobs with opaque 8-bit pictures in and out.
    codec: Option<FixedCodec>,
    /// Energy balance.
    balance: Balance,
}

fn unbalanced() -> Diagnostic {
    let message = format!(
        "{KERNEL} light: there is not memory enough for all of the geometry; near poles, seams and the corners of faces light \
         may be added or lost. Give more with {MEMORY}"
    );
    Diagnostic::warning(Code::Unbalanced, message)
}

/// Returns the warning that reusable geometry does not fit into memory.
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
        let codec = codec(job);
        let arithmetic = if codec.is_some() { Arithmetic::Fixed } else { Arithmetic::Float };
        let groups = balance::groups(job);
        // What is balanced needs its plan, even for one picture.
        let is_kept = pays(job) || !groups.is_empty();
        let plans = if is_kept {
            plans(job, arithmetic, balance::bytes_of(job, &groups), &mut warnings)
        } else {
            job.target.views.iter().map(|_| None).collect()
        };
        if groups.iter().flatten().any(|view| plans[*view].is_none()) {
            warnings.push(unbalanced());
        }
        let balance = Balance::of(job, groups, &plans);
        (Self { plans, codec, balance }, warnings)
    }

    /// Returns the encoder from 15 bits to 8, if the job uses it.
    pub(crate) fn codec(&self) -> Option<&FixedCodec> {
        self.codec.as_ref()
    }

    /// Returns the bytes that it holds.
    pub(crate) fn bytes(&self) -> u64 {
        self.plans.iter().flatten().map(|plan| plan.bytes() as u64).sum::<u64>() + self.balance.bytes()
    }

    /// Renders a target view from light of any range over a background. With holes there is no balance; `last` belongs
    /// to the same frame. With a plan, pixels are written into `used`, an image to reuse, if its size fits.
    pub(crate) fn light(
        &self,
        index: usize,
        resampler: Resampler,
        (texels, has_holes): (&[Rgba], bool),
        background: Rgba,
        used: Option<Image<Rgba>>,
        last: &mut BalancedLight,
    ) -> Image<Rgba> {
        let plan = self.plans[index].as_ref().filter(|_| self.codec.is_none());
        // What does not serve goes before anything is made.
        let used = used.filter(|image| plan.is_some() && fits(image, &resampler));
        let Some(plan) = plan else { return resampler.render_over(texels, background) };
        let over = |texels: &[Rgba], background: Rgba| match used {
            Some(mut image) => {
                plan.apply_into(texels, background, &mut image);
                image
            }
            None => plan.apply_over(texels, background),
        };
        let balanced = if has_holes { None } else { self.balance.light(index, texels, last) };
        let Some(balanced) = balanced else { return over(texels, background) };
        let mut image = over(balanced, Rgba::TRANSPARENT);
        self.balance.complete(index, &mut image);
        image.lay_over(background);
        image
    }

    /// Renders the code values of a target view. With a plan, they are written into `used`, as in [`Geometry::light`].
    pub(crate) fn codes(
        &self,
        index: usize,
        resampler: Resampler,
        (light, codec): (&FixedLight, &FixedCodec),
        used: Option<Image<[u8; 3]>>,
    ) -> Image<[u8; 3]> {
        let plan = self.plans[index].as_ref().filter(|_| self.codec.is_some());
        let used = used.filter(|image| plan.is_some() && fits(image, &resampler));
        match (plan, used) {
            (Some(plan), Some(mut image)) => {
                plan.apply_fixed_into(light, codec, &mut image);
                image
            }
            (Some(plan), None) => plan.apply_fixed(light, codec),
            (None, _) => resampler.render_fixed(light, codec),
        }
    }
}

/// Returns whether an image has the size of a conversion's target.
fn fits<P>(image: &Image<P>, resampler: &Resampler) -> bool {
    (image.width(), image.height()) == (resampler.target.width(), resampler.target.height())
}

/// Returns whether geometry would be used more than once.
fn pays(job: &ConvertJob) -> bool {
    job.outputs.frames.len() > 1
}

/// Makes the plans of all target views, as far as they fit into memory beside what is `taken`.
fn plans(job: &ConvertJob, arithmetic: Arithmetic, taken: u64, warnings: &mut Vec<Diagnostic>) -> Vec<Option<Plan>> {
    let left = job.memory.left_for_plan(&job.input, &job.target, rayon::current_num_threads());
    let (mut left, mut lacks_room) = (left.saturating_sub(taken), false);
    let plan_of = |target: &TargetView| {
        let resampler = job.resampler(target);
        if resampler.plan_bytes_estimate(arithmetic) as u64 > left {
            lacks_room = true;
            return None;
        }
        let plan = resampler.plan(arithmetic)?;
        left = left.saturating_sub(plan.bytes() as u64);
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
        let plan = dome.resampler().plan(Arithmetic::Fixed).expect("a plan");
        let expected = plan.apply_fixed(&dome.light, &dome.codec);
        let codec = FixedCodec::new(&Transfer::Srgb, Rgba::BLACK).expect("sRGB has 8 bits");
        let geometry = Geometry { plans: vec![Some(plan)], codec: Some(codec), balance: Balance::default() };
        let codes = |used| geometry.codes(0, dome.resampler(), (&dome.light, &dome.codec), used);
        let made = codes(Some(roomy([9; 3])));
        assert!(made == expected);
        // As handed on by what writes them.
        let made = EncodedImage::of_codes(made).into_codes().expect("codes");
        assert!(made == expected && is_roomy(made));
        assert!(codes(Some(Image::filled(64, 63, [9; 3]))) == expected && codes(None) == expected, "of no other size");

        let texels: Vec<Rgba> = (0..dome.world.texel_count()).map(|texel| dome.light.rgba(texel)).collect();
        let plan = dome.resampler().plan(Arithmetic::Float).expect("a plan");
        let expected = plan.apply_over(&texels, Rgba::BLACK);
        let geometry = Geometry { plans: vec![Some(plan)], codec: None, balance: Balance::default() };
        let light = |used| {
            geometry.light(0, dome.resampler(), (&texels, false), Rgba::BLACK, used, &mut BalancedLight::default())
        };
        let made = light(Some(roomy(Rgba::TRANSPARENT)));
        assert!(made == expected && is_roomy(made));
        assert!(light(Some(Image::filled(63, 64, Rgba::BLACK))) == expected && light(None) == expected);
    }
}
