use cosmorama::raster::{Channels, Depth, FixedCodec, FixedDecoder, FixedLight, Image, Rgba};
use cosmorama::resample::{FilterKind, FixedPlan, Plan, PyramidPlan, Resampler};

use crate::job::{ConvertJob, Coverage, TargetView};

/// The geometry of a job, in the form that its light needs: compiled by target view, where that pays and fits into memory.
pub(super) enum Geometry {
    /// For light of any range.
    Float(Vec<Option<Plan>>),
    /// For opaque pictures of 8 bits, in and out.
    Fixed(Vec<Option<FixedPlan>>, FixedCodec),
    /// For light of any range, by a pyramid of it.
    Pyramid(Vec<Option<PyramidPlan>>),
}

impl Geometry {
    /// That of a job.
    pub(super) fn compile(job: &ConvertJob) -> Self {
        if job.filter.kind == FilterKind::EwaPyramid {
            return Self::Pyramid(plans(job, |r| r.plan_bytes_estimate(), |r| r.pyramid_plan(), PyramidPlan::bytes));
        }
        match codec(job) {
            Some(codec) => {
                let plans = plans(job, |r| r.fixed_plan_bytes_estimate(), |r| r.fixed_plan(), FixedPlan::bytes);
                Self::Fixed(plans, codec)
            }
            None => Self::Float(plans(job, |r| r.plan_bytes_estimate(), |r| r.plan(), Plan::bytes)),
        }
    }

    /// From 15 bits to 8, where the job works in those.
    pub(super) fn codec(&self) -> Option<&FixedCodec> {
        match self {
            Self::Float(_) | Self::Pyramid(_) => None,
            Self::Fixed(_, codec) => Some(codec),
        }
    }

    /// Bytes that it holds.
    pub(super) fn bytes(&self) -> u64 {
        match self {
            Self::Float(plans) => plans.iter().flatten().map(|plan| plan.bytes() as u64).sum(),
            Self::Fixed(plans, _) => plans.iter().flatten().map(|plan| plan.bytes() as u64).sum(),
            Self::Pyramid(plans) => plans.iter().flatten().map(|plan| plan.bytes() as u64).sum(),
        }
    }

    /// The pixels of a target view, of any light.
    pub(super) fn light(&self, index: usize, resampler: Resampler, texels: &[Rgba]) -> Image<Rgba> {
        let made = match self {
            Self::Float(plans) => plans[index].as_ref().map(|plan| plan.apply(texels)),
            Self::Pyramid(plans) => plans[index].as_ref().map(|plan| plan.apply(texels)),
            Self::Fixed(..) => None,
        };
        made.unwrap_or_else(|| resampler.render(texels))
    }

    /// The code values of a target view.
    pub(super) fn codes(
        &self,
        index: usize,
        resampler: Resampler,
        light: &FixedLight,
        codec: &FixedCodec,
    ) -> Image<[u8; 3]> {
        let plan = match self {
            Self::Float(_) | Self::Pyramid(_) => None,
            Self::Fixed(plans, _) => plans[index].as_ref(),
        };
        plan.map_or_else(|| resampler.render_fixed(light, codec), |plan| plan.apply(light, codec))
    }
}

/// Geometry for many frames is computed once, as far as it fits into memory.
fn plans<P>(
    job: &ConvertJob,
    estimate: impl Fn(&Resampler) -> usize,
    plan: impl Fn(&Resampler) -> Option<P>,
    bytes: impl Fn(&P) -> usize,
) -> Vec<Option<P>> {
    let mut left = job.memory.left_for_plan(&job.input, &job.target);
    let pays = job.outputs.frames.len() > 1;
    let plan_of = |target: &TargetView| {
        let resampler = job.resampler(target);
        if !pays || estimate(&resampler) as u64 > left {
            return None;
        }
        let plan = plan(&resampler)?;
        left = left.saturating_sub(bytes(&plan) as u64);
        Some(plan)
    };
    job.target.views.iter().map(plan_of).collect()
}

/// That of a job whose inputs and outputs are opaque pictures of 8 bits that 15 bits of light are enough for.
fn codec(job: &ConvertJob) -> Option<FixedCodec> {
    let light = &job.light;
    let is_possible = !matches!(job.filter.kind, FilterKind::Reference { .. } | FilterKind::EwaPyramid)
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
