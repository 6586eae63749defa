use glam::{DMat3, DVec3};

/// Light of a block of texels, as far as a lobe that bends little over the block sees it: to second order.
#[derive(Clone, Copy, Default)]
pub(super) struct Block {
    /// Radiance times solid angle, by colour.
    pub(super) light: [f32; 3],
    /// Moments of each colour about the centre of the light: the sum of light times offset, by axis.
    pub(super) moments: [[f32; 3]; 3],
    /// Place and spread of the light, all colours together.
    pub(super) lit: Cloud,
    /// Opacity times solid angle.
    pub(super) shown: f32,
    /// Place and spread of the opacity.
    pub(super) seen: Cloud,
}

impl Block {
    /// Returns whether anything is there.
    pub(super) fn shows(&self) -> bool {
        self.shown != 0.0 || self.light != [0.0; 3]
    }

    /// Returns the mean radiance, all colours added.
    pub(super) fn brightness(&self) -> f32 {
        let light: f32 = self.light.iter().map(|light| light.max(0.0)).sum();
        if self.shown > 0.0 { light / self.shown } else { 0.0 }
    }

    /// Returns a point among its texels.
    pub(super) fn middle(&self) -> DVec3 {
        to_double(self.seen.centre)
    }
}

/// Place of many points: their mean and covariance, by axis (xx, yy, zz, xy, xz, yz).
#[derive(Clone, Copy, Default)]
pub(super) struct Cloud {
    pub(super) centre: [f32; 3],
    pub(super) spread: [f32; 6],
}

/// Weighted points: sums from which a [`Cloud`] is made, about some reference.
#[derive(Clone, Copy)]
struct Points {
    weight: f64,
    first: DVec3,
    second: DMat3,
}

/// Sums over texels or blocks, about a reference near them.
#[derive(Clone, Copy)]
pub(super) struct Sums {
    reference: DVec3,
    light: DVec3,
    /// Light times offset: a column for each colour.
    moments: DMat3,
    lit: Points,
    seen: Points,
}

impl Sums {
    pub(super) fn about(reference: DVec3) -> Self {
        Self { reference, light: DVec3::ZERO, moments: DMat3::ZERO, lit: Points::NONE, seen: Points::NONE }
    }

    /// Adds a texel: its light and opacity, times its solid angle.
    pub(super) fn add_texel(&mut self, direction: DVec3, [red, green, blue, shown]: [f64; 4]) {
        let offset = direction - self.reference;
        let light = DVec3::new(red, green, blue);
        self.light += light;
        self.moments += outer(offset, light);
        let square = outer(offset, offset);
        let add = |points: &mut Points, weight: f64| {
            points.weight += weight;
            points.first += offset * weight;
            points.second += square * weight;
        };
        add(&mut self.lit, brightness(light));
        add(&mut self.seen, shown);
    }

    /// Adds a block.
    pub(super) fn add_block(&mut self, block: &Block) {
        let light = to_double(block.light);
        let offset = to_double(block.lit.centre) - self.reference;
        self.light += light;
        self.moments +=
            DMat3::from_cols_array_2d(&block.moments.map(|moment| moment.map(f64::from))) + outer(offset, light);
        self.lit.add(&block.lit, brightness(light), self.reference);
        self.seen.add(&block.seen, f64::from(block.shown), self.reference);
    }

    pub(super) fn block(&self) -> Block {
        let seen = self.seen.cloud(self.reference).unwrap_or_default();
        let lit = self.lit.cloud(self.reference).unwrap_or(seen);
        let centre = to_double(lit.centre) - self.reference;
        let moments = self.moments - outer(centre, self.light);
        Block {
            light: to_single(self.light),
            moments: moments.to_cols_array_2d().map(|moment| moment.map(|value| value as f32)),
            lit,
            shown: self.seen.weight as f32,
            seen,
        }
    }
}

impl Points {
    const NONE: Self = Self { weight: 0.0, first: DVec3::ZERO, second: DMat3::ZERO };

    fn add(&mut self, cloud: &Cloud, weight: f64, reference: DVec3) {
        let offset = to_double(cloud.centre) - reference;
        let [xx, yy, zz, xy, xz, yz] = cloud.spread.map(f64::from);
        let spread = DMat3::from_cols_array(&[xx, xy, xz, xy, yy, yz, xz, yz, zz]);
        self.weight += weight;
        self.first += offset * weight;
        self.second += (spread + outer(offset, offset)) * weight;
    }

    fn cloud(&self, reference: DVec3) -> Option<Cloud> {
        if self.weight <= 0.0 {
            return None;
        }
        let mean = self.first / self.weight;
        let spread = self.second * self.weight.recip() - outer(mean, mean);
        let [x, y, z] = [spread.x_axis, spread.y_axis, spread.z_axis];
        let spread = [x.x, y.y, z.z, x.y, x.z, y.z].map(|value| value as f32);
        Some(Cloud { centre: to_single(reference + mean), spread })
    }
}

/// Returns the weight of light in the place of a block. Negative light has none.
fn brightness(light: DVec3) -> f64 {
    light.max(DVec3::ZERO).element_sum()
}

/// Returns the matrix a bᵀ.
fn outer(a: DVec3, b: DVec3) -> DMat3 {
    DMat3::from_cols(a * b.x, a * b.y, a * b.z)
}

fn to_single(vector: DVec3) -> [f32; 3] {
    vector.to_array().map(|value| value as f32)
}

fn to_double(vector: [f32; 3]) -> DVec3 {
    DVec3::from_array(vector.map(f64::from))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sums of blocks are those of their texels, whatever they are taken about.
    #[test]
    fn blocks_of_blocks_are_blocks_of_texels() {
        let texel = |k: usize| {
            let (x, y) = ((k % 8) as f64, (k / 8) as f64);
            let direction = DVec3::new(0.01 * x, 1.0, 0.02 * y).normalize();
            (direction, [x, 2.0 * y, 3.0 + x * y, 1.0])
        };
        let of = |texels: &[usize]| {
            let mut sums = Sums::about(texel(texels[0]).0);
            texels.iter().for_each(|k| sums.add_texel(texel(*k).0, texel(*k).1));
            sums.block()
        };
        let whole = of(&(0..64).collect::<Vec<_>>());
        let mut sums = Sums::about(texel(40).0);
        for half in [0, 1] {
            sums.add_block(&of(&(32 * half..32 * half + 32).collect::<Vec<_>>()));
        }
        let joined = sums.block();
        let near = |a: f32, b: f32, unit: f32| assert!((a - b).abs() < 2e-6 * unit, "{a}, {b}");
        for axis in 0..3 {
            near(joined.light[axis], whole.light[axis], whole.light[axis]);
            near(joined.lit.centre[axis], whole.lit.centre[axis], 0.05);
            for colour in 0..3 {
                near(joined.moments[colour][axis], whole.moments[colour][axis], 0.1 * whole.light[colour]);
            }
        }
        for k in 0..6 {
            near(joined.lit.spread[k], whole.lit.spread[k], 0.01);
            near(joined.seen.spread[k], whole.seen.spread[k], 0.01);
        }
        near(joined.shown, whole.shown, 64.0);
    }
}
