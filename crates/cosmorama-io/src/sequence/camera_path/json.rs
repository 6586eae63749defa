use std::path::Path;

use serde_json::{Map, Value};

use super::CameraPathError;
use super::error::wrong;
use super::table::{Row, Table};

/// Reads a list of poses, or an object with a list of numbers for each name.
pub(super) fn table<'a>(text: &str, name: &'a Path) -> Result<Table<'a>, CameraPathError> {
    let value = serde_json::from_str(text).map_err(|error| wrong(name, format!("no valid JSON ({error})")))?;
    let mut table = Table { name, unit: "pose", names: Vec::new(), header: 0, rows: Vec::new() };
    match &value {
        Value::Array(poses) => of_poses(poses, &mut table)?,
        Value::Object(columns) => of_columns(columns, &mut table)?,
        _ => {}
    }
    Ok(table)
}

fn of_poses(poses: &[Value], table: &mut Table) -> Result<(), CameraPathError> {
    for (place, pose) in (1..).zip(poses) {
        let Value::Object(pose) = pose else {
            let row = Row { place, values: Vec::new() };
            return Err(table.error(&row, "not an object; expected one for each pose, as {\"frame\": 1, \"yaw\": 30}"));
        };
        for name in pose.keys() {
            if !table.names.contains(&name.to_lowercase()) {
                table.names.push(name.to_lowercase());
                table.check_names()?;
            }
        }
        let value = |name: &String| pose.iter().find(|(key, _)| key.to_lowercase() == *name);
        let values = table.names.iter().map(|name| value(name).map(|(_, value)| value.to_string())).collect();
        table.rows.push(Row { place, values });
    }
    Ok(())
}

fn of_columns(columns: &Map<String, Value>, table: &mut Table) -> Result<(), CameraPathError> {
    let mut first: Option<(&str, usize)> = None;
    for (name, column) in columns {
        let Value::Array(column) = column else {
            return Err(wrong(
                table.name,
                format!("{name} is {column}; expected a list of numbers, one for each pose"),
            ));
        };
        let (of, count) = *first.get_or_insert((name, column.len()));
        if count != column.len() {
            let found = format!("{name} has {} numbers, but {of} has {count}; give one for each pose", column.len());
            return Err(wrong(table.name, found));
        }
        let places = 1..=count as u64;
        table.rows.resize_with(count, || Row { place: 0, values: Vec::new() });
        for ((row, value), place) in table.rows.iter_mut().zip(column).zip(places) {
            row.place = place;
            row.values.push(Some(value.to_string()));
        }
        table.names.push(name.to_lowercase());
        table.check_names()?;
    }
    Ok(())
}
