# SPDX-FileCopyrightText: Copyright (c) 2026 The newton_cagecut developers
# SPDX-License-Identifier: Apache-2.0
"""Launches in chunks: every element is run once, and nothing runs any more once a launch has returned or raised."""

from __future__ import annotations

import threading
import time

import numpy as np
import pytest
import warp as wp

from newton_cagecut.harmonic import launch as launching


@wp.kernel(enable_backward=False, module="unique")
def _count_visits(offset: int, visits: wp.array[wp.int32]):
    wp.atomic_add(visits, offset + wp.tid(), 1)


@pytest.fixture
def two_cores(monkeypatch):
    """A pool of one thread besides the calling one, on any machine."""
    monkeypatch.setattr(launching, "_core_count", lambda: 2)
    monkeypatch.setattr(launching, "_pool", None)
    yield
    if launching._pool is not None:
        launching._pool.shutdown()


@pytest.mark.parametrize("count", [1, 511, 512, 513, 40000])
def test_every_element_is_run_once(count, two_cores):
    """The chunks cover the elements once each; the fractions that are reported rise to 1."""
    visits = wp.zeros(count, dtype=wp.int32, device="cpu")
    fractions = []
    launching.launch(_count_visits, count, [visits], device=wp.get_device("cpu"), progress=fractions.append)
    assert (visits.numpy() == 1).all()
    assert fractions == sorted(fractions)
    assert fractions[-1] == 1.0
    assert min(fractions) > 0.0


def test_nothing_is_run_for_no_elements(two_cores):
    """A launch without elements is none."""
    launching.launch(_count_visits, 0, [None], device=wp.get_device("cpu"))


@pytest.mark.parametrize("failure", [MemoryError, KeyboardInterrupt])
@pytest.mark.parametrize("failing", ["helper", "caller", "progress"])
def test_no_chunk_outlives_a_failure(failing, failure, two_cores, monkeypatch):
    """Whichever thread fails, the launch raises after the chunk that was under way in the other one has ended."""
    caller = threading.current_thread()
    started, running = [], []
    both_at_work = threading.Barrier(2, timeout=10.0)

    def slow_launch(kernel, *, dim, inputs, device):
        thread = threading.current_thread()
        if thread not in started:
            started.append(thread)
            both_at_work.wait()
            if failing == ("caller" if thread is caller else "helper"):
                raise failure("injected")
        started.append(thread)
        running.append(inputs[0])
        time.sleep(0.02)
        running.remove(inputs[0])

    def report(fraction):
        if failing == "progress":
            raise failure("injected")

    monkeypatch.setattr(launching.wp, "launch", slow_launch)
    visits = wp.zeros(100_000, dtype=wp.int32, device="cpu")
    with pytest.raises(failure, match="injected"):
        launching.launch(_count_visits, visits.size, [visits], device=visits.device, progress=report)
    assert running == []
    count = len(started)
    assert count < 8
    time.sleep(0.05)
    assert len(started) == count


def test_interrupt_while_waiting_is_raised_afterwards(two_cores, monkeypatch):
    """An interrupt of the thread that waits for the last chunks is raised when they have ended."""
    begun, ended = threading.Event(), []
    caller = threading.current_thread()

    def slow_launch(kernel, *, dim, inputs, device):
        if threading.current_thread() is caller:
            begun.wait(10.0)
        else:
            begun.set()
            time.sleep(0.05)
            ended.append(inputs[0])

    real_wait = launching.wait
    interrupts = iter([KeyboardInterrupt("injected")])

    def interrupted_wait(helpers):
        for interrupt in interrupts:
            raise interrupt
        return real_wait(helpers)

    monkeypatch.setattr(launching.wp, "launch", slow_launch)
    monkeypatch.setattr(launching, "wait", interrupted_wait)
    visits = wp.zeros(1024, dtype=wp.int32, device="cpu")
    with pytest.raises(KeyboardInterrupt, match="injected"):
        launching.launch(_count_visits, visits.size, [visits], device=visits.device)
    assert len(ended) == 1


def test_small_launch_stays_in_the_calling_thread(two_cores):
    """A launch too small for two chunks stays in the calling thread."""
    visits = wp.zeros(launching._SMALLEST_CHUNK, dtype=wp.int32, device="cpu")
    launching.launch(_count_visits, visits.size, [visits], device=visits.device)
    np.testing.assert_array_equal(visits.numpy(), 1)
    assert launching._pool is None
