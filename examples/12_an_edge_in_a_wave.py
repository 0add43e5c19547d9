"""
12. An edge designed as a wave
==============================

A heavy rubber sheet is clamped along one edge. Which natural curvatures of 16 patches hold its free edge in a
sine of 4 mm against the weight? The lattice finds these 32 numbers by gradients; the shell, which shares no
mechanics with it, then solves the same scene.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import minimize

import lumped
import sheetbench as sb
from sheetbench.scenes.objects.natural import Natural
from sheetbench.scenes.objects.patches import Patch

side = 0.1
plain = sb.Scene(
    name="designed",
    sheet=sb.Sheet(side, side, 0.003),
    material=sb.Material(young=10e6, poisson=0.48, density=1100.0),
    gravity=sb.Gravity(acceleration=(0.0, 0.0, -9.81)),
    supports=(sb.Clamped(edge="x0"),),
)
sheet = lumped.Differentiable(plain)
y = np.linspace(0.0, side, 9)
edge = np.column_stack([np.full(9, side), y])
to_edge = sheet.at(edge)
wave = 4e-3 * np.sin(2.0 * np.pi * y / side)


def over_cells(design):
    """Return curvatures (8, 8, 3) of patches (4, 4, 2) of 2 x 2 cells."""
    return np.pad(
        np.repeat(np.repeat(design.reshape(4, 4, 2), 2, axis=0), 2, axis=1), ((0, 0), (0, 0), (0, 1))
    )


def misfit(tenths):
    """Return the misfit of the edge's height [mm²] plus a small penalty of curvature, and its derivatives.

    tenths: curvatures in 10/m.
    """
    design = 10.0 * tenths
    u = sheet.solve({"cells.curvature": over_cells(design)})
    missed = np.zeros((9, 3))
    missed[:, 2] = 1e3 * ((to_edge @ u.ravel()).reshape(-1, 3)[:, 2] - wave)
    by_u = (to_edge.T @ (2e3 * missed).ravel()).reshape(u.shape)
    by_cells = sheet.pullback(by_u)["cells.curvature"]
    slope = by_cells[..., :2].reshape(4, 2, 4, 2, 2).sum(axis=(1, 3)).ravel() + 2e-4 * design
    return np.sum(missed**2) + 1e-4 * np.sum(design**2), 10.0 * slope


found = minimize(
    misfit, np.zeros(32), jac=True, method="L-BFGS-B", bounds=[(-6, 6)] * 32, options={"maxiter": 150}
)
curvature = 10.0 * found.x.reshape(4, 4, 2)
print(f"{found.nfev} gradients, curvatures up to {np.abs(curvature).max():.0f} 1/m")

# %%
# The design as a scene, on lattice and shell:

patches = tuple(
    Patch(
        shape={
            "rectangle": {"x": (side * i / 4, side * (i + 1) / 4), "y": (side * j / 4, side * (j + 1) / 4)}
        },
        natural=Natural(curvature=(*curvature[j, i].tolist(), 0.0)),
    )
    for j in range(4)
    for i in range(4)
)
designed = plain.replace(patches=patches)
heights = {
    "wanted": wave,
    "without the design": sb.solve(plain, "shell", elements=8).displacement(edge)[:, 2],
}
for model, settings in (("lumped", {"grid": 9}), ("shell", {"elements": 8})):
    heights[model] = sb.solve(designed, model, **settings).displacement(edge)[:, 2]
    print(f"{model}: {1e3 * np.abs(heights[model] - wave).max():.2f} mm off the wave of 4 mm")
figure, axes = plt.subplots(figsize=(5.2, 3.4), layout="constrained")
for name, z in heights.items():
    axes.plot(1e3 * y, 1e3 * z, ":" if name.startswith("without") else "-", label=name)
axes.set(xlabel="along the free edge [mm]", ylabel="height [mm]")
axes.legend(frameon=False)
plt.show()
