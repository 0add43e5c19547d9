"""
7. An edge bent by an actuator
==============================

A flexible chain of rigid segments bound to the edge opposite the clamp bends it upwards: the lattice with
the chain beside the shell with an elastic rod.
"""

import matplotlib.pyplot as plt
import numpy as np

import sheetbench as sb

both = sb.compare("actuated-edge", elements=8)
print(both)

# %%
# The driven edge, in both models:

scene = both.scene
y = np.linspace(0.0, scene.sheet.length_y, 41)
edge = np.column_stack([np.full_like(y, scene.sheet.length_x), y])
figure, axes = plt.subplots(figsize=(6.4, 3.4), layout="constrained")
for solution in both.solutions[:2]:
    u = solution.displacement(edge)
    axes.plot(1e3 * (y + u[:, 1]), 1e3 * u[:, 2], label=solution.label)
axes.set(xlabel="y [mm]", ylabel="z [mm]")
axes.legend(frameon=False)
plt.show()
