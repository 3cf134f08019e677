# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The arguments of ``add_cage_body``, all checked before anything is added."""

from __future__ import annotations

import warnings
from collections.abc import Collection, Mapping, Sequence

import newton
import numpy as np
import warp as wp

from ..cage import Cage
from ..elastic import Material
from ..geometry import as_flag, as_index, as_instance, as_length, as_number, as_numbers, shown
from ..harmonic import HarmonicCoordinates, check_options, chosen_walks
from ..surface import Surface
from .body.capacity import MOST, Capacity
from .body.contact_material import ContactMaterial

_FIRMEST = 1.0e15
"""Greatest value of a contact material."""


def as_surface(
    mesh: Surface | tuple[np.ndarray, np.ndarray] | newton.Mesh,
    *,
    weld: float | None = None,
    data: Mapping[str, object] | None = None,
) -> Surface:
    """The surface that a mesh is.

    Args:
        mesh: What was passed.
        weld: Distance up to which ends of open edges count as one [m]; None for the default.
        data: Arrays of its points, corners or triangles.

    Raises:
        TypeError: It is no mesh, or an array is not of numbers.
        ValueError: The mesh is wrong, an array does not fit it, or ``weld`` comes with a surface.
    """
    if isinstance(mesh, Surface):
        if weld is not None:
            raise ValueError("weld belongs to the mesh's surface: pass Surface(points, triangles, weld=...)")
        return mesh if data is None else mesh.with_data(data)
    if isinstance(mesh, newton.Mesh):
        points, triangles = np.asarray(mesh.vertices), np.asarray(mesh.indices).reshape(-1, 3)
        return Surface(points, triangles, uvs=mesh.uvs, normals=mesh.normals, weld=weld, data=data)
    if isinstance(mesh, tuple) and len(mesh) == 2:
        return Surface(*mesh, weld=weld, data=data)
    raise TypeError(f"mesh must be a Surface, a newton.Mesh or (points, triangles), got {type(mesh).__name__}")


def check_cuttable(surface: Surface) -> None:
    """Warn of what was done to a mesh so that it can be cut, and of what cuts will leave open.

    Args:
        surface: The surface of a body.

    Raises:
        ValueError: A sheet of it touches itself along an edge and cannot be cut.
    """
    surface.refuse_branches()
    if surface.notes:
        warnings.warn(f"the mesh of the body: {'; '.join(surface.notes)}", stacklevel=3)


def as_material(material: Material | None) -> Material:
    """The material, the default one for None.

    Args:
        material: What was passed.

    Raises:
        TypeError: It is none.
    """
    if material is None:
        return Material()
    return as_instance(material, Material, "material", hint="such as Material(young=1e5)")


def as_pose(xform: wp.transform | Sequence[float] | None) -> wp.transform:
    """The pose, with a rotation of length one; the identity for None.

    Args:
        xform: What was passed.

    Raises:
        TypeError: It is not seven numbers.
        ValueError: A number is not finite, or the quaternion is zero.
    """
    if xform is None:
        return wp.transform_identity()
    values = as_numbers(xform, "xform", 7, kind="a position and a quaternion, wp.transform(p, q)")
    length = float(np.linalg.norm(values[3:]))
    if length < 1.0e-6:
        raise ValueError("xform: the quaternion is zero; wp.quat_identity() turns nothing")
    return wp.transform(wp.vec3(*values[:3]), wp.quat(*(values[3:] / length)))


def as_velocity(velocity: Sequence[float]) -> np.ndarray:
    """A velocity, shape (3,) [m/s].

    Args:
        velocity: What was passed.

    Raises:
        TypeError: It is not three numbers.
        ValueError: A number is not finite.
    """
    return as_numbers(velocity, "velocity", 3, kind="three numbers [m/s]")


def as_fixed(fixed: np.ndarray | Sequence[int] | None, vertex_count: int) -> np.ndarray:
    """Which cage vertices are fixed, shape (vertex_count,), bool.

    Args:
        fixed: What was passed: indices, a mask, or None.
        vertex_count: Vertices of the cage.

    Raises:
        TypeError: It is neither indices nor a mask.
        ValueError: It names a vertex that is not there, or a mask has another length.
    """
    mask = np.zeros(vertex_count, dtype=bool)
    if fixed is None:
        return mask
    try:
        values = np.asarray(fixed)
    except ValueError:
        values = np.asarray(None)
    if values.dtype == bool:
        if values.shape != (vertex_count,):
            raise ValueError(f"the mask fixed must have the shape ({vertex_count},), got {values.shape}")
        return values.copy()
    if values.shape == (0,):
        return mask
    if not np.issubdtype(values.dtype, np.integer) or values.ndim != 1:
        raise TypeError(f"fixed must be indices of cage vertices or a mask over all {vertex_count}, got {shown(fixed)}")
    wrong = values[(values < 0) | (values >= vertex_count)]
    if wrong.size:
        raise ValueError(f"fixed names vertex {wrong.flat[0]}, but the cage has {vertex_count} vertices")
    mask[values] = True
    return mask


def as_walks(
    walks: int | str | None, error: float | None, cage: Cage, points: np.ndarray, seed: int, options: dict[str, object]
) -> int:
    """Walks a point, checked with the other options of the body's coordinates.

    Args:
        error: Wanted error of the weights, or None.
        cage: The cage.
        points: Points in it [m], shape (n, dimension).
        walks: What was passed; None for 256 on a CPU and 2048 (the paper's) on CUDA, or 0 of fitted weights.
        seed: Seed.
        options: Further keyword options of ``HarmonicCoordinates``.

    Raises:
        TypeError: There is no such option.
        ValueError: A value is out of its range.
    """
    if error is not None or isinstance(walks, str):
        check_options({"walks": 1, "seed": seed, **options}, "add_cage_body")
        tried = {name: value for name, value in options.items() if name != "bounds"}
        walks = chosen_walks(walks, error, HarmonicCoordinates, cage, points, tried)
    if walks is None and options.get("correction") == "fitted":
        walks = 0
    if walks is None:
        walks = 2048 if wp.get_device().is_cuda else 256
    check_options({"walks": walks, "seed": seed, **options}, "add_cage_body")
    return walks


def as_quadrature_count(quadrature: int | None, vertex_count: int) -> int:
    """Wanted number of quadrature points.

    Args:
        quadrature: What was passed; None for 8 a vertex, and at least 300.
        vertex_count: Vertices of the cage.

    Raises:
        TypeError: It is not a whole number.
        ValueError: It is negative.
    """
    if quadrature is None:
        return max(300, 8 * vertex_count)
    count = as_index(quadrature, "quadrature, the number of quadrature points,")
    if not 0 <= count <= MOST:
        raise ValueError(f"quadrature is a number of points up to {MOST}, 0 for a body without elasticity; got {count}")
    return count


def as_capacity(capacity: Capacity | None, cage: Cage, surface: Surface, *, cuttable: bool) -> Capacity:
    """Room for cuts that the body itself fits in.

    Args:
        capacity: What was passed; None for the default.
        cage: The cage.
        surface: The surface.
        cuttable: Whether the body can be cut.

    Raises:
        TypeError: It is no capacity.
        ValueError: The body does not fit.
    """
    if capacity is None:
        return Capacity.for_cuts(cage, surface) if cuttable else Capacity.without_cuts(cage, surface)
    as_instance(capacity, Capacity, "capacity", hint="Capacity.for_cuts(cage, surface, cuts=12) makes one")
    capacity.require(cage, surface)
    return capacity


def as_contact_radius(radius: float | None, cage: Cage, quadrature: int | None) -> float | None:
    """A radius of surface points [m]; None without contact.

    Args:
        radius: What was passed.
        cage: The cage.
        quadrature: Wanted number of quadrature points.

    Raises:
        TypeError: It is not a number.
        ValueError: It is not positive, or larger than the body, or nothing could push the body.
    """
    if radius is None:
        return None
    radius = as_length(radius, "contact_radius")
    if quadrature == 0:
        raise ValueError(
            "contact_radius was given with quadrature=0: a body without elasticity goes where its vertices are put, "
            "and nothing can push it; leave out one of the two"
        )
    if radius > cage.diameter:
        raise ValueError(
            f"contact_radius is that of the surface's points; {radius:g} m is more than the cage's size of "
            f"{cage.diameter:g} m"
        )
    return radius


def as_contact_material(radius: float | None, **values: float | None) -> ContactMaterial:
    """The contact material of a body.

    Args:
        radius: Its contact radius, as it was passed.
        values: What was passed for stiffness, damping and friction, by the arguments' names.

    Raises:
        TypeError: A value is not a number.
        ValueError: A value is negative or too large, the stiffness is zero, or there is no contact radius.
    """
    numbers = {}
    for name, value in values.items():
        numbers[name] = None if value is None else as_number(value, name)
        if value is not None and radius is None:
            raise ValueError(f"{name} is of no use without contact_radius; give both, or neither")
        if value is not None and not 0.0 <= numbers[name] <= _FIRMEST:
            raise ValueError(f"{name} must not be negative, and at most {_FIRMEST:g}; got {numbers[name]:g}")
    if numbers["contact_stiffness"] == 0.0:
        raise ValueError("contact_stiffness must be positive; leave contact_radius out for a body without contact")
    return ContactMaterial(numbers["contact_stiffness"], numbers["contact_damping"], numbers["friction"])


def as_touching(radius: float | None, cage: Cage, **flags: bool) -> dict[str, bool]:
    """What a body touches of itself.

    Args:
        radius: Its contact radius, as it was passed.
        cage: Its cage.
        flags: What was passed, by the arguments' names.

    Raises:
        TypeError: A value is no flag.
        ValueError: There is no contact radius, or the body is a plane one.
    """
    found = {name: as_flag(flag, name) for name, flag in flags.items()}
    for name in (name for name, flag in found.items() if flag):
        if radius is None:
            raise ValueError(f"{name} needs contact_radius: without, the surface has no particles that could touch")
        if cage.dimension == 2:
            raise ValueError(f"{name} is for solid bodies; a plane body touches shapes only")
    return found


def as_thickness(thickness: float | None, cage: Cage, surface: Surface) -> float | None:
    """Thickness of a plane body, None of a solid one [m]; refuses what is not of the cage's dimension.

    Args:
        thickness: What was passed.
        cage: The cage.
        surface: The surface.

    Raises:
        TypeError: It is not a number.
        ValueError: It is not positive, or of a solid body, or the mesh is not of the cage's dimension.
    """
    if surface.dimension != cage.dimension:
        raise ValueError(
            f"the cage is of dimension {cage.dimension} and the mesh of dimension {surface.dimension}; give mesh "
            f"points of {cage.dimension} numbers"
        )
    if cage.dimension == 3:
        if thickness is not None:
            raise ValueError(f"only a plane body has a thickness, and the cage is not plane; got thickness={thickness}")
        return None
    return 1.0 if thickness is None else as_length(thickness, "the thickness of a plane body")


def as_label(label: str | None, index: int, taken: Collection[str]) -> str:
    """The name of a body, which no other has.

    Args:
        label: What was passed; None for one made of the index.
        index: Number of the body.
        taken: Names of the bodies that are there.

    Raises:
        TypeError: It is no text.
        ValueError: It is empty, or another body has it.
    """
    if label is None:
        label = f"cage_body_{index}"
    if not isinstance(label, str):
        raise TypeError(f"label must be text, got {label!r}")
    if not label:
        raise ValueError("label is empty; leave it out for a name like cage_body_0")
    if label in taken:
        raise ValueError(f"there is a cage body {label!r} already; viewers and files tell bodies apart by their labels")
    return label
