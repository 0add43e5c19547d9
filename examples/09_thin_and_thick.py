"""
9. From foil to plate
=====================

The same sheet at other thicknesses, under a weight scaled to keep its deflection small: where a 9 × 9 × 2
lattice is good.
"""

import matplotlib.pyplot as plt

import sheetbench as sb

scene = sb.load("one-edge-clamped")
probes = scene.probe_points()
thicknesses = [0.5e-3, 1e-3, 2e-3, 4e-3, 8e-3, 16e-3]  # m
errors = []
for thickness in thicknesses:
    g = 9.81e-2 * (thickness / 3e-3) ** 2  # deflections go with g/h²
    thin = scene.replace(
        sheet=scene.sheet.replace(thickness=thickness), gravity=sb.Gravity(acceleration=(0.0, 0.0, -g))
    )
    truth = sb.solve(thin, "shell", elements=8).displacement(probes)
    errors.append(100 * sb.error(sb.solve(thin).displacement(probes), truth))

figure, axes = plt.subplots(figsize=(5.6, 3.4), layout="constrained")
axes.semilogx([1e3 * h for h in thicknesses], errors, "o-")
axes.set(xlabel="thickness [mm]", ylabel="error at the probes [%]", ylim=(0.0, None))
plt.show()
