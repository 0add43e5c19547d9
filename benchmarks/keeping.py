"""What benchmarks found, kept: a file a run and benchmark, named by the day and the machine."""

import json
import platform
import re
import subprocess
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "history"
PACKAGES = ("numpy", "scipy", "numba")


def machine() -> str:
    """The processor's name."""
    about = Path("/proc/cpuinfo")
    named = re.search(r"^model name\s*: (.*)$", about.read_text(), re.MULTILINE) if about.exists() else None
    return named[1] if named else platform.processor() or platform.machine()


def keep(benchmark: str, rows: list[dict[str, Any]], folder: Path = FOLDER) -> Path:
    """Write the rows of a run beside those of the runs before; the file."""
    now = datetime.now(UTC)
    name = re.sub(r"[^a-z0-9]+", "-", machine().lower()).strip("-")
    folder.mkdir(parents=True, exist_ok=True)
    path = folder / f"{now:%Y-%m-%dT%H%M%S}-{benchmark}-{name}.json"
    about = {
        "benchmark": benchmark,
        "date": now.isoformat(timespec="seconds"),
        "machine": machine(),
        "commit": _commit(),
        "python": platform.python_version(),
        **{package: version(package) for package in PACKAGES},
    }
    path.write_text(json.dumps({"about": about, "rows": rows}, indent=1) + "\n", encoding="utf-8")
    return path


def _commit() -> str:
    """The state of the code, if it is one that git knows."""
    ask = ["git", "-C", str(Path(__file__).parent), "describe", "--always", "--dirty"]
    found = subprocess.run(ask, capture_output=True, text=True)
    return found.stdout.strip()
