# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Every argument of every public call, given values that it may not have: named, in words, and nothing has changed."""

from __future__ import annotations

import pytest

from bad_values import VALUES, complaint
from call_world import World
from public_calls import CALLS


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
