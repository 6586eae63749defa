//! What there is to say is typed: a kind, what it is about, what would change it, and no option of any command line.

use cosmorama_convert::{Code, Conversion, Quiet, Remedy, Setting, Severity};

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
    assert!(wrong.is_of_settings() && wrong.code() == Code::Settings);
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
