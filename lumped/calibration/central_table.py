"""The moduli of the calibration `central` by Poisson's ratio: `make central` computes and writes them.

The training scenes are in `studies.transfer.training`.
"""

from typing import NamedTuple


class CentralFactors(NamedTuple):
    """Factors on the sheet's D and A at a Poisson's ratio, with their errors. D11 = bending D, D12 = D66 =
    twisting D, A11 = stretching A, A12 = A66 = (twisting/bending) stretching A; the errors are the largest on
    the training scenes that bend and that stretch, and of `cauchy` on scenes that bend."""

    poisson: float
    bending: float
    twisting: float
    stretching: float
    bending_error: float
    stretching_error: float
    cauchy_error: float


ROWS = (
    CentralFactors(-0.8, 1.128, 0.5369, 1.1449, 0.2824, 0.3951, 0.7118),
    CentralFactors(-0.4, 1.171, 0.4356, 1.1183, 0.202, 0.202, 0.4846),
    CentralFactors(0.0, 1.08, 0.3866, 1.1178, 0.1123, 0.0954, 0.2488),
    CentralFactors(0.1, 1.067, 0.3692, 1.099, 0.084, 0.0694, 0.1801),
    CentralFactors(0.2, 1.043, 0.3536, 1.0665, 0.0516, 0.0417, 0.1067),
    CentralFactors(0.3, 1.014, 0.3377, 1.0191, 0.0141, 0.0112, 0.0277),
    CentralFactors(0.3333, 1.0, 0.3333, 1.0, 0.0, 0.0, 0.0),
    CentralFactors(0.4, 0.971, 0.3243, 0.9564, 0.0306, 0.0237, 0.0577),
    CentralFactors(0.45, 0.947, 0.3172, 0.9186, 0.056, 0.0433, 0.1061),
    CentralFactors(0.49, 0.926, 0.3121, 0.8866, 0.0784, 0.0604, 0.1482),
)
