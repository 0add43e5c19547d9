"""
2. Which k belongs to my E?
===========================

Spring constants follow from E, ν and the thickness in closed form, and they depend on the grid. No single k
for all springs meets an isotropic sheet; the calibration ``consistent`` has one for every family of
springs.
"""

import matplotlib.pyplot as plt

import sheetbench as sb

grids = [5, 9, 17, 33]
found = {n: sb.calibrate("two-edges-clamped", grid=n) for n in grids}
print(found[9])

# %%
# The layers come closer as the grid gets finer, and every family goes its own way:

figure, (left, right) = plt.subplots(1, 2, figsize=(8.0, 3.4), layout="constrained")
left.semilogx(grids, [1e3 * found[n].layer_distance for n in grids], "o-", base=2)
left.set(xlabel="masses along a side", ylabel="distance of the layers [mm]")
for family in ("axial", "diagonal", "cross", "cross_diagonal"):
    k = [getattr(found[n].springs, family) for n in grids]
    right.loglog(grids, k, "o-", base=2, label=family.replace("_", " "))
right.set(xlabel="masses along a side", ylabel="k [N/m]", yscale="log")
figure.legend(loc="outside right center", frameon=False, fontsize="small")
for axes in (left, right):
    axes.set_xticks(grids, [str(n) for n in grids])
plt.show()
