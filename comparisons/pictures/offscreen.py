"""A test of VTK's off-screen drawing on this system in a child process.

VTK draws through the system's EGL or OSMesa library. Without either it ends the process with a segmentation
fault, so a small image is drawn in a child process first, once per process.
"""

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache

PACKAGES = "libegl1 libgl1-mesa-dri (or libosmesa6)"
_WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
_WINDOWS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow", "")  # "": VTK's default
_TRIAL = """
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkFiltersSources import vtkPlaneSource
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter,
)

plane, mapper, actor, renderer = vtkPlaneSource(), vtkPolyDataMapper(), vtkActor(), vtkRenderer()
mapper.SetInputConnection(plane.GetOutputPort())
actor.SetMapper(mapper)
renderer.AddActor(actor)
window = vtkRenderWindow()
window.SetOffScreenRendering(True)
window.SetSize(32, 32)
window.AddRenderer(renderer)
window.Render()
image = vtkWindowToImageFilter()
image.SetInput(window)
image.Update()
low, high = image.GetOutput().GetPointData().GetScalars().GetRange()
raise SystemExit(0 if low < high else 1)
"""


def unavailable_reason() -> str | None:
    """Return the reason against off-screen drawing and the packages to install, None if it works."""
    if _working_window() is None:
        return f"off-screen drawing does not work on this system; on Debian install {PACKAGES}"
    return None


@contextmanager
def drawing() -> Iterator[None]:
    """Set the environment variable for a block that selects a kind of VTK window that works here."""
    previous = os.environ.get(_WINDOW)
    os.environ[_WINDOW] = _working_window() or ""
    try:
        yield
    finally:
        del os.environ[_WINDOW]
        os.environ.update({} if previous is None else {_WINDOW: previous})


@cache
def _working_window() -> str | None:
    """Return the first kind of window that passes a trial drawing, None if none passes."""
    requested = os.environ.get(_WINDOW)
    kinds = (requested,) if requested else _WINDOWS
    return next((kind for kind in kinds if _draws({**os.environ, _WINDOW: kind})), None)


def _draws(environment: dict[str, str]) -> bool:
    try:
        trial = subprocess.run(
            [sys.executable, "-c", _TRIAL], env=environment, capture_output=True, timeout=120, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return trial.returncode == 0
