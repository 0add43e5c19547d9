"""A lattice in motion as an FMI 3.0 co-simulation unit: the program in C, a description of its variables, and
a library for the machine that writes it where it has a compiler.

Source: Functional Mock-up Interface 3.0.1, sections 2.4, 2.5 and 4.
"""

from __future__ import annotations

import functools
import platform
import shutil
import subprocess
import sys
import tempfile
import uuid
import zipfile
from pathlib import Path
from xml.sax.saxutils import quoteattr

from comparisons.codes.files import script
from comparisons.codes.onefile import Program
from sheetbench.answers.report import Write
from sheetbench.files import replacing

UNITS = {"m": 'm="1"', "s": 's="1"', "m/s2": 'm="1" s="-2"'}
UNITS |= {"N": 'kg="1" m="1" s="-2"', "J": 'kg="1" m="2" s="-2"'}
XML = '<?xml version="1.0" encoding="UTF-8"?>\n'
BUILD = f"""{XML}<fmiBuildDescription fmiVersion="3.0"><BuildConfiguration modelIdentifier="sheet">
<SourceFileSet language="C99"><SourceFile name="sheet.c"/><SourceFile name="fmi3.c"/></SourceFileSet>
</BuildConfiguration></fmiBuildDescription>
"""
MODEL = """<fmiModelDescription fmiVersion="3.0" modelName={name} instantiationToken="{{{token}}}"
 generationTool="sheetbench">
<CoSimulation modelIdentifier="sheet" canHandleVariableCommunicationStepSize="true"/>
<UnitDefinitions>{units}</UnitDefinitions>
<DefaultExperiment startTime="0" stopTime="1" stepSize="0.005"/>
<ModelVariables>
{variables}
</ModelVariables>
<ModelStructure>{structure}</ModelStructure>
</fmiModelDescription>
"""


def description(name: str, of: Program) -> str:
    """Return the unit's modelDescription.xml, with variables numbered as in `scripts/fmi3.c`, without inputs
    that a history sets: a tool that writes all inputs would stop it."""
    kinds = ['"time" unit="s" causality="independent" variability="continuous"']
    entry, output = '"{}" unit="{}" causality="input" start="{!r}"', 'causality="output" initial="calculated"'
    kinds += ["" if at is None else entry.format(x, unit, at) for x, (unit, at) in of.inputs.items()]
    kinds += [f'"{x}" unit="{unit}" {output}' for x, unit in of.outputs.items()]
    rows = [f'<Float64 valueReference="{n}" name={kind}/>' for n, kind in enumerate(kinds) if kind]
    numbers = range(1 + len(of.inputs), len(kinds))
    entries = [f'<{kind} valueReference="{n}"/>' for kind in ("Output", "InitialUnknown") for n in numbers]
    return XML + MODEL.format(
        name=quoteattr(name),
        token=uuid.uuid5(uuid.NAMESPACE_OID, of.texts["sheet.c"]),
        units="".join(f'<Unit name="{unit}"><BaseUnit {base}/></Unit>' for unit, base in UNITS.items()),
        variables="\n".join(rows).replace(' unit=""', ""),
        structure="".join(entries),
    )


def library(texts: dict[str, str]) -> dict[str, bytes]:
    """Return the compiled library for this machine by its path in the unit; empty without a working
    compiler."""
    compiler = next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)
    system, ending = {"linux": ("linux", "so"), "darwin": ("darwin", "dylib")}.get(sys.platform, ("", ""))
    if not (compiler and system):
        return {}
    machine = {"amd64": "x86_64", "arm64": "aarch64"}.get(platform.machine().lower(), platform.machine())
    flags = ["-std=c99", "-O3", "-fPIC", "-shared", "-fvisibility=hidden", "-o", "out", "-lm"]
    with tempfile.TemporaryDirectory() as folder:
        for name, text in texts.items():
            Path(folder, name).write_text(text, encoding="utf-8")
        command = [compiler, "sheet.c", "fmi3.c", *flags]
        failed = subprocess.run(command, cwd=folder, capture_output=True).returncode
        place = f"binaries/{machine}-{system}/sheet.{ending}"
        return {} if failed else {place: Path(folder, "out").read_bytes()}


def fmu_files(name: str, of: Program) -> tuple[dict[str, Write], list[str]]:
    """Return the FMU of a scene by its file's name, and the features that it omits."""
    sources = {name: of.texts[name] for name in ("sheet.h", "sheet.c")} | {"fmi3.c": script("fmi3.c")}
    built = library(sources)
    content: dict[str, str | bytes] = {"modelDescription.xml": description(name, of), **built}
    content |= {f"sources/{name}": text for name, text in (sources | {"buildDescription.xml": BUILD}).items()}
    missing = [] if built else ["no working compiler: sheet.fmu has its sources only"]
    return {"sheet.fmu": functools.partial(write_zip, content=content)}, missing


def write_zip(path: Path, content: dict[str, str | bytes]) -> None:
    """Write files by their names into an archive."""
    with replacing(path) as partial, zipfile.ZipFile(partial, "w") as archive:
        for name, of in content.items():
            archive.writestr(zipfile.ZipInfo(name), of, zipfile.ZIP_DEFLATED)
