use std::time::{Duration, Instant};

use cpu_time::ProcessTime;
use serde::Serialize;

/// The stages of a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Stage {
    /// Reading files and turning code values into light.
    Decode,
    /// Arguments, headers, what is needed of the input, and the geometry that several frames share.
    Plan,
    /// Making pixels; for a single frame, its geometry too.
    Filter,
    /// Turning light into code values and writing files.
    Encode,
}

/// What the stages have cost. They run one after the other, each on all threads, so the time that the process spends
/// on processors during a stage is the stage's.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Stages {
    decode: Cost,
    plan: Cost,
    filter: Cost,
    encode: Cost,
}

#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    cpu: Duration,
    wall: Duration,
}

/// CPU seconds by stage, all threads added.
#[derive(Clone, Copy, Debug, Serialize)]
pub(super) struct CpuSeconds {
    pub(super) decode: f64,
    pub(super) plan: f64,
    pub(super) filter: f64,
    pub(super) encode: f64,
}

impl Stages {
    /// Does a part of a stage.
    pub(super) fn time<T>(&mut self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let (start, cpu) = (Instant::now(), ProcessTime::now());
        let result = work();
        let cost = match stage {
            Stage::Decode => &mut self.decode,
            Stage::Plan => &mut self.plan,
            Stage::Filter => &mut self.filter,
            Stage::Encode => &mut self.encode,
        };
        cost.cpu += cpu.elapsed();
        cost.wall += start.elapsed();
        result
    }

    /// CPU seconds.
    pub(super) fn cpu_seconds(&self) -> CpuSeconds {
        CpuSeconds {
            decode: self.decode.cpu.as_secs_f64(),
            plan: self.plan.cpu.as_secs_f64(),
            filter: self.filter.cpu.as_secs_f64(),
            encode: self.encode.cpu.as_secs_f64(),
        }
    }

    /// For people: how long each part took.
    pub(super) fn describe(&self) -> String {
        let seconds = |cost: Cost| cost.wall.as_secs_f64();
        format!(
            "decode {:.2} s, plan {:.2} s, filter {:.2} s, encode {:.2} s",
            seconds(self.decode),
            seconds(self.plan),
            seconds(self.filter),
            seconds(self.encode)
        )
    }
}
