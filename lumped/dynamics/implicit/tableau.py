"""Coefficients of ESDIRK5(4)7L[2]SA2, a Runge–Kutta method: singly diagonally implicit with an explicit first
stage, fifth order with an embedded fourth, both L-stable, stiffly accurate, stages of second order.

Source: Kennedy and Carpenter (2019), Applied Numerical Mathematics 146, 221–244; the rationals as ARKODE
(Reynolds et al. 2023) has them.
"""

import numpy as np

GAMMA = 23 / 125  # on the diagonal of every stage but the first
ABSCISSAE = np.array(
    [0.0, 46 / 125, 7121331996143 / 11335814405378, 49 / 353, 3706679970760 / 5295570149437, 347 / 382, 1.0]
)
_INNER = (  # of stages 3 to 6, from the second column to the diagonal
    (791020047304 / 3561426431547,),
    (-158159076358 / 11257294102345, -85517644447 / 5003708988389),
    (-1653327111580 / 4048416487981, 1514767744496 / 9099671765375, 14283835447591 / 12247432691556),
    (
        -4540011970825 / 8418487046959,
        -1790937573418 / 7393406387169,
        10819093665085 / 7266595846747,
        4109463131231 / 7386972500302,
    ),
)
_LAST = (
    -188593204321 / 4778616380481,
    2809310203510 / 10304234040467,
    1021729336898 / 2364210264653,
    870612361811 / 2470410392208,
    -1307970675534 / 8059683598661,
)
_EMBEDDED = (
    -582099335757 / 7214068459310,
    615023338567 / 3362626566945,
    3192122436311 / 6174152374399,
    6156034052041 / 14430468657929,
    -1011318518279 / 9693750372484,
    1914490192573 / 13754262428401,
)


def _stages() -> np.ndarray:
    """Return A, (7, 7), whose first column completes the rows' sums to the abscissae."""
    a = np.zeros((7, 7))
    for row, inner in enumerate(((), *_INNER, _LAST), start=1):
        a[row, 1 : 1 + len(inner)] = inner
        a[row, row] = GAMMA
    a[:, 0] = ABSCISSAE - a.sum(axis=1)
    return a


def _cumulative() -> np.ndarray:
    """Return the coefficients (8, 7) of θ⁰ to θ⁷ in the integral from 0 to θ of the polynomial through values
    at the abscissae, corrected in proportion to θ so that it ends in the weights of the method."""
    coefficients = np.zeros((8, 7))
    powers = np.linalg.inv(np.vander(ABSCISSAE, increasing=True))  # of the values
    coefficients[1:] = powers / np.arange(1.0, 8.0)[:, None]
    coefficients[1] += WEIGHTS - coefficients.sum(axis=0)
    return coefficients


def _guesses() -> np.ndarray:
    """Return G, (7, 7), the guess of each stage's acceleration from the earlier stages: its displacement lies
    on the parabola nearest to their displacements and velocities, h² A² v̇ and h A v̇ without the part of the
    start alone."""
    guesses = np.zeros((7, 7))
    guesses[1, 0] = 1.0
    for i in range(2, 7):
        before = ABSCISSAE[:i] - ABSCISSAE[i]
        slope = np.vander(before, 2, True) @ [[0.0, 1.0, 0.0], [0.0, 0.0, 2.0]]
        parabola = np.vstack([np.vander(before, 3, True), slope])
        of_u, of_v = np.split(np.linalg.pinv(parabola)[0], 2)
        inner = np.where(np.arange(7) < i, STAGES[i], 0.0)
        led = of_u @ STAGES[:i] @ STAGES + of_v @ STAGES[:i]
        guesses[i] = (led - inner @ STAGES - GAMMA * inner) / GAMMA**2
    return np.tril(guesses, -1)


STAGES = _stages()
WEIGHTS = STAGES[-1]
ERRORS = WEIGHTS - np.array([1.0 - sum(_EMBEDDED), *_EMBEDDED])
CUMULATIVE = _cumulative()
GUESSES = _guesses()
