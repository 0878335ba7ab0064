"""Deep images beyond those of make.py, written by OpenEXR's own library (PyPI OpenEXR 3.5 or later): ZSTD, several parts, half depths.

Pixel (x, y) of 40 x 21 holds (x + 2 y) % 4 samples; sample k lies at Z = 1 + k + x / 8 (one more in the part 'second'), has A = (k + 1) / 4 and the
unpremultiplied colour (0.5, 0.25, 2). Run in this folder.
"""
import numpy as np
import OpenEXR

WIDTH, HEIGHT = 40, 21


def channels(kinds, shift=0.0):
    out = {name: np.empty((HEIGHT, WIDTH), dtype=object) for name in "ZARGB"}
    for y in range(HEIGHT):
        for x in range(WIDTH):
            k = np.arange((x + 2 * y) % 4)
            alpha = (k + 1) / 4
            values = {"Z": 1 + shift + k + x / 8, "A": alpha, "R": 0.5 * alpha, "G": 0.25 * alpha, "B": 2 * alpha}
            for name, value in values.items():
                out[name][y, x] = value.astype(kinds.get(name, "f4")) if len(k) else None
    return out


def write(name, compression, kinds={}, **header):
    header = {"compression": compression, "type": OpenEXR.deepscanline, **header}
    OpenEXR.File(header, channels(kinds)).write(name)


HALVES = {name: "f2" for name in "ARGB"}
write("zstd_scanline.exr", OpenEXR.ZSTD_COMPRESSION)
write("zstd_halves.exr", OpenEXR.ZSTD_COMPRESSION, HALVES)
write("half_depth.exr", OpenEXR.ZIPS_COMPRESSION, {"Z": "f2", **HALVES})
tiles = OpenEXR.TileDescription()
tiles.xSize, tiles.ySize = 16, 8
write("zstd_tiled.exr", OpenEXR.ZSTD_COMPRESSION, HALVES, type=OpenEXR.deeptile, tiles=tiles)
parts = [
    OpenEXR.Part({"compression": OpenEXR.ZIPS_COMPRESSION, "type": OpenEXR.deepscanline}, channels({}, shift), name)
    for name, shift in [("first", 0.0), ("second", 1.0)]
]
OpenEXR.File(parts).write("parts.exr")
