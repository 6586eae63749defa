//! Every form of a world to every other at twice the resolution and back: what is lost, printed as matrices.
//!
//! `cargo run --release -p cosmorama --example round_trips [FROM [THROUGH]]`

use cosmorama::resample::Filter;
use rayon::prelude::*;
use testkit::{Form, RoundTrip};

/// Pixels a steradian: a panorama of 194 × 97.
const FROM: f64 = 1500.0;

/// What a matrix shows of each pair.
struct Figure {
    title: &'static str,
    of: fn(&RoundTrip) -> f64,
}

const FIGURES: [Figure; 5] = [
    Figure { title: "mean error, thousandths of the contrast", of: |trip| 1e3 * trip.mean_error },
    Figure { title: "shift, thousandths of a pixel", of: |trip| 1e3 * trip.shift },
    Figure {
        title: "displacement of the pixel that moved most, thousandths of a pixel",
        of: |trip| 1e3 * trip.displacement,
    },
    Figure {
        title: "largest step across a former seam, percent of the largest elsewhere",
        of: |trip| 100.0 * trip.across / trip.elsewhere,
    },
    Figure { title: "compared, percent of the pixels", of: |trip| 100.0 * trip.compared },
];

#[allow(clippy::print_stdout)] // An example may talk; the library may not.
fn main() {
    let asked: Vec<String> = std::env::args().skip(1).collect();
    let wanted = |k: usize, forms: Vec<Form>| -> Vec<Form> {
        forms.into_iter().filter(|form| asked.get(k).is_none_or(|name| name == form.name)).collect()
    };
    let (from, through) = (wanted(0, Form::all(FROM)), wanted(1, Form::all(4.0 * FROM)));
    let row = |a: &Form| through.iter().map(|b| RoundTrip::measure(a, b, Filter::DEFAULT)).collect();
    let trips: Vec<Vec<Option<RoundTrip>>> = from.par_iter().map(row).collect();
    for Figure { title, of } in FIGURES {
        println!("\n{title}; a line for each form, a column for each that it went through");
        let names = through.iter().map(|form| format!("{:>6.5}", form.name));
        println!("{:14}{}", "", names.collect::<String>());
        for (form, trips) in from.iter().zip(&trips) {
            let cell = |trip: &Option<RoundTrip>| {
                trip.as_ref().map_or(format!("{:>6}", "·"), |trip| format!("{:>6.1}", of(trip)))
            };
            println!("{:14}{}", form.name, trips.iter().map(cell).collect::<String>());
        }
    }
}
