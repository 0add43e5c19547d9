"""The solvers' clock: it stands still while kernels are compiled, on the thread that compiles."""

import threading
from time import perf_counter, sleep

import numba
import pytest

import fem_reference
import lumped
from sheetbench import clock, kernels
from sheetbench.scenes import load


def test_compiling_counts_as_no_time():
    assert kernels  # which tells the clock of what numba compiles

    @numba.njit
    def inner(x):
        return x + 1.0

    @numba.njit
    def outer(x):
        return inner(x) + 1.0

    first, began, before, second = perf_counter(), clock.now(), clock.compiled(), perf_counter()
    assert outer(1.0) == 3.0
    third, counted, compiled = perf_counter(), clock.now() - began, clock.compiled() - before
    assert compiled > 0.0
    assert third - second - 1e-6 < counted + compiled < perf_counter() - first + 1e-6
    began, before = clock.now(), clock.compiled()
    outer(2.0)
    assert clock.compiled() == before and clock.now() >= began


def test_another_thread_s_clock_goes_on():
    began = clock.now()
    with clock.stopped(), clock.stopped():
        moment = clock.now()
        elapsed: list[float] = []

        def other():
            start = clock.now()
            sleep(0.01)
            elapsed.append(clock.now() - start)

        thread = threading.Thread(target=other)
        thread.start()
        thread.join()
        assert clock.now() == moment
    assert elapsed[0] >= 0.01 > clock.now() - began


@pytest.mark.parametrize("model", ["lumped", *fem_reference.MODELS])
def test_setting_up_and_solving_take_no_longer_than_the_call(model):
    scene, began = load("one-edge-clamped"), clock.now()
    if model == "lumped":
        answer = lumped.solve(scene, lumped.calibrate(scene.sheet, scene.material, (3, 3)))
    else:
        answer = fem_reference.solve(scene, model, elements=2)
    assert answer.setup_seconds > 0.0 and answer.solve_seconds > 0.0
    assert answer.setup_seconds + answer.solve_seconds <= clock.now() - began
