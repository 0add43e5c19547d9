"""
6. A sheet that settles
=======================

The dynamics of Habibi et al., the published study: the weight is switched on at t = 0, dampers bring
the sheet to rest. Energies are accounted for, so a wrong step would show.
"""

import matplotlib.pyplot as plt

import sheetbench as sb

history = sb.simulate("two-edges-settling", 0.4, grid=5)
print(history)

# %%
# The free corner, and where the energy goes:

figure, (left, right) = plt.subplots(1, 2, figsize=(8.8, 3.4), layout="constrained")
left.plot(history.time, 1e3 * history.probes["P4"][:, 2])
left.set(xlabel="time [s]", ylabel="uz of P4 [mm]")
for name, energy in history.energies.items():
    right.plot(history.time, 1e3 * energy, label=name)
right.plot(history.time, 1e3 * history.balance, "k--", label="balance")
right.set(xlabel="time [s]", ylabel="energy [mJ]")
figure.legend(loc="outside right center", frameon=False, fontsize="small")
plt.show()
