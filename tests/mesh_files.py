# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Writes small mesh files of every format, for tests of the readers."""

from __future__ import annotations

import json
import struct
from pathlib import Path

import numpy as np

from newton_cagecut.usd import write_mesh

BOX = np.array([[x, y, z] for z in (0.0, 1.0) for y in (0.0, 2.0) for x in (0.0, 3.0)])
QUADS = ((0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (1, 3, 7, 5), (3, 2, 6, 7), (2, 0, 4, 6))
TRIANGLES = np.array([(a, b, c) for p, q, r, s in QUADS for a, b, c in ((p, q, r), (p, r, s))])
UVS = BOX[:, :2] / 4.0
NORMALS = (BOX - BOX.mean(axis=0)) / np.linalg.norm(BOX - BOX.mean(axis=0), axis=1)[:, None]


def write_obj(path: Path) -> None:
    """Quads with texture coordinates and normals of the points."""
    rows = [
        f"{key} {' '.join(map(str, row))}" for key, table in (("v", BOX), ("vt", UVS), ("vn", NORMALS)) for row in table
    ]
    rows += ["f " + " ".join(f"{v + 1}/{v + 1}/{v + 1}" for v in face) for face in QUADS]
    path.write_text("# a box\nmtllib none.mtl\n" + "\n".join(rows) + "\n")


def write_off(path: Path) -> None:
    """Quads with texture coordinates and normals of the points."""
    table = np.column_stack([BOX, NORMALS, UVS]).tolist()
    rows = [*(" ".join(map(str, row)) for row in table), *(f"4 {' '.join(map(str, face))} 255 0 0" for face in QUADS)]
    path.write_text("STNOFF  # a box\n\n8 6 12\n" + "\n".join(rows))


def write_ply(path: Path, *, order: str = "binary_little_endian", faces: tuple = QUADS) -> None:
    """Polygons with texture coordinates and normals of the points."""
    names = ("x", "y", "z", "nx", "ny", "nz", "s", "t")
    header = ["ply", f"format {order} 1.0", "element vertex 8", *(f"property double {name}" for name in names)]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    table = np.column_stack([BOX, NORMALS, UVS])
    if order == "ascii":
        body = "\n".join(" ".join(map(str, row)) for row in [*table.tolist(), *((len(f), *f) for f in faces)]).encode()
    else:
        sign = "<" if "little" in order else ">"
        body = table.astype(f"{sign}f8").tobytes()
        body += b"".join(struct.pack(f"{sign}B{len(face)}i", len(face), *face) for face in faces)
    path.write_bytes("\n".join(header).encode() + b"\n" + body)


def write_stl(path: Path, *, text: bool = False) -> None:
    """Triangles of the box."""
    if text:
        corner = "\n".join
        facets = (corner(f"vertex {x} {y} {z}" for x, y, z in BOX[t].tolist()) for t in TRIANGLES)
        path.write_text(
            "solid box\n"
            + "".join(f"facet normal 0 0 0\nouter loop\n{f}\nendloop\nendfacet\n" for f in facets)
            + "endsolid box\n"
        )
        return
    rows = np.zeros(len(TRIANGLES), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")])
    rows["corners"] = BOX[TRIANGLES]
    path.write_bytes(b"solid in name only".ljust(80) + struct.pack("<I", len(rows)) + rows.tobytes())


def write_usd(path: Path) -> None:
    """Quads with texture coordinates of the points, in centimetres."""
    write_mesh(path, BOX, QUADS, uvs=UVS, name="box", meters_per_unit=0.01)


def gltf_box(*, nodes: list[dict] | None = None, names: tuple[str, ...] = ("box",)) -> tuple[dict, bytes]:
    """A scene of boxes and its buffer; texture coordinates count from the top, as glTF has them."""
    parts = [BOX.astype("<f4"), NORMALS.astype("<f4"), (UVS * [1, -1] + [0, 1]).astype("<f4"), TRIANGLES.astype("<u2")]
    data = b"".join(part.tobytes() for part in parts)
    starts = np.cumsum([0] + [part.nbytes for part in parts]).tolist()
    kinds = [("VEC3", 5126, 8), ("VEC3", 5126, 8), ("VEC2", 5126, 8), ("SCALAR", 5123, TRIANGLES.size)]
    bounds = {"min": [0, 0, 0], "max": [3, 2, 1]}
    primitive = {"attributes": {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3}
    nodes = nodes or [{"mesh": i} for i in range(len(names))]
    return {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": list(range(len(nodes)))}],
        "nodes": nodes,
        "meshes": [{"name": name, "primitives": [primitive]} for name in names],
        "buffers": [{"byteLength": len(data)}],
        "bufferViews": [
            {"buffer": 0, "byteOffset": start, "byteLength": part.nbytes} for start, part in zip(starts, parts)
        ],
        "accessors": [
            {"bufferView": i, "componentType": component, "count": count, "type": kind, **(bounds if i == 0 else {})}
            for i, (kind, component, count) in enumerate(kinds)
        ],
    }, data


def write_gltf(path: Path, content: dict, data: bytes) -> None:
    """A scene with its buffer in a file beside it."""
    path.with_suffix(".bin").write_bytes(data)
    buffers = [{**buffer, "uri": path.with_suffix(".bin").name} for buffer in content["buffers"]]
    path.write_text(json.dumps({**content, "buffers": buffers}))


def write_glb(path: Path, content: dict, data: bytes) -> None:
    """A scene with its buffer in one binary file."""
    text = json.dumps(content).encode()
    text += b" " * (-len(text) % 4)
    data += b"\0" * (-len(data) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(data), len(text), 0x4E4F534A)
    path.write_bytes(head + text + struct.pack("<II", len(data), 0x004E4942) + data)
