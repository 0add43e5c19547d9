"""Laws of rubber from tensile tests: closed forms, intervals that hold, Treloar's rubber, refusals."""

from pathlib import Path

import numpy as np
import pytest

from comparisons.identification.tensile.curves import TESTS, Curve, read
from comparisons.identification.tensile.laws import KEYS, LAWS, energy, kinematics, stress
from comparisons.identification.tensile.tensile import identify_tensile
from sheetbench.errors import BadInput

TRUE = {
    "neo-hookean": (0.6e6,),
    "mooney-rivlin": (0.08e6, 0.02e6),
    "yeoh": (0.1e6, -2e3, 400.0),
    "gent": (0.2e6, 20.0),
}


def work(of, test, stretch):
    """W of an incompressible sheet at a stretch."""
    s = {"uniaxial": stretch**-0.5, "pure-shear": 1.0, "equibiaxial": stretch}[test]
    squares = np.array([stretch, s, 1.0 / (stretch * s)]) ** 2
    x, y = squares.sum() - 3.0, (1.0 / squares).sum() - 3.0
    chain = -of.c10 * of.limit * np.log(1.0 - x / of.limit) if of.limit else of.c10 * x
    return float(chain + of.c20 * x**2 + of.c30 * x**3 + of.c01 * y)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("test", TESTS)
def test_stress_is_the_slope_of_the_work(law, test):
    """Of an equibiaxial sheet half the slope: two sides are pulled. Central differences, error (1e-5)²."""
    of = energy(law, TRUE[law])
    for at in (0.8, 1.3, 2.1):
        slope = (work(of, test, at + 1e-5) - work(of, test, at - 1e-5)) / 2e-5
        sides = 2.0 if test == "equibiaxial" else 1.0
        assert sides * stress(of, test, np.array([at]))[0] == pytest.approx(slope, rel=1e-7)
    assert stress(of, test, np.array([1.0]))[0] == pytest.approx(0.0, abs=1e-9)


def curves(law, tests=TESTS, noise=0.0, seed=0):
    random, found = np.random.default_rng(seed), []
    for test in tests:
        at = np.linspace(1.02, 3.0 if test == "uniaxial" else 2.2, 40)
        clean = stress(energy(law, TRUE[law]), test, at)
        found.append(Curve(test, at, clean + noise * clean.max() * random.standard_normal(len(at))))
    return found


@pytest.mark.parametrize("law", LAWS)
def test_a_laws_own_curves_give_its_constants_back(law):
    found = identify_tensile(curves(law))
    assert found.law is not None and found.law.law == law == found.material().law
    assert list(found.law.constants.values()) == pytest.approx(TRUE[law], rel=1e-4)
    assert found.material(poisson=0.4999).young == pytest.approx(found.law.young, rel=1e-3)


@pytest.mark.sweep
@pytest.mark.parametrize("law", LAWS)
def test_intervals_hold_in_18_to_20_of_20_seeds(law):
    held = np.zeros(len(KEYS[law]))
    for seed in range(20):
        (fit,) = (f for f in identify_tensile(curves(law, TESTS, 0.02, seed)).fits if f.law == law)
        low, high = np.array([fit.intervals[key] for key in KEYS[law]]).T
        held += (low <= TRUE[law]) & (TRUE[law] <= high)
    assert min(held) >= 18, held


def test_one_curve_cannot_tell_the_two_constants_of_mooney_rivlin():
    one, both = (
        identify_tensile(curves("mooney-rivlin", tests, 0.005))
        for tests in (("uniaxial",), ("uniaxial", "equibiaxial"))
    )
    (mooney,) = (f for f in one.fits if f.law == "mooney-rivlin")
    assert mooney.correlation < -0.9 and one.law.law != "mooney-rivlin" == both.law.law
    assert "cannot distinguish c1 from c2" in " ".join(one.report().notes)


def table(folder, text):
    (folder / "test.csv").write_text(text, encoding="utf-8")
    return str(folder / "test.csv")


def rows(stretch, values, header):
    return "\n".join([header, *(f"{s:.9g},{v:.9g}" for s, v in zip(stretch, values, strict=True))])


def test_columns_of_all_kinds_mean_the_same_curve(tmp_path):
    (one,) = curves("gent", ("uniaxial",))
    written = {
        "stretch,engineering_stress [MPa]": (one.stretch, one.stress / 1e6),
        "Engineering Strain (%),True Stress (kPa)": (100 * (one.stretch - 1), one.stress * one.stretch / 1e3),
        "true strain,force [mN]": (np.log(one.stretch), one.stress * 18e-6 * 1e3),
        "Displacement (mm),Force (N)": (33.0 * (one.stretch - 1), one.stress * 18e-6),
        'Strain,Force,Note\n"(-)","(kN)",': (one.stretch - 1, one.stress * 18e-9),
        "Extension,Force,Time\nmm,mN,s": (33.0 * (one.stretch - 1), one.stress * 18e-3),
        "stretch,true stress [kPa]\n-,Pa": (one.stretch, one.stress * one.stretch / 1e3),
        "engineering strain,true stress\n%,MPa": (100 * (one.stretch - 1), one.stress * one.stretch / 1e6),
    }  # fmt: skip
    for header, (stretch, values) in written.items():
        found = read(table(tmp_path, "Machine,5\n" + rows(stretch, values, header)), 18e-6, gauge=33e-3)
        assert found.stretch == pytest.approx(one.stretch, rel=1e-6)
        assert found.stress == pytest.approx(one.stress, rel=1e-6)
    for name, test in (("equibiaxial", "equibiaxial"), ("biaxial", "equibiaxial"), ("planar", "pure-shear")):
        assert read(f"{name}={tmp_path / 'test.csv'}", 18e-6, gauge=33e-3).test == test
    with pytest.raises(BadInput, match=r"test = 'planer': unknown.*did you mean planar"):
        read(f"planer={tmp_path / 'test.csv'}", 18e-6)
    (tmp_path / "test.csv").rename(tmp_path / "planer=1.csv")
    assert read(str(tmp_path / "planer=1.csv"), 18e-6, gauge=33e-3).test == "uniaxial"


@pytest.mark.parametrize("law", ["neo-hookean", "gent"])
def test_compression_and_tension_are_one_curve(law, tmp_path):
    """Of larger stress in compression, in any order; the torn side is the one that is named."""
    at = np.linspace(0.45, 2.2, 36)
    of = energy(law, TRUE[law])
    file = table(tmp_path, rows(at, stress(of, "uniaxial", at), "stretch,engineering_stress"))
    found = identify_tensile(file)
    assert found.law.law == law and found.covered == {"uniaxial": pytest.approx((0.45, 2.2))}
    assert list(found.law.constants.values()) == pytest.approx(TRUE[law], rel=1e-4)
    down = np.linspace(1.2, 0.3, 30)
    for way in (down, down[::-1]):
        assert len(
            read(table(tmp_path, rows(way, stress(of, "uniaxial", way), "stretch,true_stress"))).stress
        )
    crushed = stress(of, "uniaxial", down)
    crushed[-1] = -1.0
    with pytest.raises(BadInput, match=r"falls after stretch 0.331: torn. Leave out the rows below 0.331"):
        read(table(tmp_path, rows(down, crushed, "stretch,engineering_stress")))


UP = np.linspace(1.05, 2.0, 12)
PULL = 1e5 * (UP - UP**-2)
REFUSED = {
    "which stress": (rows(UP, PULL, "stretch,stress"), "engineering or true"),
    "per cent": (rows(100 * (UP - 1.0), PULL, "strain,engineering_stress"), r"per cent.*strain \[%\]"),
    "no unit": (rows(UP, PULL / 1e6, "stretch,engineering_stress"), "write the stress's unit"),
    "unloading": (
        rows(np.append(UP, UP[::-1]), np.append(PULL, PULL[::-1]), "stretch,true_stress"),
        "line 15: stretch goes back to 1.914: an unloading branch",
    ),
    "torn": (rows(np.append(UP, 2.1), np.append(PULL, 9.0), "stretch,nominal_stress"), "torn.*--up-to 2"),
    "no area": (rows(UP, PULL, "stretch,force"), "--area"),
    "no gauge": (rows(UP - 1.0, PULL, "displacement,true_stress"), "--gauge"),
    "few rows": (rows(UP[:2], PULL[:2], "stretch,true_stress"), "2 rows; at least 3"),
    "no stretch": (rows(UP, PULL, "time,true_stress"), "needed is stretch"),
    "pushed": (rows(UP, -PULL, "stretch,engineering_stress"), "tension is > 0"),
}  # fmt: skip


@pytest.mark.parametrize("fault", REFUSED)
def test_what_is_no_loading_branch_is_refused(tmp_path, fault):
    text, named = REFUSED[fault]
    path = table(tmp_path, text)
    with pytest.raises(BadInput, match=f"^{path}.*{named}"):
        read(path)


def measured_data(name):
    """The file of this name below `shared/data`, which stands beside the checkout or above it."""
    for above in Path(__file__).parents[3].parents:
        if (found := above / "shared" / "data" / name).is_file():
            return found
    pytest.skip(f"../shared/data/{name} is not there")


def test_treloars_rubber_asks_for_gent_with_published_constants(tmp_path):
    """Published of the same data: 0.240 MPa and 80 (Hyperelastics.jl), within our intervals."""
    text = measured_data("treloar/uniaxial.csv").read_text(encoding="utf-8")
    found = identify_tensile(table(tmp_path, text.replace(",Stress", ",engineering_stress [MPa]", 1)))
    assert found.law is not None and found.law.law == "gent"
    for key, published, width in (("shear", 0.240e6, 1.2), ("limit", 80.0, 1.1)):
        low, high = found.law.intervals[key]
        assert low < published < high < width * low
    largest = max(kinematics(curve.test, curve.stretch)[2].max() for curve in found.curves)
    assert largest == pytest.approx(7.512**2 + 2.0 / 7.512 - 3.0)


def test_a_silicone_file_is_read_as_the_machine_wrote_it():
    file = str(measured_data("silicone-tensile/Ecoflex 00-30.csv"))
    found = identify_tensile(file, up_to=2.5)
    assert len(found.curves[0].stretch) == 64
    assert found.law is not None and found.law.young == pytest.approx(47e3, rel=0.05)
    with pytest.raises(BadInput, match=r"--up-to = 0\.5: a stretch, above 1"):
        identify_tensile(file, up_to=0.5)


@pytest.mark.parametrize(
    ("mark", "rows"),
    [(",", "0,0\n0.1,0.05\n0.2,0.09\n0.3,0.13\n"), (";", "0;0\n0,1;0,05\n0,2;0,09\n0,3;0,13\n")],
)
def test_marks_in_a_machines_own_lines_separate_nothing(tmp_path, mark, rows):
    file, other = tmp_path / "pulled.csv", ",;".replace(mark, "")
    above = f"Instron 5544{other} specimen x{other}"
    file.write_text(f"{above}\nstrain{mark}engineering stress [MPa]\n{rows}")
    assert identify_tensile(str(file)).curves[0].stretch[-1] == pytest.approx(1.3)
