"""Part f(I₁ − 3) of a rubber's energy (`scenes.objects.material`): its slopes, and its nonlinear part.

A further law is a row of that module's table and its slopes here.
"""

from collections.abc import Iterable

import numpy as np

from sheetbench.choices import STRAIN_LAW
from sheetbench.errors import BadInput, require_choice
from sheetbench.scenes import Scene
from sheetbench.scenes.meaning.composition import require_flat_at_rest
from sheetbench.scenes.objects.material import WORDS, Energy


def slopes(energy: Energy, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return f(x) − f′(0) x, f′(x) − f′(0) and f″(x), each (…) [Pa], of a law at x = I₁ − 3 (…).

    They are nan beyond Gent's limit, which ends a step.

    >>> slopes(Energy(1.0, limit=2.0), np.array([0.0, 1.0, 3.0]))[1]
    array([ 0.,  1., nan])
    """
    c10, _, c20, c30, limit = energy
    if not limit:
        second = 2.0 * c20 + 6.0 * c30 * x
        return (x * x * (c20 + c30 * x), x * (2.0 * c20 + 3.0 * c30 * x), second)
    rest = np.where(x < limit, 1.0 - x / limit, np.nan)
    return (-c10 * (limit * np.log(rest) + x), c10 * x / (limit * rest), c10 / (limit * rest**2))


def require_law(law: str, laws: Iterable[str], scene: Scene) -> None:
    """Raise BadInput for an unknown law, or a law whose constants the material does not have. Raises
    Impossible for any law but the default, of a sheet that is not flat at rest."""
    require_choice("law", law, laws)
    if law != STRAIN_LAW:
        require_flat_at_rest(scene, f"law '{law}'")
    if law in WORDS and scene.material.law != law:
        keys = " and ".join(WORDS[law].keys)
        raise BadInput(
            f"law = '{law}': the material lacks its constants; give the scene [material] law = '{law}' "
            f"with {keys}, or take law = 'neo-hookean', which needs none"
        )
