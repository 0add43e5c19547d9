"""
10. What E does my sheet have?
==============================

``identify`` finds the values with which a model comes nearest to measured displacements, with 95 %
intervals. Here the measurement is the shell's answer for E = 40 MPa with 0.05 mm of noise, so that what it
should find is known.
"""

import matplotlib.pyplot as plt
import numpy as np

import sheetbench as sb

scene = sb.load("two-edges-clamped")
made = scene.replace(young=40e6)  # Pa
points = np.array([(0.03 + 0.04 * i, 0.03 + 0.04 * j) for i in range(4) for j in range(4)])
measured = sb.solve(made, "shell", elements=8).displacement(points)
measured = measured + np.random.default_rng(1).normal(0.0, 0.05e-3, measured.shape)

found = sb.identify(scene, sb.Displacements(points, measured), "young", refine=False)
print(found)

# %%
# What was measured against what the fitted lattice answers:

fitted = scene.replace(young=found.unknowns["young"].value)
answered = sb.solve(fitted).displacement(points)
figure, axes = plt.subplots(figsize=(4.4, 4.0), layout="constrained")
axes.plot(1e3 * measured[:, 2], 1e3 * answered[:, 2], "o")
ends = [1e3 * measured[:, 2].min(), 0.0]
axes.plot(ends, ends, "k", linewidth=0.6)
axes.set(xlabel="measured uz [mm]", ylabel="the fitted lattice's [mm]", aspect="equal")
plt.show()
