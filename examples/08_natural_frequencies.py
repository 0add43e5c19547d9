"""
8. Natural frequencies
======================

The first six of the sheet about its flat state, lattice and shell.
"""

import matplotlib.pyplot as plt
import numpy as np

import sheetbench as sb

spectra = sb.modes("two-edges-clamped", count=6, grid=9, elements=8)
print(spectra)

# %%
# Every frequency of the lattice, as a fraction of the shell's:

lattice, shell = spectra[0], spectra[1]
number = np.arange(1, 7)
figure, axes = plt.subplots(figsize=(5.6, 3.2), layout="constrained")
axes.bar(number, 100 * (lattice.frequencies / shell.frequencies - 1.0))
axes.axhline(0.0, color="black", linewidth=0.6)
axes.set(xlabel="mode", ylabel="lattice − shell [%]")
plt.show()
