"""`sheetbench verify`: the quick cases, the table and its document; all of them in the slow run."""

import json
from functools import cache

import numpy as np
import pytest
from cases import elastica_tip
from commands import run as command

from fem_reference.verification import (
    CASES,
    Verification,
    manufactured,
    round_shapes,
    square_plates,
    strips,
    verify,
)
from fem_reference.verification.cases import Case
from fem_reference.verification.rows import absolute_row, relative_row

ELSEWHERE = ("locking-plate", "locking-shell", "strain-laws", "rubber")  # test_locking, test_strain_laws
HEAVIEST = ("disc-bending", "disc-frequencies", "nafems-fv16", "end-shear")  # by night
SLOW = ("slit-annulus", "strip-with-hole", "nafems-le10", "manufactured-solid", "locking-solid")
QUICK = [name for name in CASES if name not in (*SLOW, *ELSEWHERE)]
LIFTED = {load: round_shapes.LIFTED[load] for load in (0.1, 0.25)}


@cache
def rows_of(name):
    return verify(name).rows


def held(rows):
    assert rows
    assert not [row for row in rows if not row.passed]


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.nightly] * (name in HEAVIEST)) for name in QUICK]
)
def test_quick_verification_cases_pass(name):
    rows = rows_of(name)
    held(rows)
    assert {row.case for row in rows} == {name}


@pytest.mark.parametrize(("rows", "coarse"), [
    (manufactured.solid, {"BRICKS": (2, 4)}),
    (round_shapes.elliptic_plate, {"BRICKS": (4, 6, 2), "WITHIN": 0.07}),
    (strips.roll_up, {"ELEMENTS": 8, "SHARES": (0.25, 1.0), "ROLLED": 2**4 * 2e-3}),
    (round_shapes.slit_annulus, {"RADIAL": 2, "AROUND": 16, "TOLERANCE": 0.013, "LIFTED": LIFTED}),
    (round_shapes.frequencies, {"ELEMENTS": 12}),
], ids=["manufactured-solid", "nafems-le10", "roll-up", "slit-annulus", "disc-frequencies"])  # fmt: skip
def test_slow_cases_come_near_on_coarse_meshes(monkeypatch, rows, coarse):
    for name, value in coarse.items():
        monkeypatch.setattr(f"{rows.__module__}.{name}", value)
    held(list(rows()))


def test_a_mesh_too_coarse_for_an_equilibrium_has_no_value():
    assert np.isnan(strips.rolled("shell", 1.0, 2)).tolist() == [True, True]


@pytest.mark.slow
def test_all_cases_pass(tmp_path, capsys):
    assert command("verify", "--json", "--out", str(tmp_path)) == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    assert all(row["passed"] for row in rows)
    assert {row["case"] for row in rows} == set(CASES)
    assert {file.name for file in tmp_path.iterdir()} >= {"verification.json", "verification.csv"}


@pytest.mark.parametrize("load", strips.HEAVY)
def test_the_heavy_elastica_s_values_are_its_equation_s(load):
    """In lengths L, β = qL³/EI: five digits by collocation."""
    x, z = elastica_tip(1.0, 1.0, weight=-load, turn=0.5)
    assert (z, 1.0 - x) == pytest.approx(strips.HEAVY[load], abs=6e-6)


def test_the_simply_supported_plate_s_values_are_navier_s_series():
    """w D/(q L⁴) = Σ 16 sin(mπ/2) sin(nπ/2)/(π² m n α²) (1 + α D/κGhL²), α = π²(m² + n²), m and n odd."""
    odd = np.arange(1, 200, 2)
    sign = np.where(odd % 4 == 1, 1.0, -1.0)
    alpha = np.pi**2 * (odd[:, None] ** 2 + odd**2)
    for ratio, printed in square_plates.HARD_SIMPLE.items():
        by_shear = 1.0 + alpha * ratio**2 / (6.0 * (1.0 - 0.3) * 5.0 / 6.0)
        term = 16.0 * np.outer(sign / odd, sign / odd) / (np.pi**2 * alpha**2) * by_shear
        assert term.sum() == pytest.approx(printed, abs=5.1e-6)


def test_the_thin_clamped_plate_s_value_is_that_of_a_series():
    """Ritz with w = (1 − x²)² (1 − y²)² P_2i(x) P_2j(y) on [−1, 1]², minimising ∫ ½ (Δw)² − w: w(0, 0)/2⁴."""
    x, weight = np.polynomial.legendre.leggauss(40)
    ends = np.polynomial.Polynomial([1.0, 0.0, -1.0]) ** 2
    along = [
        ends * np.polynomial.Legendre.basis(2 * i).convert(kind=np.polynomial.Polynomial) for i in range(8)
    ]
    value, bent = (np.array([f.deriv(order)(x) for f in along]) for order in (0, 2))
    mass, mixed, bending = ((a * weight) @ b.T for a, b in ((value, value), (value, bent), (bent, bent)))
    stiffness = (
        np.kron(bending, mass) + np.kron(mixed, mixed.T) + np.kron(mixed.T, mixed) + np.kron(mass, bending)
    )
    load, middle = (np.kron(at, at) for at in (value @ weight, np.array([f(0.0) for f in along])))
    deflection = middle @ np.linalg.solve(stiffness, load) / 2.0**4
    assert deflection == pytest.approx(square_plates.CLAMPED[0.001], abs=5e-8)


def test_relative_is_to_the_published_value_or_to_a_length():
    assert relative_row("q", "m", -2.0, "A 1900", -2.1, 0.1).relative == pytest.approx(0.05)
    at_zero = relative_row("q", "m", 0.0, "A 1900", 0.3, 0.1, scale=12.0)
    assert at_zero.relative == pytest.approx(0.025) and at_zero.passed
    assert absolute_row("order", "m", 3.0, "theory", 3.2, 0.15).relative is None
    assert not absolute_row("order", "m", 3.0, "theory", 3.2, 0.15).passed
    assert not relative_row("q", "m", 1.0, "A 1900", float("nan"), 0.1).passed


def test_document_has_the_promised_keys(capsys):
    assert command("verify", "--case", "patch", "--json") == 0
    rows = json.loads(capsys.readouterr().out)["rows"]
    promised = {"case", "quantity", "published", "source", "computed", "relative", "passed"}
    assert all(promised <= set(row) for row in rows)
    assert {row["relative"] for row in rows} == {None}


def test_a_row_that_fails_leaves_with_3(monkeypatch, capsys):
    row = relative_row("w", "one", 1.0, "A 1900", 1.1, 0.05)
    monkeypatch.setitem(CASES, "wrong", Case("a wrong one", lambda: iter([row])))
    assert command("verify", "--case", "wrong", "--case", "patch") == 3
    printed, right = capsys.readouterr(), len(rows_of("patch"))
    assert "wrong: w: 1.1 instead of 1" in printed.err
    assert "NO" in printed.out and f"{right} of {right + 1} rows pass" in printed.out


def test_bad_options_leave_with_2(capsys):
    assert command("verify", "--case", "no-such") == 2
    said = capsys.readouterr().err
    assert (
        said.startswith("sheetbench: case = 'no-such': unknown, choose one of end-shear, ")
        and "locking-solid" in said
    )


def test_a_table_shows_a_case_with_its_meshes():
    rows = [row for name in ("patch", "nafems-fv12") for row in rows_of(name)]
    tables = Verification(rows).printed()
    assert [len(table.rows) for table in tables] == [len(rows_of(name)) for name in ("patch", "nafems-fv12")]
    assert "shell 9 elements, distorted" in tables[0].to_markdown()
    assert "relative" not in tables[0].to_markdown()
