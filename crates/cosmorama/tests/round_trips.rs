//! A world in another form and back: nothing moves, and no seam of the other form is left.

use testkit::{Form, RoundTrip};

/// What is promised, in pixels.
const SHIFT: f64 = 0.005;

#[test]
fn worlds_come_back_from_other_forms() {
    let some = ["cube", "equirect", "hammer"];
    let forms = |density| Form::all(density).into_iter().filter(|form| some.contains(&form.name));
    for from in forms(1500.0) {
        for through in forms(6000.0) {
            let trip = RoundTrip::measure(&from, &through).expect("enough in common");
            let pair = format!("{} → {}: {trip:?}", from.name, through.name);
            assert!(trip.shift <= SHIFT, "{pair}");
            assert!(trip.across <= trip.elsewhere, "{pair}");
            assert!(trip.mean_error < 0.01, "{pair}");
        }
    }
}
