# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Every argument of every public call, given values that it may not have: named, in words, and nothing has changed."""

from __future__ import annotations

import inspect

import pytest

import newton_cagecut as cagecut
from bad_values import VALUES, complaint
from call_world import World
from public_calls import CALLS

MADE_BY_THE_LIBRARY = ("BodyPiece", "BodySnapshot", "CageEdit", "CutReport", "PlanEntry", "UpdateStats")
ELSEWHERE = ("add_usd",)
"""Calls whose arguments are files, of which tests of their own try what can be wrong in them."""
HANDED_OUT = ("BodyCut", "CageBody")
"""Classes of which users only call methods."""


@pytest.mark.parametrize("name", CALLS)
def test_every_wrong_argument_is_named(name: str, tmp_path, monkeypatch):
    """Each is refused by the library's own error, which names the argument; the right ones are taken after that."""
    monkeypatch.chdir(tmp_path)
    call, world = CALLS[name], World(tmp_path)
    function, right = call.function(world), call.arguments(world)
    before, faults = world.digest(), []
    for argument in right:
        good = call.good.get(argument, ())
        for what, value in VALUES.items():
            if what in good:
                continue
            found = "was taken"
            try:
                function(**{**right, argument: value})
            except Exception as error:
                found = complaint(error, (argument, *call.names.get(argument, ())))
                found = found and f"{found}: {type(error).__name__}: {error}"
            if found:
                faults.append(f"{argument} = {what}: {found}")
                if found == "was taken":
                    world = World(tmp_path)
                    function, right = call.function(world), call.arguments(world)
                    before = world.digest()
    assert not faults, f"{name}, {len(faults)} faults:\n" + "\n".join(faults)
    assert world.digest() == before
    function(**right)


def test_every_public_call_is_tried():
    """Every public class that is made, and each of its public methods with arguments, is in the list of calls."""
    missing = []
    for name in cagecut.__all__:
        found = getattr(cagecut, name)
        if not callable(found) or name in (*MADE_BY_THE_LIBRARY, *ELSEWHERE):
            continue
        missing += [name] if name not in CALLS and name not in HANDED_OUT else []
        for method, function in vars(found).items() if isinstance(found, type) else ():
            function = getattr(function, "__func__", function)
            if method.startswith("_") or not inspect.isfunction(function):
                continue
            arguments = [key for key in inspect.signature(function).parameters if key not in ("self", "cls", "journal")]
            if arguments and f"{name}.{method}" not in CALLS:
                missing.append(f"{name}.{method}")
    assert missing == []
