use glam::{DMat3, DQuat, DVec3};

use super::{Angle, Direction, DirectionJacobian};

/// Orientation of a view in the world.
///
/// Yaw, then pitch, then roll: yaw > 0 turns right, pitch > 0 looks up, roll > 0 turns the camera
/// clockwise as the photographer sees it (so the picture's content turns counter-clockwise).
///
/// ```
/// use cosmorama::sphere::{Angle, Direction, Orientation};
/// let right = Orientation::from_yaw_pitch_roll(Angle::from_degrees(90.0), Angle::ZERO, Angle::ZERO);
/// assert!(right.to_world(Direction::FRONT).angle_to(Direction::RIGHT).degrees() < 1e-9);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Orientation {
    world_from_view: DMat3,
}

impl Orientation {
    /// Looking to the front, with up at the top.
    pub const IDENTITY: Self = Self { world_from_view: DMat3::IDENTITY };

    /// Returns the orientation of a camera turned by yaw, then pitch, then roll, each about its own axes.
    pub fn from_yaw_pitch_roll(yaw: Angle, pitch: Angle, roll: Angle) -> Self {
        let world_from_view = DMat3::from_rotation_y(-yaw.radians())
            * DMat3::from_rotation_x(pitch.radians())
            * DMat3::from_rotation_z(-roll.radians());
        Self { world_from_view }
    }

    /// Returns yaw, pitch and roll: yaw and roll from −180° to 180°, pitch from −90° to 90°. Straight up and down,
    /// where yaw and roll turn about one axis, roll is zero.
    pub fn yaw_pitch_roll(&self) -> [Angle; 3] {
        let [right, up, back] = [self.world_from_view.x_axis, self.world_from_view.y_axis, self.world_from_view.z_axis];
        let pitch = (-back.y).clamp(-1.0, 1.0).asin();
        let level = right.y.hypot(up.y);
        let (yaw, roll) = if level > 1e-9 {
            ((-back.x).atan2(back.z), (-right.y).atan2(up.y))
        } else {
            (right.z.atan2(right.x), 0.0)
        };
        [yaw, pitch, roll].map(|angle| Angle::from_radians(if angle == 0.0 { 0.0 } else { angle }))
    }

    /// Returns the orientation whose image right, up and forward are these directions (an orthonormal, right-handed
    /// set).
    pub fn from_axes(right: Direction, up: Direction, forward: Direction) -> Self {
        let world_from_view = DMat3::from_cols(right.vector(), up.vector(), -forward.vector());
        debug_assert!((world_from_view.determinant() - 1.0).abs() < 1e-9, "axes are not right-handed");
        Self { world_from_view }
    }

    /// Returns the orientation of a camera that a unit quaternion turns: it takes the view's frame, in which −Z is
    /// forward and +Y up, to the world's.
    pub fn from_rotation(rotation: DQuat) -> Self {
        Self { world_from_view: DMat3::from_quat(rotation.normalize()) }
    }

    /// Returns the orientation of a camera that a unit quaternion turns, given by its numbers w, x, y and z, as
    /// [`Orientation::from_rotation`] has it.
    ///
    /// # Errors
    /// The quaternion's length, if that is not 1 to a thousandth.
    pub fn from_quaternion([w, x, y, z]: [f64; 4]) -> Result<Self, f64> {
        let rotation = DQuat::from_xyzw(x, y, z, w);
        let length = rotation.length();
        if (length - 1.0).abs() < 1e-3 { Ok(Self::from_rotation(rotation)) } else { Err(length) }
    }

    /// Returns the angle of the shortest turn from this orientation to another.
    pub fn angle_to(&self, other: &Self) -> Angle {
        // The angle of a rotation, by its trace and its antisymmetric part: exact for small angles, and near half a turn.
        let turn = self.world_from_view.transpose() * other.world_from_view;
        let axis =
            DVec3::new(turn.y_axis.z - turn.z_axis.y, turn.z_axis.x - turn.x_axis.z, turn.x_axis.y - turn.y_axis.x);
        let trace = turn.x_axis.x + turn.y_axis.y + turn.z_axis.z;
        Angle::from_radians(axis.length().atan2(trace - 1.0))
    }

    /// Returns the unit quaternion that takes the view's frame to the world's.
    pub fn rotation(&self) -> DQuat {
        DQuat::from_mat3(&self.world_from_view)
    }

    /// Returns the orientation that undoes this one.
    #[must_use]
    pub fn inverse(self) -> Self {
        Self { world_from_view: self.world_from_view.transpose() }
    }

    /// Returns this orientation as seen from a frame that is itself turned by `outer`.
    pub fn within(self, outer: Self) -> Self {
        Self { world_from_view: outer.world_from_view * self.world_from_view }
    }

    /// Converts a direction from the view's frame to the world's.
    pub fn to_world(&self, direction: Direction) -> Direction {
        Direction::from_unit(self.world_from_view * direction.vector())
    }

    /// Converts a direction from the world's frame to the view's.
    pub fn to_view(&self, direction: Direction) -> Direction {
        Direction::from_unit(self.vector_to_view(direction.vector()))
    }

    /// Converts a vector from the view's frame to the world's.
    pub(crate) fn vector_to_world(&self, vector: DVec3) -> DVec3 {
        self.world_from_view * vector
    }

    /// Converts a tangent vector from the world's frame to the view's.
    pub fn vector_to_view(&self, vector: DVec3) -> DVec3 {
        self.world_from_view.transpose() * vector
    }

    /// Converts a surface's normal, of any length, from the view's frame to the world's, and gives it length one. `None` for
    /// a vector without direction.
    pub fn normal_to_world(&self, normal: [f32; 3]) -> Option<[f32; 3]> {
        let direction = Direction::new(normal.map(f64::from).into())?;
        Some(self.to_world(direction).vector().as_vec3().to_array())
    }

    /// Converts a surface's normal from the world's frame to the view's, like [`Orientation::normal_to_world`].
    pub fn normal_to_view(&self, normal: [f32; 3]) -> Option<[f32; 3]> {
        let direction = Direction::new(normal.map(f64::from).into())?;
        Some(self.to_view(direction).vector().as_vec3().to_array())
    }

    /// Converts both derivatives from the view's frame to the world's.
    pub fn jacobian_to_world(&self, jacobian: DirectionJacobian) -> DirectionJacobian {
        DirectionJacobian { dx: self.world_from_view * jacobian.dx, dy: self.world_from_view * jacobian.dy }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn yaw_pitch_and_roll_come_back() {
        let same = |a: Orientation, b: Orientation| a.world_from_view.abs_diff_eq(b.world_from_view, 1e-9);
        for yaw in [-180.0, -100.0, 0.0, 37.0, 90.0, 179.0] {
            for pitch in [-90.0, -40.0, 0.0, 22.0, 90.0] {
                for roll in [-170.0, -90.0, 0.0, 5.0, 180.0] {
                    let given = oriented(yaw, pitch, roll);
                    let [y, p, r] = given.yaw_pitch_roll();
                    assert!(same(given, Orientation::from_yaw_pitch_roll(y, p, r)), "{yaw} {pitch} {roll}");
                    if f64::abs(pitch) < 90.0 {
                        let close = |found: Angle, given: f64| {
                            let apart = (found.degrees() - given).rem_euclid(360.0);
                            apart.min(360.0 - apart) < 1e-7
                        };
                        assert!(close(y, yaw) && close(p, pitch) && close(r, roll), "{yaw} {pitch} {roll}");
                    }
                }
            }
        }
    }

    fn oriented(yaw: f64, pitch: f64, roll: f64) -> Orientation {
        Orientation::from_yaw_pitch_roll(
            Angle::from_degrees(yaw),
            Angle::from_degrees(pitch),
            Angle::from_degrees(roll),
        )
    }

    fn assert_close(a: Direction, b: Direction) {
        assert!(a.angle_to(b).degrees() < 1e-9, "{a:?} is not {b:?}");
    }

    #[test]
    fn quaternions_and_angles_between_orientations() {
        let half = 0.5_f64.sqrt();
        let left = Orientation::from_quaternion([half, 0.0, half, 0.0]).expect("a unit quaternion");
        assert_close(left.to_world(Direction::FRONT), Direction::LEFT);
        assert!(Orientation::from_quaternion([1.0, 0.1, 0.0, 0.0]).is_err_and(|length| (length - 1.005).abs() < 1e-3));
        assert!(Orientation::from_quaternion([f64::NAN, 0.0, 0.0, 0.0]).is_err());
        for degrees in [0.0, 1e-5, 30.0, 90.0, 179.99] {
            let (a, b) = (oriented(20.0, 10.0, 5.0), oriented(20.0, 10.0, 5.0 + degrees));
            assert!((a.angle_to(&b).degrees() - degrees).abs() < 1e-9, "{degrees}");
        }
    }

    #[test]
    fn normals_turn_and_get_length_one() {
        let pose = oriented(90.0, 0.0, 0.0);
        let close = |found: Option<[f32; 3]>, expected: [f32; 3]| {
            found.is_some_and(|found| {
                found.iter().zip(expected).all(|(found, expected)| (found - expected).abs() < 1e-6)
            })
        };
        assert!(close(pose.normal_to_world([0.0, 0.0, -7.0]), [1.0, 0.0, 0.0]));
        assert!(close(pose.normal_to_view([0.5, 0.0, 0.0]), [0.0, 0.0, -1.0]));
        assert_eq!(pose.normal_to_view([0.0; 3]), None);
        assert_eq!(pose.normal_to_world([f32::NAN, 0.0, 1.0]), None);
    }

    #[test]
    fn yaw_turns_right() {
        assert_close(oriented(90.0, 0.0, 0.0).to_world(Direction::FRONT), Direction::RIGHT);
    }

    #[test]
    fn pitch_looks_up() {
        assert_close(oriented(0.0, 90.0, 0.0).to_world(Direction::FRONT), Direction::UP);
    }

    #[test]
    fn roll_turns_the_camera_clockwise() {
        // The camera's top leans to its right, as a clock's hand goes from twelve to three.
        assert_close(oriented(0.0, 0.0, 90.0).to_world(Direction::UP), Direction::RIGHT);
    }

    #[test]
    fn pitch_is_about_the_yawed_axis() {
        assert_close(oriented(90.0, 45.0, 0.0).to_world(Direction::RIGHT), Direction::BACK);
    }
}
