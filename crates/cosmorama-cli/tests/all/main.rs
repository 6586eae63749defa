//! Tests of the program as it is called, in one program.
#![allow(
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a test that cannot go on should stop where it stands, and one that is left out says so"
)]

mod bench;
mod convert;
mod oracles;

mod faces {
    mod arrangement;
    mod arrangement_advice;
    mod layouts;
}

mod filter {
    mod channels;
    mod classics;
    mod labels;
    mod laboratory;
    mod light;
    mod light_balance;
    mod pyramids;
    mod rims;
    mod suns;
}

mod input {
    mod bad_input;
    mod builtin;
    mod detection;
    #[cfg(feature = "video")]
    mod live;
    mod pipes;
    mod real_data;
    mod st_maps;
    mod stereo;
    mod tiffs;
}

mod lenses {
    mod calibrations;
    mod cameras;
    mod hugin;
    mod several_views;
    mod worlds;
}

mod light {
    mod brdf;
    mod deploy;
    mod harmonics;
    mod maps;
    mod shade;
    mod sky;
    mod sun;
    mod table;
}

mod output {
    mod bad_output;
    mod colour;
    mod colour_table;
    mod metadata;
    mod output_shape;
    mod page_table;
}

mod sequence {
    mod backdrop;
    mod choices;
    #[cfg(target_os = "linux")]
    mod disks;
    #[cfg(feature = "video")]
    pub(crate) mod films;
    mod motion;
    mod resume;
    #[cfg(target_os = "linux")]
    mod sequence_memory;
    mod sequences;
    mod sky;
    #[cfg(feature = "video")]
    mod streams;
    mod verify;
    #[cfg(feature = "video")]
    mod videos;
}

mod usage {
    mod advice;
    mod help;
    mod logs;
    mod messages;
    mod mistakes;
    mod names;
    mod verbs;
    mod wrong_usage;
}
