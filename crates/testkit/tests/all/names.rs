//! `docs/names.md` lists what the code knows: face names, orders of faces and other programs' names of projections.

use cosmorama::layout::{FaceOrder, LayoutKind, Naming};

use crate::source::crates_folder;

/// Cells of the page's table rows, without the marks of code.
fn rows() -> Vec<Vec<String>> {
    let page = std::fs::read_to_string(crates_folder().join("../docs/names.md")).unwrap();
    let cells =
        |line: &str| line.trim_matches('|').split('|').map(|cell| cell.replace('`', "").trim().to_owned()).collect();
    page.lines().filter(|line| line.starts_with("| ")).map(cells).collect()
}

/// Asserts that a row begins with these cells.
fn assert_has(rows: &[Vec<String>], expected: &[&str]) {
    assert!(
        rows.iter().any(|row| row.iter().zip(expected).filter(|(found, cell)| found == cell).count() == expected.len()),
        "docs/names.md has no row | {} |",
        expected.join(" | ")
    );
}

#[test]
fn every_naming_is_on_the_page() {
    let rows = rows();
    for naming in Naming::presets() {
        let aliases = naming.aliases.join(", ");
        let [front, right, back, left, up, down] = naming.names;
        assert_has(&rows, &[naming.name, &aliases, front, right, back, left, up, down]);
    }
}

#[test]
fn every_order_and_layout_is_on_the_page() {
    let rows = rows();
    for order in FaceOrder::presets() {
        let faces = order.faces.map(|face| face.name()).join(" ");
        assert_has(&rows, &[order.name, &order.aliases.join(", "), &faces, &order.letters()]);
    }
    for kind in LayoutKind::ALL {
        let (columns, lines) = kind.grid();
        assert_has(&rows, &[kind.name(), &format!("{columns} × {lines}")]);
    }
}

#[test]
fn every_name_of_another_program_is_on_the_page() {
    let rows = rows();
    let source = std::fs::read_to_string(crates_folder().join("cosmorama-spec/src/spec/alias.rs")).unwrap();
    let list = source.split("const ALIASES").nth(1).and_then(|rest| rest.split("];").next()).unwrap();
    let mut count = 0;
    for line in list.lines().map(str::trim).filter(|line| line.starts_with("(\"")) {
        let words: Vec<&str> = line.split('"').collect();
        let (alias, meaning) = (words[1], words[3]);
        let is_there = rows
            .iter()
            .any(|row| row[0].split(", ").any(|name| name == alias) && row.get(1).is_some_and(|cell| cell == meaning));
        assert!(is_there, "docs/names.md does not say that {alias} is {meaning}");
        count += 1;
    }
    assert!(count > 20, "the list of aliases is not where it was");
}
