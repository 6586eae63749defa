use cosmorama::filter::ClassicTables;
use cosmorama::raster::{Encoder, FixedCodec, FixedLight, FramePool, Image, Rgba};
use cosmorama::render::{Arithmetic, Plan, Progress, Stopped, Watched};

use crate::colour::LayerContent;
use crate::diagnostic::{Code, Diagnostic, KERNEL, MEMORY};
use crate::engine::{Balance, BalancedLight, Shares, balance};
use crate::job::{ConvertJob, STRIP};
use crate::source::MemoryBudget;
use crate::target::{Strip, TargetView};

/// Light of a world in a frame.
#[derive(Clone, Copy)]
pub(crate) struct WorldLight<'a> {
    pub(crate) texels: &'a [Rgba],
    /// Tables that the filter has made of it.
    pub(crate) tables: Option<&'a ClassicTables>,
    /// Whether texels are missing.
    pub(crate) has_holes: bool,
}

/// Geometry of a job, compiled for each target view where that pays and fits into memory.
pub(crate) struct Geometry {
    plans: Vec<Option<Plan>>,
    /// Arithmetic of the plans.
    arithmetic: Arithmetic,
    /// Energy balance.
    balance: Balance,
    /// Bytes that balanced pictures keep free for the plan of a strip.
    strip: u64,
}

fn unbalanced() -> Diagnostic {
    let message = format!(
        "{KERNEL} light: there is not memory enough for all of the geometry; near poles, seams and the corners of faces light \
         may be added or lost. Give more with {MEMORY}"
    );
    Diagnostic::warning(Code::Unbalanced, message)
}

/// Returns the warning that reusable geometry does not fit into memory.
fn anew(memory: MemoryBudget) -> Diagnostic {
    let with = memory.with_codecs();
    let message = format!(
        "there is not memory enough to hold the geometry{with}: it is computed anew for each frame; give more with {MEMORY}"
    );
    Diagnostic::warning(Code::PlanAnew, message)
}

/// Returns the warning that the geometry of some strips, of all, does not fit into memory.
pub(super) fn partly_anew(kept: usize, all: usize) -> Diagnostic {
    let message = format!(
        "there is memory enough for the geometry of {kept} of {all} strips: that of the others is computed anew for each frame; give more with \
         {MEMORY}"
    );
    Diagnostic::warning(Code::PlanAnew, message)
}

impl Geometry {
    /// Compiles the geometry of a job's views in one pose, and returns it with its warnings. It is kept by plans where that
    /// pays: if the pose `is_repeated`, or serves further channels.
    pub(crate) fn compile(
        job: &ConvertJob,
        (views, is_repeated): (&[TargetView], bool),
        progress: &dyn Progress,
    ) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        let mut warnings = Vec::new();
        let arithmetic = arithmetic(job);
        if job.lighting.is_some() || job.formula().is_some() {
            let plans = views.iter().map(|_| None).collect();
            return Ok((Self { plans, arithmetic, balance: Balance::default(), strip: 0 }, warnings));
        }
        let groups = balance::groups(job, views);
        if job.is_by_strips() {
            return Self::by_strips((job, views), groups, progress);
        }
        // Balanced pictures need their plan, even if there is only one.
        let is_kept = is_repeated || has_passes(job) || !groups.is_empty();
        let plans = if is_kept {
            let taken = balance::bytes_of((job, views), &groups);
            plans((job, views, is_repeated), (arithmetic, left_for_plans(job, taken)), progress, &mut warnings)?
        } else {
            views.iter().map(|_| None).collect()
        };
        if groups.iter().flatten().any(|view| plans[*view].is_none()) {
            warnings.push(unbalanced());
        }
        let balance = Balance::of((job, views), groups, &plans);
        Ok((Self { plans, arithmetic, balance, strip: 0 }, warnings))
    }

    /// Computes the balance of pictures that are made strip by strip, if there is room for it and for the plan of a strip.
    fn by_strips(
        (job, views): (&ConvertJob, &[TargetView]),
        groups: Vec<Vec<usize>>,
        progress: &dyn Progress,
    ) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        let (plans, arithmetic) = (views.iter().map(|_| None).collect(), arithmetic(job));
        let mut geometry = Self { plans, arithmetic, balance: Balance::default(), strip: 0 };
        if groups.is_empty() {
            return Ok((geometry, Vec::new()));
        }
        let strip = strip_bytes(job, views);
        if left_for_plans(job, balance::bytes_by_strips((job, views), &groups)) < strip {
            return Ok((geometry, vec![unbalanced()]));
        }
        (geometry.balance, geometry.strip) = (Balance::by_strips((job, views), groups, progress)?, strip);
        Ok((geometry, Vec::new()))
    }

    /// Compiles the geometry of a strip's views in the pose of the whole, like [`Geometry::compile`]. So many bytes are `taken` by that of
    /// other strips.
    pub(crate) fn of_strip(
        (job, whole): (&ConvertJob, &Self),
        (strip, views, is_repeated): (&Strip, &[TargetView], bool),
        taken: u64,
        progress: &dyn Progress,
    ) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        let (mut warnings, arithmetic) = (Vec::new(), arithmetic(job));
        let is_balanced = !whole.balance.is_empty();
        let plans = if is_balanced && !is_repeated {
            // There is room for it, and strips without it would stand out.
            plans((job, views, false), (arithmetic, u64::MAX), progress, &mut warnings)?
        } else if job.formula().is_none() && (is_repeated || has_passes(job)) {
            let left = left_for_plans(job, taken.saturating_add(whole.bytes()));
            plans((job, views, is_repeated), (arithmetic, left), progress, &mut warnings)?
        } else {
            views.iter().map(|_| None).collect()
        };
        let balance = whole.balance.of_strip(strip, &plans);
        Ok((Self { plans, arithmetic, balance, strip: 0 }, warnings))
    }

    /// Returns whether each of its views has a plan.
    pub(crate) fn is_whole(&self) -> bool {
        self.plans.iter().all(Option::is_some)
    }

    /// Returns the number of plans that are kept.
    pub(crate) fn kept(&self) -> usize {
        self.plans.iter().flatten().count()
    }

    /// Returns the bytes that it holds.
    pub(crate) fn bytes(&self) -> u64 {
        self.plans.iter().flatten().map(|plan| plan.bytes() as u64).sum::<u64>() + self.balance.bytes() + self.strip
    }

    fn plan(&self, index: usize, arithmetic: Arithmetic) -> Option<&Plan> {
        self.plans[index].as_ref().filter(|_| self.arithmetic == arithmetic)
    }

    /// Renders a target view from light of any range over a background. With holes there is no balance; `last` belongs
    /// to the same frame. With a plan, pixels are written into memory of a pool.
    pub(crate) fn light(
        &self,
        index: usize,
        watched: Watched,
        WorldLight { texels, tables, has_holes }: WorldLight,
        background: Rgba,
        pool: &FramePool,
        last: &mut BalancedLight,
    ) -> Result<Image<Rgba>, Stopped> {
        let plan = self.plan(index, Arithmetic::Float);
        let Some(plan) = plan else { return watched.render_by(tables, texels, background) };
        let target = watched.resampler.target;
        let over = |texels: &[Rgba], background: Rgba| {
            let mut image = pool.take_image(target.width(), target.height());
            plan.apply_into(texels, background, &mut image);
            image
        };
        let balanced = if has_holes { None } else { self.balance.light(index, texels, last) };
        let Some(balanced) = balanced else { return whole(over(texels, background), watched) };
        let mut image = over(balanced, Rgba::TRANSPARENT);
        self.balance.complete(index, &mut image);
        image.lay_over(background);
        whole(image, watched)
    }

    /// Returns whether a target view has a plan that makes the samples of an encoder at once.
    pub(crate) fn encodes(&self, index: usize, encoder: &Encoder) -> bool {
        self.plan(index, Arithmetic::Float).is_some_and(|plan| plan.encodes(encoder))
    }

    /// Renders the samples of a target view whose plan makes them at once, from light of any range over a background, without a
    /// balance. They are written into memory of a pool.
    pub(crate) fn samples(
        &self,
        index: usize,
        watched: Watched,
        (texels, background): (&[Rgba], Rgba),
        encoder: &Encoder,
        pool: &FramePool,
    ) -> Result<Image<[u8; 3]>, Stopped> {
        let target = watched.resampler.target;
        let mut image = pool.take_image(target.width(), target.height());
        if let Some(plan) = self.plan(index, Arithmetic::Float) {
            plan.apply_encoded_into(texels, background, encoder, &mut image);
        }
        whole(image, watched)
    }

    /// Renders the code values of a target view. With a plan, they are written into memory of a pool.
    pub(crate) fn codes(
        &self,
        index: usize,
        watched: Watched,
        (light, codec): (&FixedLight, &FixedCodec),
        pool: &FramePool,
    ) -> Result<Image<[u8; 3]>, Stopped> {
        let plan = self.plan(index, Arithmetic::Fixed);
        let Some(plan) = plan else { return watched.render_fixed(light, codec) };
        let target = watched.resampler.target;
        let mut image = pool.take_image(target.width(), target.height());
        plan.apply_fixed_into(light, codec, &mut image);
        whole(image, watched)
    }
}

/// Reports the progress of a picture that a plan makes in one step.
fn whole<P>(image: Image<P>, Watched { progress, .. }: Watched) -> Result<Image<P>, Stopped> {
    if progress.advance(1.0).is_break() { Err(Stopped) } else { Ok(image) }
}

/// Returns whether the geometry of one frame would be used more than once, for further channels.
fn has_passes(job: &ConvertJob) -> bool {
    let layers = &job.layers;
    let filtered = layers.groups.iter().filter(|group| group.content != LayerContent::Labels).count();
    filtered + usize::from(!layers.leaves_picture_out()) > 1
}

/// Returns the bytes of the balance of pictures that are made strip by strip, with the plan of a strip.
pub(super) fn balance_bytes(job: &ConvertJob) -> u64 {
    let views = &job.target.views[..];
    let groups = balance::groups(job, views);
    let strip = if groups.is_empty() { 0 } else { strip_bytes(job, views) };
    balance::bytes_by_strips((job, views), &groups).saturating_add(strip)
}

/// Returns the bytes of the plan of a strip, with which further channels are filtered.
pub(super) fn bytes_of_passes(job: &ConvertJob) -> u64 {
    if has_passes(job) { strip_bytes(job, &job.target.views).min(left_for_plans(job, 0)) } else { 0 }
}

/// Returns the bytes that are left for plans beside what is `taken`.
fn left_for_plans(job: &ConvertJob, taken: u64) -> u64 {
    job.memory.left_for_plan(job.frame_needs(), rayon::current_num_threads()).saturating_sub(taken)
}

/// Returns the bytes of the largest plan of a strip, with the target's views in some pose.
fn strip_bytes(job: &ConvertJob, views: &[TargetView]) -> u64 {
    let plan = |target: &TargetView| job.resampler(target).plan_bytes_estimate(Arithmetic::Float) as u64;
    let bytes = |strip: Strip| strip.views(views).iter().map(plan).sum();
    Strip::all(&job.target, STRIP).map(bytes).max().unwrap_or(0)
}

/// Makes the plans of all target views, as far as they fit into the bytes that are `left`.
fn plans(
    (job, views, is_repeated): (&ConvertJob, &[TargetView], bool),
    (arithmetic, mut left): (Arithmetic, u64),
    progress: &dyn Progress,
    warnings: &mut Vec<Diagnostic>,
) -> Result<Vec<Option<Plan>>, Stopped> {
    let mut shares = Shares::new(progress, views.iter().map(|target| &target.view));
    let mut lacks_room = false;
    let plan_of = |target: &TargetView| {
        let (resampler, share) = (job.resampler(target), shares.next(&target.view));
        if resampler.plan_bytes_estimate(arithmetic) as u64 > left {
            lacks_room = true;
            return Ok(None);
        }
        let plan = resampler.watched(&share).plan(arithmetic)?;
        left = left.saturating_sub(plan.as_ref().map_or(0, Plan::bytes) as u64);
        Ok(plan)
    };
    let plans = views.iter().map(plan_of).collect::<Result<_, Stopped>>()?;
    if lacks_room && is_repeated {
        warnings.push(anew(job.memory));
    }
    Ok(plans)
}

/// Returns the arithmetic of a job's plans.
pub(crate) fn arithmetic(job: &ConvertJob) -> Arithmetic {
    if job.fixed_codec().is_some() { Arithmetic::Fixed } else { Arithmetic::Float }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use testkit::Dome;

    use super::*;

    #[test]
    fn pictures_are_made_in_memory_that_others_have_left() {
        let dome = Dome::new(64);
        let plan = dome.resampler().plan(Arithmetic::Fixed).expect("a plan");
        let expected = plan.apply_fixed(&dome.light, &dome.codec);
        let geometry =
            Geometry { plans: vec![Some(plan)], arithmetic: Arithmetic::Fixed, balance: Balance::default(), strip: 0 };
        let watched = || dome.resampler().watched(&|_: f64| ControlFlow::Continue(()));
        let codes = |pool: &FramePool| geometry.codes(0, watched(), (&dome.light, &dome.codec), pool).expect("pixels");
        let pool = FramePool::keeping(1 << 20);
        let mut left = pool.take_image::<[u8; 3]>(64, 64);
        left.pixels_mut().fill([9; 3]);
        let place = left.pixels().as_ptr();
        pool.give_image(left);
        let made = codes(&pool);
        assert!(made == expected && made.pixels().as_ptr() == place);
        assert!(codes(&FramePool::default()) == expected);

        let texels: Vec<Rgba> = (0..dome.world.texel_count()).map(|texel| dome.light.rgba(texel)).collect();
        let plan = dome.resampler().plan(Arithmetic::Float).expect("a plan");
        let expected = plan.apply_over(&texels, Rgba::BLACK);
        let geometry =
            Geometry { plans: vec![Some(plan)], arithmetic: Arithmetic::Float, balance: Balance::default(), strip: 0 };
        let left = pool.take_image::<Rgba>(64, 64);
        let place = left.pixels().as_ptr();
        pool.give_image(left);
        let mut last = BalancedLight::default();
        let light = WorldLight { texels: &texels, tables: None, has_holes: false };
        let made = geometry.light(0, watched(), light, Rgba::BLACK, &pool, &mut last).expect("pixels");
        assert!(made == expected && made.pixels().as_ptr() == place);
    }
}
