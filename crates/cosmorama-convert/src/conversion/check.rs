use std::time::Instant;

use cosmorama::explain;
use rayon::{ThreadPool, ThreadPoolBuilder};

use super::{Content, ConvertJob};
use crate::diagnostic::{Diagnostic, Outcome, Result, failure};
use crate::engine::{Stage, Stages};
use crate::settings::Conversion;

/// A conversion of which everything has been checked that can be without decoding a pixel.
pub struct Checked {
    pub(crate) settings: Conversion,
    pub(crate) content: Content,
    pub(crate) job: ConvertJob,
    /// The threads that everything runs on.
    pub(crate) pool: ThreadPool,
    /// What has been said so far.
    pub(crate) diagnostics: Vec<Diagnostic>,
    pub(crate) stages: Stages,
    pub(crate) start: Instant,
}

impl Conversion {
    /// Checks the settings against the files, of which only headers are read, and pixels where nothing else tells what they are.
    /// What cannot be done may have been guessed wrongly: diagnostics count with an error, too.
    pub fn check(self) -> Outcome<Checked> {
        let mut diagnostics = Vec::new();
        let result = self.checked(&mut diagnostics);
        Outcome { result, diagnostics }
    }

    fn checked(self, diagnostics: &mut Vec<Diagnostic>) -> Result<Checked> {
        let (start, stages) = (Instant::now(), Stages::default());
        let content = Content::of(&self)?;
        let pool = threads(self.limits.threads)?;
        let resolve = || stages.alone(Stage::Plan, || ConvertJob::resolve(&self, content, diagnostics));
        let job = pool.install(resolve)?;
        Ok(Checked { settings: self, content, job, pool, diagnostics: diagnostics.clone(), stages, start })
    }
}

impl Checked {
    /// Explains what the conversion does: for each picture its name and which part of which view it shows, with what
    /// magnification. Formulas have no views.
    pub fn explain(&self) -> Vec<(String, explain::Report)> {
        let Self { job, pool, content, .. } = self;
        let views = job.target.views.iter().filter(|_| content.has_files());
        let report = |target: &crate::target::TargetView| {
            (target.name.clone(), explain::Report::of(job.world(target), &target.view, &job.filter))
        };
        pool.install(|| views.map(report).collect())
    }
}

/// Starts threads to work with.
pub fn threads(count: Option<usize>) -> Result<ThreadPool> {
    let pool = ThreadPoolBuilder::new().num_threads(count.unwrap_or(0)).build();
    pool.map_err(|error| failure!("cannot start threads: {error}"))
}
