"""Files what scripts/bench-gpu measured under the adapter's name, and makes a table of it.

    bench_gpu_table.py RAW OUT        RAW: a folder of methods-SCENE-WxH.json and frames-SCENE-WxH.json; OUT: data/bench
"""

import json
import pathlib
import re
import shutil
import sys

SOFTWARE = re.compile("llvmpipe|lavapipe|swiftshader|softpipe|basic render|warp", re.IGNORECASE)


def runs(raw):
    """Results by kind, scene and size, in the order of the files' names."""
    found = {}
    for path in sorted(raw.glob("*.json")):
        kind, scene, size = re.fullmatch(r"(methods|frames)-(.+)-(\d+x\d+)", path.stem).groups()
        found[kind, scene, size] = json.loads(path.read_text())
    if not found:
        sys.exit(f"{raw} holds no measurements")
    return found


def adapter_of(found):
    """The one adapter that all results name."""
    names = {result["adapter"] for run in found.values() for result in run["results"]}
    if len(names) != 1:
        sys.exit(f"one adapter is expected, found {sorted(names)}")
    return names.pop()


def milliseconds(seconds):
    return "-" if seconds is None else f"{1e3 * seconds:.3g}"


def table(found, adapter):
    """Markdown: a table a scene and kind of passes, two columns a size."""
    first = next(iter(found.values()))
    machine = first["machine"]
    lines = [f"# {adapter}", ""]
    if SOFTWARE.search(adapter):
        lines += ["**A software adapter: it runs on the CPU, and its times are no graphics card's.**", ""]
    lines += [
        f"{machine['cpu']}, {machine['os']}, nmt {first['version']}. Medians in milliseconds; raw samples lie beside",
        "this file. Made by `scripts/bench-gpu`.",
        "",
    ]
    sizes = sorted({size for _, _, size in found}, key=lambda size: int(size.split("x")[0]))
    head = [f"{size}: pass {number}" for size in sizes for number in (1, 2)]
    for scene in dict.fromkeys(scene for _, scene, _ in found):
        rows = {}
        for size in sizes:
            for result in found["methods", scene, size]["results"]:
                key = result["method"]
                cells, _ = rows.setdefault(key, ({}, result))
                cells[size] = (result["seconds_accumulate"], result["seconds_weights"])
        lines += [f"## {scene}, passes in compute shaders", ""]
        lines += [f"| method | bits/pixel | image MSE x 1e-4 | {' | '.join(head)} |", "|" + "---|" * (3 + len(head))]
        for method, (cells, result) in rows.items():
            times = [milliseconds(t) for size in sizes for t in cells.get(size, (None, None))]
            mse = result["image_mse"]
            error = "-" if mse is None else f"{1e4 * mse:.3f}"
            lines.append(f"| `{method}` | {result.get('bits_per_pixel') or '-'} | {error} | {' | '.join(times)} |")
        lines.append("")
        rows = {}
        for size in sizes:
            for result in found["frames", scene, size]["results"]:
                key = (result["method"], result["passes"], result["skip"])
                rows.setdefault(key, {})[size] = (result["seconds_accumulate"], result["seconds_weights"])
        lines += [f"## {scene}, whole frames", ""]
        lines += [f"| network | passes | skip | {' | '.join(head)} |", "|" + "---|" * (3 + len(head))]
        for (method, passes, skip), cells in rows.items():
            times = [milliseconds(t) for size in sizes for t in cells.get(size, (None, None))]
            lines.append(f"| `{method}` | {passes} | {skip} | {' | '.join(times)} |")
        lines.append("")
    return "\n".join(lines)


def main():
    raw, out = map(pathlib.Path, sys.argv[1:])
    found = runs(raw)
    adapter = adapter_of(found)
    folder = out / re.sub(r"[^a-z0-9]+", "-", adapter.lower()).strip("-")
    folder.mkdir(parents=True, exist_ok=True)
    for path in raw.glob("*.json"):
        shutil.copy(path, folder / path.name)
    text = table(found, adapter)
    (folder / "table.md").write_text(text)
    print(text)
    print(f"written to {folder}", file=sys.stderr)


if __name__ == "__main__":
    main()
