#!/usr/bin/env python3
"""Training speed of `nmt` beside JAX, Keras and PyTorch: the same network on the same rows, by turns in one run.

    nmt generate configs/paper.toml --out target/dataset
    bench_peers.py target/dataset                          every peer that imports; the others are named
    bench_peers.py target/dataset --peers jax,torch --rounds 9 --json peers.json

The network is 7-32-16-1 (ReLU, sigmoid at the end), the loss the mean squared error, the optimiser Adam with step size 1e-3 and epsilon 1e-7, the batch 8192:
the recipe of Neural Moment Transparency. Every peer keeps all rows in memory and steps over whole batches in a fixed order; compilation and a first pass are not
timed. Each peer has a process of its own, since not all of them bear one another. A round gives each of them one turn of about as many seconds; the figures are
medians over the rounds.

`nmt` is taken from PATH, or from --nmt; the sgemm rate of NumPy's own library in the same rounds is a yardstick of the machine. Exit code 0, or 2 for wrong input.
"""

import argparse
import json
import os
import pathlib
import shlex
import statistics
import subprocess
import sys
import tempfile
import time

os.environ.setdefault("TF_CPP_MIN_LOG_LEVEL", "3")

try:
    import numpy as np
except ModuleNotFoundError:
    sys.exit("bench_peers: NumPy is needed; install it with: python3 -m pip install numpy")

HIDDEN = (32, 16)
RATE, BETA1, BETA2, EPSILON = 1e-3, 0.9, 0.999, 1e-7


def read_rows(folder, batch):
    """Whole batches of a dataset: features [N, W], targets [N, 1]."""
    manifest = json.loads((folder / "manifest.json").read_text())
    if manifest["target"] != "transmittance" or manifest["features"] != "paper":
        raise ValueError("its answers are no plain sigmoid; generate a dataset with features = \"paper\"")
    features, targets = np.load(folder / "training_features.npy"), np.load(folder / "training_targets.npy")
    n = len(targets) // batch * batch
    if n == 0:
        raise ValueError(f"{len(targets)} rows are fewer than a batch of {batch}")
    return np.ascontiguousarray(features[:n]), targets[:n, None].copy()


def weights(width):
    rng = np.random.default_rng(1)
    sizes = (width, *HIDDEN, 1)
    layers = []
    for i, o in zip(sizes, sizes[1:]):
        limit = np.sqrt(6 / (i + o))
        layers.append((rng.uniform(-limit, limit, (i, o)).astype(np.float32), np.zeros(o, np.float32)))
    return layers


# Each peer: a function of (features, targets, batch, threads) that returns a description and `epoch`, which passes once over all rows and returns the mean loss.


def jax_peer(features, targets, batch, threads):
    """One jitted scan over all steps of an epoch."""
    import jax
    import jax.numpy as jnp

    x = jnp.asarray(features.reshape(-1, batch, features.shape[1]))
    y = jnp.asarray(targets.reshape(-1, batch, 1))
    parameters = [(jnp.asarray(w), jnp.asarray(b)) for w, b in weights(features.shape[1])]

    def loss(parameters, x, y):
        for w, b in parameters[:-1]:
            x = jax.nn.relu(x @ w + b)
        w, b = parameters[-1]
        return jnp.mean((jax.nn.sigmoid(x @ w + b) - y) ** 2)

    def step(state, rows):
        parameters, m, v, t = state
        value, g = jax.value_and_grad(loss)(parameters, *rows)
        t = t + 1
        tree = jax.tree_util.tree_map
        m = tree(lambda m, g: BETA1 * m + (1 - BETA1) * g, m, g)
        v = tree(lambda v, g: BETA2 * v + (1 - BETA2) * g * g, v, g)
        scale = RATE * jnp.sqrt(1 - BETA2**t) / (1 - BETA1**t)
        parameters = tree(lambda p, m, v: p - scale * m / (jnp.sqrt(v) + EPSILON), parameters, m, v)
        return (parameters, m, v, t), value

    @jax.jit
    def scan(state, x, y):
        return jax.lax.scan(step, state, (x, y))

    zeros = jax.tree_util.tree_map(jnp.zeros_like, parameters)
    state = [(parameters, zeros, zeros, jnp.float32(0))]

    def epoch():
        state[0], losses = scan(state[0], x, y)
        return float(jnp.mean(losses))

    return f"jitted scan, jax {jax.__version__}", epoch


def keras_peer(features, targets, batch, threads):
    """`fit`, compiled by XLA where the backend can."""
    import keras

    sizes = [keras.layers.Dense(h, activation="relu") for h in HIDDEN]
    model = keras.Sequential([keras.Input((features.shape[1],)), *sizes, keras.layers.Dense(1, activation="sigmoid")])
    model.compile(optimizer=keras.optimizers.Adam(RATE, BETA1, BETA2, EPSILON), loss="mse", jit_compile=True)
    for layer, (w, b) in zip(model.layers, weights(features.shape[1])):
        layer.set_weights([w, b])

    def epoch():
        return model.fit(features, targets, batch_size=batch, shuffle=False, verbose=0).history["loss"][0]

    return f"fit, keras {keras.__version__} on {keras.backend.backend()}", epoch


def torch_peer(features, targets, batch, threads):
    """A loop over batches, eager."""
    import torch

    if threads:
        torch.set_num_threads(threads)
    layers = []
    for index, (w, b) in enumerate(weights(features.shape[1])):
        layer = torch.nn.Linear(*w.shape)
        with torch.no_grad():
            layer.weight.copy_(torch.from_numpy(w.T))
            layer.bias.copy_(torch.from_numpy(b))
        layers += [layer, torch.nn.ReLU() if index < len(HIDDEN) else torch.nn.Sigmoid()]
    model = torch.nn.Sequential(*layers)
    optimiser = torch.optim.Adam(model.parameters(), RATE, (BETA1, BETA2), EPSILON, fused=True)
    x = torch.from_numpy(features).split(batch)
    y = torch.from_numpy(targets).split(batch)

    def epoch():
        total = 0.0
        for a, b in zip(x, y):
            optimiser.zero_grad()
            loss = torch.nn.functional.mse_loss(model(a), b)
            loss.backward()
            optimiser.step()
            total += loss.detach()
        return float(total) / len(x)

    return f"eager loop, torch {torch.__version__}", epoch


PEERS = {"jax": jax_peer, "keras": keras_peer, "torch": torch_peer}


def work(name, features, targets, batch, threads, seconds):
    """The process of one peer: says what it is, then takes a turn for every line that it reads, and writes its samples a second."""
    what, epoch = PEERS[name](features, targets, batch, threads)
    first = epoch()
    start = time.perf_counter()
    last = epoch()
    count = max(1, round(seconds / (time.perf_counter() - start)))
    if not last < first:
        raise SystemExit(f"its loss went from {first:.3e} to {last:.3e}; it does not learn")
    print(json.dumps({"what": what, "epochs": count}), flush=True)
    for _ in sys.stdin:
        start = time.perf_counter()
        for _ in range(count):
            epoch()
        print(json.dumps(len(targets) * count / (time.perf_counter() - start)), flush=True)


class Peer:
    """The other end of `work`."""

    def __init__(self, name, arguments):
        self.name, self.raw = name, []
        command = [sys.executable, __file__, str(arguments.dataset), "--batch", str(arguments.batch), "--seconds", str(arguments.seconds)]
        command += ["--threads", str(arguments.threads), "--work", name]
        self.log = tempfile.TemporaryFile("w+")
        self.process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.log, text=True)
        if line := self.process.stdout.readline():
            self.what = json.loads(line)["what"]
            return
        self.process.wait()
        self.log.seek(0)
        reason = (self.log.read().strip().splitlines() or ["no word of why"])[-1]
        missing = reason.startswith("ModuleNotFoundError")
        self.what = "not installed" if missing else "failed"
        note(f"{name}: {self.what}: {reason}" + (f"; to compare with it: python3 -m pip install {name}" if missing else ""))

    def turn(self):
        if self.what in ("not installed", "failed"):
            return
        self.process.stdin.write("\n")
        self.process.stdin.flush()
        line = self.process.stdout.readline()
        if not line:
            raise SystemExit(f"bench_peers: {self.name}: ended amid the run")
        self.raw.append(json.loads(line))

    def end(self):
        self.process.stdin.close()
        self.process.wait()


class Ours:
    """`nmt bench train` on the same rows."""

    name, what = "nmt", "fused kernel"

    def __init__(self, arguments):
        self.arguments, self.raw = arguments, []

    def turn(self):
        a = self.arguments
        self.raw.append(nmt_rate(a.nmt, a.dataset, a.batch, a.seconds, a.threads))

    def end(self):
        pass


def note(text):
    print(f"bench_peers: {text}", file=sys.stderr, flush=True)


def nmt_rate(command, folder, batch, seconds, threads):
    """Samples a second of one turn of `nmt bench train` on the same rows."""
    arguments = ["bench", "train", "--backend", "fused", "--network", "7-32-16-1", "--dataset", str(folder), "--batch", str(batch)]
    arguments += ["--repeat", "1", "--sample-seconds", str(seconds), "--json", "--quiet"]
    arguments += ["--threads", str(threads)] if threads else []
    try:
        done = subprocess.run([*shlex.split(command), *arguments], capture_output=True, text=True)
    except OSError as error:
        raise SystemExit(f"bench_peers: {command}: {error.strerror}; build it with cargo build --release, and name it by --nmt")
    if done.returncode:
        raise SystemExit(f"bench_peers: {command}: {done.stderr.strip()}")
    (result,) = json.loads(done.stdout)["results"]
    return result["samples_per_second"]


def sgemm_rate(seconds, size=1024):
    """f32 matrix multiplication of NumPy's library [GFLOP/s]."""
    a = np.ones((size, size), np.float32)
    a @ a
    count, start = 0, time.perf_counter()
    while time.perf_counter() - start < seconds:
        a @ a
        count += 1
    return 2e-9 * size**3 * count / (time.perf_counter() - start)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], epilog=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dataset", type=pathlib.Path, help="folder that `nmt generate` wrote, with features = \"paper\"")
    parser.add_argument("--peers", default=",".join(PEERS), help="which, of " + ", ".join(PEERS))
    parser.add_argument("--nmt", default="nmt", help="command that runs nmt")
    parser.add_argument("--batch", type=int, default=8192)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--seconds", type=float, default=1.0, help="least time of a turn")
    parser.add_argument("--threads", type=int, default=0, help="of nmt and PyTorch; JAX and Keras take what XLA chooses")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="write the figures with their raw samples")
    parser.add_argument("--work", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    names = arguments.peers.split(",")
    if unknown := [name for name in names if name not in PEERS]:
        parser.error(f"--peers {unknown[0]}: not one of {', '.join(PEERS)}")
    if arguments.batch < 16 or arguments.batch % 16 or arguments.rounds < 1 or arguments.seconds <= 0:
        parser.error("--batch must be a multiple of 16, --rounds at least 1, --seconds greater than 0")
    try:
        features, targets = read_rows(arguments.dataset, arguments.batch)
    except (OSError, ValueError, KeyError) as error:
        parser.error(f"{arguments.dataset}: {error}")

    if arguments.work:
        return work(arguments.work, features, targets, arguments.batch, arguments.threads, arguments.seconds)

    rows = len(targets)
    peers = [Ours(arguments), *(Peer(name, arguments) for name in names)]
    gemm = []
    for done in range(arguments.rounds):
        for peer in peers:
            peer.turn()
        gemm.append(sgemm_rate(min(arguments.seconds, 0.3)))
        note(f"round {done + 1} of {arguments.rounds}")
    for peer in peers:
        peer.end()

    ours = statistics.median(peers[0].raw)
    results = []
    print(f"{'peer':<8}  {'samples/s':>10}  {'min':>10}  {'max':>10}  {'of ours':>8}  what")
    for peer in peers:
        raw = peer.raw
        median = statistics.median(raw) if raw else None
        rates = [f"{f(raw) / 1e6:.2f} M" if raw else "-" for f in (statistics.median, min, max)]
        ratio = f"{median / ours:.3f}" if raw else "-"
        print(f"{peer.name:<8}  {rates[0]:>10}  {rates[1]:>10}  {rates[2]:>10}  {ratio:>8}  {peer.what}")
        ratio = median / ours if raw else None
        results.append({"peer": peer.name, "what": peer.what, "samples_per_second": median, "ratio_to_ours": ratio, "raw_samples_per_second": raw})
        if raw and max(raw) > 1.5 * min(raw):
            note(f"warning: {peer.name}: rounds differ by {max(raw) / min(raw):.1f}; stop what else runs, or try --rounds {3 * arguments.rounds}")
    print(f"7-32-16-1, {rows} rows, batch {arguments.batch}, medians of {arguments.rounds} rounds; sgemm of NumPy {statistics.median(gemm):.0f} GFLOP/s")
    if arguments.json:
        report = {"network": "7-32-16-1", "rows": rows, "batch": arguments.batch, "sgemm_gflops": statistics.median(gemm), "results": results}
        arguments.json.write_text(json.dumps(report, indent=2) + "\n")


if __name__ == "__main__":
    main()
