# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""Files of named arrays that are either whole or refused.

A magic number, the SHA-256 of the rest, and an uncompressed NumPy archive. The checksum is compared before anything is
parsed, so that a file that was cut short or damaged anywhere is an error, never other numbers.
"""

from __future__ import annotations

import hashlib
import json
import os
from pathlib import Path
from typing import BinaryIO

import numpy as np

_MAGIC = b"newton_cagecut\r\n"
_DIGEST_SIZE = hashlib.sha256().digest_size
_HEADER = "header"


def write_container(path: str | os.PathLike, header: dict, arrays: dict[str, np.ndarray]) -> None:
    """Write a file beside its place and then put it there: readers find the old one or the new one, never a part.

    Args:
        path: Where to write it.
        header: What is said of the arrays; anything that JSON holds.
        arrays: The arrays, by name.

    Raises:
        OSError: The file cannot be written; one that was there is as it was.
    """
    path = Path(path)
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    text = np.frombuffer(json.dumps(header).encode(), dtype=np.uint8)
    try:
        with part.open("w+b") as file:
            file.write(_MAGIC + bytes(_DIGEST_SIZE))
            np.savez(file, **{_HEADER: text}, **arrays)
            file.flush()
            digest = _digest(file)
            file.seek(len(_MAGIC))
            file.write(digest)
            file.flush()
            os.fsync(file.fileno())
        os.replace(part, path)
    finally:
        part.unlink(missing_ok=True)


def read_container(path: str | os.PathLike) -> tuple[dict, dict[str, np.ndarray]]:
    """Read a file that ``write_container`` wrote.

    Args:
        path: Where it is.

    Returns:
        Its header and its arrays, by name.

    Raises:
        OSError: There is no such file, or it cannot be read.
        ValueError: It is no such file, or it was cut short or damaged.
    """
    if not Path(path).exists():
        raise FileNotFoundError(f"no such file: {os.fspath(path)}; save() writes one")
    with Path(path).open("rb") as file:
        magic, digest = file.read(len(_MAGIC)), file.read(_DIGEST_SIZE)
        if magic != _MAGIC:
            raise ValueError(f"{os.fspath(path)} is no file of harmonic coordinates")
        if digest != _digest(file):
            raise ValueError(f"{os.fspath(path)} is cut short or damaged: its checksum is another one; save it again")
        file.seek(len(_MAGIC) + _DIGEST_SIZE)
        with np.load(file, allow_pickle=False) as archive:
            arrays = {name: archive[name] for name in archive.files}
    return json.loads(arrays.pop(_HEADER).tobytes()), arrays


def _digest(file: BinaryIO) -> bytes:
    """SHA-256 of what follows magic number and checksum."""
    file.seek(len(_MAGIC) + _DIGEST_SIZE)
    return hashlib.file_digest(file, "sha256").digest()
