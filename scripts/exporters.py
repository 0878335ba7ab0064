#!/usr/bin/env python3
"""Writes files with public exporters, reads each with `nmt scene`, and prints a table of what came of it.

    python3 -m venv target/exporters
    target/exporters/bin/pip install numpy pillow trimesh pygltflib plyfile OpenEXR open3d
    target/exporters/bin/python scripts/exporters.py target/release/nmt

A file that ends other than expected fails the script: exit code 1.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR
import pygltflib
import trimesh
from PIL import Image
from plyfile import PlyData, PlyElement
from trimesh.visual import ColorVisuals, TextureVisuals
from trimesh.visual.material import PBRMaterial, SimpleMaterial

try:
    import open3d
except ImportError:
    open3d = None

RNG = np.random.default_rng(1)


def checkered():
    """A picture whose alpha is 200 and 50 in turn."""
    pixels = np.full((8, 8, 4), 255, np.uint8)
    pixels[..., 3] = np.where(np.indices((8, 8)).sum(0) % 2 == 0, 200, 50)
    return Image.fromarray(pixels)


def box(material):
    mesh = trimesh.creation.box((1, 1, 1))
    mesh.visual = TextureVisuals(uv=RNG.random((len(mesh.vertices), 2)), material=material)
    return mesh


def trimesh_obj(path):
    box(SimpleMaterial(image=checkered(), diffuse=[255, 0, 0, 128])).export(path)


def trimesh_vertex_colours(path):
    mesh = trimesh.creation.icosphere(2)
    colours = np.tile([0, 255, 0, 100], (len(mesh.vertices), 1)).astype(np.uint8)
    mesh.visual = ColorVisuals(mesh, vertex_colors=colours)
    mesh.export(path)


def trimesh_blend(path):
    box(PBRMaterial(name="leaf", baseColorTexture=checkered(), alphaMode="BLEND", doubleSided=True)).export(path)


def trimesh_mask(path):
    mesh = box(PBRMaterial(name="cut", baseColorTexture=checkered(), alphaMode="MASK", alphaCutoff=0.5))
    for name, content in trimesh.exchange.gltf.export_gltf(trimesh.Scene(mesh)).items():
        (path if name.endswith(".gltf") else path.parent / name).write_bytes(content)


def trimesh_scene(path):
    trimesh.Scene([trimesh.creation.box((1, 1, 1)), trimesh.creation.cylinder(0.3, 2)]).export(path)


def trimesh_ply(path):
    trimesh.creation.box().export(path)


def pygltflib_quantised(path):
    """A quantised pane with a transmission that alpha does not say."""
    corners = np.array([[-127, -127, 0, 0], [127, -127, 0, 0], [127, 127, 0, 0], [-127, 127, 0, 0]], np.int8)
    indices = np.array([0, 1, 2, 0, 2, 3], np.uint16)
    blob = corners.tobytes() + indices.tobytes()
    primitive = pygltflib.Primitive(attributes=pygltflib.Attributes(POSITION=0), indices=1, material=0)
    transmission = {"KHR_materials_transmission": {"transmissionFactor": 0.8}}
    gltf = pygltflib.GLTF2(
        scene=0,
        scenes=[pygltflib.Scene(nodes=[0])],
        nodes=[pygltflib.Node(mesh=0)],
        meshes=[pygltflib.Mesh(primitives=[primitive])],
        materials=[pygltflib.Material(name="pane", extensions=transmission)],
        accessors=[
            pygltflib.Accessor(bufferView=0, componentType=5120, normalized=True, count=4, type="VEC3"),
            pygltflib.Accessor(bufferView=1, componentType=5123, count=6, type="SCALAR"),
        ],
        bufferViews=[
            pygltflib.BufferView(buffer=0, byteOffset=0, byteLength=16, byteStride=4, target=34962),
            pygltflib.BufferView(buffer=0, byteOffset=16, byteLength=12, target=34963),
        ],
        buffers=[pygltflib.Buffer(byteLength=len(blob))],
        extensionsUsed=["KHR_mesh_quantization", "KHR_materials_transmission"],
        extensionsRequired=["KHR_mesh_quantization"],
    )
    gltf.set_binary_blob(blob)
    gltf.save_binary(path)


def splats(n):
    """So many splats on a sphere, with all columns of the INRIA program."""
    names = [*"xyz", "nx", "ny", "nz", *(f"f_dc_{i}" for i in range(3)), *(f"f_rest_{i}" for i in range(45))]
    names += ["opacity", *(f"scale_{i}" for i in range(3)), *(f"rot_{i}" for i in range(4))]
    table = np.zeros(n, dtype=[(name, "f4") for name in names])
    places = RNG.normal(size=(n, 3))
    for name, column in zip("xyz", (places / np.linalg.norm(places, axis=1)[:, None]).T):
        table[name] = column
    for name in names[6:9] + names[-4:]:
        table[name] = RNG.normal(size=n)
    for i in range(3):
        table[f"scale_{i}"] = RNG.normal(-3, 0.4, n)
    table["opacity"] = RNG.normal(0, 2, n)
    return PlyElement.describe(table, "vertex")


def plyfile_splats(path):
    PlyData([splats(2000)]).write(path)


def plyfile_ascii(path):
    PlyData([splats(300)], text=True).write(path)


def deep(shift=0.0):
    """Channels of a deep picture of 24 x 18 with up to four samples a pixel, green beyond 1."""
    kinds = {"Z": "f4", "A": "f2", "R": "f2", "G": "f2", "B": "f2"}
    channels = {name: np.empty((18, 24), object) for name in kinds}
    for y in range(18):
        for x in range(24):
            k = np.arange((x + y) % 5)
            alpha = (k + 1) / 6
            values = {"Z": 1 + shift + k + x / 8, "A": alpha, "R": alpha / 2, "G": alpha * 3, "B": alpha / 10}
            for name, kind in kinds.items():
                channels[name][y, x] = values[name].astype(kind) if len(k) else None
    return channels


def openexr_parts(path):
    def part(compression, name, shift):
        return OpenEXR.Part({"type": OpenEXR.deepscanline, "compression": compression}, deep(shift), name)

    left = part(OpenEXR.ZIPS_COMPRESSION, "left", 0.0)
    OpenEXR.File([left, part(OpenEXR.RLE_COMPRESSION, "right", 2.0)]).write(str(path))


def openexr_windows(path):
    window = (np.array([-5, -4], np.int32), np.array([18, 13], np.int32))
    display = (np.array([0, 0], np.int32), np.array([31, 31], np.int32))
    header = {"type": OpenEXR.deepscanline, "compression": OpenEXR.ZIPS_COMPRESSION}
    OpenEXR.File({**header, "dataWindow": window, "displayWindow": display}, deep()).write(str(path))


def torus():
    mesh = open3d.geometry.TriangleMesh.create_torus()
    mesh.paint_uniform_color([0.2, 0.5, 0.9])
    mesh.compute_vertex_normals()
    return mesh


def open3d_mesh(path):
    open3d.io.write_triangle_mesh(str(path), torus())


def open3d_points(path):
    open3d.io.write_point_cloud(str(path), torus().sample_points_uniformly(500))


# File, who writes it, and whether it is read.
FILES = [
    ("trimesh-textured.obj", trimesh_obj, True),
    ("trimesh-vertex-colours.glb", trimesh_vertex_colours, True),
    ("trimesh-blend.glb", trimesh_blend, True),
    ("trimesh-mask.gltf", trimesh_mask, True),
    ("trimesh-scene.glb", trimesh_scene, True),
    ("trimesh-mesh.ply", trimesh_ply, False),
    ("pygltflib-quantised.glb", pygltflib_quantised, True),
    ("plyfile-splats.ply", plyfile_splats, True),
    ("plyfile-splats-ascii.ply", plyfile_ascii, True),
    ("openexr-parts.exr", openexr_parts, True),
    ("openexr-windows.exr", openexr_windows, True),
    ("open3d-torus.obj", open3d_mesh, True),
    ("open3d-torus.glb", open3d_mesh, True),
    ("open3d-torus.gltf", open3d_mesh, True),
    ("open3d-points.ply", open3d_points, False),
]


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    unexpected = 0
    print("| file | fragments | most in a pixel | left out, or why it is refused |\n|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for name, write, is_read in FILES:
            if open3d is None and name.startswith("open3d"):
                print(f"| `{name}` | | | skipped: open3d is not installed |")
                continue
            folder_of_file = Path(folder) / Path(name).stem
            folder_of_file.mkdir(exist_ok=True)
            path = folder_of_file / name
            write(path)
            command = [sys.argv[1], "scene", path, "--out", folder_of_file / "fragments.npz", "--force", "--json"]
            done = subprocess.run(command, capture_output=True, text=True, check=False)
            found = json.loads(done.stdout)
            if (done.returncode == 0) != is_read:
                unexpected += 1
            if done.returncode:
                why = found["error"].replace(str(folder_of_file) + "/", "")
                print(f"| `{name}` | | | {why} |")
                continue
            left_out = "; ".join(f"{l['what']} ({l['count']})" for l in found["left_out"])
            result = found["results"][0]
            print(f"| `{name}` | {result['fragments']} | {result['depth_complexity']} | {left_out} |")
    if unexpected:
        sys.exit(f"{unexpected} files ended other than expected")


if __name__ == "__main__":
    main()
