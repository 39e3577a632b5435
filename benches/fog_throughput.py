#!/usr/bin/env python3
"""CPU time of `airlight fog` over many pictures, beside a NumPy and OpenCV program that does the same.

Both programs decode pictures and depth maps, decode sRGB, apply uniform fog of one visibility and one ambient colour, encode
sRGB and write the pictures, in turn, several times. Printed are CPU seconds (user and system) for each megapixel, the sizes of
the files and the largest difference of the results. Start-up and imports of Python are not counted; those of `airlight` are.
See README.md beside this file.
"""

import argparse
import json
import os
import resource
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import cv2
import numpy as np

VISIBILITY_M = 60.0
# Contrast 5 %, as `airlight` uses by default.
EXTINCTION_PER_M = -np.log(0.05) / VISIBILITY_M
AMBIENT_RGB = (0.62, 0.66, 0.71)
FOV_DEG = 60.0
# As `airlight` writes JPEG by default: full colour resolution.
JPEG_QUALITY = 92
SKY = 65535
WIDTH, HEIGHT = 1250, 800


def leaves(rng):
    """A scene of overlapping discs with a power law of sizes, whose statistics are near those of photographs, and its depth.

    Returns 8-bit BGR and depth in millimetres; the uncovered part near the top is sky.
    """
    height, width = HEIGHT, WIDTH
    rows = np.linspace(0.0, 1.0, height, dtype=np.float32)[:, None, None]
    colour = np.broadcast_to((1.0 - 0.25 * rows) * np.float32([0.95, 0.85, 0.75]), (height, width, 3)).copy()
    depth = np.full((height, width), SKY, np.uint16)
    horizon = int(height * rng.uniform(0.25, 0.4))
    ground = np.arange(height - horizon, dtype=np.float32)
    depth[horizon:] = np.clip(1.6 * 720_000.0 / (ground + 30.0), 1500, 60_000).astype(np.uint16)[:, None]
    colour[horizon:] = np.float32([0.28, 0.33, 0.36])
    count = 2500
    radii = np.clip(4.0 / rng.random(count) ** 0.55, 4.0, 220.0)
    # Far ones first.
    depths = np.sort(rng.uniform(2500, 55_000, count))[::-1]
    for radius, z in zip(radii, depths):
        size = max(2, int(radius * 9000.0 / z ** 0.9))
        x = int(rng.integers(-size, width + size))
        y = int(horizon + 1.6 * 720_000.0 / z - 30 + rng.normal(0.0, 60.0))
        shade = rng.beta(1.4, 2.2) * (1.0 + 0.25 * rng.standard_normal(3))
        cv2.circle(colour, (x, y), size, tuple(float(v) for v in np.clip(shade, 0.02, 1.0)), -1, cv2.LINE_AA)
        cv2.circle(depth, (x, y), size, int(z), -1)
    # Texture with a falling spectrum on everything but the sky, blur of a lens, noise of a sensor.
    texture = np.zeros((height, width), np.float32)
    for octave in range(1, 8):
        shape = (max(2, height >> octave), max(2, width >> octave))
        noise = rng.standard_normal(shape).astype(np.float32)
        texture += 0.012 * octave * cv2.resize(noise, (width, height), interpolation=cv2.INTER_CUBIC)
    colour *= 1.0 + np.where(depth == SKY, 0.05, 1.0)[:, :, None].astype(np.float32) * texture[:, :, None]
    colour = cv2.GaussianBlur(colour, (0, 0), 0.8)
    colour += (0.006 * rng.standard_normal(colour.shape)).astype(np.float32)
    return (np.clip(colour, 0.0, 1.0) * 255.0 + 0.5).astype(np.uint8), depth


def photograph(path, depth_path, number):
    """The photograph, cut to a megapixel or enlarged to it, moved by `number` pixels; a strip at its top is sky."""
    picture = cv2.imread(str(path), cv2.IMREAD_COLOR)
    depth = cv2.imread(str(depth_path), cv2.IMREAD_UNCHANGED)
    scale = max(1.0, (WIDTH + 40) / picture.shape[1], (HEIGHT + 40) / picture.shape[0])
    size = (int(np.ceil(picture.shape[1] * scale)), int(np.ceil(picture.shape[0] * scale)))
    if scale > 1.0:
        picture = cv2.resize(picture, size, interpolation=cv2.INTER_CUBIC)
        depth = cv2.resize(depth, size, interpolation=cv2.INTER_NEAREST)
    at = number % 40
    picture, depth = (a[at:at + HEIGHT, at:at + WIDTH].copy() for a in (picture, depth))
    # Ten times as far away, and without holes: the NumPy program does not fill them.
    depth = np.minimum(np.maximum(depth, 500).astype(np.uint32) * 10, SKY - 1).astype(np.uint16)
    depth[: HEIGHT // 5] = SKY
    return picture, depth


def make_inputs(folder, count, photo):
    for name in ("png", "jpg", "depth"):
        (folder / name).mkdir(parents=True)
    for number in range(count):
        if photo:
            picture, depth = photograph(*photo, number)
        else:
            picture, depth = leaves(np.random.default_rng(number + 1))
        name = f"{number:04}"
        cv2.imwrite(str(folder / "png" / f"{name}.png"), picture)
        full = [cv2.IMWRITE_JPEG_QUALITY, 95]
        cv2.imwrite(str(folder / "jpg" / f"{name}.jpg"), picture, full)
        cv2.imwrite(str(folder / "depth" / f"{name}.png"), depth)


def with_numpy(folder, ending, out):
    """The program to compare with: tables for sRGB, single precision, one pass over the picture for each operation."""
    cv2.setNumThreads(1)
    begun = time.process_time()
    signal = np.arange(256) / 255.0
    decode = np.where(signal <= 0.04045, signal / 12.92, ((signal + 0.055) / 1.055) ** 2.4).astype(np.float32)
    light = np.arange(65536) / 65535.0
    encode = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    encode = (255.0 * encode + 0.5).astype(np.uint8)
    focal = WIDTH / 2 / np.tan(np.radians(FOV_DEG) / 2)
    x = (np.arange(WIDTH, dtype=np.float32) + 0.5 - WIDTH / 2) / focal
    y = (np.arange(HEIGHT, dtype=np.float32) + 0.5 - HEIGHT / 2) / focal
    length = np.sqrt(1.0 + x[None, :] ** 2 + y[:, None] ** 2).astype(np.float32)
    factor = (-EXTINCTION_PER_M * 0.001 * length).astype(np.float32)
    ambient = np.float32(AMBIENT_RGB[::-1])
    options = [cv2.IMWRITE_JPEG_QUALITY, JPEG_QUALITY]
    options += [cv2.IMWRITE_JPEG_SAMPLING_FACTOR, cv2.IMWRITE_JPEG_SAMPLING_FACTOR_444]
    for path in sorted((folder / ending).iterdir()):
        linear = decode[cv2.imread(str(path), cv2.IMREAD_COLOR)]
        depth = cv2.imread(str(folder / "depth" / f"{path.stem}.png"), cv2.IMREAD_UNCHANGED)
        transmittance = np.exp(depth * factor)
        transmittance[depth == SKY] = 0.0
        linear -= ambient
        linear *= transmittance[:, :, None]
        linear += ambient
        linear *= 65535.0
        linear += 0.5
        foggy = encode[linear.astype(np.uint16)]
        cv2.imwrite(str(out / path.name), foggy, options if ending == "jpg" else [])
    print(json.dumps({"cpu_s": time.process_time() - begun}))


def run_numpy(folder, ending, out):
    command = [sys.executable, __file__, "--as-numpy", str(folder), ending, str(out)]
    return json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["cpu_s"]


def run_airlight(program, folder, ending, out, extra):
    command = [program, "fog", str(folder / ending), "--depth", str(folder / "depth"), "--depth-scale", "0.001"]
    command += ["--far-m", "65.5", "--fov", str(FOV_DEG), "--visibility-m", str(VISIBILITY_M), "--quiet", "--overwrite"]
    command += ["--ambient", ",".join(map(str, AMBIENT_RGB)), "-o", str(out) + "/", *extra]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def bytes_in(folder, ending):
    return sum(path.stat().st_size for path in folder.glob(f"*.{ending}"))


def largest_difference(a, b, ending):
    worst, unequal, count = 0, 0, 0
    for path in sorted(a.glob(f"*.{ending}")):
        one, other = (cv2.imread(str(folder / path.name)).astype(np.int16) for folder in (a, b))
        apart = np.abs(one - other)
        worst, unequal, count = max(worst, int(apart.max())), unequal + int((apart > 0).sum()), count + apart.size
    return worst, unequal / max(count, 1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--airlight", default="target/release/airlight", help="the program [%(default)s]")
    parser.add_argument("--count", type=int, default=12, help="number of pictures [%(default)s]")
    parser.add_argument("--pairs", type=int, default=5, help="number of runs of each program [%(default)s]")
    parser.add_argument("--photo", nargs=2, metavar=("COLOUR", "DEPTH"), help="photograph with 16-bit depth [drawn scenes]")
    parser.add_argument("--keep", type=Path, metavar="FOLDER", help="folder for inputs and outputs, which stay [temporary]")
    parser.add_argument("--as-numpy", nargs=3, metavar=("FOLDER", "ENDING", "OUT"), help=argparse.SUPPRESS)
    parser.add_argument("extra", nargs="*", help="further options of airlight fog, after --")
    args = parser.parse_args()
    if args.as_numpy:
        folder, ending, out = args.as_numpy
        return with_numpy(Path(folder), ending, Path(out))
    folder = args.keep or Path(tempfile.mkdtemp())
    inputs = folder / "in"
    if not inputs.exists():
        make_inputs(inputs, args.count, args.photo)
    count = len(list((inputs / "depth").iterdir()))
    megapixels = count * WIDTH * HEIGHT / 1e6
    for ending in ("png", "jpg"):
        outs = {name: folder / f"{name}-{ending}" for name in ("numpy", "airlight")}
        for out in outs.values():
            out.mkdir(exist_ok=True)
        times = {"numpy": [], "airlight": []}
        for _ in range(args.pairs):
            times["numpy"].append(run_numpy(inputs, ending, outs["numpy"]) / megapixels)
            times["airlight"].append(run_airlight(args.airlight, inputs, ending, outs["airlight"], args.extra) / megapixels)
        worst, share = largest_difference(outs["numpy"], outs["airlight"], ending)
        sizes = {name: bytes_in(out, ending) for name, out in outs.items()}
        middle = {name: statistics.median(values) for name, values in times.items()}
        for name, values in times.items():
            print(f"{ending} {name:9} {middle[name]:.4f} CPU s/MP ({min(values):.4f} to {max(values):.4f}), "
                  f"{sizes[name] / megapixels / 1e3:.0f} kB/MP")
        ratio = statistics.median(a / n for a, n in zip(times["airlight"], times["numpy"]))
        print(f"{ending} airlight / numpy: time {ratio:.2f}, size {sizes['airlight'] / sizes['numpy']:.3f}; "
              f"largest difference {worst} of 255, {100 * share:.2f} % of samples differ")
    if not args.keep:
        shutil.rmtree(folder)


if __name__ == "__main__":
    os.environ.setdefault("OMP_NUM_THREADS", "1")
    main()
