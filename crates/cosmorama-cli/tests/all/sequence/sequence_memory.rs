//! That sequences keep what `--memory` promises.

use crate::bench::{Bench, picture};
use serde_json::Value;

#[test]
fn sequences_of_deep_pictures_take_no_more_memory_than_they_may() {
    let bench = Bench::new();
    bench.save("sky.png", &picture(3, 256, 128));
    for (extension, depth) in [("png", "16"), ("exr", "half")] {
        let first = format!("sky_01.{extension}");
        let deep = ["--from", "equirect", "--to", "equirect", "--size", "2048x1024", "--depth", depth];
        bench.succeed(&[&["convert", "sky.png", &first], &deep[..]].concat());
        for frame in 2..=8 {
            std::fs::hard_link(bench.path(&first), bench.path(&format!("sky_{frame:02}.{extension}"))).unwrap();
        }
        let (input, output) = (format!("sky_##.{extension}"), format!("dome_##.{extension}"));
        let args = ["convert", &input, &output, "--from", "equirect", "--to", "fulldome", "--size", "1024", "-y"];
        // A frame takes 84 MiB, of OpenEXR 100: there is room for some that are read and written meanwhile, and in the end for plans.
        for memory in [120, 200] {
            let limits = ["--memory", &format!("{memory}M"), "--threads", "4", "--json"];
            let report: Value = serde_json::from_str(&bench.succeed(&[&args[..], &limits].concat())).unwrap();
            let peak = report["peak_memory_bytes"].as_u64().unwrap() >> 20;
            // What threads hold by themselves differs from run to run.
            assert!(peak < memory + memory / 8, "{depth}: {peak} of {memory} MiB");
        }
    }
}
