# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""The plan of a scene that is named on the command line, as text."""

from __future__ import annotations

import gc
from collections import defaultdict
from collections.abc import Sequence

import newton
import warp as wp

from ..solver import PlanEntry, SolverCageCut
from .machine import chosen_device
from .scenes.building import build_of, built

_PACKAGE = __package__.split(".")[0]


def plan_text(scene: str, *, device: str | None = None, walks: int | None = None) -> str:
    """Build a scene, make one step, and say what it needs.

    Args:
        scene: Path of a script with ``build(builder)``, or the name of an example.
        device: Where to build it.
        walks: Walks a point of an example's bodies; its own by default.

    Raises:
        OSError: The script is not there.
        ValueError: There is no such scene or device, or it has no cage bodies.
    """
    wp.config.log_level = wp.LOG_WARNING
    with wp.ScopedDevice(chosen_device(device)) as where:
        solver = _stepped(build_of(scene, walks=walks))
        plan = solver.plan()
        kernels = loaded_kernels()
        name = where.alias
    return "\n".join([*_entry_lines(plan), "", _total_line(plan, name), *_kernel_lines(kernels)])


def loaded_kernels() -> dict[str, list[str]]:
    """Names of the kernels that are loaded, compiled now or found in Warp's cache, by the module they are in."""
    found = defaultdict(set)
    for kernel in (value for value in gc.get_objects() if isinstance(value, wp.Kernel)):
        module = kernel.func.__module__
        if module.split(".")[0] == _PACKAGE and kernel.module.execs:
            found[module].add(kernel.func.__name__)
    return {module: sorted(found[module]) for module in sorted(found)}


def _stepped(build: object) -> SolverCageCut:
    """The solver of a scene that has made a step, so that all that a step needs is there."""
    model = built(build).finalize()
    solver = SolverCageCut(model)
    state, other = model.state(), model.state()
    pipeline = newton.CollisionPipeline(model)
    contacts = pipeline.contacts()
    pipeline.collide(state, contacts)
    solver.step(state, other, None, contacts, 1.0 / 60.0)
    return solver


def _entry_lines(plan: Sequence[PlanEntry]) -> list[str]:
    """The entries, body by body; what was left out after what is on."""
    width = max(len(entry.feature) for entry in plan)
    lines, body = [], None
    for entry in sorted(plan, key=lambda entry: ([e.body for e in plan].index(entry.body), not entry.on)):
        if entry.body != body:
            body = entry.body
            lines += ["", body or "the whole scene"]
        size = (size_text(entry.byte_count) if entry.byte_count else "-") if entry.on else "left out"
        lines.append(f"  {entry.feature:<{width}}  {size:>9}  {entry.reason}")
    return lines[1:]


def _total_line(plan: Sequence[PlanEntry], device: str) -> str:
    room = sum(entry.byte_count for entry in plan if entry.feature == "room for cuts")
    total = sum(entry.byte_count for entry in plan)
    bodies = len({entry.body for entry in plan} - {""})
    noun = "body" if bodies == 1 else "bodies"
    return f"{size_text(total)} on {device} for {bodies} {noun}, of which {size_text(room)} is room for cuts"


def _kernel_lines(kernels: dict[str, list[str]]) -> list[str]:
    """The kernels, a line for each file."""
    count = sum(map(len, kernels.values()))
    lines = [f"{count} kernels were loaded for it, from {len(kernels)} files, Newton's own not counted:"]
    return lines + [f"  {module.removeprefix(f'{_PACKAGE}.')}: {', '.join(names)}" for module, names in kernels.items()]


def size_text(byte_count: int) -> str:
    """A number of bytes in three digits.

    Args:
        byte_count: The bytes.
    """
    for unit, scale in (("GB", 1e9), ("MB", 1e6), ("kB", 1e3)):
        if byte_count >= scale:
            return f"{byte_count / scale:.3g} {unit}"
    return f"{byte_count} B"
