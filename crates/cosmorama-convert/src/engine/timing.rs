use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use cpu_time::{ProcessTime, ThreadTime};

/// Stage of a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Stage {
    /// Reading files and decoding them to light.
    Decode,
    /// Arguments, headers, needs of the input, and geometry that several frames share.
    Plan,
    /// Making pixels; for a single frame, its geometry too.
    Filter,
    /// Encoding light and writing files.
    Encode,
}

/// Cost of the stages: processor time of the process, summed over all threads.
#[derive(Debug, Default)]
pub(crate) struct Stages {
    costs: Mutex<Costs>,
}

#[derive(Clone, Copy, Debug, Default)]
struct Costs {
    decode: Duration,
    plan: Duration,
    filter: Duration,
    encode: Duration,
}

/// Processor seconds by stage, summed over all threads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CpuSeconds {
    /// Reading files and decoding them to light.
    pub decode: f64,
    /// Settings, headers, and geometry that several frames share.
    pub plan: f64,
    /// Making pixels.
    pub filter: f64,
    /// Encoding light and writing files.
    pub encode: f64,
}

impl Stages {
    /// Runs a part of a stage while nothing else runs, and charges all processor time to the stage.
    pub(crate) fn alone<T>(&self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let cpu = ProcessTime::now();
        let result = work();
        self.add(stage, cpu.elapsed());
        result
    }

    /// Runs a part of a stage on one thread, and charges only that thread's processor time to the stage.
    pub(crate) fn beside<T>(&self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let cpu = ThreadTime::now();
        let result = work();
        self.add(stage, cpu.elapsed());
        result
    }

    /// Runs several stages at once. Time in [`beside`](Self::beside) is charged to its stage, and the rest to `stage`.
    pub(crate) fn among<T>(&self, stage: Stage, work: impl FnOnce() -> T) -> T {
        let (cpu, before) = (ProcessTime::now(), self.costs().sum());
        let result = work();
        let others = self.costs().sum().saturating_sub(before);
        self.add(stage, cpu.elapsed().saturating_sub(others));
        result
    }

    fn costs(&self) -> Costs {
        *self.costs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn add(&self, stage: Stage, cpu: Duration) {
        let mut costs = self.costs.lock().unwrap_or_else(PoisonError::into_inner);
        *match stage {
            Stage::Decode => &mut costs.decode,
            Stage::Plan => &mut costs.plan,
            Stage::Filter => &mut costs.filter,
            Stage::Encode => &mut costs.encode,
        } += cpu;
    }

    /// Returns processor seconds by stage.
    pub(crate) fn cpu_seconds(&self) -> CpuSeconds {
        let Costs { decode, plan, filter, encode } = self.costs();
        let [decode, plan, filter, encode] = [decode, plan, filter, encode].map(|cost| cost.as_secs_f64());
        CpuSeconds { decode, plan, filter, encode }
    }
}

impl Costs {
    fn sum(&self) -> Duration {
        self.decode + self.plan + self.filter + self.encode
    }
}

#[cfg(test)]
mod tests {
    use std::hint::black_box;

    use super::*;

    fn work(rounds: u64) -> u64 {
        (0..black_box(rounds)).fold(1, |sum, round| black_box(sum ^ round).rotate_left(1))
    }

    #[test]
    fn what_others_do_meanwhile_is_not_counted_twice() {
        let (stages, all) = (Stages::default(), ProcessTime::now());
        stages.among(Stage::Filter, || {
            std::thread::scope(|scope| {
                let other = scope.spawn(|| stages.beside(Stage::Encode, || work(30_000_000)));
                black_box(work(10_000_000));
                other.join().unwrap_or_default()
            })
        });
        let CpuSeconds { filter, encode, decode, plan } = stages.cpu_seconds();
        // Other tests run meanwhile, so that only the process's total time can be compared.
        let all = all.elapsed().as_secs_f64();
        assert!(encode > 0.0 && filter > 0.0 && encode + filter <= all, "{encode} {filter} {all}");
        assert_eq!((decode, plan), (0.0, 0.0));
    }
}
