# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What Blender makes of a USD file: ``python blender_reader.py FILE OUT.npz FRAME...``; needs the wheel ``bpy``."""

import sys

import bpy  # loads an OpenUSD of its own, which does not go with usd-core in one process
import numpy as np


def numbers(values, attribute: str, width: int) -> np.ndarray:
    """Return an attribute of all items, shape (n, width)."""
    flat = np.zeros(len(values) * width, dtype=np.float32)
    values.foreach_get(attribute, flat)
    return flat.reshape(-1, width)


def mesh_arrays(item: bpy.types.Object, graph: bpy.types.Depsgraph) -> dict[str, np.ndarray]:
    """Return what one mesh is in the present frame."""
    evaluated = item.evaluated_get(graph)
    mesh = evaluated.to_mesh()
    arrays = {
        "points": numbers(mesh.vertices, "co", 3),
        "corners": numbers(mesh.loops, "vertex_index", 1).reshape(-1).astype(int),
        "normals": numbers(mesh.corner_normals, "vector", 3),
        "uvs": numbers(mesh.uv_layers[0].data, "uv", 2) if mesh.uv_layers else np.zeros((0, 2)),
        "materials": np.array([material.name for material in mesh.materials]),
        "colors": np.array([tuple(material.diffuse_color) for material in mesh.materials]),
    }
    velocity = mesh.attributes.get("velocity")
    arrays["velocities"] = np.zeros((0, 3)) if velocity is None else numbers(velocity.data, "vector", 3)
    evaluated.to_mesh_clear()
    return arrays


def main(path: str, out: str, *frames: str) -> None:
    """Import a file and keep the arrays of all meshes in some frames."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.wm.usd_import(filepath=path, import_guide=False)
    scene = bpy.context.scene
    found = {"fps": scene.render.fps, "range": (scene.frame_start, scene.frame_end)}
    for frame in map(int, frames):
        scene.frame_set(frame)
        graph = bpy.context.evaluated_depsgraph_get()
        for item in scene.objects:
            if item.type == "MESH":
                arrays = mesh_arrays(item, graph)
                found |= {f"{frame}/{item.name}/{key}": values for key, values in arrays.items()}
    found["kinds"] = np.array([item.type for item in scene.objects])
    np.savez(out, **found)


main(*sys.argv[1:])
