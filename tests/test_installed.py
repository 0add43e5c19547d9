"""What `make install` leaves: packages that editors and type checkers find, as plain folders on the path."""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent


def test_the_packages_are_found_by_path_from_any_folder(tmp_path):
    """setuptools' import hook, which editors and mypy do not follow, is no path."""
    code = "from importlib.machinery import PathFinder as P; print(all(map(P.find_spec, {names})))"
    names = ["sheetbench", "lumped", "fem_reference", "comparisons"]
    found = subprocess.run(
        [sys.executable, "-c", code.format(names=names)], cwd=tmp_path, capture_output=True, text=True
    )
    assert found.stdout.strip() == "True", "run `make install` again"


def test_every_installation_of_the_makefile_is_by_path():
    text = "".join((ROOT / place).read_text(encoding="utf-8") for place in ("Makefile", "studies/Makefile"))
    assert "EDITABLE := --config-settings editable_mode=compat --editable" in text
    # but of other codes alone, in environments of their own
    installs = re.findall(r"pip install (?:.*\\\n)*.*", text)
    known = re.compile(r"\$\(EDITABLE\)|--requirement|plug-ins")
    assert len(installs) >= 3 and all(known.search(one) for one in installs)
    for package in ("sheetbench", "lumped", "fem_reference", "comparisons"):
        assert (ROOT / package / "py.typed").is_file()
