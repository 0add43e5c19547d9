"""What others say: one line of few characters, wherever it is passed on."""

import pytest

from comparisons.external.plugins import plugin
from comparisons.identification import columns
from sheetbench.errors import FOREIGN, BadInput, foreign
from sheetbench.process import run
from sheetbench.scenes import SceneError, load
from sheetbench.scenes.objects import plan_mesh

LONG = "reason " * 500


def test_foreign_messages_become_one_short_line():
    assert foreign(" a\n b\x1b ") == r"a b\x1b" and foreign(ValueError()) == "ValueError"
    assert foreign(LONG).startswith("reason reason") and len(foreign(LONG)) == FOREIGN


def test_refusals_shorten_foreign_messages(tmp_path):
    (tmp_path / "mine.py").write_text(f"raise SystemExit({LONG!r})")
    (tmp_path / "scene.toml").write_text("a = 1\n" + "b" * 5000)
    (tmp_path / "m.csv").write_text(f"x,y,uz [{'m' * 5000}]\n0,0,1\n")
    (tmp_path / "m.off").write_text("OFF\n4 1 0\n" + "x" * 5000)
    for refuse, said in (
        (lambda: plugin(f"{tmp_path / 'mine.py'}:M"), "cannot be loaded: reason"),
        (lambda: load(tmp_path / "scene.toml"), "not a TOML file"),
        (lambda: columns.read_columns(tmp_path / "m.csv"), "column uz"),
        (lambda: plan_mesh.read_file(tmp_path / "m.off"), "meshio cannot read it"),
    ):
        with pytest.raises((BadInput, SceneError, ValueError), match=said) as refused:
            refuse()
        assert len(str(refused.value).replace(str(tmp_path), "")) < 300
    assert len(run(["sh", "-c", f"echo {LONG!r} >&2; exit 3"], b"", 60.0).fault) < 200
