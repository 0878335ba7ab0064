"""Prints the numbers that the tests of src/evaluate/flip.rs hold our FLIP to.

    python -m venv venv && venv/bin/pip install flip-evaluator==1.7 numpy && venv/bin/python scripts/flip_reference.py

Each line is one case: name, width, height, mean of the map, and the map at a few pixels. Images are float32 in [0, 1] and are handed over as
they stand, as sRGB, at 67 pixels per degree. The test makes the same images from the same whole-number arithmetic.
"""

import flip_evaluator
import numpy as np


def grid(width, height):
    y, x, c = np.meshgrid(np.arange(height), np.arange(width), np.arange(3), indexing="ij")
    return x.astype(np.int64), y.astype(np.int64), c.astype(np.int64)


def noise(x, y, c, salt):
    """Whole numbers from 0 to 255 without visible order: a 32-bit multiplicative hash."""
    h = (x * 374761393 + y * 668265263 + c * 2147483647 + salt * 1274126177) & 0xFFFFFFFF
    h = ((h ^ (h >> 13)) * 1103515245) & 0xFFFFFFFF
    return (h ^ (h >> 16)) & 255


def f32(numerator, denominator):
    return numerator.astype(np.float32) / np.float32(denominator)


def cases():
    x, y, c = grid(61, 43)
    gradient = (x * (c + 2) + y * 3) % 256
    yield "noise on a gradient", f32(gradient, 255), f32(np.clip(gradient + noise(x, y, c, 1) // 8 - 16, 0, 255), 255)
    x, y, c = grid(64, 48)
    yield "two noises", f32(noise(x, y, c, 2), 255), f32(noise(x, y, c, 3), 255)
    board = ((x // 6 + y // 6) % 2) * 200 + 20 * c
    shifted = (((x + 1) // 6 + y // 6) % 2) * 200 + 20 * c
    yield "a checkerboard moved by a pixel", f32(board, 255), f32(shifted, 255)
    x, y, c = grid(40, 40)
    disc = np.where((x - 20) ** 2 + (y - 17) ** 2 < 150, 200 - 60 * c, 255)
    fainter = np.where((x - 20) ** 2 + (y - 17) ** 2 < 150, 203 - 60 * c, 255)
    yield "a disc on white, slightly off", f32(disc, 255), f32(fainter, 255)
    x, y, c = grid(32, 24)
    yield "green against blue", f32(255 * (c == 1), 255), f32(255 * (c == 2), 255)
    x, y, c = grid(5, 3)
    yield "smaller than the filters", f32(noise(x, y, c, 4), 255), f32(noise(x, y, c, 5), 255)
    x, y, c = grid(1, 1)
    yield "one pixel", f32(10 + 90 * c, 255), f32(100 - 20 * c, 255)


for name, reference, test in cases():
    map_, mean, _ = flip_evaluator.evaluate(
        np.ascontiguousarray(reference), np.ascontiguousarray(test), "LDR", inputsRGB=True, applyMagma=False, parameters={"ppd": 67.0}
    )
    height, width = map_.shape[:2]
    places = [map_[0, 0, 0], map_[height // 2, width // 3, 0], map_[height - 1, width - 1, 0]]
    print(f'("{name}", {width}, {height}, {map_.mean(dtype=np.float64):.8f}, [{", ".join(f"{v:.7f}" for v in places)}]),')
