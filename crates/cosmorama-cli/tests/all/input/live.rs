//! Streams that are read as they come, and passed on picture by picture.

use std::io::{Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Stdio};
use std::time::Duration;

use crate::bench::{Bench, assert_says, eight_bits, picture, text};
use cosmorama::raster::EncodedImage;

const DOME: [&str; 6] = ["--from", "equirect", "--to", "fulldome", "--size", "16"];

/// Bytes of a dome in PAM.
const HEAD: &[u8] = b"P7\nWIDTH 16\nHEIGHT 16\nDEPTH 3\nMAXVAL 255\nTUPLTYPE RGB\nENDHDR\n";
const PIXELS: usize = 16 * 16 * 3;

/// Returns a picture as binary PPM.
fn ppm(image: &EncodedImage) -> Vec<u8> {
    let head = format!("P6\n{} {}\n255\n", image.width(), image.height());
    [head.as_bytes(), eight_bits(image)].concat()
}

fn sky(frame: usize) -> Vec<u8> {
    ppm(&picture(frame, 64, 32))
}

/// Makes the domes of some skies by way of files, and returns their pixels.
fn domes(bench: &Bench, count: usize) -> Vec<Vec<u8>> {
    (0..count).for_each(|frame| bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32)));
    bench.succeed(&[&["convert", "sky_#.png", "by_files_#.png"], &DOME[..]].concat());
    (0..count).map(|frame| eight_bits(&bench.load(&format!("by_files_{frame}.png"))).to_vec()).collect()
}

/// A conversion between a producer and a consumer, in a folder of its own for temporary files.
struct Chain {
    child: Child,
    producer: Option<ChildStdin>,
    consumer: Option<ChildStdout>,
}

impl Chain {
    fn start(bench: &Bench, args: &[&str]) -> Self {
        std::fs::create_dir_all(bench.path("temporary")).unwrap();
        let mut command = bench.command(&[&["convert", "-"], args, &DOME[..]].concat());
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.env("TMPDIR", bench.path("temporary")).spawn().unwrap();
        let (producer, consumer) = (child.stdin.take(), child.stdout.take());
        Self { child, producer, consumer }
    }

    fn put(&mut self, bytes: &[u8]) {
        self.producer.as_mut().unwrap().write_all(bytes).unwrap();
    }

    /// Reads the next picture. One that does not come is no picture of the end of time: the conversion is ended then.
    fn dome(&mut self) -> Vec<u8> {
        let (done, wait) = std::sync::mpsc::channel::<()>();
        let process = self.child.id().to_string();
        let watch = std::thread::spawn(move || {
            if wait
                .recv_timeout(Duration::from_secs(60))
                .is_err_and(|error| error == std::sync::mpsc::RecvTimeoutError::Timeout)
            {
                std::process::Command::new("kill").args(["-KILL", &process]).status().unwrap();
            }
        });
        let mut bytes = vec![0; HEAD.len() + PIXELS];
        let read = self.consumer.as_mut().unwrap().read_exact(&mut bytes);
        drop(done);
        watch.join().unwrap();
        read.expect("a picture comes before the producer goes on");
        assert!(bytes.starts_with(HEAD), "{}", text(&bytes[..HEAD.len()]));
        bytes.split_off(HEAD.len())
    }

    /// Ends the producer; the exit code, what else comes out, and messages.
    fn end(mut self) -> (Option<i32>, Vec<u8>, String) {
        drop(self.producer.take());
        let mut rest = Vec::new();
        self.consumer.take().into_iter().for_each(|mut consumer| _ = consumer.read_to_end(&mut rest).unwrap());
        let output = self.child.wait_with_output().unwrap();
        (output.status.code(), rest, text(&output.stderr))
    }
}

#[test]
fn a_picture_goes_out_before_the_stream_that_comes_in_has_ended() {
    let bench = Bench::new();
    let expected = domes(&bench, 5);
    for threads in ["1", "2", "8"] {
        let mut chain = Chain::start(&bench, &["-", "--format", "pam", "--threads", threads, "--progress", "plain"]);
        chain.put(&[sky(0), sky(1)].concat());
        // The producer waits for the first, and from then on for each.
        assert!(chain.dome() == expected[0], "{threads}");
        for (frame, dome) in expected.iter().enumerate().take(4).skip(1) {
            chain.put(&sky(frame + 1));
            assert!(chain.dome() == *dome, "{threads}: {frame}");
        }
        assert!(chain.dome() == expected[4], "{threads}: of what has come, nothing waits for the end");
        assert_eq!(std::fs::read_dir(bench.path("temporary")).unwrap().count(), 0, "nothing is on disk");
        let (code, rest, told) = chain.end();
        assert_eq!((code, rest.len()), (Some(0), 0), "{told}");
        assert_says(&told, &["frame 0: 1 done, ", "frame 4: 5 done, ", "standard output in"]);
        assert!(!told.contains(" of 5") && !told.contains(" left"), "nobody knew how many there would be: {told}");
    }
}

#[test]
fn a_producer_that_never_ends_is_left_when_the_frames_asked_for_are_made() {
    let bench = Bench::new();
    let expected = domes(&bench, 4);
    let mut chain = Chain::start(&bench, &["-", "--format", "pam", "--frames", "2-3"]);
    (0..4).for_each(|frame| chain.put(&sky(frame)));
    assert!([chain.dome(), chain.dome()] == expected[2..4]);
    // It is not waited for, and gets an error if it goes on.
    let status = chain.child.wait().unwrap();
    assert!(status.success(), "{status}");
    let producer = chain.producer.as_mut().unwrap();
    let unread = (0..).map(|_| producer.write_all(&sky(0))).take(1000).find_map(Result::err).unwrap();
    assert_eq!(unread.kind(), std::io::ErrorKind::BrokenPipe);
    // One of them alone is a picture.
    let mut chain = Chain::start(&bench, &["one.png", "--frames", "1"]);
    (0..3).for_each(|frame| chain.put(&sky(frame)));
    let (code, _, told) = chain.end();
    assert_eq!(code, Some(0), "{told}");
    assert!(eight_bits(&bench.load("one.png")) == expected[1]);
}

#[test]
fn a_consumer_that_has_seen_enough_ends_the_conversion_without_an_error() {
    let bench = Bench::new();
    let mut chain = Chain::start(&bench, &["-", "--format", "pam"]);
    chain.put(&sky(0));
    chain.dome();
    drop(chain.consumer.take());
    // The next picture finds nobody.
    chain.put(&sky(1));
    let (code, _, told) = chain.end();
    assert!(code == Some(0) && !told.contains("error") && !told.contains("frame 1:"), "{told}");
}

#[test]
fn of_a_stream_that_is_cut_off_the_frame_is_named_and_those_before_are_whole() {
    let bench = Bench::new();
    let expected = domes(&bench, 3);
    let whole = (0..3).flat_map(sky).collect::<Vec<u8>>();
    let mut chain = Chain::start(&bench, &["-", "--format", "pam"]);
    chain.put(&whole[..whole.len() - 7]);
    assert!([chain.dome(), chain.dome()] == expected[..2]);
    let (code, rest, told) = chain.end();
    assert_eq!((code, rest.len()), (Some(1), 0), "{told}");
    assert_says(&told, &["standard input", "frame 2", "the stream ends within it"]);
    // Frames that never come are named, too.
    let mut chain = Chain::start(&bench, &["-", "--format", "pam", "--frames", "1-4"]);
    chain.put(&whole);
    assert!([chain.dome(), chain.dome()] == expected[1..3]);
    let (code, rest, told) = chain.end();
    assert_eq!((code, rest.len()), (Some(1), 0), "{told}");
    assert_says(&told, &["standard input", "no frame 3; its frames are 0 to 2"]);
    // What is no picture from its beginning makes none.
    let mut chain = Chain::start(&bench, &["-", "--format", "y4m"]);
    chain.put(&whole[..100]);
    let (code, rest, told) = chain.end();
    assert_eq!((code, rest.len()), (Some(1), 0), "{told}");
    assert_says(&told, &["standard input", "frame 0"]);
}

#[test]
fn frames_of_a_stream_become_files_as_they_come() {
    let bench = Bench::new();
    let expected = domes(&bench, 3);
    let mut chain = Chain::start(&bench, &["dome_##.png", "--json"]);
    chain.put(&[sky(0), sky(1)].concat());
    for _ in 0..600 {
        if bench.path("dome_00.png").exists() {
            break;
        }
        std::thread::sleep(Duration::from_millis(100));
    }
    assert!(bench.path("dome_00.png").exists(), "a file appears before the stream ends");
    chain.put(&sky(2));
    let (code, report, told) = chain.end();
    assert_eq!(code, Some(0), "{told}");
    let report: serde_json::Value = serde_json::from_slice(&report).unwrap();
    assert_eq!((&report["frames"], report["outputs"].as_array().unwrap().len()), (&3.into(), 3), "{report}");
    for (frame, expected) in expected.iter().enumerate() {
        assert!(eight_bits(&bench.load(&format!("dome_{frame:02}.png"))) == expected, "{frame}");
    }
    // A file that any frame would replace is found before the first.
    std::fs::copy(bench.path("dome_02.png"), bench.path("again_02.png")).unwrap();
    let mut chain = Chain::start(&bench, &["again_##.png"]);
    chain.put(&sky(0));
    let (code, _, told) = chain.end();
    assert_eq!(code, Some(1), "{told}");
    assert_says(&told, &["again_02.png exists", "--overwrite"]);
    assert!(!bench.path("again_00.png").exists());
    // They say nothing of the stream, and an interrupted run goes on all the same: then the stream is kept.
    std::fs::remove_file(bench.path("dome_01.png")).unwrap();
    let mut chain = Chain::start(&bench, &["dome_##.png", "--resume"]);
    chain.put(&(0..3).flat_map(sky).collect::<Vec<u8>>());
    let (code, _, told) = chain.end();
    assert_eq!(code, Some(0), "{told}");
    assert_says(&told, &["2 kept"]);
    assert!(eight_bits(&bench.load("dome_01.png")) == expected[1]);
}

/// A camera that turns over all frames has to know how many there are.
#[test]
fn a_stream_is_kept_where_its_end_must_be_known() {
    let bench = Bench::new();
    domes(&bench, 3);
    let turn = ["--yaw", "0..90"];
    bench.succeed(&[&["convert", "sky_#.png", "turned_#.png"], &DOME[..], &turn].concat());
    let mut chain = Chain::start(&bench, &[&["-", "--format", "pam"], &turn[..]].concat());
    chain.put(&(0..3).flat_map(sky).collect::<Vec<u8>>());
    drop(chain.producer.take());
    for frame in 0..3 {
        assert!(chain.dome() == eight_bits(&bench.load(&format!("turned_{frame}.png"))), "{frame}");
    }
    // Backwards.
    let mut back = Chain::start(&bench, &["-", "--format", "pam", "--frames", "2,0"]);
    back.put(&(0..3).flat_map(sky).collect::<Vec<u8>>());
    drop(back.producer.take());
    for frame in [2, 0] {
        assert!(back.dome() == eight_bits(&bench.load(&format!("by_files_{frame}.png"))), "{frame}");
    }
    // Folders for frames are made before the work.
    let mut folders = Chain::start(&bench, &["shot_##/dome.png"]);
    folders.put(&(0..3).flat_map(sky).collect::<Vec<u8>>());
    for chain in [chain, back, folders] {
        let (code, rest, told) = chain.end();
        assert_eq!((code, rest.len()), (Some(0), 0), "{told}");
    }
    for frame in 0..3 {
        let made = eight_bits(&bench.load(&format!("shot_0{frame}/dome.png"))).to_vec();
        assert!(made == eight_bits(&bench.load(&format!("by_files_{frame}.png"))), "{frame}");
    }
}

/// A killed conversion leaves nothing of the stream that it has kept, and the folder of its output only until the next.
#[cfg(target_os = "linux")]
#[test]
fn a_killed_conversion_leaves_no_stream_behind() {
    let bench = Bench::new();
    let kept = || std::fs::read_dir(bench.path("temporary")).unwrap().count();
    let mut chain = Chain::start(&bench, &["-", "--format", "pam", "--yaw", "0..90"]);
    chain.put(&(0..3).flat_map(sky).collect::<Vec<u8>>());
    let files = format!("/proc/{}/fd", chain.child.id());
    let links = || std::fs::read_dir(&files).unwrap().flatten().filter_map(|file| std::fs::read_link(file.path()).ok());
    wait_until(|| links().any(|link| link.starts_with(bench.path("temporary"))));
    chain.child.kill().unwrap();
    chain.child.wait().unwrap();
    assert_eq!(kept(), 0);

    let mut chain = Chain::start(&bench, &["-", "--format", "png"]);
    wait_until(|| kept() == 1);
    chain.child.kill().unwrap();
    chain.child.wait().unwrap();
    assert_eq!(kept(), 1, "nobody could remove it");
    let mut next = Chain::start(&bench, &["-", "--format", "png"]);
    next.put(&sky(0));
    let (code, _, told) = next.end();
    assert_eq!((code, kept()), (Some(0), 0), "{told}");
}

/// Waits until something is so, a minute at most.
#[cfg(target_os = "linux")]
fn wait_until(is_so: impl Fn() -> bool) {
    let begun = std::time::Instant::now();
    while !is_so() {
        assert!(begun.elapsed() < Duration::from_secs(60), "it never is");
        std::thread::sleep(Duration::from_millis(5));
    }
}

/// The most memory that a process has held, in KiB.
#[cfg(target_os = "linux")]
fn most_memory(process: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    line.split_whitespace().next().unwrap().parse().unwrap()
}

#[cfg(target_os = "linux")]
#[test]
fn memory_stays_that_of_a_few_frames() {
    const FRAMES: usize = 600;
    let bench = Bench::new();
    let frame = ppm(&picture(3, 256, 128));
    let mut chain = Chain::start(&bench, &["-", "--format", "pam", "--threads", "2"]);
    let mut producer = chain.producer.take().unwrap();
    let held = std::thread::scope(|scope| {
        scope.spawn(move || (0..FRAMES).for_each(|_| producer.write_all(&frame).unwrap()));
        let process = chain.child.id();
        let mut read = |count: usize| (0..count).for_each(|_| _ = chain.dome());
        read(100);
        let early = most_memory(process);
        read(FRAMES - 200);
        // Before the last, with which it may end.
        let late = most_memory(process);
        read(100);
        [early, late]
    });
    // The other 400 frames would be 37 MiB.
    assert!(held[1] < held[0] + held[0] / 50 + 2048, "{held:?} KiB");
    let (code, ..) = chain.end();
    assert_eq!(code, Some(0));
}
