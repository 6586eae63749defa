#!/usr/bin/env python3
"""A map of diffuse light by Mitsuba's sampling of a panorama: CPU-seconds and noise, beside a map without noise.

    python benches/light_mitsuba.py SKY.hdr TRUTH.exr SAMPLES     prints JSON: {"seconds": CPU-s, "rms": error in parts of the map}

The truth is radiance-normalised, of a panorama, as `light diffuse --exact` writes it. Seconds are those of the process without its start and
without reading files; compiling the loop and the sampling table are counted. PyPI's mitsuba, with an LLVM that it likes: Debian's libllvm19.
"""
import json
import math
import sys
import time

import mitsuba

mitsuba.set_variant("llvm_ad_rgb")
import drjit  # noqa: E402
from mitsuba import Bitmap, Float, UInt32, Vector3f  # noqa: E402


def main() -> None:
    sky, truth, samples = Bitmap(sys.argv[1]), Bitmap(sys.argv[2]), int(sys.argv[3])
    truth = mitsuba.TensorXf(truth.convert(Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False))
    height, width = truth.shape[:2]
    begun = time.process_time()
    emitter = mitsuba.load_dict({"type": "scene", "sky": {"type": "envmap", "bitmap": sky}}).emitters()[0]
    pixel = drjit.arange(UInt32, height * width)
    # As the emitter maps directions: columns go round the y-axis.
    across, down = 2 * math.pi * (Float(pixel % width) + 0.5) / width, math.pi * (Float(pixel // width) + 0.5) / height
    up = Vector3f(drjit.sin(across) * drjit.sin(down), drjit.cos(down), -drjit.cos(across) * drjit.sin(down))
    up = drjit.repeat(up, samples)
    place = drjit.zeros(mitsuba.SurfaceInteraction3f, height * width * samples)
    place.n = up
    sampler = mitsuba.load_dict({"type": "independent"})
    sampler.seed(1, height * width * samples)
    towards, light = emitter.sample_direction(place, sampler.next_2d())
    light = light * drjit.maximum(0, drjit.dot(towards.d, up)) / math.pi
    made = [drjit.block_sum(channel, samples) / samples for channel in light]
    drjit.eval(made)
    drjit.sync_thread()
    seconds = time.process_time() - begun
    errors = [made[k] - drjit.gather(Float, truth.array, 3 * pixel + k) for k in range(3)]
    rms = math.sqrt(sum(float(drjit.mean(error * error)[0]) for error in errors) / 3)
    rms /= math.sqrt(float(drjit.mean(truth.array * truth.array)[0]))
    print(json.dumps({"seconds": seconds, "rms": rms}))


if __name__ == "__main__":
    main()
