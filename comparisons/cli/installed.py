"""What is installed here, as `sheetbench --version --verbose` prints it for bug reports."""

from __future__ import annotations

import os
from pathlib import Path


def installed_parts() -> str:
    """Return a line each: versions, processor, memory, solvers, other codes, pictures, folders."""
    import numpy  # noqa: F401  # loads the BLAS that is listed
    from llvmlite import binding
    from threadpoolctl import threadpool_info

    from comparisons.external import memory, plugins
    from comparisons.external.answer import find_codes
    from comparisons.pictures import offscreen, work
    from comparisons.sweep import load, manifest
    from sheetbench import sources
    from sheetbench.numerics import pardiso

    machine, busy, free = manifest.machine(), load.average(), memory.available()
    blas = {f"{one['internal_api']} for {one.get('architecture', '?')}" for one in threadpool_info()}
    codes = [f"{one.code.called} {one.version or 'not here'}" for one in find_codes()]
    mkl = "MKL PARDISO" if pardiso.library() else "no MKL PARDISO"
    lines = {
        "sheetbench": f"{sources.version()}, source {sources.source()}, in {Path(__file__).parents[2]}",
        "Python": f"{machine['python']} on {machine['system']}, {machine['architecture']}",
        "processor": f"{machine['processor']} ({binding.get_host_cpu_name()}), {machine['cpu_count']} cores, "
        f"load {'unknown' if busy is None else f'{busy:.3g}'}",
        "memory": "unknown" if free is None else f"{work.memory(free)} free",
        "BLAS": ", ".join(sorted(blas)) or "none found",
        "solvers": f"own multifrontal, SciPy's SuperLU, {mkl}",
        "other codes": ", ".join(codes),
        "plug-ins": ", ".join(plugins.names()) or "none",
        "pictures": offscreen.why_not() or "can be drawn",
        "kernels": os.environ["NUMBA_CACHE_DIR"],
        "packages": ", ".join(f"{name} {version}" for name, version in manifest.versions().items()),
    }
    return "\n".join(f"{name + ':':12} {value}" for name, value in lines.items())
