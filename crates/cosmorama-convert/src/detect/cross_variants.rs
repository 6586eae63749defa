//! Crosses with their long arm at the other end. They are mirrored as a whole, so their faces lie in other places.

use cosmorama::camera::{Mirror, PixelRect};
use cosmorama::layout::{CubeLayout, LayoutKind};
use cosmorama::sphere::{Angle, Orientation};
use cosmorama_spec::{Cube, Spec};

use crate::detect::Continuity;
use crate::diagnostic::FROM;

/// Returns the mirroring that moves a layout's faces to other places, if there is one.
pub(crate) fn axis(kind: LayoutKind) -> Option<Mirror> {
    let places = |mirror: Mirror| -> Vec<PixelRect> {
        CubeLayout::new(kind).mirrored(mirror).faces(2).iter().map(|placed| placed.rect).collect()
    };
    let own = places(Mirror::default());
    let axes = [Mirror { x: true, y: false }, Mirror { x: false, y: true }];
    axes.into_iter().find(|axis| places(*axis).iter().any(|place| !own.contains(place)))
}

/// SPECs that put faces into the places of a mirrored picture. Borders cannot tell them apart.
pub(crate) struct Readings {
    /// The mirrored reading.
    pub(crate) mirrored: Spec,
    /// A cross with its arm at the other end: turned upside down, which moves faces to the same places, with the world
    /// turned back.
    pub(crate) upright: Spec,
    /// A cross that was itself turned upside down.
    pub(crate) on_its_head: Spec,
}

impl Readings {
    pub(crate) fn new(kind: LayoutKind, mirror: Mirror) -> Self {
        let mirrored = |mirror: Mirror| Cube { mirror, ..kind.into() };
        let on_its_head = mirrored(mirror.and(along(kind)));
        let orientation = Orientation::from_yaw_pitch_roll(Angle::ZERO, Angle::ZERO, Angle::HALF_TURN);
        let upright = Cube { orientation, ..on_its_head.clone() };
        Self { mirrored: mirrored(mirror).into(), upright: upright.into(), on_its_head: on_its_head.into() }
    }
}

/// Returns the mirroring along the other axis, which keeps every place.
fn along(kind: LayoutKind) -> Mirror {
    let both = Mirror { x: true, y: true };
    axis(kind).map_or(both, |axis| both.and(axis))
}

/// Returns the message about faces that were found in the places of a mirrored picture.
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

/// Returns the addition to the message for faces that would also meet in the mirror image.
pub(crate) fn mirror_image(kind: LayoutKind, mirror: Mirror) -> String {
    let spec = Spec::from(Cube { mirror: mirror.and(along(kind)), ..kind.into() });
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
            [mirrored, upright, on_its_head].map(|spec| spec.to_string().replace("cube:layout=cross-h", ""))
        };
        assert_eq!(specs(across), [",flip=x", ",flip=xy,roll=180", ",flip=xy"]);
        assert_eq!(specs(Mirror::default()), ["", ",flip=y,roll=180", ",flip=y"]);
    }
}
