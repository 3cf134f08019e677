# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""What trimesh reads for us: STL and glTF, whose faces are triangles anyway."""

from __future__ import annotations

import json
import struct
from io import BytesIO
from pathlib import Path
from types import ModuleType

import numpy as np

from .file_mesh import FileMesh

_MAGIC, _JSON_CHUNK = b"glTF", 0x4E4F534A
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
_KEPT = {"TEXCOORD_0": "_CAGECUT_UVS", "NORMAL": "_CAGECUT_NORMALS"}
"""Attributes that get a second name, under which trimesh hands them on as they are, with or without a material."""


def read_stl(path: Path) -> list[FileMesh]:
    """Read an STL file, in text or binary; its triangles share no points.

    Args:
        path: The file.

    Raises:
        ImportError: The extra is not installed.
        ValueError: The file cannot be read, or is cut short.
    """
    data = path.read_bytes()
    promised = int.from_bytes(data[80:84], "little") if len(data) >= 84 else 0
    if data.lstrip()[:5].lower() != b"solid" or len(data) == 84 + 50 * promised:
        if len(data) < 84 + 50 * promised or len(data) < 84:
            held = max(len(data) - 84, 0) // 50
            raise ValueError(f"{path} is cut short or no STL: it promises {promised} triangles and holds {held}")
    elif b"endsolid" not in data.lower():
        raise ValueError(f"{path} is cut short: it does not end with endsolid")
    scene = _load(path, data, "stl")
    return [_triangles(path.stem, geometry) for geometry in scene.geometry.values() if _is_mesh(geometry)]


def read_gltf(path: Path) -> list[FileMesh]:
    """Read the meshes of glTF's scene, one for each primitive and place of a mesh, in the scene's space.

    Args:
        path: The file, ``.gltf`` or ``.glb``.

    Raises:
        ImportError: The extra is not installed.
        ValueError: The file cannot be read, is cut short or compressed, or places no mesh.
    """
    content, rest = _gltf_content(path)
    used = {name for name in content.get("extensionsRequired", []) if name in _COMPRESSED}
    if used:
        raise ValueError(f"{path} is compressed ({', '.join(sorted(used))}); export it without compression")
    if not content.get("meshes"):
        raise ValueError(f"{path} has no meshes")
    names = [str(mesh.get("name", f"mesh{i}")) for i, mesh in enumerate(content["meshes"])]
    for i, node in enumerate(content.get("nodes", [])):
        node["name"] = f"{i:09d}"
    for i, mesh in enumerate(content["meshes"]):
        mesh["name"] = f"{i}#"
        for primitive in mesh.get("primitives", []):
            attributes = primitive.get("attributes", {})
            attributes.update({_KEPT[key]: attributes[key] for key in _KEPT if key in attributes})
    suffix = path.suffix.lower()
    scene = _load(path, _gltf_bytes(content, rest), suffix[1:], skip_materials=True)
    found = []
    places = [(*scene.graph[node], node) for node in scene.graph.nodes_geometry]  # of a set: in any order
    for transform, key, _ in sorted(places, key=lambda place: (*_key_order(place[1]), place[2])):
        if _is_mesh(scene.geometry[key]):
            mesh = _triangles(names[int(key.split("#")[0])], scene.geometry[key])
            found.append(_placed(path, mesh, np.asarray(transform, dtype=np.float64)))
    if not found:
        raise ValueError(f"{path} has {len(names)} meshes, but its scene shows no triangles of them")
    return found


def _key_order(key: str) -> tuple[int, int, str]:
    """The place of a primitive among all: the number of its mesh, then its own, of keys such as ``12#_3``."""
    number, own = key.split("#")
    return int(number), len(own), own


def _placed(path: Path, mesh: FileMesh, transform: np.ndarray) -> FileMesh:
    """A mesh in the space of the scene, turned over where that mirrors it."""
    linear = transform[:3, :3]
    determinant = np.linalg.det(linear)
    if abs(determinant) <= 1e-12 * np.prod(np.linalg.norm(linear, axis=0)):
        raise ValueError(f"{path}: a node of mesh {mesh.name!r}, or one above it, has a scale of zero")
    normals = None if mesh.normals is None else mesh.normals @ np.linalg.inv(linear)
    points = mesh.points @ linear.T + transform[:3, 3]
    placed = FileMesh(mesh.name, points, mesh.counts, mesh.indices, mesh.uvs, normals)
    return placed.reversed() if determinant < 0.0 else placed


def _gltf_content(path: Path) -> tuple[dict, bytes]:
    """The JSON of a glTF file, and in the binary form what follows it."""
    data, rest = path.read_bytes(), b""
    if path.suffix.lower() == ".glb":
        if len(data) < 20 or data[:4] != _MAGIC:
            raise ValueError(f"{path} is cut short or no binary glTF")
        length, size, kind = *struct.unpack("<I", data[8:12]), *struct.unpack("<II", data[12:20])
        if len(data) < length or len(data) < 20 + size or kind != _JSON_CHUNK:
            raise ValueError(f"{path} is cut short: it promises {length} bytes and holds {len(data)}")
        data, rest = data[20 : 20 + size], data[20 + size : length]
    try:
        content = json.loads(data)
    except ValueError:
        content = None
    if not isinstance(content, dict) or "asset" not in content:
        raise ValueError(f"{path} cannot be read as glTF: its JSON is damaged or cut short")
    return content, rest if path.suffix.lower() == ".glb" else None


def _gltf_bytes(content: dict, rest: bytes | None) -> bytes:
    """A glTF file of JSON, in the binary form where something follows it."""
    text = json.dumps(content).encode()
    if rest is None:
        return text
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", _MAGIC, 2, 20 + len(text) + len(rest), len(text), _JSON_CHUNK)
    return head + text + rest


def _triangles(name: str, geometry: object) -> FileMesh:
    """A mesh of trimesh's, in the units of its file."""
    faces = np.asarray(geometry.faces, dtype=np.int64)
    points = np.array(geometry.vertices, dtype=np.float64)
    uvs, normals = (_attribute(geometry, _KEPT[key]) for key in ("TEXCOORD_0", "NORMAL"))
    if uvs is not None:
        uvs = uvs * [1.0, -1.0] + [0.0, 1.0]  # glTF counts from the top
    return FileMesh(name, points, np.full(len(faces), 3), faces.reshape(-1), uvs, normals)


def _attribute(geometry: object, name: str) -> np.ndarray | None:
    values = geometry.vertex_attributes.get(name)
    return None if values is None or len(values) != len(geometry.vertices) else np.array(values, dtype=np.float64)


def _is_mesh(geometry: object) -> bool:
    return isinstance(geometry, _import_trimesh().Trimesh)


def _load(path: Path, data: bytes, kind: str, **options: object) -> object:
    """A scene of trimesh's; its failures are one line that says nothing of it."""
    trimesh = _import_trimesh()
    resolver = trimesh.resolvers.FilePathResolver(str(path.resolve()))
    try:
        return trimesh.load_scene(BytesIO(data), file_type=kind, resolver=resolver, process=False, **options)
    except Exception:
        text = "it, or a file that it names, is damaged, cut short or missing"
        raise ValueError(f"{path} cannot be read as {path.suffix[1:]}: {text}") from None


def _import_trimesh() -> ModuleType:
    """Return the module ``trimesh``.

    Raises:
        ImportError: The extra is not installed; the text says how to.
    """
    try:
        import trimesh
    except ImportError as error:
        raise ImportError(
            f"STL and glTF are read with trimesh, which cannot be imported ({error}); "
            "install it with: pip install 'newton_cagecut[files]'"
        ) from error
    return trimesh
