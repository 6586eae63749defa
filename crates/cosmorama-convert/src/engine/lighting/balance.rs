//! Energy balance: the total light of a world is kept from one form to another, suns included.

use std::sync::Arc;

use cosmorama::camera::View;
use cosmorama::lighting::LightBalance;
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::{Arithmetic, Plan, Progress, Share, Stopped};

use crate::job::{ConvertJob, STRIP};
use crate::target::{Strip, TargetView};

/// Energy balance of a job's pictures, for those that can and should keep light.
#[derive(Default)]
pub(crate) struct Balance(Vec<Group>);

/// Balanced light of a frame for the most recent group; views of a group mostly follow one another.
#[derive(Default)]
pub(crate) struct BalancedLight(Option<(usize, Vec<Rgba>)>);

/// Views of one size that together show a world.
struct Group {
    /// Indices of the target's views.
    views: Vec<usize>,
    balance: Arc<LightBalance>,
    /// Factors of each view's pixels; none of pictures that are made strip by strip.
    pixels: Vec<Vec<f32>>,
    bytes: u64,
}

/// Returns the views of each size that together show all that a world shows. Pixels filled for lack of a view, and
/// alpha, rule out a balance.
pub(crate) fn groups(job: &ConvertJob, targets: &[TargetView]) -> Vec<Vec<usize>> {
    if !job.is_balance_asked_for() || job.light.input_alpha || !job.is_complete() {
        return Vec::new();
    }
    let key = |index: usize| {
        let target = &targets[index];
        (target.world(job.worlds.len()), target.view.width(), target.view.height())
    };
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for index in 0..targets.len() {
        match groups.iter_mut().find(|group| key(group[0]) == key(index)) {
            Some(group) => group.push(index),
            None => groups.push(vec![index]),
        }
    }
    let views = |group: &[usize]| group.iter().map(|index| &targets[*index].view).collect::<Vec<&View>>();
    groups.retain(|group| LightBalance::applies(job.world(&targets[group[0]]), &views(group)));
    groups
}

/// Returns the bytes that the balance of these groups takes.
pub(crate) fn bytes_of((job, targets): (&ConvertJob, &[TargetView]), groups: &[Vec<usize>]) -> u64 {
    let pixels = |index: &usize| targets[*index].view.width() as u64 * targets[*index].view.height() as u64;
    let bytes = |group: &Vec<usize>| LightBalance::bytes(job.world(&targets[group[0]]), group.iter().map(pixels).sum());
    groups.iter().map(bytes).sum()
}

/// Returns the bytes that the balance of these groups takes, of which a strip of one view is made at once.
pub(crate) fn bytes_by_strips((job, targets): (&ConvertJob, &[TargetView]), groups: &[Vec<usize>]) -> u64 {
    // Views of a group have one size.
    let bytes = |group: &Vec<usize>| {
        let first = &targets[group[0]];
        LightBalance::bytes(job.world(first), first.view.width() as u64 * first.view.height().min(STRIP) as u64)
    };
    groups.iter().map(bytes).sum()
}

impl Balance {
    /// Computes the balance of groups whose plans are kept.
    pub(crate) fn of(
        (job, targets): (&ConvertJob, &[TargetView]),
        groups: Vec<Vec<usize>>,
        plans: &[Option<Plan>],
    ) -> Self {
        let balanced = |indices: Vec<usize>| {
            let plan = |index: &usize| Some((plans[*index].as_ref()?, &targets[*index].view));
            let planned: Vec<_> = indices.iter().map(plan).collect::<Option<_>>()?;
            let balance = LightBalance::new(job.world(&targets[indices[0]]), &planned);
            let pixels = planned.iter().map(|(plan, _)| balance.pixels(plan)).collect();
            let bytes = bytes_of((job, targets), std::slice::from_ref(&indices));
            Some(Group { views: indices, balance: Arc::new(balance), pixels, bytes })
        };
        Self(groups.into_iter().filter_map(balanced).collect())
    }

    /// Computes the balance of groups whose pictures are made strip by strip. Plans of strips are made anew for each of its steps: all
    /// together are too large.
    pub(crate) fn by_strips(
        (job, targets): (&ConvertJob, &[TargetView]),
        groups: Vec<Vec<usize>>,
        progress: &dyn Progress,
    ) -> Result<Self, Stopped> {
        let count = groups.len();
        let balanced = |(place, indices): (usize, Vec<usize>)| {
            let at = |place: usize| place as f64 / count as f64;
            let share = Share { whole: progress, from: at(place), to: at(place + 1) };
            let all: usize = indices.iter().map(|index| targets[*index].view.height()).sum();
            let mut done = 0;
            let balance = LightBalance::of_parts(job.world(&targets[indices[0]]), |visit| {
                for target in indices.iter().map(|index| &targets[*index]) {
                    for top in (0..target.view.height()).step_by(STRIP) {
                        let part = target.rows(top..target.view.height().min(top + STRIP));
                        let at = |done: usize| done as f64 / (all * LightBalance::STEPS) as f64;
                        let share = Share { whole: &share, from: at(done), to: at(done + part.view.height()) };
                        done += part.view.height();
                        if let Some(plan) = job.resampler(&part).watched(&share).plan(Arithmetic::Float)? {
                            visit(&plan, &part.view);
                        }
                    }
                }
                Ok(())
            })?;
            let bytes = bytes_by_strips((job, targets), std::slice::from_ref(&indices));
            Ok(Group { views: indices, balance: Arc::new(balance), pixels: Vec::new(), bytes })
        };
        Ok(Self(groups.into_iter().enumerate().map(balanced).collect::<Result<_, Stopped>>()?))
    }

    /// Returns the balance of a strip, of that of whole pictures.
    pub(crate) fn of_strip(&self, strip: &Strip, plans: &[Option<Plan>]) -> Self {
        let part = |Group { views, balance, .. }: &Group| {
            let (views, pixels): (Vec<usize>, Vec<Vec<f32>>) = (strip.indices().enumerate())
                .filter(|(_, index)| views.contains(index))
                .filter_map(|(part, _)| Some((part, balance.pixels(plans[part].as_ref()?))))
                .unzip();
            let bytes = pixels.iter().map(|pixels| size_of_val(&pixels[..]) as u64).sum();
            Group { views, balance: Arc::clone(balance), pixels, bytes }
        };
        Self(self.0.iter().map(part).collect())
    }

    /// Returns whether no light is balanced.
    pub(crate) fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the bytes of the balance and of the light that it makes.
    pub(crate) fn bytes(&self) -> u64 {
        self.0.iter().map(|group| group.bytes).sum()
    }

    /// Returns the balanced light for a target view; `None` where light is used unchanged. `last` belongs to the same
    /// frame.
    pub(crate) fn light<'a>(&self, view: usize, texels: &[Rgba], last: &'a mut BalancedLight) -> Option<&'a [Rgba]> {
        let index = self.0.iter().position(|group| group.views.contains(&view))?;
        if last.0.as_ref().is_none_or(|(group, _)| *group != index) {
            // Freed first, since two are never held at once.
            last.0 = None;
            last.0 = Some((index, self.0[index].balance.balanced(texels)));
        }
        last.0.as_ref().map(|(_, light)| light.as_slice())
    }

    /// Applies the factors of a target view's pixels.
    pub(crate) fn complete(&self, view: usize, image: &mut Image<Rgba>) {
        let factors = |group: &Group| group.views.iter().position(|index| *index == view);
        if let Some(factors) = self.0.iter().find_map(|group| group.pixels.get(factors(group)?)) {
            LightBalance::complete(factors, image);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::ops::ControlFlow;

    use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
    use cosmorama_io::WriteOptions;

    use super::*;
    use crate::settings::Conversion;

    /// Compares the balance that strips make together with that of whole pictures.
    #[test]
    fn the_balance_of_strips_is_that_of_the_whole() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name).display().to_string();
        let sky = EncodedImage::new(32, 16, Channels::Rgb, Depth::Float, Samples::Float(vec![0.5; 32 * 16 * 3]));
        cosmorama_io::write(path("sky.exr"), &sky.unwrap(), &WriteOptions::default()).unwrap();
        let conversion = Conversion::new(path("sky.exr"), path("sphere.exr")).from("equirect".parse().unwrap());
        let mut conversion = conversion.to("equirect:pitch=30".parse().unwrap()).size("8x530".parse().unwrap());
        conversion.geometry.kernel = "light".parse().unwrap();
        let checked = conversion.check().result.unwrap();
        let (job, views) = (&checked.job, &checked.job.target.views[..]);
        let plan = |target: &TargetView| job.resampler(target).plan(Arithmetic::Float);
        let whole = Balance::of((job, views), groups(job, views), &views.iter().map(plan).collect::<Vec<_>>());
        let progress = &|_: f64| ControlFlow::Continue(());
        let by_strips = Balance::by_strips((job, views), groups(job, views), progress);
        let by_strips = by_strips.unwrap_or_else(|_| panic!("stopped"));
        let light = vec![Rgba::opaque(1.0, 1.0, 1.0); job.worlds[0].texel_count()];
        let factors = |balance: &Balance| balance.light(0, &light, &mut BalancedLight::default()).unwrap().to_vec();
        let (whole, by_strips) = (factors(&whole), factors(&by_strips));
        assert!(whole.iter().any(|factor| (factor.0[0] - 1.0).abs() > 1e-3), "nothing is balanced");
        for (whole, part) in whole.iter().zip(&by_strips) {
            assert!((whole.0[0] - part.0[0]).abs() < 1e-4, "{whole:?} and {part:?}");
        }
    }
}
