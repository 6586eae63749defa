//! Help, manual pages and completions: short where that is asked for, and whole where all is.

use std::process::Command;

use crate::bench::{Bench, assert_says, text};
use cosmorama_spec::{FilterName, KernelName, SpecKind, TransferName};

const VERBS: [&str; 14] = [
    "demo",
    "convert",
    "light",
    "shade",
    "plates",
    "info",
    "explain",
    "compare",
    "verify",
    "filters",
    "figures",
    "completions",
    "man",
    "help",
];

/// Lines of short help at most.
const SHORT: usize = 60;

/// What a command prints in a terminal of so many columns.
fn printed(bench: &Bench, args: &[&str], columns: usize) -> String {
    let output = bench.command(args).env("COLUMNS", columns.to_string()).output().unwrap();
    assert!(output.status.success(), "{args:?}: {}", text(&output.stderr));
    text(&output.stdout)
}

/// Examples at the beginning of a help text.
fn examples(help: &str) -> Vec<&str> {
    help.lines().skip(1).take_while(|line| !line.is_empty()).map(str::trim).collect()
}

#[test]
fn every_help_begins_with_examples_that_never_break() {
    let bench = Bench::new();
    for verb in VERBS {
        let wide = bench.succeed(&[verb, "--help"]);
        assert!(wide.starts_with(&format!("Examples:\n  cosmorama {verb}")), "{wide}");
        assert!(examples(&wide).iter().all(|example| example.len() <= 78), "{wide}");
        for option in ["-h", "--help"] {
            let narrow = printed(&bench, &[verb, option], 40);
            assert_eq!(examples(&narrow), examples(&wide), "{verb} {option}");
        }
    }
    assert!(bench.succeed(&["--help"]).starts_with("Examples:\n  cosmorama demo\n"));
}

/// The parser of the program itself takes every example.
#[test]
fn examples_can_be_run() {
    let bench = Bench::new();
    for verb in VERBS {
        let help = bench.succeed(&[verb, "--help"]);
        for example in
            examples(&help).iter().filter(|example| ["convert", "explain"].contains(&verb) && !example.is_empty())
        {
            let program = format!("'{}'", env!("CARGO_BIN_EXE_cosmorama"));
            let script = example.replacen("cosmorama", &program, 1);
            let output = Command::new("sh").args(["-c", &script]).current_dir(bench.path("")).output().unwrap();
            // Their inputs are not there, but nothing else is wrong with them.
            let said = text(&output.stderr);
            let lacks_input = ["no such", "cannot open", "no frame found", "no face found", "cannot be read"];
            let is_fine = output.status.success() || lacks_input.iter().any(|words| said.contains(words));
            assert!(is_fine && output.status.code() != Some(2), "{example}: {said}");
        }
    }
}

#[test]
fn short_help_is_short_and_long_help_explains() {
    let bench = Bench::new();
    for verb in VERBS {
        for columns in [80, 100] {
            let short = printed(&bench, &[verb, "-h"], columns);
            assert!(short.lines().count() <= SHORT, "{verb} -h has {} lines: {short}", short.lines().count());
        }
    }
    let (short, long) = (bench.succeed(&["convert", "-h"]), bench.succeed(&["convert", "--help"]));
    assert_says(&short, &["--from <SPEC>", "--to <SPEC>", "--size", "--kernel", "--frames", "cosmorama help spec"]);
    assert_says(
        &long,
        &["omnimax      an Omnimax film frame", "- balanced: Between the two", "--in-transfer", "zone-plate"],
    );
    assert!(printed(&bench, &["-h"], 80).lines().count() <= SHORT);
}

#[test]
fn help_has_topics() {
    let bench = Bench::new();
    let spec = bench.succeed(&["help", "spec"]);
    assert_says(
        &spec,
        &["tilt=DEGREES            how far the dome leans to the front (0)", "latlong          equirect"],
    );
    assert_says(&spec, &["tinyplanet       stereographic:pitch=-90", "posx, negz"]);
    let fisheye = bench.succeed(&["help", "spec", "fisheye"]);
    assert_says(&fisheye, &["fisheye is a fisheye lens that looks ahead.", "fov=DEGREES", "and, as every SPEC, yaw"]);
    assert!(bench.succeed(&["help", "spec", "panorama"]).starts_with("equirect is "));
    assert_eq!(bench.succeed(&["help", "convert"]), bench.succeed(&["convert", "--help"]));
    assert_eq!(bench.succeed(&["help"]), bench.succeed(&["--help"]));
    assert_says(&bench.fail(2, &["help", "spec", "fishey"]), &["did you mean 'fisheye'?"]);
    assert_says(&bench.fail(2, &["help", "convert", "fisheye"]), &["only 'help spec' takes a projection"]);
    assert_says(&bench.fail(2, &["help", "convrt"]), &["did you mean 'convert'?", "spec, cube"]);
    assert_eq!(bench.succeed(&["help", "fulldome"]), bench.succeed(&["help", "spec", "domemaster"]));
}

#[test]
fn keys_and_lists_are_topics_of_help() {
    let bench = Bench::new();
    assert_says(&bench.succeed(&["help", "tilt"]), &["tilt is a key", "fulldome:tilt=DEGREES"]);
    assert_says(&bench.succeed(&["help", "yaw"]), &["SPEC:yaw=DEGREES", "turns the view to the right"]);
    for (name, about) in KernelName::NAMES {
        assert_says(&bench.succeed(&["help", "kernels"]), &[name, about]);
    }
    assert_says(&bench.succeed(&["help", "formats"]), &["tif, tiff", "TIFF: --depth 8, 10, 12, 16, half, float"]);
    assert_says(&bench.succeed(&["help", "naming"]), &["bourke", "cube:order=PRESET"]);
    let part = bench.succeed(&["help", "light", "diffuse"]);
    assert_eq!(part, bench.succeed(&["light", "diffuse", "--help"]));
    assert_says(&bench.fail(2, &["help", "size"]), &["it is an option: 'cosmorama convert --help' explains --size"]);
    assert_says(&bench.fail(2, &["help", "bourke"]), &["--from cube:naming=bourke"]);
    assert_says(&bench.fail(2, &["help", "blender"]), &["docs/blender-cube.md"]);
    assert_says(&bench.fail(2, &["help", "tilted"]), &["did you mean 'tilt'?"]);
    // A folder of a verb's name is not made by mistake.
    assert_says(&bench.fail(2, &["man", "convert"]), &["'cosmorama help convert' prints it", "./convert"]);
    bench.succeed(&["man", "./convert"]);
}

#[test]
fn every_verb_has_a_manual_page_with_examples_and_without_empty_sections() {
    let bench = Bench::new();
    bench.succeed(&["man", "pages"]);
    let names = VERBS.map(|verb| format!("man1/cosmorama-{verb}.1"));
    let others = [
        "man1/cosmorama.1",
        "man1/cosmorama-light-diffuse.1",
        "man1/cosmorama-light-specular.1",
        "man1/cosmorama-light-harmonics.1",
        "man1/cosmorama-light-brdf.1",
        "man1/cosmorama-light-deploy.1",
        "man1/cosmorama-light-sun.1",
        "man1/cosmorama-light-table.1",
        "man7/cosmorama-spec.7",
    ];
    let names = names.iter().map(String::as_str).chain(others);
    let mut all = 0;
    for name in names {
        let page = text(&bench.bytes(&format!("pages/{name}")));
        all += page.len();
        assert!(page.contains(".TH cosmorama"), "{name}: {page}");
        let is_for_specs = name.ends_with(".7");
        assert!(is_for_specs || page.contains(".SH \"EXAMPLES\"\n.nf\ncosmorama "), "{name}: {page}");
        let lines: Vec<&str> = page.lines().filter(|line| !line.is_empty()).collect();
        for pair in lines.windows(2).filter(|pair| pair[0].starts_with(".SH")) {
            assert!(!pair[1].starts_with(".SH") && pair[1] != ".fi", "{name}: {} is empty", pair[0]);
        }
        assert!(!lines.last().unwrap().starts_with(".SH"), "{name}");
    }
    assert_eq!(bench.succeed(&["man"]).len(), all, "all pages one after the other");
    assert_says(&text(&bench.bytes("pages/man1/cosmorama-convert.1")), &["anti\\-ringing", "no\\-mkdir"]);
    assert_says(&text(&bench.bytes("pages/man7/cosmorama-spec.7")), &["tilt=DEGREES", "little\\-planet"]);
    assert_says(&bench.fail(1, &["man", "pages"]), &["outputs exist", "--overwrite"]);
    bench.succeed(&["man", "pages", "-y"]);
}

#[test]
fn completions_know_values() {
    let bench = Bench::new();
    for shell in ["bash", "zsh", "fish"] {
        let script = bench.succeed(&["completions", shell]);
        let has =
            |name: &str| script.split(|c: char| !(c.is_alphanumeric() || "-_".contains(c))).any(|word| word == name);
        for kind in SpecKind::all() {
            assert!(has(kind.name()), "{shell}: {}", kind.name());
        }
        // Other programs' names are offered, too.
        assert!(SpecKind::other_names().all(|(name, _)| has(name)), "{shell}");
        let names = [FilterName::NAMES, &KernelName::NAMES, &TransferName::NAMES].concat();
        for (name, _) in names.iter().filter(|(name, _)| !name.contains(':')) {
            assert!(has(name), "{shell}: {name}");
        }
    }
    assert!(bench.succeed(&["completions", "bash"]).contains("_cosmorama()"));
    assert!(bench.succeed(&["completions", "zsh"]).starts_with("#compdef cosmorama"));
}

#[test]
fn fish_and_zsh_know_words_without_options() {
    let bench = Bench::new();
    let fish = bench.succeed(&["completions", "fish"]);
    let words = |verb: &str| {
        let line = format!("complete -c cosmorama -n \"__fish_cosmorama_using_subcommand {verb}\" -f -a");
        fish.lines().filter(|said| said.starts_with(&line)).collect::<String>()
    };
    assert_says(&words("completions"), &["bash elvish fish powershell zsh"]);
    assert_says(&words("help"), &["convert", "spec", "fulldome"]);
    assert_eq!(words("convert"), "", "files are offered there");
    let zsh = bench.succeed(&["completions", "zsh"]);
    let help = zsh.split("(help)").nth(1).unwrap();
    assert_says(help, &["fulldome"]);
}

/// What bash offers behind `--to`.
#[cfg(target_os = "linux")]
#[test]
fn bash_completes_a_projection() {
    let bench = Bench::new();
    std::fs::write(bench.path("script"), bench.succeed(&["completions", "bash"])).unwrap();
    let line = "source ./script; COMP_WORDS=(cosmorama convert a.png b.png --to full); COMP_CWORD=5; \
                _cosmorama cosmorama full --to; echo \"${COMPREPLY[@]}\"";
    let output = Command::new("bash").args(["-c", line]).current_dir(bench.path("")).output().unwrap();
    assert_eq!(text(&output.stdout), "fulldome\n", "{}", text(&output.stderr));
}
