//! Mirrored faces: the effect of `flip=x`.

use cosmorama::arrange::Pose;
use cosmorama::camera::Mirror;
use cosmorama::layout::{CubeLayout, FaceOrder, FacePlacement, LayoutKind};

pub(crate) const ACROSS: Mirror = Mirror { x: true, y: false };

/// Returns the placement of a picture that is mirrored before it is turned.
pub(crate) fn of(pose: Pose) -> Pose {
    let lies = pose.placement();
    Pose::new(pose.face, FacePlacement { mirrored: !lies.mirrored, ..lies })
}

/// Returns the placements of pictures in a kind of layout, if the image is the mirror image of one in `layout`: every
/// face mirrored, in the opposite place. `None` if the kind does not have these places.
pub(crate) fn poses(kind: LayoutKind, layout: CubeLayout) -> Option<Vec<Pose>> {
    let across = layout.mirrored(ACROSS).faces(2);
    let places = CubeLayout::new(kind).faces(2);
    let pose =
        |rect| across.iter().find(|placed| placed.rect == rect).map(|placed| of(Pose::new(placed.face, placed.lies)));
    places.iter().map(|place| pose(place.rect)).collect()
}

/// Returns the end of a SPEC that mirrors a picture.
pub(crate) fn flip_key(mirror: Mirror) -> &'static str {
    match (mirror.x, mirror.y) {
        (false, false) => "",
        (true, false) => ",flip=x",
        (false, true) => ",flip=y",
        (true, true) => ",flip=xy",
    }
}

/// Returns the order and the turns for pictures mirrored by `flip=x` that lie as given, in the order of the layout's
/// places.
pub(crate) fn spec(kind: LayoutKind, lie: &[Pose]) -> Option<String> {
    let plain = || CubeLayout::new(kind);
    let places = plain().faces(2);
    // An image that is mirrored has its first face last.
    let seats = plain().mirrored(ACROSS).faces(2);
    let seat = |rect| places.iter().position(|place| place.rect == rect);
    let seats: Vec<usize> = seats.iter().map(|placed| seat(placed.rect)).collect::<Option<_>>()?;
    let letters: String = seats.iter().filter_map(|place| lie.get(*place)?.face.name().chars().next()).collect();
    let order = FaceOrder::parse(&letters)?;
    let ordered = |turns: u8| plain().with_order(&order).with_turns([turns; 6]);
    let turned: Vec<Vec<Pose>> = (0..4).map(|turns| poses(kind, ordered(turns))).collect::<Option<_>>()?;
    let digit = |place: &usize| (0..4_u8).find(|turns| turned[usize::from(*turns)][*place] == lie[*place]);
    let digits: String = seats.iter().map(|place| Some(char::from(b'0' + digit(place)?))).collect::<Option<_>>()?;
    Some(format!("cube:layout={kind},order={letters},rotate={digits}"))
}
