# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0

"""How the quantised levels of walk bounds are stored.

A level of 16 bits has a word of its own; smaller ones share words of 32 bits. Word w of all walks lies side by side, so
that a test which one level decides reads no other.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np
import warp as wp

wp.set_module_options({"enable_backward": False})


@dataclass(frozen=True, eq=False)
class LevelLayout:
    """Storage of some levels a walk: types, Warp functions and one host function.

    Args:
        Quantized: Warp vector of the words of one walk.
        word_type: Warp's unsigned integer for one word.
        level_of: ``(Quantized, k) -> int``, level ``k``.
        add_level: ``(Quantized, k, level) -> Quantized``, write level ``k`` where there is 0.
        level_at: ``(words, walk, k) -> int``, level ``k`` of a walk, from words of shape (word_count, walk_count).
        load: ``(words, walk) -> Quantized``.
        store: ``(words, walk, Quantized)``.
        unpack: Levels of shape (walk_count, level_count), from the words on the host.
    """

    Quantized: type
    word_type: type
    level_of: wp.Function
    add_level: wp.Function
    level_at: wp.Function
    load: wp.Function
    store: wp.Function
    unpack: Callable[[np.ndarray], np.ndarray]


@cache
def make_layout(level_count: int, bits: int) -> LevelLayout:
    """Lay out levels.

    Args:
        level_count: Levels of one walk.
        bits: Bits of a level: 16, or as few as let several share 32.
    """
    word_type = wp.uint16 if bits == 16 else wp.uint32
    word_count = level_count if bits == 16 else -(-level_count // (32 // bits))
    highest = (1 << bits) - 1
    Quantized = wp.types.vector(length=word_count, dtype=word_type)

    @wp.func
    def load(words: wp.array2d[word_type], walk: int) -> Quantized:
        result = Quantized()
        for k in range(wp.static(word_count)):
            result[k] = words[k, walk]
        return result

    @wp.func
    def store(words: wp.array2d[word_type], walk: int, bounds: Quantized):
        for k in range(wp.static(word_count)):
            words[k, walk] = bounds[k]

    if bits == 16:

        @wp.func
        def row_of(k: int) -> int:
            return k

        @wp.func
        def level_in(word: wp.uint16, k: int) -> int:
            return int(word)

        @wp.func
        def word_with(word: wp.uint16, k: int, level: int) -> wp.uint16:
            return wp.uint16(level)

    else:

        @wp.func
        def row_of(k: int) -> int:
            return k % wp.static(word_count)

        @wp.func
        def level_in(word: wp.uint32, k: int) -> int:
            shift = wp.uint32(wp.static(bits) * (k // wp.static(word_count)))
            return int((word >> shift) & wp.uint32(wp.static(highest)))

        @wp.func
        def word_with(word: wp.uint32, k: int, level: int) -> wp.uint32:
            return word | (wp.uint32(level) << wp.uint32(wp.static(bits) * (k // wp.static(word_count))))

    @wp.func
    def level_of(bounds: Quantized, k: int) -> int:
        return level_in(bounds[row_of(k)], k)

    @wp.func
    def add_level(bounds: Quantized, k: int, level: int) -> Quantized:
        row = row_of(k)
        bounds[row] = word_with(bounds[row], k, level)
        return bounds

    @wp.func
    def level_at(words: wp.array2d[word_type], walk: int, k: int) -> int:
        return level_in(words[row_of(k), walk], k)

    def unpack(words: np.ndarray) -> np.ndarray:
        levels = np.arange(level_count)
        shift = (bits * (levels // word_count)).astype(words.dtype)
        return ((words[levels % word_count].T >> shift) & words.dtype.type(highest)).astype(np.uint16)

    return LevelLayout(Quantized, word_type, level_of, add_level, level_at, load, store, unpack)
