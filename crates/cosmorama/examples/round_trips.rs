//! Every form of a world to every other at twice the resolution and back: what is lost, printed as matrices.
//!
//! `cargo run --release -p cosmorama --example round_trips [FROM [THROUGH]]`

use cosmorama::filter::FilterSettings;
use rayon::prelude::*;
use testkit::{Form, RoundTrip};

/// Pixels a steradian: a panorama of 194 × 97.
const FROM: f64 = 1500.0;

/// What a matrix shows of each pair.
struct Figure {
    title: &'static str,
    decimals: usize,
    of: fn(&RoundTrip) -> f64,
}

const FIGURES: [Figure; 6] = [
    Figure { title: "Mean error, thousandths of the contrast", decimals: 1, of: |trip| 1e3 * trip.mean_error },
    Figure {
        title: "Shift: mean displacement, as a vector, thousandths of a pixel",
        decimals: 2,
        of: |trip| 1e3 * trip.shift,
    },
    Figure {
        title: "Mean length of the displacements, thousandths of a pixel",
        decimals: 2,
        of: |trip| 1e3 * trip.moved,
    },
    Figure {
        title: "Displacement of the pixel that moved most, thousandths of a pixel",
        decimals: 1,
        of: |trip| 1e3 * trip.displacement,
    },
    Figure {
        title: "Largest step across a former seam, percent of the largest elsewhere",
        decimals: 1,
        of: |trip| 100.0 * trip.across / trip.elsewhere,
    },
    Figure { title: "Compared, percent of the pixels", decimals: 1, of: |trip| 100.0 * trip.compared },
];

/// What was measured of one form, through each that it went through.
struct Row {
    from: Form,
    trips: Vec<Option<RoundTrip>>,
}

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn main() {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |k: usize, forms: Vec<Form>| -> Vec<Form> {
        forms.into_iter().filter(|form| asked.get(k).is_none_or(|name| name == form.name)).collect()
    };
    let through = wanted(1, Form::all(4.0 * FROM));
    let measure = |from: Form| {
        let trips = through.iter().map(|through| RoundTrip::measure(&from, through, FilterSettings::DEFAULT)).collect();
        Row { from, trips }
    };
    let rows: Vec<Row> = wanted(0, Form::all(FROM)).into_par_iter().map(measure).collect();
    for figure in &FIGURES {
        println!("{}", matrix(figure, &rows, &through));
    }
}

/// A paragraph and a block of Markdown.
fn matrix(figure: &Figure, rows: &[Row], through: &[Form]) -> String {
    let cell = |trip: &Option<RoundTrip>| {
        trip.as_ref().map_or(format!("{:>6}", "·"), |trip| format!("{:>6.*}", figure.decimals, (figure.of)(trip)))
    };
    let line = |row: &Row| format!("{:14}{}\n", row.from.name, row.trips.iter().map(cell).collect::<String>());
    let names: String = through.iter().map(|form| format!("{:>6}", format!("{:.5}", form.name).trim_end())).collect();
    let lines: String = rows.iter().map(line).collect();
    format!("{}{}:\n\n```text\n{:14}{names}\n{lines}```\n", figure.title, largest(figure, rows, through), "")
}

/// Where the largest one is.
fn largest(figure: &Figure, rows: &[Row], through: &[Form]) -> String {
    let of_row = |row: &Row| {
        let figures = row.trips.iter().zip(through).filter_map(|(trip, through)| Some((trip.as_ref()?, through.name)));
        let from = row.from.name;
        figures.map(|(trip, through)| ((figure.of)(trip), from, through)).collect::<Vec<_>>()
    };
    let found = rows.iter().flat_map(of_row).max_by(|a, b| a.0.total_cmp(&b.0));
    found.map_or(String::new(), |(value, from, through)| {
        format!("; at most {value:.*}, from {from} through {through}", figure.decimals)
    })
}
