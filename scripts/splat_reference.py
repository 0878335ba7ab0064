#!/usr/bin/env python3
"""What a camera sees of a .splat file, computed with NumPy alone, against a fragment list that nmt wrote.

Every splat is projected by itself: covariance R S S R^T, the Jacobian of the projection at its centre, 0.3 square pixels added. A fragment is where
opacity exp(-d^2 / 2) is at least 1/255, at the depth of the splat's centre. Exits with 1 where fragments, alpha (1e-5) or depth (1e-6) differ.
"""
import argparse
import sys

import numpy as np

ALPHA, DEPTH = 1e-5, 1e-6


def splats(path):
    rows = np.fromfile(path, dtype=np.uint8).reshape(-1, 32)
    numbers = rows[:, :24].copy().view("<f4").astype(np.float64)
    turn = (rows[:, 28:32].astype(np.float64) - 128) / 128
    return numbers[:, :3], numbers[:, 3:], rows[:, 24:28] / 255.0, turn / np.linalg.norm(turn, axis=1, keepdims=True)


def rotation(q):
    w, x, y, z = q
    return np.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def camera(position, target, up):
    forward = target - position
    forward = forward / np.linalg.norm(forward)
    right = np.cross(forward, up)
    right = right / np.linalg.norm(right)
    return np.stack([right, np.cross(forward, right), forward])


def render(path, options, width, height, dilation=0.3):
    """Per pixel, the depths and alphas of its fragments, by depth."""
    position = np.array(options.position)
    world = camera(position, np.array(options.look_at), np.array(options.up))
    focal = height / 2 / np.tan(np.radians(options.fov) / 2)
    columns, rows = np.meshgrid(np.arange(width) + 0.5, np.arange(height) + 0.5)
    pixels = [[] for _ in range(width * height)]
    for center, scale, rgba, turn in zip(*splats(path)):
        x, y, z = world @ (center - position)
        if not options.near <= z <= options.far:
            continue
        jacobian = np.array([[focal / z, 0, -focal * x / z**2], [0, focal / z, -focal * y / z**2]])
        root = jacobian @ world @ rotation(turn) @ np.diag(scale)
        inverse = np.linalg.inv(root @ root.T + dilation * np.eye(2))
        offset = np.stack([columns - width / 2 - focal * x / z, rows - height / 2 - focal * y / z], axis=-1)
        alpha = rgba[3] * np.exp(-0.5 * np.einsum("hwi,ij,hwj->hw", offset, inverse, offset))
        for p in np.flatnonzero(alpha >= 1 / 255):
            pixels[p].append((z, alpha.flat[p]))
    return [sorted(p) for p in pixels]


def differences(pixels, data):
    """Worst differences of alpha and of relative depth, and the number of pixels that hold other fragments."""
    offsets, alpha, depth, other = data["offsets"], 0.0, 0.0, 0
    for p, expected in enumerate(pixels):
        own = slice(int(offsets[p]), int(offsets[p + 1]))
        found = sorted(zip(data["view_z"][own].astype(np.float64), data["alpha"][own].astype(np.float64)))
        if len(found) != len(expected):
            # One at the very limit may fall either way.
            rest = [a for _, a in expected] + [a for _, a in found]
            other += min(rest, default=0) > 1 / 255 + 1e-6
            continue
        for (z, a), (zf, af) in zip(expected, found):
            depth = max(depth, abs(zf / z - 1))
            alpha = max(alpha, abs(af - a))
    return alpha, depth, other


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("splats")
    parser.add_argument("fragments")
    for name, default in [("position", None), ("look-at", [0, 0, 0]), ("up", [0, 1, 0])]:
        parser.add_argument("--" + name, type=float, nargs=3, default=default, required=default is None)
    for name in ["fov", "near", "far"]:
        parser.add_argument("--" + name, type=float, required=True)
    options = parser.parse_args()
    data = np.load(options.fragments)
    width, height = int(data["width"]), int(data["height"])
    alpha, depth, other = differences(render(options.splats, options, width, height), data)
    print(f"{len(data['alpha'])} fragments: alpha within {alpha:.1e}, depth within {depth:.1e}, {other} pixels with other fragments")
    good = len(data["alpha"]) > 0 and alpha <= ALPHA and depth <= DEPTH and other == 0
    print("ok alpha" if good else "FAILED alpha")
    # Control: without the pixel's own extent the fragments are others.
    alpha, _, other = differences(render(options.splats, options, width, height, dilation=0.0), data)
    control = alpha > ALPHA or other > 0
    print("ok control" if control else "FAILED control")
    return 0 if good and control else 1


if __name__ == "__main__":
    sys.exit(main())
