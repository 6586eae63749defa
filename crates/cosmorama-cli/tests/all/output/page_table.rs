//! Tables of pages that tests write: what becomes of inputs in each output format.

use std::path::Path;

/// Formats of the columns, each with its extension.
pub(super) const FORMATS: [(&str, &str); 8] = [
    ("PNG", "png"),
    ("JPEG", "jpg"),
    ("TIFF", "tif"),
    ("OpenEXR", "exr"),
    ("Radiance HDR", "hdr"),
    ("KTX 2", "ktx2"),
    ("DDS", "dds"),
    ("TGA", "tga"),
];

const END: &str = "<!-- end -->\n";

/// Checks that a page of docs/ has a table with these rows, behind the line that names the test's file. With UPDATE_GOLDENS the
/// table is written instead.
pub(super) fn check(page: &str, test: &str, rows: &[String]) {
    let columns: String = FORMATS.iter().map(|(name, _)| format!(" {name} |")).collect();
    let table = format!("| input |{columns}\n|{}\n{}\n", "---|".repeat(FORMATS.len() + 1), rows.join("\n"));
    let begin = format!("<!-- written by cosmorama-cli/tests/all/output/{test} -->\n");
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs").join(page);
    let text = std::fs::read_to_string(&path).unwrap();
    let (start, rest) = text.split_once(&begin).unwrap();
    let (stored, end) = rest.split_once(END).unwrap();
    if std::env::var_os("UPDATE_GOLDENS").is_some() {
        std::fs::write(path, [start, &begin, &table, END, end].concat()).unwrap();
        return;
    }
    for (stored, found) in stored.lines().zip(table.lines()) {
        assert_eq!(stored, found, "docs/{page}; after a change that is meant: UPDATE_GOLDENS=1");
    }
    assert_eq!(stored, table);
}
