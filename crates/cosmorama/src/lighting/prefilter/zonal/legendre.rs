use std::f64::consts::PI;

use fearless_simd::{Level, dispatch};

use super::grid::GridSize;

/// Real and imaginary parts of red, green, blue and opacity, one after the other.
pub(super) type Parts = [f64; 8];

/// Rings that are worked on together.
const LANES: usize = 4;

/// A number for each ring.
type Lanes = [f64; LANES];

/// Rings of a grid on the half with +Y; the others are their mirror images, in which functions are the same but for the sign.
pub(super) struct Rings {
    blocks: Vec<Block>,
    level: Level,
}

/// Latitudes of rings.
struct Block {
    sine: Lanes,
    cosine: Lanes,
}

/// Legendre's functions of one order on rings: orthonormal over the sphere, without the phase of Condon and Shortley.
struct Function {
    sine: Lanes,
    older: Lanes,
    newer: Lanes,
    /// Sums or values of rings and their mirror images, for functions that are even and odd across the equator.
    parts: [[Lanes; 8]; 2],
}

impl Rings {
    pub(super) fn new(size: GridSize) -> Self {
        let block = |first: usize| {
            let latitudes: [(f64, f64); LANES] = std::array::from_fn(|lane| size.latitude(first + lane));
            Block { sine: latitudes.map(|latitude| latitude.0), cosine: latitudes.map(|latitude| latitude.1) }
        };
        let blocks = (0..size.rows / 2).step_by(LANES).map(block).collect();
        Self { blocks, level: Level::new() }
    }

    /// Sums the waves of order m of all rings, times each function of that order from band m to the highest.
    pub(super) fn sums(&self, m: usize, highest: usize, rings: &[Parts]) -> Vec<Parts> {
        let mut functions = self.functions(m);
        for (k, function) in functions.iter_mut().enumerate() {
            for lane in 0..LANES {
                let ring = k * LANES + lane;
                let (here, there) = (rings[ring], rings[rings.len() - 1 - ring]);
                for part in 0..8 {
                    function.parts[0][part][lane] = here[part] + there[part];
                    function.parts[1][part][lane] = here[part] - there[part];
                }
            }
        }
        let mut sums = Vec::with_capacity(highest + 1 - m);
        for l in m..=highest {
            let step = Step::from(l, m);
            let of_band = dispatch!(self.level, _simd => sum(&mut functions, (l - m) % 2, step));
            sums.push(of_band.map(|lanes| lanes.iter().sum()));
        }
        sums
    }

    /// Returns the wave of order m of each ring, from factors of the functions from band m on.
    pub(super) fn values(&self, m: usize, factors: &[Parts]) -> Vec<Parts> {
        let mut functions = self.functions(m);
        for (l, factors) in (m..).zip(factors) {
            let step = Step::from(l, m);
            dispatch!(self.level, _simd => add(&mut functions, (l - m) % 2, (step, factors)));
        }
        let count = 2 * LANES * functions.len();
        let mut rings = vec![Parts::default(); count];
        for (k, Function { parts: [even, odd], .. }) in functions.iter().enumerate() {
            for lane in 0..LANES {
                let ring = k * LANES + lane;
                rings[ring] = std::array::from_fn(|part| even[part][lane] + odd[part][lane]);
                rings[count - 1 - ring] = std::array::from_fn(|part| even[part][lane] - odd[part][lane]);
            }
        }
        rings
    }

    /// Returns the first functions of an order: √((2m+1)!!/(2m)!!/4π) cosᵐ of the latitude.
    fn functions(&self, m: usize) -> Vec<Function> {
        let square: f64 = (1..=m).map(|k| (2 * k + 1) as f64 / (2 * k) as f64).product();
        let scale = (square / (4.0 * PI)).sqrt();
        let function = |Block { sine, cosine }: &Block| Function {
            sine: *sine,
            older: [0.0; LANES],
            newer: cosine.map(|cosine| scale * cosine.powi(m as i32)),
            parts: [[[0.0; LANES]; 8]; 2],
        };
        self.blocks.iter().map(function).collect()
    }
}

/// Step from a band to the next: P(l+1) = rise · (sin φ · P(l) − fall · P(l−1)).
#[derive(Clone, Copy)]
struct Step {
    rise: f64,
    fall: f64,
}

impl Step {
    fn from(l: usize, m: usize) -> Self {
        let (square, order) = ((l * l) as f64, (m * m) as f64);
        let next = ((l + 1) * (l + 1)) as f64;
        Self {
            rise: ((4.0 * next - 1.0) / (next - order)).sqrt(),
            fall: ((square - order) / (4.0 * square - 1.0).max(1.0)).sqrt(),
        }
    }
}

impl Function {
    #[inline(always)]
    fn step(&mut self, Step { rise, fall }: Step) {
        for lane in 0..LANES {
            let next = rise * (self.sine[lane] * self.newer[lane] - fall * self.older[lane]);
            self.older[lane] = self.newer[lane];
            self.newer[lane] = next;
        }
    }
}

#[inline(always)]
fn sum(functions: &mut [Function], parity: usize, step: Step) -> [Lanes; 8] {
    let mut sums = [[0.0; LANES]; 8];
    for function in functions {
        for (sums, parts) in sums.iter_mut().zip(&function.parts[parity]) {
            for lane in 0..LANES {
                sums[lane] += function.newer[lane] * parts[lane];
            }
        }
        function.step(step);
    }
    sums
}

#[inline(always)]
fn add(functions: &mut [Function], parity: usize, (step, factors): (Step, &Parts)) {
    for function in functions {
        for (parts, factor) in function.parts[parity].iter_mut().zip(factors) {
            for (part, newer) in parts.iter_mut().zip(function.newer) {
                *part += newer * factor;
            }
        }
        function.step(step);
    }
}
