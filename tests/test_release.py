"""What a release carries beside the code: versions that agree, licences of others' work."""

import re
import tomllib
from pathlib import Path

import sheetbench
from comparisons.scoring.reference import VERSION

ROOT = Path(__file__).resolve().parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]


def test_versions_agree_with_the_citation():
    cited = re.findall(r'^ *version: "?([\d.]+)"?$', (ROOT / "CITATION.cff").read_text(), re.M)
    assert cited == [PROJECT["version"], VERSION]
    assert sheetbench.__version__ == PROJECT["version"]


def test_the_wheel_carries_the_licence_of_every_package_in_the_viewer():
    viewer = (ROOT / "comparisons/pages/viewer.js").read_text(encoding="utf-8")
    text = (ROOT / "LICENSES/three.js.txt").read_text(encoding="utf-8")
    bundled = re.search(r"/\*! With three\.js ([\d.]+)\.\n(.*?)\n\*/", viewer, re.S)
    assert bundled and bundled[1] in text and bundled[2] in text
    assert "LICENSES/*.txt" in PROJECT["license-files"]
