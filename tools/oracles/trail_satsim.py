#!/usr/bin/env python3
"""The trail of an object of one magnitude across a frame by package satsim (USSF; gen_line, gen_gaussian and mv_to_pe on pixels of a
fifteenth), for tests/data/detector/trail_satsim.csv. Usage: trail_satsim.py > tests/data/detector/trail_satsim.csv"""
from importlib.metadata import version

import numpy as np
from satsim.geometry.draw import gen_line
from satsim.image.fpa import add_counts, downsample, mv_to_pe
from satsim.image.psf import gen_gaussian
import tensorflow as tf

SIDE, FINE = 48, 15
ZERO_POINT, MAGNITUDE, SECONDS, FWHM = 20.57117, 12.0, 0.8, 3.0
START, SPEED = (0.30, 0.22), (9.0, 31.0)  # share of the frame; pixels a second; row and column


def main():
    pe = float(mv_to_pe(ZERO_POINT, MAGNITUDE))
    side = SIDE * FINE
    rows, columns, counts, _ = gen_line(side, side, list(START), [v * FINE for v in SPEED], pe, 0.0, SECONDS)
    bare = add_counts(tf.zeros([side, side], tf.float64), np.rint(rows), np.rint(columns), counts).numpy()
    image = gen_gaussian(side + 1, side + 1, FWHM * FINE / np.sqrt(8 * np.log(2)), tf.float64).numpy()
    wide = np.fft.irfft2(np.fft.rfft2(bare, (2 * side,) * 2) * np.fft.rfft2(image, (2 * side,) * 2))
    middle = side // 2  # of the odd image
    smeared = wide[middle:middle + side, middle:middle + side]
    frame = downsample(tf.constant(smeared, tf.float32), FINE, "pool").numpy()
    print(f"# satsim {version('satsim')}: {SIDE} x {SIDE} px, zero point {ZERO_POINT}, magnitude {MAGNITUDE:g}, {SECONDS:g} s, "
          f"Gaussian of {FWHM:g} px,")
    print(f"# from ({START[1]:g}, {START[0]:g}) of the frame at ({SPEED[1]:g}, {SPEED[0]:g}) px/s (x, y); electrons of pixels above 1 % of the brightest")
    print("x,y,electrons")
    for y, x in zip(*np.nonzero(frame > .01 * frame.max())):
        print(f"{x},{y},{frame[y, x]:.4f}")


if __name__ == "__main__":
    main()
