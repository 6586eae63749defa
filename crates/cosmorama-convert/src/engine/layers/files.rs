use std::sync::{Arc, OnceLock};

use cosmorama_io::Limits;
use rayon::prelude::*;

use super::FilePlanes;
use crate::colour::LayerGroup;
use crate::diagnostic::Result;
use crate::engine::{FrameFile, Which};
use crate::job::ConvertJob;
use crate::source::read_further;

/// Further channels in the files of a frame.
pub(crate) struct FurtherFiles<'a> {
    job: &'a ConvertJob,
    frame: Option<u64>,
    /// All channels, where they are read at once. Strips ask for them again and again.
    all: OnceLock<Arc<Vec<FilePlanes>>>,
}

impl<'a> FurtherFiles<'a> {
    /// Prepares the files of a frame, of which nothing is read yet.
    pub(crate) fn new(job: &'a ConvertJob, frame: Option<u64>) -> Self {
        Self { job, frame, all: OnceLock::new() }
    }

    /// Returns the channels of some groups, which are read from all files.
    pub(super) fn of(&self, batch: &[LayerGroup]) -> Result<Arc<Vec<FilePlanes>>> {
        if batch.len() < self.job.layers.groups.len() {
            return self.read(batch).map(Arc::new);
        }
        if let Some(read) = self.all.get() {
            return Ok(Arc::clone(read));
        }
        let read = Arc::new(self.read(batch)?);
        Ok(Arc::clone(self.all.get_or_init(|| read)))
    }

    fn read(&self, batch: &[LayerGroup]) -> Result<Vec<FilePlanes>> {
        let job = self.job;
        let names: Vec<&str> =
            batch.iter().flat_map(|group| &group.channels).map(|channel| channel.name.as_str()).collect();
        let limits = Limits::memory(job.memory.bytes);
        let read = |file: FrameFile<'_>| -> Result<FilePlanes> {
            let planes = read_further(&*job.files, &file.path, &limits, &names)?;
            Ok(FilePlanes { views: file.indices(), path: file.path, planes })
        };
        let files = FrameFile::all(job, self.frame, Which::All).into_par_iter();
        // In the order of files, so that the same one of several errors is reported every time.
        files.map(read).collect::<Vec<_>>().into_iter().collect()
    }
}
