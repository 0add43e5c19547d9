"""
4. A sheet of my own, in Python
===============================

A silicone strip of 300 × 200 × 2 mm between two clamps, with a weight in its middle. The same scene could
stand in a TOML file (``sheetbench new my-sheet.toml`` writes one); here it is made of objects.
"""

import pyvista

import sheetbench as sb

scene = sb.Scene(
    name="weighted strip",
    sheet=sb.Sheet(length_x=0.30, length_y=0.20, thickness=0.002),  # m
    material=sb.Material(young=1.2e6, poisson=0.45, density=1100.0),  # Pa, kg/m³
    gravity=sb.Gravity(acceleration=(0.0, 0.0, -9.81)),  # m/s²
    supports=(sb.Clamped(edge="x0"), sb.Clamped(edge="x1")),
    loads=(sb.PointLoad(at=(0.15, 0.10), force=(0.0, 0.0, -0.2)),),  # N
)
print(sb.check(scene))

# %%
# The shell's deformed surface, coloured by its own displacement:

shell = sb.solve(scene, "shell", elements=8)
surface = shell.to_pyvista().extract_surface(algorithm="dataset_surface").warp_by_vector("displacement")
surface["uz [mm]"] = 1e3 * surface["displacement"][:, 2]
plotter = pyvista.Plotter(off_screen=True, window_size=(800, 450))
plotter.add_mesh(surface, scalars="uz [mm]", cmap="cividis", smooth_shading=True)
plotter.view_isometric()
plotter.show()
