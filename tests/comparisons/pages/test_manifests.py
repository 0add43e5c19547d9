"""`sheetbench report` on manifests and documents that no verb wrote: a sentence, and no traceback."""

import json

import pytest
from commands import run

RUN = {"files": ["comparison.json"], "words": {"title": "A", "document": "comparison.json"}}


@pytest.mark.parametrize("damaged", [
    7,
    [],
    {"runs": [RUN]},
    {"runs": {"compare": None}},
    {"runs": {"compare": {"files": None}}},
    {"runs": {"compare": {"files": 3}}},
    {"runs": {"compare": {"files": ["a\0b.json"]}}},
    {"runs": {"compare": {"files": ["x" * 300 + ".json"]}}},
    {"runs": {"compare": {**RUN, "words": {"notes": 5}}}},
    {"runs": {"compare": {**RUN, "words": {"complaints": None}}}},
    {"runs": {"compare": {**RUN, "words": {"tables": ["a"]}}}},
    {"runs": {"compare": {**RUN, "words": {"document": ["a"]}}}},
    {"runs": {"compare": {**RUN, "command": 3}}},
    {"runs": {"compare": RUN}, "machine": ["processor"]},
    {"runs": {"compare": RUN}, "versions": "numpy"},
], ids=lambda value: str(value)[-40:])  # fmt: skip
def test_a_manifest_of_another_shape_costs_a_sentence(tmp_path, capsys, damaged):
    for name, record in (("odd", damaged), ("sound", {"runs": {"compare": RUN}})):
        (tmp_path / name).mkdir()
        (tmp_path / name / "manifest.json").write_text(json.dumps(record))
        (tmp_path / name / "comparison.json").write_text("{}")
    assert run("report", str(tmp_path)) == 0
    said = capsys.readouterr()
    assert "1 study in" in said.out
    assert "odd/manifest.json: damaged, cannot be read: " in said.err and "Traceback" not in said.err
