//! A world in another form and back: nothing moves, and no seam of the other form is left.

use cosmorama::filter::FilterSettings;
use testkit::{Form, RoundTrip};

/// What is promised, in pixels.
const SHIFT: f64 = 0.005;

/// One pixel may be further off: where texels are long, at the poles of maps and the rims of lenses, the tops of colours are cut
/// off between them.
const DISPLACEMENT: f64 = 0.05;

fn returns(from: &Form, through: &Form, error: f64) {
    let trip = RoundTrip::measure(from, through, FilterSettings::DEFAULT)
        .unwrap_or_else(|| panic!("{} → {}: too little in common", from.name, through.name));
    let pair = format!("{} → {}: {trip:?}", from.name, through.name);
    assert!(trip.shift <= SHIFT, "{pair}");
    // A wrong scale or a turn, which are no shift, are seen here.
    assert!(trip.moved <= SHIFT, "{pair}");
    assert!(trip.displacement <= DISPLACEMENT, "{pair}");
    assert!(trip.across <= trip.elsewhere, "{pair}");
    assert!(trip.mean_error < error, "{pair}");
}

#[test]
fn worlds_come_back_from_other_forms() {
    let some = ["cube", "equirect", "hammer"];
    let forms = |density| Form::all(density).into_iter().filter(|form| some.contains(&form.name));
    for from in forms(1500.0) {
        for through in forms(6000.0) {
            returns(&from, &through, 0.01);
        }
    }
}

/// Each form through one that shows the whole world, the next of those in the list, and that one through it. The same waves
/// lose more in fewer pixels.
#[test]
fn every_form_is_left_and_gone_through() {
    let (coarse, fine) = (Form::all(700.0), Form::all(2800.0));
    for index in 0..coarse.len() {
        let mut later = (index + 1..coarse.len()).chain(0..index);
        let whole = later.find(|&at| coarse[at].is_whole).expect("a cube");
        returns(&coarse[index], &fine[whole], 0.012);
        returns(&coarse[whole], &fine[index], 0.012);
    }
}
