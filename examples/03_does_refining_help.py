"""
3. Does refining help?
======================

The error of a lattice against the cells' size: with ``consistent`` springs it falls as the grid is refined,
with one k for all springs it goes to something else, since such a lattice has a twisting stiffness and a
Poisson's ratio of its own.
"""

import matplotlib.pyplot as plt

import sheetbench as sb

scene = sb.load("two-edges-clamped")
probes = scene.probe_points()  # (n, 2) [m]
truth = sb.solve(scene, "shell", elements=16).displacement(probes)

grids = [3, 5, 9, 17]
figure, axes = plt.subplots(figsize=(5.6, 3.8), layout="constrained")
for calibration in ("consistent", "cauchy", "uniform"):
    errors = []
    for grid in grids:
        lattice = sb.solve(scene, grid=grid, calibration=calibration)
        errors.append(100 * sb.error(lattice.displacement(probes), truth))
    print(
        f"{calibration:12s}", "  ".join(f"{grid}: {e:5.2f} %" for grid, e in zip(grids, errors, strict=True))
    )
    axes.loglog([grid - 1 for grid in grids], errors, "o-", label=calibration)
axes.set(xlabel="cells along a side", ylabel="error at the probes [%]")
axes.set_xticks([2, 4, 8, 16], ["2", "4", "8", "16"])
axes.xaxis.minorticks_off()
axes.legend(frameon=False)
plt.show()
