//! How long each piece of work takes: `cargo bench -p testkit`. Figures and what bounds them: docs/performance.md.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use testkit::Kernel;

fn kernels(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("dome of 1024²");
    group.sample_size(10);
    for kernel in Kernel::all(1024) {
        group.throughput(Throughput::Elements(kernel.pixels as u64));
        group.bench_function(kernel.name, |bencher| bencher.iter(|| kernel.run()));
    }
    group.finish();
}

criterion_group!(benches, kernels);
criterion_main!(benches);
