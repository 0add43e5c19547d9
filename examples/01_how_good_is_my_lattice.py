"""
1. How good is my lattice?
==========================

Test 1 of the published study (Habibi et al.): a nitrile sheet with two adjacent edges clamped, under its
own weight. Its 9 × 9 × 2 lattice is solved beside a finite-element shell of the same sheet.
"""

import matplotlib.pyplot as plt
import numpy as np

import sheetbench as sb

both = sb.compare("two-edges-clamped", elements=8)
print(both)

# %%
# Along the free diagonal, from the clamped corner to the loose one:

along = np.linspace(0.0, 1.0, 41)
points = np.outer(along, [both.scene.sheet.length_x, both.scene.sheet.length_y])
figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
for solution in both.solutions:
    depth = 1e3 * solution.displacement(points)[:, 2]
    axes.plot(1e3 * points[:, 0], depth, label=solution.model)
axes.set(xlabel="x = y [mm]", ylabel="uz [mm]")
axes.legend(frameon=False)
plt.show()
