//! Memory for pictures under an open shutter whose moments are rendered together.

use cosmorama::filter::{Ewa, FilterKind, FilterSettings};
use cosmorama::motion::{Exposure, Moment};

use super::STRIP;
use crate::diagnostic::Result;
use crate::job::ConvertJob;
use crate::settings::BlurMethod;
use crate::source::memory_budget::area;
use crate::target::TargetView;

impl ConvertJob {
    /// Keeps memory for frames whose moments are rendered together, view by view, if there is enough. These are the moments of one.
    pub(crate) fn keep_room_for_rings(&mut self, method: BlurMethod, moments: &[Moment]) -> Result<()> {
        let rows = if self.is_by_strips() { STRIP } else { usize::MAX };
        let pose = self.movement.as_ref().zip(moments.first()).map(|(movement, moment)| movement.pose(moment.time));
        let views = self.views_in(pose.as_ref())?;
        let bytes = |job: &Self, target: &TargetView| {
            let pixels = area((target.view.width(), target.view.height().min(rows)));
            let of_pixel = Exposure::most_bytes_a_pixel(&target.view, (job.world(target), job.filter_of_blur(method)));
            pixels.saturating_mul(of_pixel as u64)
        };
        let with_rings = self.layers().filter(|job| job.content.has_files());
        let needed = with_rings.flat_map(|job| views.iter().map(move |target| bytes(job, target))).max().unwrap_or(0);
        self.has_room_for_rings = self.memory.beside_frame(self.frame_needs()).bytes >= needed;
        if self.has_room_for_rings {
            self.prepared = self.prepared.saturating_add(needed);
        }
        Ok(())
    }

    fn filter_of_blur(&self, method: BlurMethod) -> FilterSettings {
        match method {
            BlurMethod::Swept => self.filter,
            BlurMethod::Ellipse => {
                let Ewa { kernel, anti_ringing } = Exposure::FILTER;
                FilterSettings { kind: FilterKind::Ewa, kernel, anti_ringing }
            }
        }
    }
}
