use std::time::Instant;

use cosmorama::explain;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::diagnostic::{Diagnostic, Outcome, Result, failure};
use crate::engine::{FrameFile, Stage, Stages};
use crate::job::{Content, ConvertJob, Purpose};
use crate::settings::Conversion;

/// A conversion that has been checked as far as possible without decoding pixels.
pub struct Checked {
    pub(crate) settings: Conversion,
    pub(crate) content: Content,
    pub(crate) job: ConvertJob,
    /// Threads of the conversion.
    pub(crate) pool: ThreadPool,
    /// Diagnostics so far.
    pub(crate) diagnostics: Vec<Diagnostic>,
    pub(crate) stages: Stages,
    pub(crate) start: Instant,
}

impl Conversion {
    /// Checks the settings against the files. Only headers are read, and pixels only where nothing else tells the
    /// projection. Diagnostics are valid with an error, too: the cause may be a wrong guess.
    pub fn check(self) -> Outcome<Checked> {
        let mut diagnostics = Vec::new();
        let result = self.checked(&mut diagnostics);
        Outcome { result, diagnostics }
    }

    fn checked(self, diagnostics: &mut Vec<Diagnostic>) -> Result<Checked> {
        let (start, stages) = (Instant::now(), Stages::default());
        let content = Content::of(&self)?;
        let pool = threads(self.limits.threads)?;
        let resolve =
            || stages.alone(Stage::Plan, || ConvertJob::resolve(&self, (content, Purpose::Pictures), diagnostics));
        let job = pool.install(resolve)?;
        if content.has_files() {
            pool.install(|| stages.alone(Stage::Decode, || FrameFile::check_frames(&job)))?;
        }
        Ok(Checked { settings: self, content, job, pool, diagnostics: diagnostics.clone(), stages, start })
    }
}

impl Checked {
    /// Explains the conversion. For each picture it returns the name and a report of the parts of each view that it
    /// shows, with their magnification. Formulas have no views.
    pub fn explain(&self) -> Vec<(String, explain::Report)> {
        let Self { job, pool, content, .. } = self;
        let views = job.target.views.iter().filter(|_| content.has_files());
        let report = |target: &crate::target::TargetView| {
            (target.name.clone(), explain::Report::of(job.world(target), &target.view, &job.filter))
        };
        pool.install(|| views.map(report).collect())
    }
}

/// Starts a pool of threads.
pub fn threads(count: Option<usize>) -> Result<ThreadPool> {
    let pool = ThreadPoolBuilder::new().num_threads(count.unwrap_or(0)).build();
    pool.map_err(|error| failure!("cannot start threads: {error}"))
}
