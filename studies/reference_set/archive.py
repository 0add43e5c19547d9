"""The reference set as one archive for a repository of data: `python -m studies.reference_set.archive FILE`.

Scenes, values with bars, forms, the whole set as JSON, licence, a README and checksums. Equal sets make
equal bytes: names in order, one date, one mode, no compression, which depends on zlib's version.
"""

import sys
from hashlib import sha256
from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZIP_STORED, ZipFile, ZipInfo

from comparisons.scoring.reference import FILE, document, references
from comparisons.scoring.suite import Suite

README = """\
# Reference set {version} of sheetbench

{cases} scenes of soft sheets (statics, motion, modes) with converged values and error bars, {licence}.

- `NAME.toml`: a scene, SI units.
- `values-*.csv`: displacements [m] at its probes, over time where it moves, or natural frequencies [Hz], with
  the bars that the references' meshes and steps leave.
- `answers-*.csv`: forms for answers; `sheetbench score answers-statics.csv` reads them.
- `suite.json`: all of it, with how far each code is off that solved the case, and with what it was made.
- `cases.csv`: why each case is in the set. `SHA256SUMS`: `sha256sum --check SHA256SUMS`.

Cite as: sheetbench reference set {version}.
"""
DATE = (1980, 1, 1, 0, 0, 0)  # of every file, the first that a zip has


def archive(path: Path) -> Path:
    """Write the archive, and return the file."""
    report, set_document = Suite(None).report(), document()
    cases_by_name = references()
    with TemporaryDirectory() as folder:
        for name, write in report.attachments.items():
            write(Path(folder) / name)
        contents = {file.name: file.read_bytes() for file in Path(folder).iterdir()}
    text = README.format(
        version=set_document["version"], cases=len(cases_by_name), licence=set_document["licence"]
    )
    cases = next(table for table in report.tables if table.name == "cases")
    contents |= {
        "README.md": text.encode(),
        "suite.json": FILE.read_bytes(),
        "cases.csv": cases.to_csv().encode(),
    }
    sums = "".join(f"{sha256(data).hexdigest()}  {name}\n" for name, data in sorted(contents.items()))
    contents["SHA256SUMS"] = sums.encode()
    path.parent.mkdir(parents=True, exist_ok=True)
    with ZipFile(path, "w", ZIP_STORED) as out:
        for name, data in sorted(contents.items()):
            entry = ZipInfo(f"sheet-set-{set_document['version']}/{name}", DATE)
            entry.create_system, entry.external_attr = 3, 0o644 << 16
            out.writestr(entry, data)
    return path


if __name__ == "__main__":
    print(archive(Path(sys.argv[1])))
