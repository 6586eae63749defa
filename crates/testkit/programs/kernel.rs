//! Does one piece of work so many times, for `benches/budgets` to count its instructions: `kernel NAME TIMES`; without
//! arguments, names them all.
#![allow(clippy::print_stdout, reason = "a program that says what it knows")]

use testkit::Kernel;

/// Pixels across the dome.
const SIZE: usize = 512;

fn main() {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let kernels = Kernel::all(SIZE);
    let [name, times] = arguments.as_slice() else {
        for kernel in kernels {
            println!("{}\t{}", kernel.name, kernel.pixels);
        }
        return;
    };
    let kernel = kernels.into_iter().find(|kernel| kernel.name == name).expect("a kernel of that name");
    for _ in 0..times.parse().expect("how often") {
        kernel.run();
    }
}
