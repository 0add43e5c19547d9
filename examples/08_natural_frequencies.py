"""
8. Natural frequencies
======================

The first six of the sheet about its flat state, lattice and shell.
"""

import matplotlib.pyplot as plt

import sheetbench as sb

spectra = sb.modes("two-edges-clamped", count=6, grid=9, elements=8)
print(spectra)

# %%
# Each mode of the lattice beside the shell's mode of the same shape, whatever its place in the list
# (MAC is 1 for equal shapes):

for pair in spectra.pairs:
    print(f"{pair.number} {pair.kind:12} {100 * pair.relative:+.2f} %   MAC {pair.mac:.3f}")

figure, axes = plt.subplots(figsize=(5.6, 3.2), layout="constrained")
axes.bar([pair.number for pair in spectra.pairs], [100 * pair.relative for pair in spectra.pairs])
axes.axhline(0.0, color="black", linewidth=0.6)
axes.set(xlabel="mode of the lattice", ylabel="lattice − shell [%]")
plt.show()
