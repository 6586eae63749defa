//! Decisions of an engine in words: geometry that is kept or not, and frames in flight.

use super::pictures::Engine;
use crate::diagnostic::{Decision, Topic};
use crate::engine::geometry::{balance_bytes, bytes_of_passes};
use crate::job::{QueueDepth, with_reserve};
use crate::source::lock;
use crate::source::memory_budget::human;

impl Engine<'_> {
    /// Returns the decisions about geometry and queues, with their reasons.
    pub(crate) fn decisions(&self) -> Vec<Decision> {
        let mut told = vec![Decision::new(Topic::Geometry, self.of_geometry())];
        if self.job.outputs.are_many() {
            let QueueDepth { read, written, bytes } = self.queue_depth();
            let message = format!(
                "{read} read and {written} made or written at once, as many as there are, or as memory and threads permit; they take up to {}",
                human(bytes)
            );
            told.push(Decision::new(Topic::Frames, message));
            told.push(Decision::detail(
                Topic::Memory,
                format!("up to {} of finished frames are kept for those that follow", human(self.pool.allowed())),
            ));
        }
        told
    }

    /// Returns the memory that the run needs in all, about and at most.
    pub(crate) fn estimated_bytes(&self) -> u64 {
        let (job, threads) = (self.job, rayon::current_num_threads());
        let posed = lock(&self.posed).as_ref().map(|posed| posed.geometry.bytes());
        let geometry = if job.is_by_strips() {
            posed.unwrap_or_else(|| balance_bytes(job)) + self.strips.bytes() + bytes_of_passes(job)
        } else {
            posed.unwrap_or(0)
        };
        if !job.outputs.are_many() {
            return job.estimated_bytes(threads).saturating_add(with_reserve(geometry));
        }
        let behind = job.layers().skip(1).map(|job| job.frame_needs().peak());
        let beside = behind.fold(geometry, u64::saturating_add);
        self.needs.sequence_bytes(self.queue_depth(), beside, threads)
    }

    fn of_geometry(&self) -> String {
        let job = self.job;
        if job.lighting.is_some() {
            return "light is gathered for each map, without geometry to keep".to_owned();
        }
        let posed = lock(&self.posed);
        let (plans, bytes) = (self.strips.kept(), self.strips.bytes());
        match posed.as_ref().map(|posed| (posed.geometry.kept() + plans, posed.geometry.bytes() + bytes)) {
            None if job.is_by_strips() => "computed for each frame, strip by strip: the camera moves".to_owned(),
            None => "computed for each pose of the moving camera, and kept while it stands still".to_owned(),
            Some((0, _)) if job.outputs.are_many() => {
                "computed anew for each frame: the filter has no plan, or memory is short".to_owned()
            }
            Some((0, _)) => "computed with the picture, and not kept, because it is the only one".to_owned(),
            Some((plans, bytes)) => {
                let plans = if plans == 1 { "1 plan".to_owned() } else { format!("{plans} plans") };
                format!("kept in {plans} of {} in all, for all frames", human(bytes))
            }
        }
    }
}
