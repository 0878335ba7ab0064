#!/usr/bin/env python3
"""An independent reader of exported networks: NumPy, and onnxruntime where an ONNX file is given.

    read_export.py MODEL.json F.npz                     features and T of every fragment, error against the exact T
    read_export.py MODEL.json F.npz --predicted T.npy   ... compared with what `nmt predict` wrote
    read_export.py MODEL.json F.npz --onnx M.onnx       ... compared with onnxruntime on the same features
    read_export.py MODEL.json F.npz --dataset DIR       ... compared with a dataset made of the same pixels (`nmt generate --fragments`)

It knows nothing of nmt but the file formats: everything is computed from the JSON and the fragment list. Exit code 0 where all comparisons hold,
1 where one does not, 2 for wrong input.
"""

import argparse
import json
import pathlib
import sys

import numpy as np


def read_model(path):
    model = json.loads(pathlib.Path(path).read_text())
    if model.get("format") != "nmt-model" or model.get("version") != 1:
        raise SystemExit(f"{path}: not a model file of version 1")
    if model["feature_set"] not in ("paper", "recentred", "recentred-6", "recentred-8"):
        raise SystemExit(f"{path}: feature set '{model['feature_set']}' is not known to this reader")
    layers = [(np.array(l["weights"], np.float32), np.array(l["biases"], np.float32)) for l in model["layers"]]
    return model, layers


def forward(model, layers, rows, dtype):
    x = rows.astype(dtype)
    for index, (weights, biases) in enumerate(layers):
        x = x @ weights.astype(dtype) + biases.astype(dtype)
        if index + 1 < len(layers):
            x = np.maximum(x, 0)
    s = (1 / (1 + np.exp(np.minimum(-x, 80))))[:, 0]
    if model["feature_set"] == "paper":
        return s
    # T = exp(-b0' s), with b0' from its logarithm
    others = np.maximum(np.exp(np.minimum(rows[:, 2].astype(dtype), dtype(40))) - dtype(0.05), 0)
    return np.exp(-np.minimum(others * s, 80))


def pixels_of(offsets):
    """Pixel of every fragment."""
    return np.repeat(np.arange(len(offsets) - 1), np.diff(offsets).astype(np.int64))


def paper_features(view_z, alpha, offsets, near, far):
    """[d, n, b0, b1, b2, b3, b4] of every fragment, on window depth (Tsopouridis et al. 2024, Sec. 3.1)."""
    pixel = pixels_of(offsets)
    count = len(offsets) - 1
    v = view_z.astype(np.float64)
    w = far * (v - near) / (v * (far - near))
    wmin, wmax = np.full(count, np.inf), np.full(count, -np.inf)
    np.minimum.at(wmin, pixel, w)
    np.maximum.at(wmax, pixel, w)
    thickness = np.expm1(wmax - wmin, where=wmax > wmin, out=np.zeros(count))[pixel]
    d = np.divide(np.expm1(w - wmin[pixel]), thickness, where=thickness > 0, out=np.zeros_like(w))
    absorbance = np.minimum(-np.log1p(-np.minimum(alpha.astype(np.float64), 1 - 1e-16)), 10.0)
    z = 2 * w - 1
    moments = [np.bincount(pixel, absorbance * z**k, count)[pixel] for k in range(5)]
    n = np.diff(offsets).astype(np.float64)[pixel]
    return np.stack([d, n, *moments], axis=1).astype(np.float32), absorbance


def recentred_features(view_z, alpha, offsets, moments):
    """Features of every fragment as models/recommended.md says, and T where it needs no network (NaN elsewhere), in f64."""
    absorbance = np.minimum(-np.log1p(-np.minimum(alpha.astype(np.float64), 1 - 1e-16)), 10.0)
    v = view_z.astype(np.float64)
    z_all = 2 * np.log(v / v.min()) / np.log(v.max() / v.min()) - 1
    rows, known = np.zeros((len(v), 3 + moments)), np.full(len(v), np.nan)
    for start, end in zip(offsets[:-1].astype(int), offsets[1:].astype(int)):
        z, a, depth, n = z_all[start:end], absorbance[start:end], view_z[start:end], end - start
        for i in range(n):
            others = a.sum() - a[i]
            if depth[i] == depth.min() or others <= 1e-6 * a.sum():
                known[start + i] = 1.0
                continue
            if depth[i] == depth.max():
                known[start + i] = np.exp(-others)
                continue
            c, h = (z.min() + z.max()) / 2, (z.max() - z.min()) / 2
            x = np.delete((z - c) / h, i)
            mass = np.delete(a, i) / others
            own = (z[i] - c) / h
            if n <= 4:
                known[start + i] = np.exp(-others * mass[x < own].sum())
                continue
            row = [own, np.log2(n) / 3 - 1, np.log(others + 0.05)]
            for level in range(moments // 2):
                left = mass * (1 - x**2) ** level
                total = max(left.sum(), 1e-6)
                mean = (left * x).sum() / total
                spread = ((left * x**2).sum() / total - mean**2) / max(1 - mean**2, 1e-6)
                row += [mean, spread if level == 0 else np.sqrt(max(spread, 0))]
            rows[start + i] = row
    return rows.astype(np.float32), known, absorbance


def exact_transmittance(view_z, absorbance, offsets):
    """exp(-absorbance strictly nearer), pixel by pixel."""
    out = np.empty(len(view_z))
    for start, end in zip(offsets[:-1], offsets[1:]):
        v, a = view_z[start:end], absorbance[start:end]
        order = np.argsort(v, kind="stable")
        before = np.concatenate([[0.0], np.cumsum(a[order])])
        out[start:end] = np.exp(-before[np.searchsorted(v[order], v, side="left")])
    return out


def compare(name, found, expected, tolerance):
    """True where both have the same length, hold something, are finite, and differ nowhere by more than the tolerance."""
    found, expected = np.asarray(found, np.float64), np.asarray(expected, np.float64)
    if found.shape != expected.shape or found.size == 0:
        print(f"FAILED {name}: shapes {found.shape} and {expected.shape}")
        return False
    worst = np.max(np.abs(found - expected))
    good = bool(np.isfinite(worst) and worst <= tolerance)
    print(f"{'ok' if good else 'FAILED'} {name}: worst difference {worst:.2e}, tolerance {tolerance:.0e}, {found.size} numbers")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("model")
    parser.add_argument("fragments")
    parser.add_argument("--predicted")
    parser.add_argument("--onnx")
    parser.add_argument("--dataset")
    arguments = parser.parse_args()

    model, layers = read_model(arguments.model)
    lists = np.load(arguments.fragments)
    view_z, alpha, offsets = lists["view_z"], lists["alpha"], lists["offsets"]
    paper = model["feature_set"] == "paper"
    if paper:
        if "near" not in lists or "far" not in lists:
            raise SystemExit(f"{arguments.fragments}: no camera planes")
        features, absorbance = paper_features(view_z, alpha, offsets, float(lists["near"]), float(lists["far"]))
        known = np.full(len(view_z), np.nan)
    else:
        features, known, absorbance = recentred_features(view_z, alpha, offsets, len(model["features"]) - 3)
    asked = np.isnan(known)
    exact = exact_transmittance(view_z, absorbance, offsets)
    features = features[asked]
    reference = forward(model, layers, features, np.float64)
    single = forward(model, layers, features, np.float32)
    whole = known.copy()
    whole[asked] = reference
    sizes = "-".join(map(str, model["layer_sizes"]))
    print(f"{model['name']}, {sizes}: {len(view_z)} fragments, {np.sum(asked)} need the network, T-MSE {np.mean((whole - exact) ** 2):.4e}")

    # NumPy may round a moment's sum the other way; one ulp of a feature of 30 moves a logit by a few 1e-5.
    good = compare("f32 forward against f64", single, reference, 3e-5)
    order = [1, 0, *range(2, features.shape[1])]
    swapped = np.max(np.abs(forward(model, layers, features[:, order], np.float64) - reference))
    good &= bool(swapped > 3e-5)
    print(f"{'ok' if swapped > 3e-5 else 'FAILED'} control: with two features swapped T differs by {swapped:.2e}, which must exceed 3e-05")
    if arguments.predicted:
        predicted = np.load(arguments.predicted)
        if paper:
            good &= compare("nmt predict", predicted, whole, 5e-5)
        elif predicted.shape != whole.shape or not np.all(np.isfinite(predicted)):
            print("FAILED nmt predict: another shape, or not finite")
            good = False
        else:
            # A renderer's f32 moments, against features in f64: thin pixels lose digits, of the fifth and sixth moment more; all others agree.
            off = np.sort(np.abs(predicted - whole))
            bar, rare = (2e-3, 2e-3) if len(model["features"]) == 7 else (2e-2, 1e-2)
            most, share = off[int(0.99 * len(off))], np.mean(off > 0.02)
            fine = bool(most <= bar and share <= rare)
            print(f"{'ok' if fine else 'FAILED'} nmt predict: 99 % within {most:.1e} (at most {bar:.0e}), {share:.1e} of them beyond 0.02 (at most {rare:.0e})")
            good &= fine
    if arguments.onnx:
        import onnxruntime

        session = onnxruntime.InferenceSession(arguments.onnx, providers=["CPUExecutionProvider"])
        (answer,) = session.run(["transmittance"], {"features": features})
        good &= compare("onnxruntime", answer[:, 0], reference, 3e-5)
        names = session.get_modelmeta().custom_metadata_map["nmt.features"].split(",")
        good &= names == model["features"]
    if arguments.dataset:
        folder = pathlib.Path(arguments.dataset)
        parts = [{n: np.load(folder / f"{part}_{n}.npy") for n in ("features", "targets", "pixels")} for part in ("training", "validation")]
        rows, targets = (np.concatenate([part[n] for part in parts]) for n in ("features", "targets"))
        good &= compare("dataset features", rows, features, 1e-5)
        good &= compare("dataset targets", targets, exact[asked], 1e-7)
        pixel = np.concatenate([parts[0]["pixels"], parts[1]["pixels"] + parts[0]["pixels"][-1] + 1])
        good &= compare("dataset pixels", pixel, pixels_of(offsets), 0)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
