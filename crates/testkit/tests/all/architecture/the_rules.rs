//! The rules themselves, on made-up lines: that they find what they are there for.

use super::*;

fn used(source: &str, depth: usize) -> Vec<String> {
    rooms_used(&code_of(source), "crate", depth).into_iter().collect()
}

#[test]
fn find_an_upward_use() {
    assert_eq!(used("use crate::render::Resampler;", 2), ["render"]);
    assert_eq!(used("use crate::{raster::Rgba, world::{View, World}, render};", 2), ["raster", "render", "world"]);
    assert_eq!(used("fn f() { crate::world::World::new() }", 2), ["world"]);
    assert_eq!(used("use super::super::world::View;", 2), ["world"]);
    assert_eq!(used("use super::world::View;", 1), ["world"]);
}

#[test]
fn find_a_circle_of_rooms() {
    let uses = |files: &[(&str, &str)]| {
        uses_in(&files.iter().map(|(file, source)| (PathBuf::from(file), code_of(source))).collect::<Vec<_>>())
    };
    let lower = ("low.rs", "fn f() {}");
    let upper = ("high/mod.rs", "use crate::low::f;");
    assert_eq!(circle_in(&uses(&[lower, upper, ("top.rs", "use crate::{high, low};")])), None);
    let planted = [
        ("low.rs", "use crate::middle::g;"),
        ("low.rs", "use crate::{other, middle::{g, h}};"),
        ("low/deep/a.rs", "use super::super::super::middle::g;"),
        // By way of the crate's root.
        ("low.rs", "use crate::Middle;"),
    ];
    let middle = ("middle.rs", "use crate::high::f;");
    for plant in planted {
        let uses = uses(&[plant, upper, middle, ("lib.rs", "mod low;\npub use middle::{Middle, g};")]);
        assert_eq!(circle_in(&uses), Some(["high", "low", "middle"].map(str::to_owned).into()), "{plant:?}");
    }
}

#[test]
fn let_a_room_use_its_own_and_comments_point_up() {
    assert_eq!(used("use super::world_map::View;", 2), Vec::<String>::new());
    assert_eq!(
        used("//! [`crate::world::View`] is above; \n/// crate::render too\nlet a = \"crate::explain\";", 1),
        [""; 0]
    );
    assert_eq!(used("use other_crate::world::View;", 2), Vec::<String>::new());
}

#[test]
fn find_mathematics_and_files() {
    let words = |code| paths_and_calls(code).collect::<Vec<_>>();
    assert_eq!(words("let y = x.sin_cos();"), ["sin_cos"]);
    assert_eq!(words("use glam::DVec3;"), ["glam", "DVec3"]);
    assert_eq!(words("let sin = exp;"), [""; 0]);
    assert_eq!(words("println!(a)"), ["println"]);
    let files = names_under("use std::{fs::File, path::Path};", "std::");
    assert!(files.contains("fs") && files.contains("path"));
}

#[test]
fn find_an_option() {
    assert!(spells_option("    let text = \"give --from\";"));
    assert!(!spells_option("    /// The option --from.") && !spells_option("let text = \"% 1.0 --- a\";"));
}

#[test]
fn find_a_dependency() {
    let manifest = "[package]\nname = \"a\"\n[dependencies]\n# one\ncosmorama-io.workspace = true\nhalf = \"2\"\n\
                    [dev-dependencies]\ntestkit.workspace = true\n";
    assert_eq!(dependencies(manifest), ["cosmorama-io", "half"]);
}

#[test]
fn count_the_floors_of_a_file() {
    for (path, depth) in [("world/mod.rs", 1), ("world/view.rs", 2), ("projection/azimuthal/mod.rs", 2)] {
        assert_eq!(module_depth(Path::new(path)), depth, "{path}");
    }
}
