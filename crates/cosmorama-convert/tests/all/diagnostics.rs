//! What there is to say is typed: a kind, what it is about, what would change it, and no option of any command line.

use std::path::Path;

use cosmorama::raster::{Channels, Depth, EncodedImage, Samples};
use cosmorama_convert::{Code, Conversion, Existing, Quiet, Remedy, Setting, Severity};
use cosmorama_io::{WriteOptions, write};
use cosmorama_spec::MemorySize;

fn panorama() -> (tempfile::TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sky.png").display().to_string();
    let conversion = Conversion::new("builtin:demo", &path).to("fulldome".parse().unwrap()).size("64".parse().unwrap());
    conversion.check().result.unwrap().run(&mut Quiet).unwrap();
    (folder, path)
}

#[test]
fn what_is_only_guessed_comes_with_the_setting_that_says_so() {
    let (folder, dome) = panorama();
    let view = folder.path().join("view.png").display().to_string();
    let outcome = Conversion::new(&dome, view).to("perspective:fov=40,pitch=60".parse().unwrap()).check();
    assert!(outcome.result.is_ok());
    let [found] = &outcome.diagnostics[..] else { panic!("{:?}", outcome.diagnostics) };
    assert_eq!((found.code, found.severity), (Code::Detected, Severity::Warning));
    assert_eq!(found.subject.as_deref(), Some(&*dome));
    assert_eq!(found.remedy, Some(Remedy::Set(Setting::From, "fulldome".to_owned())));
    let python = found.message.render(|setting| format!("{}_=", setting.name()));
    assert!(python.contains("a domemaster (from_= fulldome)"), "{python}");
}

#[test]
fn errors_tell_settings_from_files() {
    let (folder, dome) = panorama();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let wrong = Conversion::new(&dome, path("out.png")).check().result.err().unwrap();
    assert!(wrong.is_of_settings() && wrong.code() == Code::MissingSetting);
    assert!(wrong.message().to_string().starts_with("to is missing"), "{}", wrong.message());
    let gone = Conversion::new(path("gone.png"), path("out.png")).to("fulldome".parse().unwrap());
    let gone = gone.check().result.err().unwrap();
    assert!(!gone.is_of_settings() && gone.message().to_string().contains("gone.png"));
    let exists = Conversion::new(&dome, &dome).to("fulldome".parse().unwrap()).check().result.err().unwrap();
    assert!(exists.is_of_settings(), "an output that is its own input: {}", exists.message());
    let uncovered =
        Conversion::new(&dome, path("out.png")).to("equirect".parse().unwrap()).check().result.err().unwrap();
    assert_eq!(uncovered.code(), Code::Uncovered);
}

/// A picture by formula.
fn make(path: &Path, to: &str, size: &str) {
    let conversion = Conversion::new("builtin:demo", path.display().to_string()).to(to.parse().unwrap());
    conversion.size(size.parse().unwrap()).check().result.unwrap().run(&mut Quiet).unwrap();
}

/// Inputs that cannot be converted, by name, each with the kind of error.
fn wrong_inputs(folder: &Path) -> Vec<(&'static str, Code)> {
    let write = |name: &str, bytes: &[u8]| std::fs::write(folder.join(name), bytes).unwrap();
    make(&folder.join("sky.png"), "equirect", "64");
    make(&folder.join("small_1.png"), "equirect", "64");
    make(&folder.join("small_3.png"), "equirect", "64");
    make(&folder.join("small.png"), "equirect", "32");
    make(&folder.join("tall.png"), "perspective:fov=40", "30x50");
    make(&folder.join("front.png"), "perspective:fov=90", "32");
    std::fs::create_dir(folder.join("folder.png")).unwrap();
    let sky = std::fs::read(folder.join("sky.png")).unwrap();
    write("empty.png", b"");
    write("cut.png", &sky[..sky.len() / 2]);
    write("text.png", b"a text that is no picture of any kind");
    write("broken.toml", b"[[view]]\nimage = 5\n");
    write("gone.toml", b"[[view]]\nimage = \"gone.png\"\n");
    write("mask.toml", b"[[view]]\nimage = \"sky.png\"\nspec = \"equirect\"\nmask = \"small.png\"\n");
    write("camera.toml", b"[[view]]\nimage = \"sky.png\"\nspec = \"perspective:calibration=gone.json\"\n");
    write("lens.toml", b"[[view]]\nimage = \"sky.png\"\nspec = \"perspective:calibration=empty.png\"\n");
    write("broken.pto", b"p f0 w40 h30 v30\ni w64\n");
    write("other.pto", b"p f0 w40 h30 v30\ni w65 h32 f4 v360 y0 p0 r0 n\"sky.png\"\n");
    write("lens.pto", b"p f0 w40 h30 v30\ni w64 h32 f20 v90 y0 p0 r0 n\"sky.png\"\n");
    vec![
        ("gone.png", Code::NotFound),
        ("*.png", Code::NotFound),
        ("small_#.png", Code::NotFound),
        ("gone_#.png", Code::NotFound),
        ("{face}/gone.png", Code::NotFound),
        ("folder.png", Code::Unreadable),
        ("empty.png", Code::Damaged),
        ("cut.png", Code::Damaged),
        ("text.png", Code::Unsupported),
        ("nowhere.toml", Code::NotFound),
        ("broken.toml", Code::Malformed),
        ("gone.toml", Code::NotFound),
        ("mask.toml", Code::WrongSize),
        ("camera.toml", Code::NotFound),
        ("lens.toml", Code::Malformed),
        ("nowhere.pto", Code::NotFound),
        ("broken.pto", Code::Malformed),
        ("other.pto", Code::WrongSize),
        ("lens.pto", Code::Unsupported),
        ("tall.png", Code::Ambiguous),
    ]
}

fn code_of(conversion: Conversion) -> Code {
    let error = conversion.check().result.and_then(|checked| checked.run(&mut Quiet)).err();
    error.map_or_else(|| panic!("no error"), |error| error.code())
}

#[test]
fn errors_have_codes_that_programs_can_react_to() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let path = |name: &str| folder.join(name).display().to_string();
    let view = |input: &str, output: &str| {
        Conversion::new(path(input), path(output)).to("perspective:fov=60".parse().unwrap()).size("16".parse().unwrap())
    };
    for (input, code) in wrong_inputs(folder) {
        assert_eq!(code_of(view(input, "out")), Code::OutputFormat, "{input}");
        let output = if input.contains('#') { "out_#.png" } else { "out.png" };
        assert_eq!(code_of(view(input, output)), code, "{input}");
    }
    let sky = || view("sky.png", "out.png");
    let sized = |size: &str| sky().size(size.parse().unwrap());
    let cases = [
        ("no projection", Conversion::new(path("sky.png"), path("out.png")), Code::MissingSetting),
        ("a calibration", sky().from("perspective:calibration=gone.json".parse().unwrap()), Code::NotFound),
        ("exists", view("sky.png", "small.png"), Code::Exists),
        ("itself", view("sky.png", "sky.png").existing(Existing::Replace), Code::SameFile),
        ("no folder", Conversion { make_folders: false, ..view("sky.png", "nowhere/out.png") }, Code::Unwritable),
        ("a folder in a file", view("sky.png", "text.png/folder/out.png"), Code::Unwritable),
        ("a view of a part", view("front.png", "out.png").from("perspective:fov=20".parse().unwrap()), Code::Uncovered),
        ("wide", Conversion { output: path("out.jpg").into(), ..sized("70000x2") }, Code::OutputFormat),
        ("memory", sky().memory(MemorySize::Bytes(1)), Code::Memory),
        ("shape", view("tall.png", "out.png").from("equirect".parse().unwrap()), Code::WrongSize),
    ];
    for (name, conversion, code) in cases {
        assert_eq!(code_of(conversion), code, "{name}");
    }
}

#[test]
fn a_frame_of_another_size_and_one_without_light_have_codes() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let path = |name: &str| folder.join(name).display().to_string();
    make(&folder.join("sky_1.exr"), "equirect", "64");
    make(&folder.join("sky_2.exr"), "equirect", "32");
    let dome = |output: &str| Conversion::new(path("sky_#.exr"), path(output)).to("fulldome".parse().unwrap());
    assert_eq!(code_of(dome("dome_#.exr").size("16".parse().unwrap())), Code::WrongSize);
    let nothing = EncodedImage::new(64, 32, Channels::Grey, Depth::Float, Samples::Float(vec![f32::NAN; 64 * 32]));
    write(folder.join("sky_2.exr"), &nothing.unwrap(), &WriteOptions::default()).unwrap();
    let dome = dome("dark_#.exr").size("16".parse().unwrap());
    assert_eq!(code_of(dome), Code::NotANumber);
}
