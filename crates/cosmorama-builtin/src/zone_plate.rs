use cosmorama::camera::Footprint;
use cosmorama::sphere::Direction;
use glam::DVec3;

use crate::pixel_window::pitch;
use crate::{Average, Radiance};

/// Rings around each of the six axes, ever finer outwards: from none at the axis to eight cycles per degree at 45°,
/// where the faces of a cube meet. Rings that pixels cannot show become grey, so false rings in a conversion come from
/// the conversion.
#[derive(Clone, Copy, Debug, Default)]
pub struct ZonePlate;

/// Growth of the rings' frequency, in cycles per radian for each radian from the axis.
const CHIRP: f64 = 8.0 / 45.0 * (180.0 / std::f64::consts::PI) * (180.0 / std::f64::consts::PI);

/// Cycles per pixel up to which rings are fully visible, and beyond which they are grey. Pixels can show half a cycle
/// per pixel at most, and near that limit rings beat.
const WHOLE: f64 = 0.25;
const GREY: f64 = 0.5;

impl Radiance for ZonePlate {
    fn radiance(&self, direction: Direction) -> [f32; 3] {
        [rings(angle_from_axis(direction.vector()).0, 1.0); 3]
    }

    fn average(&self, pixel: &Footprint) -> Average {
        let (angle, outwards) = angle_from_axis(pixel.direction.vector());
        let step = pixel.jacobian.dx.length().max(pixel.jacobian.dy.length());
        // The highest frequency in the pixel: half a pixel further out.
        let frequency = CHIRP * (angle * pitch(pixel, outwards) + step * step / 2.0);
        Average::Known([rings(angle, shown(frequency)); 3])
    }
}

/// Returns the angle from the nearest axis, and the unit tangent that points away from it.
fn angle_from_axis(direction: DVec3) -> (f64, DVec3) {
    let size = direction.abs();
    let axis = if size.x >= size.y && size.x >= size.z {
        DVec3::X * direction.x.signum()
    } else if size.y >= size.z {
        DVec3::Y * direction.y.signum()
    } else {
        DVec3::Z * direction.z.signum()
    };
    let aside = direction - axis * direction.dot(axis);
    let sine = aside.length();
    let outwards = (direction * direction.dot(axis) - axis).normalize_or_zero();
    (sine.atan2(direction.dot(axis)), outwards)
}

fn rings(angle: f64, contrast: f64) -> f32 {
    (0.5 + 0.5 * contrast * (std::f64::consts::PI * CHIRP * angle * angle).cos()) as f32
}

/// Returns the contrast that pixels show at a number of cycles per pixel.
fn shown(cycles: f64) -> f64 {
    let beyond = ((cycles - WHOLE) / (GREY - WHOLE)).clamp(0.0, 1.0);
    0.5 + 0.5 * (std::f64::consts::PI * beyond).cos()
}
