#!/usr/bin/env python3
"""Wavelet and hybrid transparency once more, in NumPy, from their definitions; it shares no code with nmt.

    oit_reference.py F.npz METHOD WEIGHTS.npy     METHOD: wavelet:R, wavelet:R+own or hybrid:K; WEIGHTS: f64, one number a fragment

It compares the weights with its own and prints the greatest difference. Exit code 0 where that is at most 1e-6 and the control, the weights of
each pixel in another order, is further off; 1 where not; 2 for wrong input.
"""

import sys

import numpy as np

TOLERANCE = 1e-6


def absorbance_of(alpha):
    return np.minimum(-np.log1p(-np.minimum(alpha.astype(np.float64), 1 - 1e-16)), 10.0)


def haar(rank):
    """Means over the cells of each Haar function of unit interval: one row a coefficient, the scaling function last."""
    n = 2 ** (rank + 1)
    rows = np.zeros((n, n))
    for p in range(rank + 1):
        width = n >> p
        for k in range(2**p):
            rows[2**p - 1 + k, k * width : k * width + width // 2] = 2 ** (p / 2)
            rows[2**p - 1 + k, k * width + width // 2 : (k + 1) * width] = -(2 ** (p / 2))
    rows[n - 1] = 1
    return rows


def in_front_of_cells(x, a, n):
    """Mean over each of n cells of Σ a [x_i <= t], from the step functions themselves."""
    edges = np.arange(n + 1) / n
    hidden = np.clip((edges[1:, None] - x[None]) * n, 0, 1)
    return hidden @ a


def wavelet(view_z, alpha, rank, own):
    n = 2 ** (rank + 1)
    v = view_z.astype(np.float64)
    a = absorbance_of(alpha)
    near, far = v.min(), v.max()
    if near == far:
        d = np.zeros(len(v))
    elif own:
        d = np.log(v / near) / np.log(far / near)
    else:
        d = (v - near) / (far - near)
    x = d * (n - 1) / n
    # The basis is orthonormal: coefficients are inner products, and a pixel's function on the cells is their sum. What is left of it is the mean
    # over each cell, so that the way through the coefficients must give what the cells say.
    basis = haar(rank)
    total = a.sum()
    answers = np.empty(len(v))
    for i in range(len(v)):
        rest = total - a[i]
        if own and (v[i] == near or rest <= 1e-6 * total):
            answers[i] = 1
            continue
        if own and v[i] == far:
            answers[i] = np.exp(-rest)
            continue
        others = np.delete(np.arange(len(v)), i)
        coefficients = basis @ in_front_of_cells(x[others], a[others], n) / n
        cells = basis.T @ coefficients
        j = min(int(np.floor(n * x[i])), n - 1)
        before = cells[j - 1] if j > 0 else 0.0
        t = np.exp(-(before + (cells[j] - before) * (n * x[i] - j)))
        answers[i] = np.clip(t, np.exp(-rest) if own else 0, 1)
    return answers


def hybrid(view_z, alpha, core):
    a = absorbance_of(alpha)
    order = np.argsort(view_z, kind="stable")
    weights = np.empty(len(a))
    in_front = np.concatenate([[0.0], np.cumsum(a[order])])
    k = min(core, len(order))
    weights[order[:k]] = np.exp(-in_front[:k])
    tail = order[k:]
    if len(tail):
        alphas = alpha[tail].astype(np.float64).sum()
        behind_core, through = np.exp(-in_front[k]), np.exp(-a[tail].sum())
        weights[tail] = behind_core * ((1 - through) / alphas if alphas > 0 else 1)
    return weights


def main():
    if len(sys.argv) != 4:
        print(__doc__, file=sys.stderr)
        return 2
    archive, name, given = np.load(sys.argv[1]), sys.argv[2], np.load(sys.argv[3])
    offsets, view_z, alpha = archive["offsets"], archive["view_z"], archive["alpha"]
    head, _, argument = name.removesuffix("+own").partition(":")
    own = name.endswith("+own")
    methods = {
        "wavelet": lambda v, a: wavelet(v, a, int(argument), own),
        "hybrid": lambda v, a: hybrid(v, a, int(argument)),
    }
    if head not in methods or given.shape != view_z.shape or not len(view_z):
        print(f"{name}: no such method here, or {given.shape} weights for {view_z.shape} fragments", file=sys.stderr)
        return 2
    ours = np.concatenate(
        [methods[head](view_z[b:e], alpha[b:e]) for b, e in zip(offsets[:-1], offsets[1:]) if e > b]
    )
    difference = np.abs(given - ours)
    worst = difference.max() if np.isfinite(difference).all() else np.inf
    control = max(np.abs(np.roll(given[b:e], 1) - ours[b:e]).max() for b, e in zip(offsets[:-1], offsets[1:]) if e > b)
    print(f"{name}: greatest difference {worst:.1e} over {len(ours)} fragments, control {control:.1e}")
    return 0 if worst <= TOLERANCE < control else 1


if __name__ == "__main__":
    sys.exit(main())
