# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The face of the package: its public names, its version and what stands around it."""

import ast
import importlib
import inspect
import re
import tomllib
import warnings
from importlib import resources

import newton
import pytest

import newton_cagecut
import newton_cagecut.solver
from import_graph import PACKAGE, ROOT, imports_of, public_names
from newton_cagecut.solver.newton_version import warn_if_untested

NAMES = [name for name in newton_cagecut.__all__ if name != "__version__"]


@pytest.mark.parametrize("name", NAMES)
def test_public_names(name: str):
    """Every public name is there, explains itself, and stands on the face of its room."""
    value, room = getattr(newton_cagecut, name), newton_cagecut._ROOMS[name]
    assert inspect.getdoc(value)
    assert value.__name__ == name
    assert value.__module__.startswith(f"{PACKAGE}.{room}")
    assert name in public_names(f"{PACKAGE}/{room}/__init__.py")


def test_type_checkers_see_the_same_names():
    """What is imported for type checkers is what the table says, each name from its room."""
    seen = {
        name: found.module.removeprefix(f"{PACKAGE}.")
        for found in imports_of(f"{PACKAGE}/__init__.py")
        for name in found.names
        if found.typing_only
    }
    assert seen == newton_cagecut._ROOMS
    assert list(newton_cagecut._ROOMS) == sorted(newton_cagecut._ROOMS)


def test_dir_lists_public_names_alone():
    """Completion offers the public names before any is used, and nothing else."""
    assert dir(newton_cagecut) == sorted(newton_cagecut.__all__)
    with pytest.raises(AttributeError, match="has no attribute 'Knife'"):
        newton_cagecut.Knife  # noqa: B018


def test_readme_uses_names_that_there_are():
    """The listings of README.md parse, and every name of the library in them exists."""
    listings = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.DOTALL)
    assert len(listings) >= 2
    for listing in listings:
        for node in ast.walk(ast.parse(listing)):
            if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "cagecut":
                assert node.attr in NAMES
            if isinstance(node, ast.ImportFrom) and node.module.startswith(PACKAGE):
                module = importlib.import_module(node.module)
                assert {alias.name for alias in node.names} <= set(module.__all__)


def test_version():
    """One file says the version; citation and changelog know it, and the annotations count for type checkers."""
    version = newton_cagecut.__version__
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())
    assert re.fullmatch(r"\d+\.\d+\.\d+", version)
    assert project["project"]["dynamic"] == ["version"]
    assert "version" not in project["project"]
    assert f"\nversion: {version}\n" in (ROOT / "CITATION.cff").read_text()
    assert re.search(rf"^## \[({re.escape(version)}|Unreleased)\]", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert resources.files(newton_cagecut).joinpath("py.typed").is_file()


def test_untested_newton_is_named():
    """A minor version of Newton that was not tested is used with a warning, a tested one without."""
    for version in ("1.9.0", "1.18.2", "1.9.0.dev3"):
        with pytest.warns(RuntimeWarning, match=f"tested with Newton 1.8, this is {version}"):
            warn_if_untested(version)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        warn_if_untested("1.8.0")
        warn_if_untested("1.8.3")


def test_solver_asks_for_the_version(monkeypatch):
    """Importing the solver says so where Newton is another one, and nothing with the one of the tests."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        importlib.reload(newton_cagecut.solver)
    monkeypatch.setattr(newton, "__version__", "1.99.0")
    with pytest.warns(RuntimeWarning, match=re.escape("this is 1.99.0")):
        importlib.reload(newton_cagecut.solver)
