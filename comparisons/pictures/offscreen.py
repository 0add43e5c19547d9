"""Whether VTK can draw off screen here, found out without risking this process.

VTK draws through the system's EGL or OSMesa library. Without either it does not raise, it ends the process
with a segmentation fault: so a small picture is tried in a child process first, once per process.
"""

from __future__ import annotations

import os
import subprocess
import sys
from functools import cache

PACKAGES = "libegl1 libgl1-mesa-dri (or libosmesa6)"
_WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
_WINDOWS = ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow", "")  # "": whatever VTK picks by itself
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


@cache
def why_not() -> str | None:
    """None where off-screen drawing works; else why there is no picture and what to install.

    The first kind of window that works is kept for this process.
    """
    requested = os.environ.get(_WINDOW)
    for window in (requested,) if requested else _WINDOWS:
        if _draws({**os.environ, _WINDOW: window}):
            os.environ[_WINDOW] = window
            return None
    return f"off-screen drawing does not work on this system; on Debian install {PACKAGES}"


def _draws(environment: dict[str, str]) -> bool:
    try:
        trial = subprocess.run(
            [sys.executable, "-c", _TRIAL], env=environment, capture_output=True, timeout=120, check=False
        )
    except (OSError, subprocess.TimeoutExpired):
        return False
    return trial.returncode == 0
