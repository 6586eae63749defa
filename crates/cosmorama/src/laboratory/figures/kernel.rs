use super::plot::{Plot, Series};
use crate::filter::CrossSection;

/// Points of the curve on each side of the middle.
const POINTS: i32 = 200;

/// Draws figure 9 of Greene & Heckbert 1986: the cross-section of a kernel.
pub fn kernel(section: CrossSection, name: &str) -> String {
    let radius = section.radius();
    let at = |k: i32| f64::from(k) / f64::from(POINTS) * 1.25 * radius;
    let points = (-POINTS..=POINTS).map(|k| (at(k), section.weight(at(k).abs()))).collect();
    let plot = Plot {
        title: "A kernel".to_owned(),
        subtitle: format!("{name}, and nothing from the radius {radius} on."),
        axes: ["r, in pixels".to_owned(), "weight".to_owned()],
        series: vec![Series { name: String::new(), points }],
    };
    plot.svg()
}
