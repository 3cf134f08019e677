# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""The imports of the library's files, read without running them."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = "newton_cagecut"


@dataclass(frozen=True)
class Import:
    """One import statement, or one name of ``from . import name`` where that is a module.

    Attributes:
        file: The file that it stands in, relative to the root.
        line: Its line.
        module: What it imports from, absolute.
        names: What it imports; empty for ``import module``.
        typing_only: Whether it stands under ``if TYPE_CHECKING``.
    """

    file: str
    line: int
    module: str
    names: tuple[str, ...]
    typing_only: bool

    @property
    def where(self) -> str:
        """The place, for messages."""
        return f"{self.file}:{self.line}"

    @property
    def target(self) -> str | None:
        """The library's file that it imports from, ``None`` for other packages."""
        return file_of(self.module)


def library_files() -> list[str]:
    """The library's Python files, relative to the root."""
    return sorted(path.relative_to(ROOT).as_posix() for path in (ROOT / PACKAGE).rglob("*.py"))


def file_of(module: str) -> str | None:
    """The library's file of a module, relative to the root."""
    stem = module.replace(".", "/")
    found = [name for name in (f"{stem}.py", f"{stem}/__init__.py") if (ROOT / name).is_file()]
    return found[0] if found and module.split(".")[0] == PACKAGE else None


def room_of(file: str) -> str:
    """The room of a library's file; "" for those beside the rooms."""
    parts = file.split("/")
    return parts[1] if len(parts) > 2 else ""


def imports_of(file: str) -> list[Import]:
    """All imports of a file, wherever they stand in it."""
    return list(_imports_in(_tree(file), file, typing_only=False))


def public_names(file: str) -> tuple[str, ...]:
    """The names in the ``__all__`` of a file, those that stand in it letter by letter."""
    for node in _tree(file).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return tuple(item.value for item in node.value.elts if isinstance(item, ast.Constant))
    return ()


@cache
def _tree(file: str) -> ast.Module:
    """The syntax of a file."""
    return ast.parse((ROOT / file).read_text())


def _imports_in(tree: ast.AST, file: str, *, typing_only: bool) -> Iterator[Import]:
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield Import(file, node.lineno, alias.name, (), typing_only)
        elif isinstance(node, ast.ImportFrom):
            yield from _from_imports(node, file, typing_only)
        elif isinstance(node, ast.If) and ast.unparse(node.test) in ("TYPE_CHECKING", "typing.TYPE_CHECKING"):
            for child in node.body:
                yield from _imports_in(ast.Module([child], []), file, typing_only=True)
            yield from _imports_in(ast.Module(node.orelse, []), file, typing_only=typing_only)
        else:
            yield from _imports_in(node, file, typing_only=typing_only)


def _from_imports(node: ast.ImportFrom, file: str, typing_only: bool) -> Iterator[Import]:
    """What ``from module import names`` imports: names that it hands on, and modules inside it."""
    module = node.module or ""
    if node.level:
        package = Path(file).parts[: -node.level]
        module = ".".join([*package, *filter(None, [module])])
    names = [alias.name for alias in node.names]
    handed_on = public_names(file_of(module)) if file_of(module) else ()
    modules = [name for name in names if name not in handed_on and file_of(f"{module}.{name}")]
    others = tuple(name for name in names if name not in modules)
    for name in modules:
        yield Import(file, node.lineno, f"{module}.{name}", (), typing_only)
    if others:
        yield Import(file, node.lineno, module, others, typing_only)
