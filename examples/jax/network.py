"""A network learns to command a sheet: `python examples/jax/network.py`, extra `jax`.

It is trained through the lattice without any data, from a wave that the free edge of example 12 should have,
two numbers, to the natural curvatures of 16 patches. The loss is what the sheet answers. Draws network.png.
"""

import jax
import jax.numpy as jnp
import matplotlib.pyplot as plt
import numpy as np

import lumped
import sheetbench as sb
from sheetbench.jax import solve

jax.config.update("jax_enable_x64", True)
side, steps = 0.1, 150
plain = sb.Scene(
    name="commanded",
    sheet=sb.Sheet(side, side, 0.003),
    material=sb.Material(young=10e6, poisson=0.48, density=1100.0),
    gravity=sb.Gravity(acceleration=(0.0, 0.0, -9.81)),
    supports=(sb.Clamped(edge="x0"),),
)
sheet = lumped.Differentiable(plain, lumped.calibrate(plain.sheet, plain.material, grid=9))
y = np.linspace(0.0, side, 9)
to_edge = sheet.at(np.column_stack([np.full(9, side), y])).toarray()
waves = 4e-3 * np.stack([np.sin(2.0 * np.pi * y / side), np.cos(2.0 * np.pi * y / side)])


def edge_of(design):
    """Return the height (9,) [m] of the free edge with curvatures (32,) of the patches."""
    cells = jnp.repeat(jnp.repeat(design.reshape(4, 4, 2), 2, axis=0), 2, axis=1)
    u = solve(sheet, {"cells.curvature": jnp.pad(cells, ((0, 0), (0, 0), (0, 1)))})
    return (to_edge @ u.ravel()).reshape(-1, 3)[:, 2]


def network(weights, wave):
    inner = jnp.tanh(weights["a"] @ wave + weights["b"])
    return 10.0 * (weights["c"] @ inner + weights["d"])


@jax.jit
@jax.value_and_grad
def loss(weights, batch):
    """Return the mean square error [mm²] of the edges plus a small penalty of curvature."""
    designs = jnp.stack([network(weights, wave) for wave in batch])
    missed = jnp.stack([edge_of(design) for design in designs]) - batch @ waves
    return 1e6 * jnp.mean(missed**2) + 1e-5 * jnp.mean(designs**2)


rng = np.random.default_rng(0)
weights = {"a": 0.7 * rng.standard_normal((16, 2)), "b": np.zeros(16)}
weights |= {"c": 0.05 * rng.standard_normal((32, 16)), "d": np.zeros(32)}
first, second = ({name: np.zeros_like(w) for name, w in weights.items()} for _ in range(2))
course = []
for step in range(1, steps + 1):  # Adam (Kingma and Ba 2015)
    value, slopes = loss(weights, rng.uniform(-1.0, 1.0, (4, 2)))
    course.append(float(value))
    for name, slope in slopes.items():
        first[name] = 0.9 * first[name] + 0.1 * slope
        second[name] = 0.99 * second[name] + 0.01 * slope**2
        move = first[name] / (1.0 - 0.9**step) / (np.sqrt(second[name] / (1.0 - 0.99**step)) + 1e-8)
        weights[name] = weights[name] - (0.02 if step < 0.7 * steps else 0.005) * move

unseen = rng.uniform(-1.0, 1.0, (4, 2))
figure, (left, right) = plt.subplots(1, 2, figsize=(7.4, 3.2), layout="constrained")
left.semilogy(course)
left.set(xlabel="step", ylabel="loss [mm²]")
for n, wave in enumerate(unseen):
    height = np.asarray(edge_of(network(weights, wave)))
    print(f"unseen wave {n + 1}: {1e3 * np.abs(height - wave @ waves).max():.2f} mm off at most")
    right.plot(1e3 * y, 1e3 * height, f"C{n}")
    right.plot(1e3 * y, 1e3 * wave @ waves, f"C{n}:")
right.set(xlabel="along the free edge [mm]", ylabel="height, wanted dotted [mm]")
figure.savefig("network.png")
