#!/usr/bin/env python3
"""nmt's files in NumPy, without a build: fragment lists, datasets, networks, and what networks answer.

Import it:

    import nmt
    fragments = nmt.read_fragments("data/sample.npz")
    model = nmt.read_model("models/recommended.json")
    T = nmt.transmittance(model, fragments)
    error = np.mean((T - nmt.exact_transmittance(fragments)) ** 2)

or run it:

    nmt.py predict MODEL.json F.npz --out T.npy      transmittance of every fragment, as `nmt predict` writes it
    nmt.py check MODEL.json F.npz                    features and T, and their error against the exact T
        --predicted T.npy                            ... compared with what `nmt predict` wrote
        --onnx M.onnx                                ... compared with onnxruntime on the same features
        --dataset DIR                                ... compared with a dataset of the same pixels

It shares no code with nmt: everything is computed from the JSON and the fragment list, in f64, so it is a second
opinion. It needs NumPy; torch runs the network where a device is named, and onnxruntime is needed for --onnx alone.
Exit code 0 where all comparisons hold, 1 where one does not, 2 for wrong input.
"""

import argparse
import dataclasses
import functools
import json
import pathlib
import sys

import numpy as np


class InputError(Exception):
    """What is wrong with a file, and where."""


# ---------------------------------------------------------------- files


@dataclasses.dataclass
class Fragments:
    """A fragment list: pixel p holds fragments offsets[p]..offsets[p + 1], in any order."""

    offsets: np.ndarray  # u64 [P + 1]
    view_z: np.ndarray  # f32 [F], > 0
    alpha: np.ndarray  # f32 [F], in [0, 1]
    color: np.ndarray | None = None  # f32 [F, 3], linear
    width: int | None = None  # pixels
    height: int | None = None
    near: float | None = None  # camera planes
    far: float | None = None

    def __post_init__(self):
        self.offsets = np.asarray(self.offsets, np.uint64)
        self.view_z = np.asarray(self.view_z, np.float32)
        self.alpha = np.asarray(self.alpha, np.float32)
        fragments = len(self.view_z)
        if self.color is not None:
            self.color = np.asarray(self.color, np.float32).reshape(fragments, 3)
        counts = np.diff(self.offsets.astype(np.int64))
        if len(self.offsets) == 0 or self.offsets[0] != 0 or self.offsets[-1] != fragments or np.any(counts < 0):
            raise InputError(f"offsets must rise from 0 to the number of fragments, {fragments}")
        if len(self.alpha) != fragments:
            raise InputError(f"alpha holds {len(self.alpha)} numbers, view_z {fragments}")
        if not (np.all(np.isfinite(self.view_z)) and np.all(self.view_z > 0)):
            raise InputError("every view_z must be a finite number greater than 0")
        if not (np.all(self.alpha >= 0) and np.all(self.alpha <= 1)):
            raise InputError("every alpha must lie in [0, 1]")

    def __len__(self):
        return len(self.view_z)

    @property
    def counts(self):
        """Number of fragments of every pixel."""
        return np.diff(self.offsets.astype(np.int64))

    @property
    def pixel(self):
        """Pixel of every fragment."""
        return np.repeat(np.arange(len(self.offsets) - 1), self.counts)

    @property
    def absorbance(self):
        """min(-ln(1 - alpha), 10) of every fragment."""
        alpha = np.minimum(self.alpha.astype(np.float64), 1 - 1e-16)
        return np.minimum(-np.log1p(-alpha), 10.0)

    def totals(self, values):
        """Sum of a value over each pixel."""
        return np.bincount(self.pixel, values, len(self.offsets) - 1)

    def extremes(self, values):
        """Least and greatest value of each pixel; infinities where it is empty."""
        least, greatest = np.full((2, len(self.offsets) - 1), np.inf)
        greatest = -greatest
        starts = self.offsets[:-1].astype(np.int64)
        full = self.counts > 0
        if np.any(full):
            least[full] = np.minimum.reduceat(values, starts[full])
            greatest[full] = np.maximum.reduceat(values, starts[full])
        return least, greatest


def read_fragments(path):
    """A fragment list from an .npz file."""
    with np.load(path) as arrays:
        missing = [name for name in ("offsets", "view_z", "alpha") if name not in arrays]
        if missing:
            raise InputError(f"{path}: holds no array '{missing[0]}'")
        scalar = lambda name, kind: kind(arrays[name]) if name in arrays else None
        return Fragments(
            arrays["offsets"],
            arrays["view_z"],
            arrays["alpha"],
            arrays["color"] if "color" in arrays else None,
            scalar("width", int),
            scalar("height", int),
            scalar("near", float),
            scalar("far", float),
        )


def write_fragments(path, fragments):
    """Writes a fragment list as `nmt` reads it."""
    arrays = {"offsets": fragments.offsets, "view_z": fragments.view_z, "alpha": fragments.alpha}
    optional = {"color": np.float32, "width": np.uint32, "height": np.uint32, "near": np.float32, "far": np.float32}
    for name, kind in optional.items():
        value = getattr(fragments, name)
        if value is not None:
            arrays[name] = np.asarray(value, kind)
    np.savez(path, **arrays)


@dataclasses.dataclass
class Rows:
    """Rows of a dataset."""

    features: np.ndarray  # f32 [N, W]
    targets: np.ndarray  # f32 [N]
    pixels: np.ndarray  # pixel of every row


@dataclasses.dataclass
class Dataset:
    """A dataset that `nmt generate` wrote."""

    manifest: dict
    training: Rows
    validation: Rows


def read_dataset(folder):
    """A dataset; its arrays are mapped from disk, so that large ones cost no memory until they are used."""
    folder = pathlib.Path(folder)
    manifest = json.loads((folder / "manifest.json").read_text())
    load = lambda part, name: np.load(folder / f"{part}_{name}.npy", mmap_mode="r")
    rows = lambda part: Rows(*(load(part, name) for name in ("features", "targets", "pixels")))
    return Dataset(manifest, rows("training"), rows("validation"))


@dataclasses.dataclass
class Model:
    """A network."""

    name: str
    feature_set: str
    columns: list
    output: str
    layers: list  # of (weights [inputs, outputs], biases [outputs]), f32

    @property
    def sizes(self):
        return [self.layers[0][0].shape[0], *(len(biases) for _, biases in self.layers)]


def read_model(path):
    """A network from its model file, which is also its JSON export."""
    document = json.loads(pathlib.Path(path).read_text())
    if document.get("format") != "nmt-model" or document.get("version") != 1:
        raise InputError(f"{path}: not a model file of version 1")
    if document["feature_set"] not in FEATURE_SETS:
        known = ", ".join(name for name in FEATURE_SETS if not name.startswith("core-")) + ", core-K-M"
        raise InputError(f"{path}: feature set '{document['feature_set']}'; this reader knows {known}")
    layers = [(np.array(l["weights"], np.float32), np.array(l["biases"], np.float32)) for l in document["layers"]]
    return Model(document["name"], document["feature_set"], document["features"], document["output"], layers)


# ---------------------------------------------------------------- exact answers


def exact_transmittance(fragments):
    """exp(-absorbance strictly nearer) of every fragment: fragments at one depth do not hide one another."""
    pixel, depth = fragments.pixel, fragments.view_z
    order = np.lexsort((depth, pixel))
    before = np.concatenate([[0.0], np.cumsum(fragments.absorbance[order])])
    p, v = pixel[order], depth[order]
    # The first fragment of the same pixel and depth, and the first of the same pixel.
    first = lambda changes: np.maximum.accumulate(np.where(changes, np.arange(len(v)), 0))
    fresh_pixel = np.concatenate([[True], p[1:] != p[:-1]])[: len(v)]
    fresh_depth = fresh_pixel | np.concatenate([[True], v[1:] != v[:-1]])[: len(v)]
    nearer = before[first(fresh_depth)] - before[first(fresh_pixel)] if len(v) else before[:0]
    out = np.empty(len(v))
    out[order] = np.exp(-nearer)
    return out


# ---------------------------------------------------------------- features
#
# A feature set is one function: it takes the fragments and the number of moments and returns
#   rows   f32 [F, W]: features of every fragment; those of fragments that need no network are not used,
#   known  f64 [F]: the answer where no network is needed, NaN elsewhere,
#   front  f64 [F]: absorbance in front that the network's answer does not hold; T = exp(-front) times that answer.
# A new one gets an entry in FEATURE_SETS below.


def paper_features(fragments, moments):
    """[d, n, b0, b1, b2, b3, b4] on window depth (Tsopouridis et al. 2024, Sec. 3.1)."""
    near, far = fragments.near, fragments.far
    if near is None or far is None:
        raise InputError("the fragment list has no camera planes, near and far")
    v, pixel = fragments.view_z.astype(np.float64), fragments.pixel
    w = far * (v - near) / (v * (far - near))
    nearest, farthest = (ends[pixel] for ends in fragments.extremes(w))
    thickness = np.expm1(farthest - nearest)
    d = np.divide(np.expm1(w - nearest), thickness, where=thickness > 0, out=np.zeros_like(w))
    absorbance, z = fragments.absorbance, 2 * w - 1
    sums = [fragments.totals(absorbance * z**k)[pixel] for k in range(moments + 1)]
    n = fragments.counts.astype(np.float64)[pixel]
    return np.stack([d, n, *sums], axis=1).astype(np.float32), np.full(len(v), np.nan), np.zeros(len(v))


def deep_weighted_blended_features(fragments, moments):
    """[depth, alpha_sum, n] (Papakostas 2022, Sec. 3.3.2)."""
    v, pixel = fragments.view_z.astype(np.float64), fragments.pixel
    least, extent = v.min(initial=np.inf), np.ptp(v) if len(v) else 0.0
    depth = (v - least) / extent if extent > 0 else np.zeros_like(v)
    alpha = fragments.totals(fragments.alpha.astype(np.float64))[pixel]
    n = fragments.counts.astype(np.float64)[pixel]
    return np.stack([depth, alpha, n], axis=1).astype(np.float32), np.full(len(v), np.nan), np.zeros(len(v))


def recentred_features(fragments, moments):
    """What the other fragments of a pixel look like from its own depth range, as models/recommended.md says."""
    v, pixel, a = fragments.view_z.astype(np.float64), fragments.pixel, fragments.absorbance
    v0, v1 = (v.min(), v.max()) if len(v) else (1.0, 1.0)
    z = 2 * np.log(v / v0) / np.log(v1 / v0) - 1 if v1 > v0 else np.zeros_like(v)
    low, high = (ends[pixel] for ends in fragments.extremes(z))
    half = np.maximum((high - low) / 2, 1e-300)
    x = np.clip((z - (low + high) / 2) / half, -1, 1)
    total = fragments.totals(a)[pixel]
    others = total - a
    n = fragments.counts.astype(np.float64)[pixel]

    rows = [x, np.log2(np.maximum(n, 1)) / 3 - 1, np.log(np.maximum(others, 0) + 0.05)]
    rows += described([fragments.totals(a * x**k)[pixel] - a * x**k for k in range(moments + 1)], 1e-300)

    nearest, farthest = (ends[pixel] for ends in fragments.extremes(fragments.view_z))
    known = np.full(len(v), np.nan)
    few = n <= 4
    known[few] = exact_transmittance(fragments)[few]
    at_end = fragments.view_z == farthest
    known[at_end] = np.exp(-others[at_end])
    known[(fragments.view_z == nearest) | (others <= 1e-6 * total)] = 1.0
    return np.stack(rows, axis=1).astype(np.float32), known, np.zeros(len(v))


def described(sums, least):
    """Mean and spread of the measure with moments sums[0], sums[1], ... on [-1, 1], then of (1 - x^2) times it, ..."""
    m, columns = [moment / np.maximum(sums[0], least) for moment in sums], []
    m[1:] = [np.clip(moment, -1, 1) for moment in m[1:]]
    while len(m) > 1:
        mass = np.maximum(m[0], 1e-6)
        mean = np.clip(m[1] / mass, -1, 1)
        if len(m) == 2:
            return columns + [mean]
        spread = np.clip((m[2] / mass - mean**2) / np.maximum(1 - mean**2, 1e-6), 0, 1)
        columns += [mean, np.sqrt(spread) if columns else spread]
        m = [m[k] - m[k + 2] for k in range(len(m) - 2)]
    return columns


BOUNDS_BIAS = 1e-4  # how much of the uniform law's moments is blended into those that bounds are taken of


def bounds(x, m):
    """Least and greatest share in front of x of the measures on [-1, 1] that have the moments m: Markov's bounds."""
    if len(m) == 2:
        lower, upper = (x - m[1]) / np.maximum(1 + x, 1e-6), (1 - m[1]) / np.maximum(1 - x, 1e-6)
        return [np.clip(lower, 0, 1), np.clip(upper, 0, 1)]
    uniform = [1, 0, 1 / 3, 0, 1 / 5]
    m = [moment * (1 - BOUNDS_BIAS) + at * BOUNDS_BIAS for moment, at in zip(m, uniform)]
    variance = np.maximum(m[2] - m[1] ** 2, 1e-7)
    y = (x - m[1]) / np.sqrt(variance)
    free = np.maximum(1 - x**2, 1e-6)
    if len(m) < 5:
        most = 1 / (1 + y**2)
        lower = np.where(y < 0, 0, 1 - most)
        # The measure of both ends and x.
        ended = (1 - m[2]) / free
        lower = np.where(ended < most, (1 - m[1] - ended * (1 - x)) / 2, lower)
        return [lower, lower + np.minimum(most, ended)]
    skewness = (m[3] - 3 * m[1] * m[2] + 2 * m[1] ** 3) / variance**1.5
    fourth = (m[4] - 4 * m[1] * m[3] + 6 * m[1] ** 2 * m[2] - 3 * m[1] ** 4) / variance**2
    g = np.clip(skewness, -30, 30)
    d = np.clip(fourth - g**2 - 1, 1e-3, 1e4)
    # Orthonormal polynomials at y: 1, y and sqrt(d) q. The other points are the roots of q u^2 + (y - q g) u + 1 - q.
    q = (y**2 - g * y - 1) / d
    most = 1 / (1 + y**2 + q**2 * d)
    linear = y - q * g
    root = np.sqrt(np.maximum(linear**2 - 4 * q * (1 - q), 1e-12))
    between = np.clip((1 - most) / 2 * (1 + linear / root) - most * y * q / root, 0, 1 - most)
    lower = np.where(q < 0, between, np.where(y > g / 2, 1 - most, 0))
    # The measure of both ends, x and a fourth point: the bound of two moments of (1 - t^2) times the measure.
    inner = np.maximum(1 - m[2], 1e-6)
    mean, second = (m[1] - m[3]) / inner, (m[2] - m[4]) / inner
    width = np.maximum(second - mean**2, 1e-7)
    share = width / (width + (mean - x) ** 2)
    ended = inner * share / free
    side = np.where(mean < x, -1, 1)
    of_fourth = inner * (1 - share) * np.abs(mean - x) / np.maximum(np.abs(mean - x) + second - x * mean, 1e-6)
    at_end = np.clip((1 - side * m[1] - ended * (1 - side * x) - of_fourth) / 2, 0, np.maximum(1 - ended, 0))
    lower = np.where(ended < most, np.where(side < 0, 1 - ended - at_end, at_end), lower)
    return [lower, lower + np.minimum(most, ended)]


DEPTH_STEPS = 1 << 16  # of a core's codes
OCTAVE_BITS = 11  # steps of absorbance to the octave, as a power of two
KEY_EXPONENT = 10  # k of the key A / v^k
LINEAR_BELOW = np.float32(2.0**-10)  # absorbance below which steps are linear


def log2_bits(bits):
    """Logarithm of base 2 of positive f32 numbers given as integers, in units of 2^-23 octaves, in integers alone."""
    m = bits & 0x7FFFFF
    high, low = m >> 11, m & 2047
    return bits + ((11 * ((high * (4096 - high) >> 1) + (low * (2048 - high) >> 11))) >> 5)


def core_steps(fragments):
    """Depth step and absorbance step of every fragment, and how much nearness adds to the key of the heavy slots."""
    bits = lambda values: np.asarray(values, np.float32).view(np.int32).astype(np.int64)
    v = fragments.view_z
    first, last = (bits(end) for end in ((v.min(), v.max()) if len(v) else (1.0, 1.0)))
    span = int(log2_bits(last) - log2_bits(first))
    shift = max(span.bit_length() - DEPTH_STEPS.bit_length(), 0)
    multiplier = (1 << 31) // ((span >> shift) + 1)
    q = (log2_bits(bits(v)) - log2_bits(first) >> shift) * multiplier // ((1 << 31) // DEPTH_STEPS)

    def step(absorbance):
        above = bits(np.float32(absorbance) + LINEAR_BELOW) - bits(LINEAR_BELOW)
        return (above + (1 << (22 - OCTAVE_BITS))) >> (23 - OCTAVE_BITS)

    slope = int(np.float32(span >> 8) * np.float32(KEY_EXPONENT * 2.0 ** (OCTAVE_BITS - 15)))
    return q, step(fragments.absorbance), min(slope, 0xFFFF - int(step(10.0)))


def core_of(fragments, q, a, slope, slots):
    """The core: fragments of every slot and pixel, int [slots, P], -1 where it is empty; and which are in the tail.

    First the nearest, then the farthest of the others, then the heaviest of the rest. Ties in depth go to the heavier
    one, ties in weight to the nearer one. A fragment that absorbs nothing is in neither.
    """
    near = DEPTH_STEPS - 1 - q
    codes = [near << 16 | a, q << 16 | a] + [(a + (near * slope >> 16)) << 16 | near] * (slots - 2)
    core = np.full((slots, len(fragments.offsets) - 1), -1)
    left = a > 0
    for slot, code in enumerate(codes):
        code = np.where(left, code, -1)
        greatest = fragments.extremes(code)[1]
        found = np.flatnonzero(left & (code == greatest[fragments.pixel]))
        # The first of doubles.
        pixels, first = np.unique(fragments.pixel[found], return_index=True)
        core[slot, pixels] = found[first]
        left[found[first]] = False
    return core, left


def core_features(fragments, moments, heavy):
    """What is left of a pixel without its nearest, its farthest and its heaviest fragments, as models/core.md says."""
    pixel, size = fragments.pixel, len(fragments)
    q, a, slope = core_steps(fragments)
    core, in_tail = core_of(fragments, q, a, slope, heavy + 2)
    z = (2 * q + 1) / DEPTH_STEPS - 1
    absorbance = (a << (23 - OCTAVE_BITS)) + int(LINEAR_BELOW.view(np.int32))
    absorbance = (absorbance.astype(np.int32).view(np.float32) - LINEAR_BELOW).astype(np.float64)

    # The pixel's own range, from the nearest to the farthest.
    lone = np.where(core[1] < 0, core[0], core[1])
    padded = lambda values, at: np.where(at < 0, 0, np.append(values, 0)[at])
    center = ((padded(z, core[0]) + padded(z, lone)) / 2)[pixel]
    half = np.maximum((padded(z, lone) - padded(z, core[0])) / 2, 1 / DEPTH_STEPS)[pixel]
    x = np.clip((z - center) / half, -1, 1)

    # The core in front, and whether a fragment is in the core: one that equals a fragment there takes itself for it.
    front, in_core = np.zeros(size), np.zeros(size, bool)
    for kept in core[:, pixel]:
        there = kept >= 0
        front += np.where(there & (padded(q, kept) < q), padded(absorbance, kept), 0)
        in_core |= there & (padded(q, kept) == q) & (padded(a, kept) == a)
    own = ~in_core & (a > 0)
    weight = np.where(in_tail, absorbance, 0)
    tail = [fragments.totals(weight * x**k)[pixel] - np.where(own, absorbance * x**k, 0) for k in range(moments + 1)]
    others = np.maximum(tail[0], 0)
    count = fragments.totals(in_tail.astype(np.float64))[pixel] - own
    m = [np.clip(moment / np.maximum(others, 1e-12), -1, 1) for moment in tail]
    rows = [x, np.log2(np.maximum(count, 1)) / 3 - 1, np.log(others + 0.05), *bounds(x, m), *described(tail, 1e-12)]

    # Short tails: where one fragment lies, or two, follows from their moments, but for the rounding of sums in f32.
    total = fragments.totals(absorbance)[pixel]
    noise = total / np.maximum(others, 1e-12) * (1 + np.abs(center)) / half * 16 * np.finfo(np.float32).eps
    step = 2 / DEPTH_STEPS / half
    before = lambda place, off: np.clip((x - place - step / 4) / (step / 2 + off), 0, 1)
    share = before(m[1], noise)
    if moments >= 3:
        variance = np.maximum(m[2] - m[1] ** 2, 1e-9)
        third = np.clip((m[3] - 3 * m[1] * m[2] + 2 * m[1] ** 3) / variance, -2, 2)
        root = np.sqrt(third**2 + 4 * variance)
        near, far = (third - root) / 2, (third + root) / 2
        of_near = np.clip(far / root, 0, 1)
        off = noise + noise / np.maximum(np.sqrt(variance), 1e-4)
        two = of_near * before(m[1] + near, off) + (1 - of_near) * before(m[1] + far, off)
        share = np.where(count == 2, two, share)
    short = (count <= 1) | ((count == 2) & (moments >= 3))

    known = np.where(short, np.exp(-front - others * np.where(count > 0, share, 0)), np.nan)
    at_end = (q >= padded(q, lone)[pixel]) & (count > 0)
    known[at_end] = np.exp(-front - others)[at_end]
    known[(core[0][pixel] < 0) | (q <= padded(q, core[0])[pixel])] = 1.0
    return np.stack(rows, axis=1).astype(np.float32), known, front


# Name, function, and number of moments.
FEATURE_SETS = {
    "paper": (paper_features, 4),
    "deep-weighted-blended": (deep_weighted_blended_features, 0),
    "recentred": (recentred_features, 4),
    "recentred-6": (recentred_features, 6),
    "recentred-8": (recentred_features, 8),
}
# core-K-M: K heavy fragments besides both ends, and M moments of the tail.
for heavy, moments in ((heavy, moments) for heavy in range(9) for moments in range(1, 7)):
    FEATURE_SETS[f"core-{heavy}-{moments}"] = (functools.partial(core_features, heavy=heavy), moments)


def features(model, fragments):
    """Features of every fragment, f32 [F, W]; the answers that need no network, NaN where one is needed; and the
    absorbance in front that the network's answer does not hold: T = exp(-front) times that answer."""
    function, moments = FEATURE_SETS[model.feature_set]
    return function(fragments, moments)


# ---------------------------------------------------------------- networks


def logits(model, rows, dtype=np.float64, device=None):
    """What the last layer gives for every row; on a torch device where one is named, in f32."""
    if device is not None:
        import torch

        x = torch.as_tensor(np.ascontiguousarray(rows), device=device)
        for index, (weights, biases) in enumerate(model.layers):
            x = x @ torch.as_tensor(weights, device=device) + torch.as_tensor(biases, device=device)
            x = torch.relu(x) if index + 1 < len(model.layers) else x
        return x[:, 0].cpu().numpy()
    out = np.empty(len(rows), dtype)
    layers = [(weights.astype(dtype), biases.astype(dtype)) for weights, biases in model.layers]
    # Blocks that stay in the cache.
    for start in range(0, len(rows), 1 << 14):
        x = rows[start : start + (1 << 14)].astype(dtype)
        for index, (weights, biases) in enumerate(layers):
            x = x @ weights + biases
            if index + 1 < len(layers):
                np.maximum(x, 0, out=x)
        out[start : start + len(x)] = x[:, 0]
    return out


def answers(model, rows, dtype=np.float64, device=None):
    """The network's answer to rows of features: T, or a front-to-back factor for deep-weighted-blended."""
    s = 1 / (1 + np.exp(np.minimum(-logits(model, rows, dtype, device).astype(dtype), 80)))
    if model.output != "absorbance-share":
        return s
    # T = exp(-b0' s), with b0' from its logarithm.
    column = model.columns.index("ln_b0")
    others = np.maximum(np.exp(np.minimum(rows[:, column].astype(dtype), dtype(40))) - dtype(0.05), 0)
    return np.exp(-np.minimum(others * s, 80))


def transmittance(model, fragments, device=None):
    """The answer to every fragment, f64 [F]: exact where no network is needed, the network's elsewhere."""
    rows, known, front = features(model, fragments)
    asked = np.isnan(known)
    known[asked] = np.exp(-front[asked]) * answers(model, rows[asked], device=device)
    return known


# ---------------------------------------------------------------- comparisons


def compare(name, found, expected, tolerance):
    """True where both have the same length, hold something, are finite, and differ by at most the tolerance."""
    found, expected = np.asarray(found, np.float64), np.asarray(expected, np.float64)
    if found.shape != expected.shape or found.size == 0:
        print(f"FAILED {name}: shapes {found.shape} and {expected.shape}")
        return False
    worst = np.max(np.abs(found - expected))
    good = bool(np.isfinite(worst) and worst <= tolerance)
    word = "ok" if good else "FAILED"
    print(f"{word} {name}: worst difference {worst:.2e}, tolerance {tolerance:.0e}, {found.size} numbers")
    return good


def compare_predicted(model, predicted, expected):
    """True where `nmt predict` agrees. It rounds sums to f32 as a renderer does, which thin pixels magnify; sums of
    `paper` are in f64."""
    if model.output != "absorbance-share":
        return compare("nmt predict", predicted, expected, 5e-5)
    if predicted.shape != expected.shape or predicted.size == 0 or not np.all(np.isfinite(predicted)):
        print("FAILED nmt predict: another shape, empty, or not finite")
        return False
    off = np.sort(np.abs(predicted - expected))
    moments = FEATURE_SETS[model.feature_set][1]
    bar, rare = (2e-3, 2e-3) if moments == 4 else (2e-2, 1e-2)
    most, share = off[int(0.99 * len(off))], np.mean(off > 0.02)
    good = bool(most <= bar and share <= rare)
    word = "ok" if good else "FAILED"
    print(
        f"{word} nmt predict: 99 % within {most:.1e} (at most {bar:.0e}), {share:.1e} beyond 0.02 (at most {rare:.0e})"
    )
    return good


def compare_onnx(model, path, rows, expected):
    """True where onnxruntime gives the same answers, and the file names the same columns."""
    import onnxruntime

    session = onnxruntime.InferenceSession(path, providers=["CPUExecutionProvider"])
    (answer,) = session.run(["transmittance"], {"features": rows})
    names = session.get_modelmeta().custom_metadata_map["nmt.features"].split(",")
    return compare("onnxruntime", answer[:, 0], expected, 3e-5) & (names == model.columns)


def compare_dataset(folder, fragments, rows, asked, exact):
    """True where a dataset of the same pixels holds the same features, answers and pixels."""
    dataset = read_dataset(folder)
    parts = (dataset.training, dataset.validation)
    both = lambda name: np.concatenate([getattr(part, name) for part in parts])
    good = compare("dataset features", both("features"), rows, 1e-5)
    good &= compare("dataset targets", both("targets"), exact[asked], 1e-7)
    shifted = [parts[0].pixels, parts[1].pixels.astype(np.int64) + parts[0].pixels[-1] + 1]
    return good & compare("dataset pixels", np.concatenate(shifted), fragments.pixel[asked], 0)


def check(arguments):
    model, fragments = read_model(arguments.model), read_fragments(arguments.fragments)
    rows, known, front = features(model, fragments)
    asked = np.isnan(known)
    rows = np.ascontiguousarray(rows[asked])
    reference, single = (answers(model, rows, dtype) for dtype in (np.float64, np.float32))
    known[asked] = np.exp(-front[asked]) * reference
    exact = exact_transmittance(fragments)
    print(
        f"{model.name}, {'-'.join(map(str, model.sizes))}: {len(fragments)} fragments, {np.sum(asked)} need the "
        f"network, T-MSE {np.mean((known - exact) ** 2):.4e}"
    )
    good = compare("f32 forward against f64", single, reference, 3e-5)
    order = [1, 0, *range(2, rows.shape[1])]
    swapped = np.max(np.abs(answers(model, rows[:, order]) - reference), initial=0)
    word = "ok" if swapped > 3e-5 else "FAILED"
    print(f"{word} control: with two features swapped T differs by {swapped:.2e}, which must exceed 3e-05")
    good &= bool(swapped > 3e-5)
    if arguments.predicted:
        good &= compare_predicted(model, np.load(arguments.predicted), known)
    if arguments.onnx:
        good &= compare_onnx(model, arguments.onnx, rows, reference)
    if arguments.dataset and model.feature_set.startswith("core-"):
        raise InputError(f"datasets of {model.feature_set} hold fragments chosen at random, so none can be compared")
    if arguments.dataset:
        good &= compare_dataset(arguments.dataset, fragments, rows, asked, exact)
    return 0 if good else 1


def predict(arguments):
    model, fragments = read_model(arguments.model), read_fragments(arguments.fragments)
    found = transmittance(model, fragments, arguments.device)
    np.save(arguments.out, found.astype(np.float32))
    print(f"{len(fragments)} fragments, T-MSE {np.mean((found - exact_transmittance(fragments)) ** 2):.4e}")
    return 0


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(required=True)
    for name, function in (("predict", predict), ("check", check)):
        command = commands.add_parser(name)
        command.set_defaults(run=function)
        command.add_argument("model", help="model file, or JSON export")
        command.add_argument("fragments", help="fragment list (.npz)")
        if function is predict:
            command.add_argument("--out", required=True, help="T.npy to write, f32")
            command.add_argument("--device", help="torch device to run the network on, such as cuda")
        else:
            command.add_argument("--predicted", help="T.npy that nmt predict wrote")
            command.add_argument("--onnx", help="ONNX export")
            command.add_argument("--dataset", help="dataset of the same pixels")
    arguments = parser.parse_args()
    try:
        return arguments.run(arguments)
    except (InputError, OSError, KeyError, ValueError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
