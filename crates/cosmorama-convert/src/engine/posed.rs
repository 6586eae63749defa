use std::sync::{Arc, OnceLock};

use cosmorama::motion::Pose;
use cosmorama::render::{Progress, ScreenMask, Stopped};

use crate::diagnostic::Diagnostic;
use crate::engine::Geometry;
use crate::job::ConvertJob;
use crate::target::TargetView;

/// Target's views in one pose of the camera, with what is computed for that pose alone.
pub(crate) struct Posed {
    /// Pose; `None` where nothing moves.
    pub(crate) pose: Option<Pose>,
    /// Views in that pose.
    pub(crate) views: Vec<TargetView>,
    /// Geometry of the views.
    pub(crate) geometry: Arc<Geometry>,
    masks: Vec<OnceLock<ScreenMask>>,
}

impl Posed {
    /// Prepares the views of a pose, whose geometry is used again if the pose `is_repeated`. Also returns the warnings about their
    /// geometry.
    pub(crate) fn new(
        job: &ConvertJob,
        (pose, views, is_repeated): (Option<Pose>, Vec<TargetView>, bool),
        progress: &dyn Progress,
    ) -> Result<(Self, Vec<Diagnostic>), Stopped> {
        let (geometry, told) = Geometry::compile(job, (&views, is_repeated), progress)?;
        Ok((Self::of((pose, views), Arc::new(geometry)), told))
    }

    /// Combines the views of a pose with their geometry.
    pub(crate) fn of((pose, views): (Option<Pose>, Vec<TargetView>), geometry: Arc<Geometry>) -> Self {
        let masks = views.iter().map(|_| OnceLock::new()).collect();
        Self { pose, views, geometry, masks }
    }

    /// Returns the mask of a view's pixels that no view of the world covers.
    pub(crate) fn mask(&self, job: &ConvertJob, index: usize) -> &ScreenMask {
        let target = &self.views[index];
        self.masks[index].get_or_init(|| ScreenMask::new(job.world(target), &target.view))
    }
}
