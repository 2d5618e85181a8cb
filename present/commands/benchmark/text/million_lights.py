#!/usr/bin/env python3
"""Writes the lights of the scene `million` as CSV: million_lights.py [COUNT] > million_lights.csv

Each light follows from its number and the seed (views.json), by integers of 64 bits and a rounding
to float32: every machine gets the same lights. Without COUNT all of them: about a minute.
"""
import json
import pathlib
import struct
import sys

MASK = 2**64 - 1
STEP = 0x9E3779B97F4A7C15  # 2^64 over the golden ratio
ONE = 1 << 24  # 1 in the fixed point of colours
HUE_STREAM = 6


def mix(x):
    """The finaliser of splitmix64."""
    x = (x ^ x >> 30) * 0xBF58476D1CE4E5B9 & MASK
    x = (x ^ x >> 27) * 0x94D049BB133111EB & MASK
    return x ^ x >> 31


def key_of(seed, light):
    return mix(mix(seed + STEP & MASK) + light * STEP & MASK)


def bits(key, stream):
    return mix(key + (stream + 1) * STEP & MASK)


def float32(x):
    return struct.unpack("f", struct.pack("f", x))[0]


def place(key, low, high):
    """A coordinate [m]: a phase of a to and fro between the ends."""
    out = []
    for axis in range(3):
        turns = bits(key, axis)
        if turns >> 63:
            turns = -turns & MASK
        at = low[axis] + float(turns) * 2.0**-63 * (high[axis] - low[axis])
        out.append(min(max(at, low[axis]), high[axis]))
    return out


def colour(key, intensity):
    """Red, green and blue [cd]: a hue, mixed with a fifth of white or more where it is dark."""
    hue = bits(key, HUE_STREAM) * 6 * ONE >> 64

    def ramp(at, falls):
        distance = abs(hue - at)
        value = max(distance, ONE) - ONE if falls else 2 * ONE - min(distance, 2 * ONE)
        return min(value, ONE)

    rgb = ramp(3 * ONE, True), ramp(2 * ONE, False), ramp(4 * ONE, False)
    luminance = 2126 * rgb[0] + 7152 * rgb[1] + 722 * rgb[2]
    missing = max(4500 * ONE, luminance) - luminance
    white = max(ONE // 5, missing * ONE // (10000 * ONE - luminance))
    scale = float32(intensity)
    return [float32((white + ((ONE - white) * c >> 24)) * 2.0**-24 * scale) for c in rgb]


def main():
    folder = pathlib.Path(__file__).resolve().parent
    views = json.loads((folder / "views.json").read_text())
    lights = next(s for s in views["scenes"] if "generated" in s)["generated"]
    count = int(sys.argv[1]) if len(sys.argv) > 1 else lights["count"]
    low, high = lights["box_m"][:3], lights["box_m"][3:]
    print("type,x_m,y_m,z_m,red_cd,green_cd,blue_cd,range_m")
    for light in range(count):
        key = key_of(lights["seed"], light)
        numbers = [*place(key, low, high), *colour(key, lights["intensity_cd"]), lights["range_m"]]
        print("point," + ",".join(map(repr, numbers)))


if __name__ == "__main__":
    main()
