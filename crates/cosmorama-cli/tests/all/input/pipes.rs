//! Standard input and output in place of files.

use std::io::Write;
use std::process::{Output, Stdio};

use crate::bench::{Bench, assert_says, picture, text};

fn piped(bench: &Bench, args: &[&str], input: &[u8]) -> Output {
    let mut command = bench.command(args);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    // Whoever refuses its arguments reads nothing.
    let _ = child.stdin.take().unwrap().write_all(input);
    child.wait_with_output().unwrap()
}

#[test]
fn pictures_come_and_go_through_pipes_as_through_files() {
    let bench = Bench::new();
    bench.save("a.png", &picture(3, 64, 32));
    let bytes = bench.bytes("a.png");
    for format in ["png", "jpg", "tif", "tga", "hdr", "exr"] {
        let to = ["--from", "equirect", "--to", "fulldome", "--size", "32"];
        let file = format!("b.{format}");
        bench.succeed(&[&["convert", "a.png", &file][..], &to].concat());
        let output = piped(&bench, &[&["convert", "-", "-", "--format", format][..], &to].concat(), &bytes);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(output.stdout == bench.bytes(&file), "{format}: {} bytes", output.stdout.len());
    }
    // Only one of the two.
    let output = piped(&bench, &["convert", "-", "c.png", "--from", "equirect", "--to", "fulldome", "--json"], &bytes);
    assert!(text(&output.stdout).contains("\"outputs\""));
    let output =
        piped(&bench, &["convert", "builtin:grid", "-", "--format", "png", "--to", "fulldome", "--size", "9"], &[]);
    assert_eq!(&output.stdout[1..4], b"PNG");
}

#[test]
fn what_is_wrong_is_said_and_no_byte_written() {
    let bench = Bench::new();
    bench.save("a.png", &picture(3, 64, 32));
    let to = ["--from", "equirect", "--to", "fulldome", "--size", "32"];
    let refused = |code: i32, args: &[&str], parts: &[&str]| {
        let args = [&["convert"][..], args, &to].concat();
        let output = piped(&bench, &args, b"no picture");
        assert_says(&bench.check_failure(code, &output, &bench.files()), parts);
    };
    refused(2, &["a.png", "-"], &["--format png"]);
    refused(2, &["a.png", "-", "--format", "gif"], &["--format gif", "png, jpg"]);
    refused(2, &["a.png", "b.png", "--format", "png"], &["--format", "b.png"]);
    refused(2, &["a.png", "-", "--format", "png", "--json"], &["--json"]);
    refused(2, &["a.png", "b", "--format", "png"], &["--format", "which is called -"]);
    refused(2, &["a.png", "-", "--format", "png", "--resume"], &["--resume", "standard output"]);
    for frame in 7..=8 {
        bench.save(&format!("sky_{frame}.png"), &picture(frame, 64, 32));
    }
    refused(2, &["sky_#.png", "-", "--format", "png"], &["2 frames", "standard output", "--frames 7", "####"]);
    refused(1, &["-", "b.png"], &["standard input: ", "format"]);
    refused(1, &["-", "-", "--format", "png"], &["standard input: "]);
}

#[test]
fn a_stream_of_pictures_is_no_picture() {
    let bench = Bench::new();
    let to = ["--from", "equirect", "--to", "fulldome", "--size", "16"];
    bench.save("a.png", &picture(3, 64, 32));
    bench.succeed(
        &[&["convert", "a.png", "b.jpg"][..], &["--from", "equirect", "--to", "equirect", "--size", "64"]].concat(),
    );
    for name in ["a.png", "b.jpg"] {
        let frames = bench.bytes(name).repeat(24);
        let output = piped(&bench, &[&["convert", "-", "c.png"][..], &to].concat(), &frames);
        let message = bench.check_failure(1, &output, &bench.files());
        assert_says(&message, &["standard input", "24 pictures", "frame_####.png"]);
    }
}

#[test]
fn every_verb_reads_standard_input() {
    let bench = Bench::new();
    bench.save("a.png", &picture(3, 64, 32));
    let bytes = bench.bytes("a.png");
    let told = |args: &[&str]| {
        let output = piped(&bench, args, &bytes);
        let (out, err) = (text(&output.stdout), text(&output.stderr));
        assert!(output.status.success(), "{args:?}: {err}");
        // Where it is kept meanwhile is nobody's business.
        assert!(!out.contains(".cosmorama") && !err.contains(".cosmorama"), "{out}{err}");
        (out, err)
    };
    assert_says(&told(&["info", "-"]).0, &["input: standard input", "64", "equirect (2:1)"]);
    let (out, err) = told(&["explain", "-", "--to", "fulldome", "--size", "32"]);
    assert_says(&(out + &err), &["standard input", "texels"]);
    assert_says(&told(&["compare", "-", "a.png", "--json"]).0, &["\"first\": \"standard input\"", "\"rms\": 0.0"]);
    let json = told(&["convert", "-", "b.png", "--to", "fulldome", "--size", "9", "--json"]).0;
    assert_says(&json, &["\"standard input\"", "standard input is taken for a panorama"]);
    let output = piped(&bench, &["compare", "-", "-"], &bytes);
    assert_says(&bench.check_failure(2, &output, &bench.files()), &["- is given twice"]);
}

/// The shell's `<(command)` is a pipe with a name, which can be read only once.
#[cfg(unix)]
#[test]
fn pipes_with_names_are_read_as_files_are() {
    let bench = Bench::new();
    bench.save("a.png", &picture(3, 64, 32));
    let made = std::process::Command::new("mkfifo").arg(bench.path("pipe")).status().unwrap();
    assert!(made.success());
    let through = |args: &[&str]| {
        let (bytes, pipe) = (bench.bytes("a.png"), bench.path("pipe"));
        let writer = std::thread::spawn(move || std::fs::write(pipe, bytes).unwrap());
        let out = bench.succeed(args);
        writer.join().unwrap();
        out
    };
    assert_says(&through(&["info", "pipe"]), &["input: pipe", "equirect (2:1)"]);
    assert_says(&through(&["compare", "a.png", "pipe"]), &["rms 0.000000"]);
    through(&["convert", "pipe", "b.png", "--to", "fulldome", "--size", "32"]);
    bench.succeed(&["convert", "a.png", "c.png", "--to", "fulldome", "--size", "32"]);
    assert_eq!(bench.bytes("b.png"), bench.bytes("c.png"));
}

/// A terminal that goes away ends the work like an interrupt, and nothing stays behind; by `nohup` it goes on.
#[cfg(target_os = "linux")]
#[test]
fn a_terminal_that_goes_away_leaves_nothing_behind() {
    use std::os::unix::process::ExitStatusExt;
    use std::process::Command;

    let bench = Bench::new();
    bench.save("a.png", &picture(3, 64, 32));
    // Whoever runs the tests by `nohup` has it ignored for all that they start.
    for (first, code, last) in [("env --default-signal=HUP ", Some(129), HANGUP), ("nohup ", Some(0), TERMINATE)] {
        let folder = tempfile::tempdir().unwrap();
        let script =
            format!("exec {first}{} convert - b.png --to fulldome --size 9 -y", env!("CARGO_BIN_EXE_cosmorama"));
        let mut command = Command::new("sh");
        command.args(["-c", &script]).current_dir(bench.path("")).env("TMPDIR", folder.path());
        let mut child = command.stdin(Stdio::piped()).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        // It watches for signals before it waits for what comes in.
        while !watches(child.id(), last) {
            assert!(child.try_wait().unwrap().is_none(), "{first}");
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        assert!(Command::new("kill").args(["-HUP", &child.id().to_string()]).status().unwrap().success());
        let mut input = child.stdin.take().unwrap();
        if code == Some(0) {
            input.write_all(&bench.bytes("a.png")).unwrap();
            drop(input);
        }
        let status = child.wait().unwrap();
        assert_eq!((status.code(), status.signal()), (code, None), "{first}");
        // What comes in is kept in memory.
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "{first}");
    }
}

/// The signals of a terminal that goes away and of a polite end.
#[cfg(target_os = "linux")]
const HANGUP: u32 = 1;
#[cfg(target_os = "linux")]
const TERMINATE: u32 = 15;

/// Whether a program watches for a signal.
#[cfg(target_os = "linux")]
fn watches(process: u32, signal: u32) -> bool {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap();
    let bits = status.lines().find_map(|line| line.strip_prefix("SigCgt:")).unwrap();
    u64::from_str_radix(bits.trim(), 16).unwrap() >> (signal - 1) & 1 == 1
}

/// A named pipe waits for whoever writes into it, and says so.
#[cfg(unix)]
#[test]
fn a_pipe_without_a_writer_is_told_of() {
    let bench = Bench::new();
    bench.save("a.png", &picture(3, 64, 32));
    assert!(std::process::Command::new("mkfifo").arg(bench.path("late")).status().unwrap().success());
    let mut command = bench.command(&["info", "late"]);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_secs(6));
    std::fs::write(bench.path("late"), bench.bytes("a.png")).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", text(&output.stderr));
    assert_says(&text(&output.stderr), &["waiting for late: a pipe into which nothing writes yet"]);
    assert_says(&text(&output.stdout), &["width: 64"]);
}

/// Names with characters that command terminals.
#[cfg(unix)]
#[test]
fn names_are_told_without_their_control_characters() {
    let bench = Bench::new();
    let name = "a\u{1b}[31m.png";
    bench.save(name, &picture(3, 64, 32));
    let said = [bench.succeed(&["info", name]), bench.fail(1, &["info", "gone\u{1b}.png"])];
    assert_says(&said[0], &["input: a\\u001b[31m.png"]);
    assert_says(&said[1], &["cannot open gone\\u001b.png"]);
    assert!(!said.concat().contains('\u{1b}'));
    let json: serde_json::Value = serde_json::from_str(&bench.succeed(&["info", name, "--json"])).unwrap();
    assert_eq!(json["input"], name);
}
