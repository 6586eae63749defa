//! Streams of pictures as sequences, and one output of all frames, without ffmpeg.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::Arc;

use cosmorama_convert::{Conversion, InMemory, Observer, Quiet, Report, Stop};

/// Returns pictures of 64x32 in one colour each, one behind the other, as binary PPM.
fn stream(colours: impl Iterator<Item = u8>) -> Vec<u8> {
    let picture = |colour: u8| [b"P6 64 32 255\n".to_vec(), vec![colour; 64 * 32 * 3]].concat();
    colours.flat_map(picture).collect()
}

/// Returns a conversion of a stream in memory.
fn dome(bytes: Vec<u8>, output: String) -> Conversion {
    let mut files = InMemory::default();
    files.insert("sky.pam", bytes);
    let conversion = Conversion::new("sky.pam", output).from("equirect".parse().unwrap());
    conversion.to("fulldome".parse().unwrap()).size("16".parse().unwrap()).files(Arc::new(files))
}

fn run(conversion: Conversion) -> Report {
    conversion.check().result.unwrap().run(&mut Quiet).unwrap()
}

/// Returns the colours in the middle of the pictures of a stream.
fn middles(bytes: &[u8]) -> Vec<u8> {
    let end = b"ENDHDR\n";
    let heads = bytes.windows(end.len()).enumerate().filter(|(_, window)| window == end);
    heads.map(|(at, _)| bytes[at + end.len() + (8 * 16 + 8) * 3]).collect()
}

#[test]
fn a_stream_in_memory_becomes_one_file_of_all_frames_in_order() {
    let folder = tempfile::tempdir().unwrap();
    for threads in [1, 2, 7] {
        let output = folder.path().join(format!("{threads}.pam"));
        let report = run(dome(stream(10..40), output.display().to_string()).threads(threads));
        assert_eq!((report.frames, report.inputs), (30, vec![PathBuf::from("sky.pam")]));
        assert_eq!(report.outputs, std::slice::from_ref(&output));
        assert_eq!(middles(&std::fs::read(output).unwrap()), (10..40).collect::<Vec<u8>>());
    }
}

/// Observer that stops a run after some frames.
struct Impatient(usize);

impl Observer for Impatient {
    fn frame_done(&mut self, _: Option<u64>) -> ControlFlow<Stop> {
        self.0 -= 1;
        if self.0 == 0 { ControlFlow::Break(Stop) } else { ControlFlow::Continue(()) }
    }
}

#[test]
fn an_output_of_many_frames_is_whole_or_not_there() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("dome.pam").display().to_string();
    let stopped = dome(stream(0..20), output.clone()).check().result.unwrap().run(&mut Impatient(5));
    assert!(stopped.is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    // Frames that end early, too.
    let bytes = stream(0..20);
    assert!(dome(bytes[..bytes.len() - 1].to_vec(), output).check().result.is_err());
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}
