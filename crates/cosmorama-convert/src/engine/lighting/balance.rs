//! Energy balance: the total light of a world is kept from one form to another, suns included.

use cosmorama::camera::View;
use cosmorama::lighting::LightBalance;
use cosmorama::raster::{Image, Rgba};
use cosmorama::render::Plan;

use crate::job::ConvertJob;
use crate::target::TargetView;

/// Energy balance of a job's pictures, for those that can and should keep light.
#[cfg_attr(test, derive(Default))]
pub(crate) struct Balance(Vec<Group>);

/// Balanced light of a frame for the most recent group; views of a group mostly follow one another.
#[derive(Default)]
pub(crate) struct BalancedLight(Option<(usize, Vec<Rgba>)>);

/// Views of one size that together show a world.
struct Group {
    /// Indices of the target's views.
    views: Vec<usize>,
    balance: LightBalance,
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
    groups.retain(|group| LightBalance::applies(job.world(&targets[group[0]]), &views(targets, group)));
    groups
}

/// Returns the bytes that the balance of these groups takes.
pub(crate) fn bytes_of((job, targets): (&ConvertJob, &[TargetView]), groups: &[Vec<usize>]) -> u64 {
    groups.iter().map(|group| LightBalance::bytes(job.world(&targets[group[0]]), &views(targets, group))).sum()
}

fn views<'a>(targets: &'a [TargetView], group: &[usize]) -> Vec<&'a View> {
    group.iter().map(|index| &targets[*index].view).collect()
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
            let bytes = bytes_of((job, targets), std::slice::from_ref(&indices));
            Some(Group { views: indices, balance, bytes })
        };
        Self(groups.into_iter().filter_map(balanced).collect())
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
        self.group(view).iter().for_each(|(group, place)| group.balance.complete(*place, image));
    }

    fn group(&self, view: usize) -> Option<(&Group, usize)> {
        self.0.iter().find_map(|group| Some((group, group.views.iter().position(|index| *index == view)?)))
    }
}
