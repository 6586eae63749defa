use std::path::Path;

use csv::{ReaderBuilder, StringRecord, Trim};

use super::CameraPathError;
use super::error::wrong;
use super::table::{Row, Table};

/// Columns of a table without names.
const USUAL: [&str; 5] = ["frame", "yaw", "pitch", "roll", "fov"];

/// Reads a table whose first line names the columns, or has numbers in the usual order. Lines that begin with # are remarks.
pub(super) fn table<'a>(text: &str, name: &'a Path) -> Result<Table<'a>, CameraPathError> {
    let mut reader = ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(Trim::All)
        .comment(Some(b'#'))
        .delimiter(separator(text))
        .from_reader(text.as_bytes());
    let mut table = Table { name, unit: "line", names: Vec::new(), header: 1, rows: Vec::new() };
    for record in reader.records() {
        let record = record.map_err(|error| wrong(name, format!("no valid table ({error}); expected CSV or JSON")))?;
        let line = record.position().map_or(0, |position| position.line());
        if table.names.is_empty() {
            table.header = line;
            if record.get(0).is_some_and(|first| first.parse::<f64>().is_err()) {
                table.names = record.iter().map(str::to_lowercase).collect();
                table.check_names()?;
                continue;
            }
            table.names = USUAL.iter().take(record.len().clamp(4, 5)).map(|&name| name.to_owned()).collect();
        }
        table.rows.push(row(&record, line));
        table.check_length()?;
    }
    Ok(table)
}

/// Returns the mark between values: the comma, unless the first line has another.
fn separator(text: &str) -> u8 {
    let first = text.lines().find(|line| !line.starts_with('#') && !line.trim().is_empty()).unwrap_or_default();
    [b',', b';', b'\t'].into_iter().find(|mark| first.as_bytes().contains(mark)).unwrap_or(b',')
}

fn row(record: &StringRecord, line: u64) -> Row {
    Row { place: line, values: record.iter().map(|value| Some(value.to_owned())).collect() }
}
