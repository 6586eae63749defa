"""The conversions that are judged against direct renders: what goes in, what comes out, how good it must be.

The renders lie beside the checkout, in ../shared/oracles/povray: one scene, six faces of 1024², four of 1024×960, and
the same scene rendered directly in each projection. All are 16-bit PNG in linear light.
"""
import subprocess
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
RENDERS = REPOSITORY.parent / "shared" / "oracles" / "povray"
PROGRAM = REPOSITORY / "target" / "release" / "cosmorama"

# The filter that the direct renders were made with: it proves the geometry.
BOX_REFERENCE = ["--filter", "reference", "--kernel", "box"]


@dataclass(frozen=True)
class Oracle:
    name: str
    render: str
    faces: str
    options: str
    region: str
    # The judge's own formula of the same picture: a function of ../shared/oracles/reference.py and its arguments.
    formula: tuple
    # PSNR in dB: of the box reference, of the default in linear light, of the default sRGB-encoded.
    floors: tuple[float, float, float]

    @property
    def direct_render(self) -> Path:
        return RENDERS / f"{self.render}.png"


ORACLES = [
    Oracle("omnimax6", "omnimax_1966x1436", "face", "--to omnimax --size 1966x1436", "omnimax",
           ("omnimax_pov", 1966 / 1436), (32.9, 35.9, 36.1)),
    Oracle("omnimax4", "omnimax_1966x1436", "face4", "--to omnimax --size 1966x1436", "omnimax",
           ("omnimax_pov", 1966 / 1436), (32.5, 35.2, 35.5)),
    Oracle("omnimax_tight", "omnimax_tight_1024x798", "face", "--to omnimax:aspect=1.000193 --size 1024x798", "omnimax",
           ("omnimax_pov",), (36.1, 39.5, 39.5)),
    Oracle("fisheye180", "fisheye180", "face", "--to fisheye:fov=180 --size 1024", "disc", ("fisheye", 180),
           (38.1, 41.8, 41.5)),
    Oracle("fisheye220", "fisheye220", "face", "--to fisheye:fov=220 --size 1024", "disc", ("fisheye", 220),
           (39.4, 42.4, 42.2)),
    Oracle("spherical", "spherical", "face", "--to equirect --size 2048x1024", "all", ("equirect",), (37.9, 40.3, 39.8)),
    # The renderer counts roll the other way round.
    Oracle("perspective", "perspective", "face",
           "--to perspective:fov=45 --size 640x480 --yaw -37 --pitch 12 --roll -9", "all",
           ("perspective", 45, None, -37, 12, 9), (29.0, 33.2, 32.2)),
    Oracle("cylinder1", "cylinder1", "face", "--to cylinder --size 1024x512", "all", ("cylinder",),
           (42.4, 41.7, 41.7)),
    Oracle("mercator", "mercator", "face", "--to mercator --size 768x576", "all", ("mercator",), (40.1, 40.3, 40.2)),
    Oracle("chromeball_ortho", "chromeball_ortho", "face", "--to mirror-ball --size 768", "disc", ("chrome_ball",),
           (34.9, 35.1, 36.4)),
    Oracle("chromeball_far", "chromeball_far", "face", "--to mirror-ball:distance=100 --size 768", "disc",
           ("chrome_ball_persp", 100), (34.9, 35.1, 36.4)),
    Oracle("motion_mid", "motion_mid", "face", "--to perspective:fov=60 --size 640x480 --yaw 20 --pitch -4", "all",
           ("perspective", 60, None, 20, -4, 0), (30.3, 33.5, 34.6)),
]


def convert(oracle: Oracle, options: list[str], output: Path, program: Path = PROGRAM) -> None:
    """Makes the oracle's picture from its faces by our program."""
    faces = str(RENDERS / f"{oracle.faces}_{{face}}.png")
    command = [str(program), "convert", faces, str(output), *oracle.options.split(), "--transfer", "linear"]
    run = subprocess.run([*command, "--overwrite", *options], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit(f"{' '.join([*command, *options])}\n{run.stderr}")
