//! Adding a projection touches its own code and one list on each floor: ARCHITECTURE.md's example is true to the letter, and
//! what has code is in its list.

use crate::source::{code_of, crates_folder, rust_files};

/// The projection that ARCHITECTURE.md takes as its example.
const EXAMPLE: &str = "pannini";

/// Code of a source file without its tests.
fn code_in(path: &std::path::Path) -> String {
    let source = std::fs::read_to_string(path).unwrap();
    code_of(source.split("#[cfg(test)]\nmod tests").next().unwrap())
}

/// Files of the crates that are published, as seen from the crates' folder, with their code.
fn files() -> Vec<(String, String)> {
    let crates = crates_folder();
    let name = |path: &std::path::Path| path.strip_prefix(&crates).unwrap().to_str().unwrap().replace('\\', "/");
    let all = rust_files(&crates).into_iter().map(|path| (name(&path), code_in(&path)));
    all.filter(|(name, _)| name.contains("/src/") && !name.starts_with("testkit/")).collect()
}

fn code_of_file(name: &str) -> String {
    code_in(&crates_folder().join(name))
}

#[test]
fn the_example_is_named_in_its_own_code_and_in_the_lists_alone() {
    let text = std::fs::read_to_string(crates_folder().join("../ARCHITECTURE.md")).unwrap();
    let section = text.split("## To add a projection").nth(1).unwrap().split("\n## ").next().unwrap();
    let mut found = Vec::new();
    for (name, code) in files() {
        let named: Vec<&str> = code.lines().filter(|line| line.to_lowercase().contains(EXAMPLE)).collect();
        let is_its_own = section.contains(&format!("`{name}`"));
        let list = section.split(&format!("// {name}:")).nth(1).map(|rest| rest.split("```").next().unwrap());
        let list = list.and_then(|list| list.split_once('\n')).map(|(_, lines)| lines.split("// ").next().unwrap());
        match list.map(code_of) {
            None if is_its_own == named.is_empty() => found.push(format!("{name} names it: {}", !named.is_empty())),
            None => {}
            Some(list) => {
                let shown = list.lines().filter(|line| line.to_lowercase().contains(EXAMPLE)).map(str::trim);
                if !shown.eq(named.iter().map(|line| line.trim())) {
                    found.push(format!("{name} has {named:?}"));
                }
            }
        }
    }
    assert!(found.is_empty(), "ARCHITECTURE.md, To add a projection, says otherwise:\n{}", found.join("\n"));
}

/// The lines of an enum, without the names of its variants' fields.
fn list<'c>(code: &'c str, name: &str) -> &'c str {
    let start = code.split(&format!("pub enum {name} {{")).nth(1).expect("the list");
    start.split("\n    }\n").next().unwrap()
}

fn first_word(text: &str) -> &str {
    text.split(|c: char| !c.is_alphanumeric()).next().unwrap()
}

#[test]
fn what_has_code_is_in_its_list() {
    let projections = code_of_file("cosmorama/src/projection/mod.rs");
    let cameras = code_of_file("cosmorama/src/camera/mod.rs");
    let lists = [
        (list(&projections, "ProjectionKind"), ["Projection for ", "Profile for ", "Parallels for "].as_slice()),
        (list(&cameras, "CameraModel"), &["Camera for "]),
    ];
    for (name, code) in files() {
        for (list, traits) in &lists {
            let implemented = traits.iter().flat_map(|of| code.split(of).skip(1)).map(first_word);
            for kind in implemented.filter(|kind| *kind != "ProjectionKind") {
                let mut words = list.split(|c: char| !c.is_alphanumeric());
                assert!(words.any(|word| word == kind), "{name}: {kind} is in no list");
            }
        }
    }
}

#[test]
fn every_camera_can_be_asked_for() {
    let cameras = code_of_file("cosmorama/src/camera/mod.rs");
    let texts: String = files()
        .into_iter()
        .filter(|(name, _)| name.starts_with("cosmorama-convert/") || name.starts_with("cosmorama-spec/"))
        .map(|(_, code)| code)
        .collect();
    let kinds: Vec<&str> = list(&cameras, "CameraModel").lines().map(|line| first_word(line.trim())).collect();
    assert!(kinds.contains(&"Perspective"));
    for kind in kinds.into_iter().filter(|kind| !kind.is_empty()) {
        assert!(texts.contains(&format!("CameraModel::{kind}(")), "no SPEC nor file makes a CameraModel::{kind}");
    }
}
