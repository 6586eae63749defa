#!/usr/bin/env python3
"""Fits the lobes of microfacets by sums of prefiltered ones, and prints table.rs.

    python crates/cosmorama-scene/src/shade/facets/fit.py > crates/cosmorama-scene/src/shade/facets/table.rs

For each roughness and angle of view: weights, shifts and spreads of three pairs of lobes of GGX, of α, α/2 and α/4, by least squares over the
sphere. What soft spots of light look like counts beside it, since worlds are smoother than lobes are narrow. Needs numpy and scipy; some
minutes.
"""
import sys

import numpy as np
from scipy.optimize import least_squares, nnls

PARTS = (1.0, 0.5, 0.25)
ALPHAS = (1 / 32, 1 / 16, 1 / 8, 1 / 4, 1 / 2, 1.0)
ANGLES = (0.0, 8.0, 16.0, 24.0, 32.0, 40.0, 47.0, 54.0, 60.0, 66.0, 71.0, 76.0, 80.0, 84.0, 90.0)
# The lobe itself has no end at 90 degrees: that of these stands for it; so for the plane of incidence at 0.
LEAST, MOST = 0.2, 87.5
# Rings and directions of the sphere about the mirrored direction; half of it, since lobes are even.
RINGS, AROUND = 60, 24
# Weights of the sum of weights, of what spots look like, and of a step away from a start.
SUM, SEEN, STEP = 1000.0, 7.0, 6e-3
# Spots exp(SHARP (cos - 1)): their angles from the mirrored direction, and directions about it.
SHARP, SPOTS, BESIDE = 40.0, (0.0, 0.12, 0.25, 0.4, 0.6, 0.9, 1.3), 6
# A part with less weight than this is none.
FAINT = 0.006
# Places and weights of the two halves of a part, which lie a spread to both sides of its shift.
HALVES = ((-1, 0.5), (1, 0.5))
# Lobes of this α or more have two parts, which do not lean away from the normal (above it they are drawn out at a slant only); those of half of it
# have two parts up to this angle. Otherwise parts would go aside, and show suns as spots of their own.
WIDE, FLAT = 1 / 2, 28.0
# Shifts and spreads of the first fits, by angle of view: at an α of 1/4, and of wide lobes.
START = ((0, (0, 0, 0.6), (0, 0, 0)), (32, (-0.1, 0.1, 1.9), (0.75, 0.3, 0.4)), (54, (-1.25, 0, 1.3), (0.87, 0.6, 0.35)),
         (71, (-2.9, -1, 0.1), (0.75, 0.36, 0.43)), (90, (-4.6, -2.3, -0.9), (1, 0.17, 0.44)))
START_OF_WIDE = ((0, (0, 0, 0), (0, 0, 0)), (90, (-0.6, -0.3, 0), (0.6, 0.3, 0)))


def ggx(cosine: np.ndarray, alpha: float) -> np.ndarray:
    """The distribution of normals of Trowbridge and Reitz, of the squared cosine."""
    return alpha**2 / (np.pi * (cosine * (alpha**2 - 1) + 1) ** 2)


def smith(cosine: np.ndarray, alpha: float) -> np.ndarray:
    """Smith's Λ (Heitz 2014, equation 72)."""
    slope = (1 - cosine**2) / np.maximum(cosine**2, 1e-12)
    return (np.sqrt(1 + alpha**2 * slope) - 1) / 2


def prefiltered(cosine: np.ndarray, alpha: float) -> np.ndarray:
    """The lobe of a map about a direction; it adds up to one."""
    place = (np.arange(20000) + 0.5) / 20000
    known = 1 - place**4
    whole = 2 * np.pi * np.sum(ggx((1 + known) / 2, alpha) * known * 4 * place**3 / 20000)
    return np.where(cosine > 0, ggx((1 + np.clip(cosine, -1, 1)) / 2, alpha) * cosine, 0) / whole


class Fit:
    """A lobe at an angle of view: the normal is +z, and light is mirrored towards −x."""

    def __init__(self, alpha: float, angle: float) -> None:
        self.alpha, self.angle = alpha, np.radians(np.clip(angle, LEAST, MOST))
        is_plain = alpha >= WIDE or (alpha >= WIDE / 2 and angle < FLAT)
        self.parts = PARTS[:2] if is_plain else PARTS
        edges = (np.arange(RINGS + 1) / RINGS) ** 2.6 * np.pi
        ring, around = np.meshgrid((edges[1:] + edges[:-1]) / 2, (np.arange(AROUND) + 0.5) / AROUND * np.pi, indexing="ij")
        size = np.repeat((np.cos(edges[:-1]) - np.cos(edges[1:]))[:, None] * 2 * np.pi / AROUND, AROUND, 1)
        self.light = self.about(ring, around)
        self.size = size.ravel()
        ring, around = np.meshgrid(SPOTS, (np.arange(BESIDE) + 0.5) / BESIDE * np.pi)
        spot = lambda centres: np.exp(SHARP * (centres @ self.light.T - 1))
        spots = self.about(ring, around)
        # The half of the sphere stands for the other, too.
        self.spots = SEEN * (spot(spots) + spot(spots * [1, -1, 1])) / 2
        lobe = self.lobe()
        lobe /= (lobe * self.size).sum()
        self.scale = np.sqrt((lobe**2 * self.size).sum())
        self.wanted = self.rows(lobe)

    def about(self, ring: np.ndarray, around: np.ndarray) -> np.ndarray:
        """Directions at angles from the mirrored one, and about it from the plane of incidence."""
        along, beside = np.array([-np.cos(self.angle), 0, -np.sin(self.angle)]), np.array([0, 1, 0])
        aside = np.cos(around)[..., None] * along + np.sin(around)[..., None] * beside
        return (np.cos(ring)[..., None] * self.towards(self.angle) + np.sin(ring)[..., None] * aside).reshape(-1, 3)

    @staticmethod
    def towards(angle: float) -> np.ndarray:
        return np.array([-np.sin(angle), 0, np.cos(angle)])

    def lobe(self) -> np.ndarray:
        """What facets reflect towards the eye, times the cosine of light: D·G/(4 n·v)."""
        eye = np.array([np.sin(self.angle), 0, np.cos(self.angle)])
        half = self.light + eye
        half /= np.linalg.norm(half, axis=1, keepdims=True)
        cosine = self.light[:, 2]
        masking = 1 / (1 + smith(eye[2], self.alpha) + smith(np.maximum(cosine, 1e-6), self.alpha))
        return np.where(cosine > 0, ggx(half[:, 2] ** 2, self.alpha) * masking / (4 * eye[2]), 0)

    def rows(self, lobe: np.ndarray) -> np.ndarray:
        return np.concatenate([lobe * np.sqrt(self.size) / self.scale, self.spots @ (lobe * self.size), [SUM * (lobe * self.size).sum()]])

    def part(self, alpha: float, shift: float, spread: float) -> np.ndarray:
        """A map's lobe at a shift, in two halves a spread to both sides, both in units of α."""
        def at(place: float) -> np.ndarray:
            return prefiltered(self.light @ self.towards(self.angle + (shift + place * spread) * self.alpha), alpha)
        drawn = sum(weight * at(place) for place, weight in HALVES) if spread > 1e-3 else at(0)
        return drawn / (drawn * self.size).sum()

    def weights(self, numbers: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """The best weights for shifts and spreads, and what is left."""
        shifts, spreads = numbers[: len(PARTS)], numbers[len(PARTS):]
        columns = [self.rows(self.part(part * self.alpha, *of)) for part, *of in zip(self.parts, shifts, spreads)]
        columns = np.stack(columns, 1)
        found, _ = nnls(columns, self.wanted)
        return np.pad(found, (0, len(PARTS) - len(found))), columns @ found - self.wanted

    def best(self, start: np.ndarray) -> tuple[float, np.ndarray]:
        """Shifts and spreads near others, and the root of what is left."""
        count, slant = len(PARTS), np.sin(self.angle)
        # Nothing is below the horizon, and lobes that are seen straight on are round.
        # A part that leans further shows light of the other side at outlines.
        lean = 6 if self.alpha < WIDE / 2 else 3.4
        low = np.r_[[-lean * slant - 2e-3] * count, [0.0] * count]
        away = 0 if self.alpha >= WIDE else 6 * slant
        drawn = 1.6 * slant ** (3 if self.alpha > WIDE else 1) + 1e-3
        high = np.r_[[min(away + 2e-3, (np.pi / 2 - 0.02 - self.angle) / self.alpha)] * count, [drawn] * count]
        start = np.clip(start, low + 1e-4, high - 1e-4)
        left = lambda numbers: np.r_[self.weights(numbers)[1], STEP * (numbers - start)]
        found = least_squares(left, start, bounds=(low, high), max_nfev=25, diff_step=1e-3).x
        return np.linalg.norm(self.weights(found)[1]), found


def fitted(alpha: float, starts: list) -> list:
    """Shifts and spreads by angle, from those of another roughness, or of a neighbour where that is far better."""
    fits = [Fit(alpha, angle) for angle in ANGLES]
    found = [fit.best(start) for fit, start in zip(fits, starts)]
    last = len(fits) - 1
    for index, other in [(i, i - 1) for i in range(1, last + 1)] + [(i, i + 1) for i in range(last - 1, -1, -1)]:
        again = fits[index].best(found[other][1])
        if again[0] < 0.93 * found[index][0]:
            found[index] = again
    print(f"α {alpha}: " + " ".join(f"{error:.3f}" for error, _ in found), file=sys.stderr)
    return [numbers for _, numbers in found]


def between(known: tuple) -> list:
    """Shifts and spreads at all angles, straight between known ones."""
    places, numbers = [place for place, *_ in known], np.array([np.concatenate(of) for _, *of in known])
    return [np.array([np.interp(angle, places, column) for column in numbers.T]) for angle in ANGLES]


def row(alpha: float, index: int, numbers: np.ndarray) -> str:
    weights = Fit(alpha, ANGLES[index]).weights(numbers)[0]
    weights = np.where(weights < FAINT, 0, weights)
    # Thousandths that add up to one.
    weights = np.round(weights / weights.sum(), 3)
    weights[np.argmax(weights)] += 1 - weights.sum()
    shifts, spreads = (numbers.reshape(2, -1) if index > 0 else np.zeros((2, len(PARTS)))) + 0.0
    return ", ".join("[%.3f, %.3f, %.3f]" % of for of in zip(weights, shifts, spreads)).replace("-0.000", "0.000")


def main() -> None:
    middle = ALPHAS.index(1 / 4)
    found = {middle: fitted(ALPHAS[middle], between(START))}
    for index in range(middle - 1, -1, -1):
        found[index] = fitted(ALPHAS[index], found[index + 1])
    for index in range(middle + 1, len(ALPHAS)):
        found[index] = fitted(ALPHAS[index], between(START_OF_WIDE))
    print("//! Numbers of [`LobePart`](super::LobePart), made by `fit.py` beside this file.\n\nuse super::PARTS;\n")
    print("/// Weight, shift and spread of each part of a lobe.\ntype Lobe = [[f64; 3]; PARTS.len()];\n")
    print("/// The lobe of a prefiltered map.\npub(super) const SIMPLE: Lobe = [[1.0, 0.0, 0.0], [0.0; 3], [0.0; 3]];\n")
    print("/// Angles of view from the normal, in degrees.\n#[rustfmt::skip]")
    print(f"pub(super) const ANGLES: [f64; {len(ANGLES)}] = [{', '.join(map(str, ANGLES))}];\n")
    print("/// Lobes of an α of 1/32, 1/16 and so on to 1, by angle of view.\n#[rustfmt::skip]")
    print('#[expect(clippy::approx_constant, reason = "numbers of fits may come near one")]')
    print(f"pub(super) const LOBES: [[Lobe; ANGLES.len()]; {len(ALPHAS)}] = [")
    for index, alpha in enumerate(ALPHAS):
        lines = [f"        [{row(alpha, i, numbers)}],\n" for i, numbers in enumerate(found[index])]
        print(f"    [\n{''.join(lines)}    ],")
    print("];")


if __name__ == "__main__":
    main()
