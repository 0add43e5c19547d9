"""Variants of a scene: what a key's text stands for, the answer, and a sweep that is killed and resumed."""

import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from campaigns import Serial, rows_in, wait_for

import sheetbench as sb
from comparisons.comparison.comparison import compare
from comparisons.models.spec import Elements, Lattice
from comparisons.sweep.store import FILE
from comparisons.sweep.variants import unit_of, variants
from comparisons.sweep.variation import vary
from sheetbench.answers.files import to_json
from sheetbench.scenes import load

SEED = load("two-edges-clamped")
TWENTY = ["sheet.thickness=2mm..4mm:5", "material.young=20MPa..50MPa:4"]


@pytest.mark.parametrize(
    ("text", "values"),
    [
        ("sheet.thickness=1mm, 2 mm,0.003", [1e-3, 2e-3, 3e-3]),
        ("material.young=0.3MPa..3MPa:5", [0.3e6, 0.975e6, 1.65e6, 2.325e6, 3e6]),
        ("material.poisson=-0.2..0.4:3", [-0.2, 0.1, 0.4]),
        ("gravity.acceleration=[0,0,-9.81],[0,0,1.62]", [[0.0, 0.0, -9.81], [0.0, 0.0, 1.62]]),
        ("gravity.acceleration.3=-9.81..-1:2", [-9.81, -1.0]),
        ("support1.kind=clamped,hinged", ["clamped", "hinged"]),
        ("material.density=1.1g/cm3,2g/cm³", [1100.0, 2000.0]),
        ("air.drag=0.5", [0.5]),  # a table that the scene does not have
        ("sheet.length_x=0.1,0.3", [0.1, 0.3]),  # probes go with it
    ],
)
def test_a_key_of_the_file_takes_what_the_file_may_hold(text, values):
    found = variants(SEED, [text])
    (key,) = found[0].varied
    assert [one.varied[key] for one in found] == [pytest.approx(value) for value in values]
    scenes = [one.scene for one in found]
    assert all(scenes.count(one) == 1 for one in scenes) and (len(scenes) > 1 or scenes[0] != SEED)


def test_every_combination_is_a_variant_and_the_last_key_changes_first():
    found = variants(SEED, ["sheet.thickness=1mm,2mm", "material.young=1MPa,2MPa"])
    assert [(one.scene.sheet.thickness, one.scene.material.young) for one in found] == [
        *((1e-3, 1e6), (1e-3, 2e6), (2e-3, 1e6), (2e-3, 2e6)),
    ]
    assert str(found[1]) == "sheet.thickness = 1 mm, material.young = 2 MPa"
    assert [unit_of(key) for key in ("load.1.force", "material.poisson", "support1.tilt")] == ["N", "", "rad"]


@pytest.mark.parametrize(
    ("texts", "refusal"),
    [
        (["sheet.thickness"], "write each key once"),
        (["sheet.thickness=1mm", "sheet.thickness=2mm"], "write each key once"),
        ([], "nothing to vary"),
        (["sheet.thicknes=1mm"], "did you mean thickness"),
        (["shet.thickness=1mm"], "did you mean sheet"),
        (["sheet.thickness=-1mm"], "thickness = -1mm: sheet.thickness = -0.001: must be greater than 0"),
        (["sheet.thickness=1kg"], "kg"),
        (["load.1.value=3"], "no such entry"),
        (["support.3.tilt=0.1"], "no such entry"),
        (["material.young=1MPa..2GPa:3"], "both in one unit"),
        (["material.young=1e6..2e6:1"], "n from 2"),
        ([f"{key}=1..2:5000" for key in ("material.young", "material.density")], "25000000 variants"),
    ],
)
def test_what_cannot_be_varied_is_refused(texts, refusal):
    with pytest.raises(sb.BadInput, match=refusal):
        variants(SEED, texts)


def test_a_row_is_what_compare_answers_of_the_variant(store):
    """Error, field error and probes to the last digit; a variant without an answer costs its row alone."""
    models = {"models": [Lattice(3), Elements("plate", 2)], "reference": Elements("shell", 2)}
    found = vary(SEED, ["sheet.thickness=3mm,5mm"], store, pool=Serial, **models)
    rows = json.loads(to_json(found.document()))["rows"]
    assert [(row["varied"]["sheet.thickness"], row["model"]) for row in rows] == [
        (h, model) for h in (3e-3, 5e-3) for model in ("shell", "lumped", "plate")
    ]
    both = compare(SEED.replace(thickness=5e-3), Lattice(3), elements=2)
    assert rows[4]["error"] == both.error(both.solutions[0]) and found.succeeded
    assert rows[4]["field_error"] == both.field_errors["lumped"] and rows[3]["error"] is None
    assert rows[4]["probes"]["P4"] == pytest.approx(both.probes(both.solutions[0])["P4"])
    frame = found.to_pandas()
    assert list(frame["sheet.thickness [m]"]) == [3e-3] * 3 + [5e-3] * 3
    assert frame["P4 uz [m]"][4] == rows[4]["probes"]["P4"][2]
    assert "at sheet.thickness = 3 mm" in found.result()
    heavy = vary(SEED, ["gravity.acceleration.3=-9.81,-1e5"], store, pool=Serial, **models)
    assert not heavy.succeeded and len(heavy.rows) == 6 and heavy.rows[0].stable
    assert any("acceleration.3 = −100000 m/s²" in one and "lumped" in one for one in heavy.complaints())
    alone = vary(
        SEED, ["support1.kind=clamped,hinged"], store, models=[Lattice(3)], reference=None, pool=Serial
    )
    assert alone.reference == "" and [row.error for row in alone.rows] == [None, None]
    for one in (found, heavy, alone):
        figure = one.figures()[0].figure()
        assert figure.axes[0].get_ylabel() == "uz at P4 [mm]" and figure.axes[0].lines


def test_the_function_takes_a_mapping_of_values():
    thickness = np.array([2e-3, 3e-3])
    given = {"sheet.thickness": thickness, "support.1.kind": "clamped"}
    found = sb.sweep(SEED, given, grid=3, reference="", workers=1)
    assert [row.varied["sheet.thickness"] for row in found.rows] == thickness.tolist()
    assert [row.request.scene for row in found.rows] == [
        SEED.replace(thickness=h) for h in thickness.tolist()
    ]


@pytest.mark.nightly
def test_twenty_variants_are_killed_and_resumed_and_are_those_of_a_cluster(tmp_path):
    """By two workers, of which nothing is left; what was kept stays, time stamps and all, and the end is what
    a local cluster of dask finds."""
    pytest.importorskip("distributed")
    from distributed import LocalCluster

    command = [sys.executable, "-m", "sheetbench", "sweep", "two-edges-clamped", "--lumped", "3"]
    command += [*(f"--vary={text}" for text in TWENTY), "--elements", "2", "--no-pictures", "--json"]
    killed = [*command, "--workers", "2", "--out", str(tmp_path / "killed")]
    with subprocess.Popen(killed, stdout=subprocess.DEVNULL, start_new_session=True) as first:
        wait_for(lambda: len(rows_in(tmp_path / "killed" / FILE)) >= 6)
        os.killpg(first.pid, signal.SIGKILL)
    kept = rows_in(tmp_path / "killed" / FILE)
    assert 6 <= len(kept) < 40
    resumed = json.loads(subprocess.run(killed, stdout=subprocess.PIPE, check=True).stdout)
    after = rows_in(tmp_path / "killed" / FILE)
    assert len(after) == 40 and {key: after[key] for key in kept} == kept
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None, protocol="tcp") as local:
        clustered = [*command, "--scheduler", local.scheduler_address]
        far = json.loads(subprocess.run(clustered, stdout=subprocess.PIPE, check=True).stdout)
    assert len(resumed["rows"]) == 40
    for one, other in zip(resumed["rows"], far["rows"], strict=True):
        assert (one["varied"], one["model"], one["status"]) == (other["varied"], other["model"], "converged")
        assert one["probes"] == other["probes"] and one["error"] == other["error"]
