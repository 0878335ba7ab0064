#!/usr/bin/env python3
"""Writes the deep images of this folder by OpenEXR's own library (PyPI: OpenEXR 3.5, numpy).

Pixel (x, y) of 13 x 9 holds n = (x + 2 y) mod 4 samples; sample k has Z = 1 + k + x/8, A = (k + 1)/4, R = A/2, G = A/4, B = 0.
Tiles are 8 x 4, so that those at the right and the bottom are cut off.
"""

import numpy as np
import OpenEXR

HEIGHT, WIDTH = 9, 13


def channel(value):
    pixels = np.empty((HEIGHT, WIDTH), object)
    for y in range(HEIGHT):
        for x in range(WIDTH):
            pixels[y, x] = np.array([value(x, k) for k in range((x + 2 * y) % 4)], np.float32)
    return pixels


for tiled in (False, True):
    for packing in ("NO", "RLE", "ZIPS"):
        alpha = lambda x, k: (k + 1) / 4
        channels = {
            "Z": channel(lambda x, k: 1 + k + x / 8),
            "A": channel(alpha),
            "R": channel(lambda x, k: alpha(x, k) / 2),
            "G": channel(lambda x, k: alpha(x, k) / 4),
            "B": channel(lambda x, k: 0.0),
        }
        header = {"compression": getattr(OpenEXR, f"{packing}_COMPRESSION"), "type": OpenEXR.deeptile if tiled else OpenEXR.deepscanline}
        if tiled:
            tiles = OpenEXR.TileDescription()
            tiles.xSize, tiles.ySize = 8, 4
            header["tiles"] = tiles
        with OpenEXR.File(header, channels) as file:
            file.write(f"{'tiled' if tiled else 'scanline'}_{packing.lower()}.exr")
