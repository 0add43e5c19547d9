"""The page of the versions: error and time of ten fixed cases, from the files of `benchmarks/versions.py`."""

import json
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "benchmarks" / "versions"
HEAD = """# Over versions

Error and CPU time of ten fixed cases in every release, held against values of finer meshes that the first
release stored (`python benchmarks/versions.py VERSION`). Errors compare, times of different machines do not.
"""


def write_version_page(path: Path) -> None:
    """Write the page, a column a release."""
    releases = {p.stem: json.loads(p.read_text()) for p in sorted(FOLDER.glob("[0-9]*.json"))}
    lines = [HEAD, "| case | " + " | ".join(f"{v} [%] | {v} [ms]" for v in releases) + " |"]
    lines.append("| --- |" + " ---: | ---: |" * len(releases))
    for case in dict.fromkeys(name for release in releases.values() for name in release["rows"]):
        cells = [release["rows"].get(case) for release in releases.values()]
        numbers = (f"{100 * c['error']:.3f} | {1e3 * c['seconds']:.1f}" if c else "– | –" for c in cells)
        lines.append(f"| {case} | {' | '.join(numbers)} |")
    made = [f"{v}: {r['date']}, {r['machine']}, Python {r['python']}." for v, r in releases.items()]
    path.write_text("\n".join([*lines, "", *made, ""]), encoding="utf-8")
