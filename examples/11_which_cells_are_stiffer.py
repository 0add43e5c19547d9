"""
11. Which cells are stiffer?
============================

A lattice is a function of what each of its cells is made of, ``lumped.Differentiable``, and ``pullback``
gives the derivatives of one number by all of them for one more solve. Here 64 moduli are sought from 81
markers with noise of 0.2 % in three load cases: hanging, turned upside down, and pushed up at a corner.
"""

import matplotlib.pyplot as plt
import numpy as np
from scipy.optimize import minimize

import lumped

sheet = lumped.Differentiable("two-edges-clamped")  # 9 x 9 x 2 masses, 8 x 8 cells
young, side = sheet.base["cells.young"], sheet.scene.sheet.length_x
middle = (np.arange(8) + 0.5) / 8
x, y = np.meshgrid(middle, middle)
true = 1.0 + np.exp(-((x - 0.45) ** 2 + (y - 0.55) ** 2) / 0.03)  # up to twice as stiff

along = np.linspace(0.06, 0.98, 9) * side
markers = np.stack(np.meshgrid(along, along), axis=-1).reshape(-1, 2)
to_markers = sheet.at(markers)
weight = sheet.problem.loads.last_dead
corner = np.zeros_like(weight)
corner[-2:, 2] = -0.15  # N, on both layers at P4
cases = (np.zeros_like(weight), -2.0 * weight, corner)


def moved(factors, forces):
    u = sheet.solve({"cells.young": factors * young, "forces": forces})
    return (to_markers @ u.ravel()).reshape(-1, 3)


clean = [moved(true, forces) for forces in cases]
noise = 0.002 * max(np.abs(u).max() for u in clean)
rng = np.random.default_rng(1)
measured = [u + noise * rng.standard_normal(u.shape) for u in clean]


def misfit(logarithms, smoothing):
    """Return χ² plus the penalty of roughness, with the derivatives by the logarithms of the moduli."""
    p = logarithms.reshape(8, 8)
    factors, value, slope = np.exp(p), 0.0, np.zeros((8, 8))
    for forces, data in zip(cases, measured, strict=True):
        missed = (moved(factors, forces) - data) / noise
        value += np.sum(missed**2)
        by_u = (to_markers.T @ (2.0 * missed / noise).ravel()).reshape(weight.shape)
        slope += sheet.pullback(by_u)["cells.young"] * young * factors
    for axis in (0, 1):
        step = np.diff(p, axis=axis)
        value += smoothing * np.sum(step**2)
        ends = (
            [(1, 0) if axis == a else (0, 0) for a in (0, 1)],
            [(0, 1) if axis == a else (0, 0) for a in (0, 1)],
        )
        slope += 2.0 * smoothing * (np.pad(step, ends[0]) - np.pad(step, ends[1]))
    return value, slope.ravel()


found, count = np.zeros(64), 3 * 3 * len(markers)
for smoothing in (300.0, 100.0, 30.0):
    end = minimize(misfit, found, (smoothing,), "L-BFGS-B", jac=True, options={"maxiter": 60})
    found = end.x
    chi = misfit(found, 0.0)[0] / count
    off = np.sqrt(np.mean((np.exp(found).reshape(8, 8) / true - 1.0) ** 2))
    print(f"smoothing {smoothing:3g}: {end.nfev} gradients, chi²/n = {chi:.2f}, E {100 * off:.1f} % off")

# %%
# The moduli as they are, and as they were found: what is left is what such data do not say.

figure, axes = plt.subplots(1, 2, figsize=(7.0, 3.2), layout="constrained")
for axis, values, title in zip(axes, (true, np.exp(found).reshape(8, 8)), ("true", "found"), strict=True):
    drawn = axis.imshow(values, origin="lower", vmin=0.9, vmax=2.0, cmap="viridis")
    axis.set(title=title, xticks=[], yticks=[])
figure.colorbar(drawn, ax=axes, label="E over the sheet's")
plt.show()
