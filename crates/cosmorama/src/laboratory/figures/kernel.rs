use super::plot::Plot;
use crate::filter::CrossSection;

/// Points of the curve on each side of the middle.
const POINTS: i32 = 200;

/// Draws figure 9 of Greene & Heckbert 1986: the cross-section of a kernel.
pub fn kernel(section: CrossSection, name: &str) -> String {
    let radius = section.radius();
    let at = |k: i32| f64::from(k) / f64::from(POINTS) * 1.25 * radius;
    let points: Vec<_> = (-POINTS..=POINTS).map(|k| (at(k), section.weight(at(k).abs()))).collect();
    let subtitle = format!("{name}, and nothing from the radius {radius} on.");
    Plot { title: "A kernel", subtitle: &subtitle, axes: ["r, in pixels", "weight"], points: &points }.svg()
}
