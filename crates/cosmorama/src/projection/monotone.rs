//! Rising functions: the interval on which they rise, and their inverse.

/// Steps in which a function is searched for the place where it stops rising.
const STEPS: usize = 4096;

/// Limit of iterations; Newton's method and bisection converge long before.
const MOST_ITERATIONS: usize = 100;

/// Returns how far from 0 towards `end` a function (value and derivative) rises: its derivative is positive and it
/// stays finite. `None` if it does not rise at 0.
pub(crate) fn rises_until(function: impl Fn(f64) -> (f64, f64), end: f64) -> Option<f64> {
    let rises = |(value, slope): (f64, f64)| slope > 0.0 && slope.is_finite() && value.is_finite();
    let mut last = 0.0;
    let mut value = function(0.0);
    if !rises(value) {
        return None;
    }
    for step in 1..=STEPS {
        let next = end * step as f64 / STEPS as f64;
        let found = function(next);
        // A pole between two steps: the value falls though the derivative is positive.
        if !rises(found) || found.0 <= value.0 {
            return Some(halved(last, next, |middle| {
                let at = function(middle);
                rises(at) && at.0 > value.0
            }));
        }
        (last, value) = (next, found);
    }
    Some(end)
}

/// Bisects for the last place between `holds` and `fails` at which `test` holds.
fn halved(mut holds: f64, mut fails: f64, test: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = f64::midpoint(holds, fails);
        if middle <= holds || middle >= fails {
            return holds;
        }
        if test(middle) {
            holds = middle;
        } else {
            fails = middle;
        }
    }
}

/// Finds the place between `low` and `high` at which a rising function (value and derivative) takes a value. Uses
/// Newton's iteration, and bisection where that would leave the bracket or gain too little.
pub(crate) fn inverse(function: impl Fn(f64) -> (f64, f64), value: f64, mut low: f64, mut high: f64) -> f64 {
    let (_, slope) = function(low);
    let mut at = (low + value / slope).clamp(low, high);
    let mut last_step = high - low;
    for _ in 0..MOST_ITERATIONS {
        let (found, slope) = function(at);
        let error = found - value;
        if error > 0.0 {
            high = at
        } else {
            low = at
        }
        let newton = at - error / slope;
        let gains = (newton - at).abs() < last_step / 2.0;
        // Beside a pole Newton's steps are small and lead nowhere.
        let beside_pole = found > 8.0 * value;
        let next =
            if gains && !beside_pole && newton >= low && newton <= high { newton } else { f64::midpoint(low, high) };
        last_step = (next - at).abs();
        at = next;
        if last_step <= 2.0 * f64::EPSILON * at.abs() {
            break;
        }
    }
    at
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_function_is_followed_to_where_it_turns_back_or_away() {
        let sine = |x: f64| (x.sin(), x.cos());
        let turn = rises_until(sine, 3.0).expect("a sine rises at 0");
        assert!((turn - std::f64::consts::FRAC_PI_2).abs() < 1e-12, "{turn}");
        let tangent = |x: f64| (x.tan(), x.cos().powi(-2));
        let pole = rises_until(tangent, 3.0).expect("a tangent rises at 0");
        assert!((pole - std::f64::consts::FRAC_PI_2).abs() < 1e-12, "{pole}");
        assert_eq!(rises_until(|x| (x, 1.0), 3.0), Some(3.0));
        assert_eq!(rises_until(|x| (-x, -1.0), 3.0), None);
    }

    #[test]
    fn a_pole_at_the_end_is_left_behind() {
        let steep = |x: f64| (x.tan().powi(4) + x, 4.0 * x.tan().powi(3) / x.cos().powi(2) + 1.0);
        for step in 1..150 {
            let angle = f64::from(step) / 100.0;
            let found = inverse(steep, steep(angle).0, 0.0, std::f64::consts::FRAC_PI_2);
            assert!((found - angle).abs() < 1e-12, "{angle}: {found}");
        }
    }

    #[test]
    fn inverses_are_exact_even_beside_a_turn() {
        let sine = |x: f64| (x.sin(), x.cos());
        for step in 0..1000 {
            let angle = std::f64::consts::FRAC_PI_2 * f64::from(step) / 1000.0;
            let found = inverse(sine, angle.sin(), 0.0, std::f64::consts::FRAC_PI_2);
            assert!((found.sin() - angle.sin()).abs() <= 2.0 * f64::EPSILON, "{angle}: {found}");
        }
    }
}
