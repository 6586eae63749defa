//! Dependencies point down only: reads every source file and manifest, and fails on an upward use.
//!
//! The tables below are the building's plan; a new room or crate gets its line there (ARCHITECTURE.md draws it).

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use crate::source::{code_of, crates_folder, rust_files};

/// A room, and the rooms that it may use.
type Room = (&'static str, &'static [&'static str]);

/// The rooms of the library, lowest floor first, and the rooms that each may use.
const ROOMS: [Room; 15] = [
    ("sphere", &[]),
    ("projection", &["sphere"]),
    ("raster", &[]),
    ("camera", &["sphere", "projection", "raster"]),
    ("layout", &["sphere", "projection", "camera", "world"]),
    ("world", &["sphere", "projection", "raster", "camera"]),
    ("filter", &["sphere", "projection", "raster", "camera", "world"]),
    ("render", &["sphere", "projection", "raster", "camera", "world", "filter"]),
    ("lighting", &["sphere", "raster", "camera", "world", "filter", "render"]),
    ("motion", &["sphere", "raster", "camera", "world", "filter", "render"]),
    ("arrange", &["sphere", "raster", "camera", "layout", "world"]),
    ("circle", &["raster"]),
    ("compare", &["raster"]),
    ("explain", &["sphere", "projection", "raster", "camera", "layout", "world", "filter", "render"]),
    ("laboratory", &["raster", "camera", "world", "filter", "render", "compare", "explain", "sphere"]),
];

/// The rooms of `cosmorama-convert`, lowest floor first.
const CONVERT_ROOMS: [Room; 11] = [
    ("diagnostic", &[]),
    ("source", &["diagnostic"]),
    ("packing", &["diagnostic"]),
    ("settings", &["source"]),
    ("detect", &["diagnostic", "source", "packing"]),
    ("input", &["diagnostic", "source", "packing", "settings", "detect"]),
    ("target", &["diagnostic", "source", "packing", "settings"]),
    ("colour", &["diagnostic", "settings", "input", "target"]),
    ("job", &["diagnostic", "source", "settings", "detect", "input", "target", "colour"]),
    ("engine", &["diagnostic", "source", "packing", "settings", "detect", "input", "target", "colour", "job"]),
    ("conversion", &["diagnostic", "source", "settings", "input", "target", "colour", "job", "engine"]),
];

/// Crates whose rooms have floors.
const HOUSES: [(&str, &[Room]); 2] = [("cosmorama", &ROOMS), ("cosmorama-convert", &CONVERT_ROOMS)];

/// Every room, for crates that stand above the whole library.
const ALL: &[&str] = &[
    "sphere",
    "projection",
    "camera",
    "layout",
    "raster",
    "world",
    "filter",
    "render",
    "lighting",
    "motion",
    "arrange",
    "circle",
    "compare",
    "explain",
    "laboratory",
];

/// A crate, our own crates that it may depend on, and the library's rooms that it may use.
struct CratePlan {
    name: &'static str,
    crates: &'static [&'static str],
    rooms: &'static [&'static str],
    /// Parts of the standard library that it must not use.
    banned_std: &'static [&'static str],
    /// Crates, functions and macros that it must not use.
    banned: &'static [&'static str],
    reason: &'static str,
}

const CRATES: [CratePlan; 9] = [
    CratePlan {
        name: "cosmorama",
        crates: &[],
        rooms: &[],
        banned_std: &["fs", "io", "process", "net", "env"],
        banned: &["println", "eprintln"],
        reason: "the library touches neither files nor the terminal",
    },
    CratePlan {
        name: "cosmorama-builtin",
        crates: &["cosmorama"],
        rooms: &["sphere", "camera", "layout", "raster", "world", "explain"],
        banned_std: &["fs", "io", "process", "net", "env"],
        banned: &["println", "eprintln"],
        reason: "worlds by formula touch neither files nor the terminal",
    },
    CratePlan {
        name: "cosmorama-spec",
        crates: &["cosmorama"],
        rooms: &[
            "sphere",
            "projection",
            "camera",
            "layout",
            "raster",
            "world",
            "filter",
            "render",
            "lighting",
            "motion",
        ],
        banned_std: &["fs", "io", "process", "net", "env", "thread"],
        banned: &["rayon", "clap", "println", "eprintln"],
        reason: "texts are values: parsing touches neither files nor the terminal, and starts no thread",
    },
    CratePlan {
        name: "cosmorama-io",
        crates: &["cosmorama"],
        rooms: &["sphere", "camera", "layout", "motion", "raster", "world"],
        banned_std: &["net", "process"],
        banned: &["glam", "println", "eprintln"],
        reason: "files know no geometry and no terminal",
    },
    CratePlan {
        name: "cosmorama-video",
        crates: &["cosmorama", "cosmorama-io"],
        rooms: &["raster"],
        banned_std: &["net"],
        banned: &["glam", "println", "eprintln"],
        reason: "videos know no geometry and no terminal",
    },
    CratePlan {
        name: "cosmorama-convert",
        crates: &["cosmorama", "cosmorama-builtin", "cosmorama-io", "cosmorama-spec", "cosmorama-video"],
        rooms: ALL,
        banned_std: &["f32", "f64", "net", "process"],
        banned: &[
            "clap",
            "anyhow",
            "print",
            "println",
            "eprint",
            "eprintln",
            "build_global",
            "glam",
            "sin",
            "cos",
            "sqrt",
        ],
        reason: "a conversion is a value: no terminal, no state of the process, no mathematics",
    },
    CratePlan {
        name: "cosmorama-scene",
        crates: &["cosmorama", "cosmorama-builtin", "cosmorama-spec"],
        rooms: &["sphere", "camera", "layout", "raster", "world", "filter", "render", "lighting"],
        banned_std: &["process", "net", "env"],
        banned: &["clap", "println", "eprintln"],
        reason: "things under a world know no terminal",
    },
    CratePlan {
        name: "cosmorama-cli",
        crates: &[
            "cosmorama",
            "cosmorama-builtin",
            "cosmorama-convert",
            "cosmorama-io",
            "cosmorama-scene",
            "cosmorama-spec",
        ],
        rooms: ALL,
        banned_std: &["f32", "f64"],
        banned: &[
            "glam",
            "sin",
            "cos",
            "tan",
            "sin_cos",
            "asin",
            "acos",
            "atan",
            "atan2",
            "sqrt",
            "hypot",
            "powi",
            "powf",
            "exp",
            "to_radians",
            "to_degrees",
        ],
        reason: "the command line holds no mathematics",
    },
    CratePlan {
        name: "testkit",
        crates: &["cosmorama", "cosmorama-builtin", "cosmorama-io"],
        rooms: ALL,
        banned_std: &[],
        banned: &[],
        reason: "",
    },
];

/// The crate whose texts name settings, not options: each caller writes those in its own way.
const SPELLS_NO_OPTION: &str = "cosmorama-convert";

#[test]
fn only_the_command_line_spells_options() {
    let mut found = Vec::new();
    for file in rust_files(&crates_folder().join(SPELLS_NO_OPTION).join("src")) {
        let source = std::fs::read_to_string(&file).unwrap();
        let lines = source.lines().enumerate().filter(|(_, line)| spells_option(line));
        found.extend(lines.map(|(index, line)| format!("{}:{}: {}", file.display(), index + 1, line.trim())));
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Whether a line that is no comment holds an option of the command line.
fn spells_option(line: &str) -> bool {
    let is_comment = line.trim_start().starts_with("//");
    !is_comment && line.split("--").skip(1).any(|rest| rest.starts_with(|c: char| c.is_ascii_lowercase()))
}

/// Lines of a file at most, without its tests.
const LONGEST: usize = 600;

#[test]
fn no_file_is_too_long_to_be_read_at_once() {
    let read = |file: &PathBuf| std::fs::read_to_string(file).unwrap();
    let lines = |file: &PathBuf| read(file).lines().take_while(|line| *line != "mod tests {").count();
    let files = rust_files(&crates_folder());
    let long: Vec<_> = files.iter().filter(|file| lines(file) > LONGEST).collect();
    assert!(files.len() > 100 && long.is_empty(), "of more than {LONGEST} lines: {long:?}");
}

/// Entries of a folder at most, the file that speaks for it among them.
const MOST_ENTRIES: usize = 12;

/// Folders that list the rooms of a whole crate, which are as many as the crate has nouns.
const CRATE_ROOTS: [&str; 1] = ["cosmorama/src"];

#[test]
fn a_folder_is_a_room_of_at_most_a_dozen_entries() {
    let folders: BTreeSet<PathBuf> = rust_files(&crates_folder())
        .iter()
        .flat_map(|file| file.ancestors().skip(1).map(Path::to_path_buf).collect::<Vec<_>>())
        .filter(|folder| folder.strip_prefix(crates_folder()).is_ok_and(|inside| inside.iter().count() > 1))
        .filter(|folder| !CRATE_ROOTS.iter().any(|root| folder.ends_with(root)))
        .collect();
    let entries = |folder: &PathBuf| std::fs::read_dir(folder).unwrap().count();
    let crowded: Vec<String> = folders
        .iter()
        .map(|folder| (entries(folder), folder))
        .filter(|(entries, _)| *entries > MOST_ENTRIES)
        .map(|(entries, folder)| format!("{entries} in {}", folder.display()))
        .collect();
    assert!(folders.len() > 30 && crowded.is_empty(), "more than {MOST_ENTRIES} entries: {}", crowded.join("\n"));
}

#[test]
fn no_room_uses_a_higher_one() {
    let mut found = Vec::new();
    for (name, rooms) in HOUSES {
        for (room, uses) in uses_of(name, code_of) {
            let Some((_, allowed)) = rooms.iter().find(|(name, _)| *name == room) else {
                found.push(format!("{name}: the room `{room}` has no floor in the table of its crate"));
                continue;
            };
            let upward = uses.iter().filter(|(used, _)| !allowed.contains(&used.as_str()));
            found.extend(
                upward.map(|(used, file)| format!("{name}/src/{}: {room} must not use {used}", file.display())),
            );
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn no_rooms_use_each_other_in_a_circle() {
    // Tests may use what stands above.
    let without_tests = |source: &str| code_of(source.split("\nmod tests {").next().unwrap_or_default());
    for plan in &CRATES {
        let uses = uses_of(plan.name, without_tests);
        let circle = circle_in(&uses).map(|circle| told(&circle, &uses));
        assert_eq!(circle, None, "{}: rooms use each other", plan.name);
    }
}

#[test]
fn no_crate_uses_what_it_must_not() {
    let mut found = Vec::new();
    for plan in &CRATES {
        for file in rust_files(&crates_folder().join(plan.name).join("src")) {
            let code = code_of(&std::fs::read_to_string(&file).unwrap());
            for used in rooms_used(&code, "cosmorama", usize::MAX) {
                if !plan.rooms.contains(&used.as_str()) {
                    found.push(format!("{}: {} must not use cosmorama::{used}", file.display(), plan.name));
                }
            }
            for used in names_under(&code, "std::").iter().filter(|used| plan.banned_std.contains(&used.as_str())) {
                found.push(format!("{}: `std::{used}`: {}", file.display(), plan.reason));
            }
            for word in paths_and_calls(&code).filter(|word| plan.banned.contains(word)) {
                found.push(format!("{}: `{word}`: {}", file.display(), plan.reason));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

#[test]
fn no_crate_depends_on_a_higher_one() {
    let mut found = Vec::new();
    for folder in std::fs::read_dir(crates_folder()).unwrap().map(|entry| entry.unwrap().path()) {
        let name = folder.file_name().unwrap().to_str().unwrap();
        let Some(plan) = CRATES.iter().find(|plan| plan.name == name) else {
            found.push(format!("the crate `{name}` has no line in CRATES"));
            continue;
        };
        let manifest = std::fs::read_to_string(folder.join("Cargo.toml")).unwrap();
        for needed in dependencies(&manifest) {
            let is_ours = CRATES.iter().any(|plan| plan.name == needed);
            if is_ours && !plan.crates.contains(&needed.as_str()) {
                found.push(format!("{name} must not depend on {needed}"));
            }
            if plan.banned.contains(&needed.as_str()) {
                found.push(format!("{name} must not depend on {needed}: {}", plan.reason));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

/// Files with code for lanes. All else is plain: one pixel after the other, so that the two can be held equal.
const LANES: [&str; 41] = [
    "filter/ewa/blocks.rs",
    "filter/ewa/cubic.rs",
    "filter/ewa/direct.rs",
    "filter/ewa/gaussian.rs",
    "filter/ewa/lanes.rs",
    "filter/ewa/pinhole.rs",
    "filter/ewa/rows.rs",
    "filter/rim/rim_extrapolation.rs",
    "filter/rim/simd_levels.rs",
    "filter/taps.rs",
    "lighting/prefilter/all_texels.rs",
    "lighting/prefilter/light_tree/mod.rs",
    "lighting/prefilter/zonal/legendre.rs",
    "lighting/prefilter/zonal/mod.rs",
    "motion/rings/mod.rs",
    "render/apply/driver.rs",
    "render/apply/fixed/at_once.rs",
    "render/apply/fixed/blocks.rs",
    "render/apply/fixed/encode_u8.rs",
    "render/apply/fixed/mod.rs",
    "render/apply/fixed/patch_texels.rs",
    "render/apply/fixed/quantize.rs",
    "render/apply/fixed/turned.rs",
    "render/apply/fixed/unmirrored.rs",
    "render/apply/fixed/weights.rs",
    "render/apply/fixed/window.rs",
    "render/apply/float/large.rs",
    "render/apply/float/mod.rs",
    "render/apply/float/turned.rs",
    "render/apply/float/weights.rs",
    "render/apply/float/window.rs",
    "render/apply/lane_shapes.rs",
    "render/apply/x86/blocks.rs",
    "render/apply/x86/srgb.rs",
    "render/batch/centring.rs",
    "render/batch/ellipses.rs",
    "render/batch/weights.rs",
    "render/batch/window.rs",
    "render/apply/tap_lists.rs",
    "render/plan/weights.rs",
    "render/plan/window_format.rs",
];

/// Files with plain code that is compiled for lanes.
const PLAIN_LANES: [&str; 2] =
    ["cosmorama-video/src/colour/rgb_to_yuv420.rs", "cosmorama-video/src/colour/yuv420_to_rgb.rs"];

#[test]
fn lanes_stay_in_the_files_that_are_for_them() {
    let found: BTreeSet<PathBuf> = rust_files(&crates_folder())
        .into_iter()
        .filter(|file| !file.components().any(|part| part.as_os_str() == "tests"))
        .filter(|file| paths_and_calls(&code_of(&std::fs::read_to_string(file).unwrap())).any(|w| w == "fearless_simd"))
        .collect();
    let library = crates_folder().join("cosmorama/src");
    let of_library = LANES.map(|name| library.join(name)).into_iter();
    assert_eq!(found, of_library.chain(PLAIN_LANES.map(|name| crates_folder().join(name))).collect());
}

#[test]
fn four_files_are_trusted_two_with_indices_one_with_memory_and_one_with_hints() {
    let is_unsafe = |file: &PathBuf| {
        let code = code_of(&std::fs::read_to_string(file).unwrap());
        code.split(|c: char| !c.is_alphanumeric() && c != '_').any(|word| word == "unsafe")
    };
    let found: BTreeSet<PathBuf> = rust_files(&crates_folder()).into_iter().filter(is_unsafe).collect();
    let trusted = [
        "cosmorama/src/filter/ewa/prefetch.rs",
        "cosmorama/src/render/apply/output_region.rs",
        "cosmorama/src/render/apply/texels.rs",
        "cosmorama-cli/src/allocator.rs",
    ];
    assert_eq!(found, trusted.map(|name| crates_folder().join(name)).into());
}

/// Modules between the crate's root and a file: `super` said so often is the root.
fn module_depth(inside: &Path) -> usize {
    inside.iter().count() - usize::from(inside.ends_with("mod.rs"))
}

/// The rooms that paths from `root` (`crate`, `cosmorama`) and from `depth` times `super` lead to.
fn rooms_used(code: &str, root: &str, depth: usize) -> BTreeSet<String> {
    let mut names = names_under(code, &format!("{root}::"));
    if depth < 16 {
        names.extend(names_under(code, &"super::".repeat(depth)));
    }
    names.retain(|name| ROOMS.iter().any(|(room, _)| room == name));
    names
}

/// By room of a crate, the rooms that it uses, each with a file that does. A name that the crate's root passes on counts as
/// its own room's.
type Uses = BTreeMap<String, BTreeMap<String, PathBuf>>;

/// Files of a crate's root, which are no rooms.
const ROOTS: [&str; 3] = ["lib", "main", "prelude"];

/// Returns what the rooms of a crate use, by the paths of its files from its root and what of each is read.
fn uses_in(files: &[(PathBuf, String)]) -> Uses {
    let room_of =
        |file: &Path| Path::new(file.iter().next().unwrap()).file_stem().unwrap().to_str().unwrap().to_owned();
    let mut uses: Uses = files.iter().map(|(file, _)| (room_of(file), BTreeMap::new())).collect();
    uses.retain(|room, _| !ROOTS.contains(&room.as_str()));
    let root = files.iter().find(|(file, _)| file == Path::new("lib.rs"));
    let homes = root.map_or_else(BTreeMap::new, |(_, code)| passed_on(code, &uses));
    for (file, code) in files {
        let room = room_of(file);
        let to_root = "super::".repeat(module_depth(file));
        let names = ["crate::", &to_root].into_iter().filter(|root| !root.is_empty());
        let names: BTreeSet<String> = names.flat_map(|root| names_under(code, root)).collect();
        let rooms = names.iter().filter_map(|name| if uses.contains_key(name) { Some(name) } else { homes.get(name) });
        let others: Vec<String> = rooms.filter(|used| **used != room).cloned().collect();
        if let Some(used) = uses.get_mut(&room) {
            used.extend(others.into_iter().map(|other| (other, file.clone())));
        }
    }
    uses
}

/// Reads what the rooms of a crate use, in what `code` leaves of the text of each file.
fn uses_of(name: &str, code: impl Fn(&str) -> String) -> Uses {
    let source = crates_folder().join(name).join("src");
    let read = |file: &PathBuf| code(&std::fs::read_to_string(file).unwrap());
    let files = rust_files(&source);
    uses_in(&files.iter().map(|file| (file.strip_prefix(&source).unwrap().to_owned(), read(file))).collect::<Vec<_>>())
}

/// Returns the names that a crate's root passes on from its rooms, each with its room.
fn passed_on(root: &str, rooms: &Uses) -> BTreeMap<String, String> {
    let statements = root.split(';').filter_map(|statement| statement.split_once("use ")?.1.split_once("::"));
    let words = |(room, names): (&str, &str)| {
        let names = names.split(|c: char| !c.is_alphanumeric() && c != '_').map(str::to_owned).collect::<Vec<_>>();
        let room = room.to_owned();
        names.into_iter().filter(|name| !name.is_empty()).map(move |name| (name, room.clone())).collect::<Vec<_>>()
    };
    statements.filter(|(room, _)| rooms.contains_key(*room)).flat_map(words).collect()
}

/// Returns rooms of which each uses the next, and the last the first, if there are any.
fn circle_in(uses: &Uses) -> Option<Vec<String>> {
    let mut left: BTreeSet<&String> = uses.keys().collect();
    // Whoever uses nobody that is left is in no circle.
    while let Some(free) = left.iter().copied().find(|room| !uses[*room].keys().any(|used| left.contains(used))) {
        left.remove(free);
    }
    let next = |room: &String| uses[room].keys().find(|used| left.contains(used)).cloned();
    let mut path = vec![left.first().copied()?.clone()];
    loop {
        let room = next(path.last()?)?;
        if let Some(start) = path.iter().position(|other| *other == room) {
            return Some(path.split_off(start));
        }
        path.push(room);
    }
}

/// Describes a circle, with a file for each step.
fn told(circle: &[String], uses: &Uses) -> String {
    let steps = circle.iter().zip(circle.iter().cycle().skip(1));
    let step = |(room, used): (&String, &String)| format!("{room} uses {used} ({})", uses[room][used].display());
    steps.map(step).collect::<Vec<_>>().join(", ")
}

/// The names that paths with this beginning go on with.
fn names_under(code: &str, root: &str) -> BTreeSet<String> {
    let is_whole = |start: usize| {
        let before = code[..start].chars().next_back();
        !before.is_some_and(|before| before.is_alphanumeric() || before == '_' || before == ':')
    };
    let starts = code.match_indices(root).map(|(start, _)| start).filter(|&start| is_whole(start));
    starts.flat_map(|start| first_names(&code[start + root.len()..])).collect()
}

/// The names that a path goes on with: one, or those of a group in braces.
fn first_names(path: &str) -> Vec<String> {
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let Some(group) = path.strip_prefix('{') else { return vec![word(path)] };
    let mut names = vec![word(group.trim_start())];
    let mut nested = 0;
    for (position, character) in group.char_indices() {
        match character {
            '{' => nested += 1,
            '}' if nested == 0 => break,
            '}' => nested -= 1,
            ',' if nested == 0 => names.push(word(group[position + 1..].trim_start())),
            _ => {}
        }
    }
    names
}

/// The words that stand in a path, are called, or are macros.
fn paths_and_calls(code: &str) -> impl Iterator<Item = &str> {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let starts = code
        .char_indices()
        .filter(move |&(start, c)| is_word(c) && !code[..start].chars().next_back().is_some_and(is_word));
    starts.filter_map(move |(start, _)| {
        let word = code[start..].split(|c| !is_word(c)).next().unwrap_or_default();
        let (before, after) = (&code[..start], &code[start + word.len()..]);
        let in_path = before.ends_with("::") || after.starts_with("::");
        let called = after.starts_with('!') || (before.ends_with('.') && after.starts_with('('));
        (in_path || called).then_some(word)
    })
}

/// The names under `[dependencies]`; those for tests and builds alone may come from anywhere.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut names = Vec::new();
    let mut counts = false;
    for line in manifest.lines().map(str::trim) {
        if line.starts_with('[') {
            counts = line == "[dependencies]";
        } else if counts && !line.is_empty() && !line.starts_with('#') {
            names.push(line.split(['.', '=', ' ']).next().unwrap_or_default().to_owned());
        }
    }
    names
}

mod the_rules;
