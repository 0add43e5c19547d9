"""References on a mesh of one's own: the answer of our mesh, finer and coarser ones, its borders."""

import numpy as np
import pytest

import fem_reference
from fem_reference.surface.mesh import mesh_of
from fem_reference.uncertainty import solve_with_bar
from sheetbench.answers.solution import Status
from sheetbench.scenes import BadInput, Material, Scene, Sheet

ROOT = {"shape": {"rectangle": {"x": (0.0, 0.05), "y": (0.0, 0.1)}}, "young": 1e8}


def fin(own=(12, 6), **keys):
    """A trapezoid with a stiff root; own: meshed by hand, so many elements between straight lines."""
    across = [np.linspace(0.0, end, n + 1) for end, n in zip((0.2, 1.0), own or (1, 1), strict=True)]
    x, t = (one.ravel() for one in np.meshgrid(*across))
    low = 0.1 * x
    number = np.arange(len(x)).reshape(len(across[1]), -1)
    quads = np.stack([number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]], axis=-1)
    points = np.column_stack([x, low + (0.1 - 2.0 * low) * t])
    mesh = {"points": [tuple(p) for p in points], "quads": [tuple(q) for q in quads.reshape(-1, 4).tolist()]}
    outline = [(0.0, 0.0), (0.2, 0.02), (0.2, 0.08), (0.0, 0.1)]
    plan = Sheet(0.2, 0.1, 0.003, **({"mesh": mesh} if own else {"outline": outline}))
    probes = {"tip": (0.2, 0.05), "corner": (0.2, 0.08), "middle": (0.1, 0.05)}
    material, gravity = Material(1e7, 0.4, 1000.0), {"acceleration": (0.0, 0.0, -9.81)}
    held = {"supports": [{"kind": "clamped", "edge": "x0"}], "gravity": gravity, **keys}
    return Scene("fin", plan, material, patches=[ROOT], probes=probes, **held)


@pytest.mark.sweep(2)
@pytest.mark.parametrize(
    ("model", "own", "ours"), [("plate", (12, 6), 8), ("shell", (12, 6), 8), ("solid", (4, 2), 3)]
)
def test_a_mesh_by_hand_gives_the_answer_of_our_mesh_within_their_bars(model, own, ours):
    by_hand, ours = (
        solve_with_bar(scene, scene.probe_points(), model, n)
        for scene, n in ((fin(own), 16), (fin(None), ours))
    )
    assert by_hand[0].status is ours[0].status is Status.CONVERGED and by_hand[0].balance.holds
    size = np.abs(ours[1].answer).max()
    off = np.abs(by_hand[1].answer - ours[1].answer).max() / size
    assert off <= by_hand[1].error + ours[1].error < 0.2
    drawn = 8 if model == "solid" else 4  # cells an element
    assert len(by_hand[0].mesh.cells[0][1]) == drawn * own[0] * own[1]


def test_sixteenths_of_a_mesh_are_it_or_cut_up_or_our_own():
    meshes = {n: mesh_of(fin(), n) for n in (16, 32, 12)}
    assert [meshes[n].nelements for n in (16, 32)] == [72, 288]
    assert np.isclose(meshes[16].p[:, :, None], meshes[32].p[:, None]).all(axis=0).any(axis=1).all()
    wanted = 72 * (12 / 16) ** 2  # ours is made of halves, each of whole elements across
    assert 0.5 * wanted < meshes[12].nelements < 2.0 * wanted
    assert {"x0", "x1"} <= set(meshes[16].boundaries) and len(meshes[16].boundaries["x0"]) == 6


def test_a_shape_between_the_sides_of_elements_is_refused():
    askew = {"kind": "clamped", "where": {"circle": {"centre": (0.03, 0.05), "radius": 0.02}}}
    scene = fin(supports=[askew])
    with pytest.raises(BadInput, match=r"sheet\.mesh: its sides do not lie on the border of the circle"):
        fem_reference.solve(scene, "shell")
    assert fem_reference.solve(scene, "plate", elements=12).status is Status.CONVERGED  # a mesh of ours


@pytest.mark.parametrize(("high", "share"), [(0.05, 0.5), (0.055, None)])
def test_a_part_of_an_edge_is_loaded_where_elements_end(high, share):
    part = {"rectangle": {"x": (0.199, 0.2), "y": (0.0, high)}}  # thinner than an element
    pull = {"kind": "edge", "edge": "x1", "force_per_length": (0.0, 0.0, 0.2), "where": part}
    scene = fin(loads=[pull], gravity=None)
    if share is None:
        with pytest.raises(BadInput, match=r"do not lie on the border of the rectangle .* 114 % of the part"):
            fem_reference.solve(scene, "plate")
    else:
        lift = sum(fem_reference.solve(scene, "plate").reactions.values())[2]
        assert lift == pytest.approx(-0.2 * share * 0.06)


def test_a_mesh_without_coarser_ones_has_no_error_bar():
    assert solve_with_bar(fin(own=(4, 2)), np.array([[0.2, 0.05]]), elements=4)[1] is None
