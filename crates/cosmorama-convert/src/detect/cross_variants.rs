//! Crosses with their long arm at the other end: mirrored as a whole, their faces lie in other places.

use cosmorama::camera::{Mirror, PixelRect};
use cosmorama::layout::{CubeLayout, LayoutKind};

use crate::detect::Continuity;
use crate::detect::mirrored_faces::flip_key;
use crate::diagnostic::FROM;

/// How a picture of a layout has to be mirrored for its faces to lie in other places, if it can be.
pub(crate) fn axis(kind: LayoutKind) -> Option<Mirror> {
    let places = |mirror: Mirror| -> Vec<PixelRect> {
        CubeLayout::new(kind).mirrored(mirror).faces(2).iter().map(|placed| placed.rect).collect()
    };
    let own = places(Mirror::default());
    let axes = [Mirror { x: true, y: false }, Mirror { x: false, y: true }];
    axes.into_iter().find(|axis| places(*axis).iter().any(|place| !own.contains(place)))
}

/// The SPECs under which faces are in the places of a picture that is mirrored so. Borders do not tell one from the other.
pub(crate) struct Readings {
    /// As mirrored.
    pub(crate) mirrored: String,
    /// As a cross whose arm is at its other end: turned upside down, which puts faces into the same places, with the world
    /// turned back.
    pub(crate) upright: String,
    /// As a cross that was itself turned upside down.
    pub(crate) on_its_head: String,
}

impl Readings {
    pub(crate) fn new(kind: LayoutKind, mirror: Mirror) -> Self {
        let on_its_head = format!("cube:layout={kind}{}", flip_key(mirror.and(along(kind))));
        Self {
            mirrored: format!("cube:layout={kind}{}", flip_key(mirror)),
            upright: format!("{on_its_head},roll=180"),
            on_its_head,
        }
    }
}

/// The other axis, which leaves every place one.
fn along(kind: LayoutKind) -> Mirror {
    let both = Mirror { x: true, y: true };
    axis(kind).map_or(both, |axis| both.and(axis))
}

/// What is told of faces that were looked for in the places of a picture that is mirrored so.
pub(crate) fn told_elsewhere(kind: LayoutKind, mirror: Mirror, found: Continuity) -> Continuity {
    let what = if mirror == Mirror::default() {
        "the picture is not mirrored".to_owned()
    } else {
        format!("the whole picture is mirrored {}", way(mirror))
    };
    let Readings { mirrored: spec, upright, on_its_head } = Readings::new(kind, mirror);
    let other = if mirror.is_backwards() { "does not read backwards" } else { "reads backwards" };
    let turned = format!(
        "if writing in it {other}, give {FROM} {upright}, or, if it stands on its head, {FROM} {on_its_head}: borders do not \
         tell a cube from its mirror image"
    );
    if found.fits != Some(true) {
        let told = format!("{what}; then {}", found.told.marked());
        return Continuity { told: told.into(), changes: [vec![what], found.changes].concat(), ..found };
    }
    let told = format!("{what}: read so, {FROM} {spec}, {}; {turned}", found.told.marked());
    Continuity { told: told.into(), fits: Some(false), changes: vec![what], spec: Some(spec), ..found }
}

/// What is told beside this of faces that meet as they lie, where those of the mirror image would, too.
pub(crate) fn mirror_image(kind: LayoutKind, mirror: Mirror) -> String {
    let spec = format!("cube:layout={kind}{}", flip_key(mirror.and(along(kind))));
    let backwards = if mirror.is_backwards() { "does not read backwards" } else { "reads backwards" };
    format!("; so do those of the mirror image: if writing in it {backwards}, give {FROM} {spec}")
}

fn way(mirror: Mirror) -> &'static str {
    match (mirror.x, mirror.y) {
        (true, true) => "both ways",
        (false, true) => "top to bottom",
        _ => "left to right",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_crosses_have_ends() {
        let ends: Vec<_> = LayoutKind::ALL.into_iter().filter_map(|kind| Some((kind, axis(kind)?))).collect();
        let (across, down) = (Mirror { x: true, y: false }, Mirror { x: false, y: true });
        assert_eq!(ends, [(LayoutKind::CrossH, across), (LayoutKind::CrossV, down)]);
    }

    #[test]
    fn the_same_picture_is_read_in_three_ways() {
        let across = Mirror { x: true, y: false };
        let specs = |mirror| {
            let Readings { mirrored, upright, on_its_head } = Readings::new(LayoutKind::CrossH, mirror);
            [mirrored, upright, on_its_head].map(|spec| spec.replace("cube:layout=cross-h", ""))
        };
        assert_eq!(specs(across), [",flip=x", ",flip=xy,roll=180", ",flip=xy"]);
        assert_eq!(specs(Mirror::default()), ["", ",flip=y,roll=180", ",flip=y"]);
    }
}
