//! Standard input and output in place of files.

// A test that cannot go on stops where it stands.
#![allow(clippy::unwrap_used)]

mod bench;

use std::io::Write;
use std::process::{Output, Stdio};

use bench::{Bench, assert_says, picture, text};

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
    refused(2, &["a.png", "-", "--format", "gif"], &["gif"]);
    refused(2, &["a.png", "b.png", "--format", "png"], &["--format", "b.png"]);
    refused(2, &["a.png", "-", "--format", "png", "--json"], &["--json"]);
    refused(1, &["-", "b.png"], &["standard-input", "format"]);
    refused(1, &["-", "-", "--format", "png"], &["standard-input"]);
}
