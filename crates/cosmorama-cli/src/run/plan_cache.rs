use std::fs::read;
use std::io::{ErrorKind, Write};
use std::path::Path;

use anyhow::Result;
use cosmorama::render::{PlanKey, Resampler, SavedPlan};
use cosmorama_io::pending::Pending;

use super::make_folder;

/// Plans in a folder, from one run to the next. Nothing depends on it: what is not there, or not right, is computed.
pub(super) struct PlanCache<'a> {
    folder: &'a Path,
    /// Bytes that may be used while a plan is read or written.
    memory: u64,
    /// What was wrong.
    pub(super) warnings: Vec<String>,
}

impl<'a> PlanCache<'a> {
    /// That of a folder, which need not exist yet.
    pub(super) fn new(folder: &'a Path, memory: u64) -> Self {
        Self { folder, memory, warnings: Vec::new() }
    }

    /// The plan of a conversion, from the folder or computed, and then kept there. `None` where there is none to be had.
    pub(super) fn plan<P: SavedPlan>(
        &mut self,
        resampler: &Resampler,
        compute: impl FnOnce() -> Option<P>,
    ) -> Option<P> {
        if self.folder.exists() && !self.folder.is_dir() {
            let folder = self.folder.display();
            self.warnings
                .push(format!("--plan-cache {folder} is no folder: nothing is kept; give a folder, new or old"));
            return compute();
        }
        let key = P::key(resampler);
        let path = self.folder.join(format!("{key}.plan"));
        match self.found(&path, key, resampler) {
            Ok(Some(plan)) => return Some(plan),
            Ok(None) => {}
            Err(reason) => {
                self.warnings.push(format!("--plan-cache: {}: {reason}; the plan is computed", path.display()))
            }
        }
        let plan = compute()?;
        if let Err(reason) = self.keep(&path, &plan, key) {
            self.warnings.push(format!("--plan-cache {}: the plan is not kept: {reason}", self.folder.display()));
        }
        Some(plan)
    }

    fn found<P: SavedPlan>(&self, path: &Path, key: PlanKey, resampler: &Resampler) -> Result<Option<P>> {
        match std::fs::metadata(path) {
            // What does not fit beside the plan that is made of it is not read.
            Ok(found) if !found.is_file() => anyhow::bail!("not a regular file"),
            Ok(found) if found.len() > self.memory / 2 => return Ok(None),
            // Why there can be no folder, keeping it tells.
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => return Ok(None),
            _ => {}
        }
        Ok(Some(P::from_bytes(&read(path)?, key, resampler)?))
    }

    /// Writes a file whole or not at all; of several programs that write the same one, the last one's stays.
    fn keep<P: SavedPlan>(&self, path: &Path, plan: &P, key: PlanKey) -> Result<()> {
        if plan.bytes() as u64 > self.memory / 2 {
            anyhow::bail!("there is no room to write it; raise --memory");
        }
        make_folder(self.folder)?;
        let mut pending = Pending::create(path)?;
        pending.writer().write_all(&plan.to_bytes(key))?;
        Ok(pending.finish()?)
    }
}
