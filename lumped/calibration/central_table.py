"""The moduli of the calibration `central` by Poisson's ratio: `make central` finds and writes them.

ν, then a, b, c with D11 = a D, D12 = D66 = b D, A11 = c A, A12 = A66 = (b/a) c A, D and A the sheet's own;
the worst error that a sheet of these moduli makes on the training scenes that bend, on those that stretch,
and that of `cauchy` on those that bend. Trained on: `studies.transfer.training`.
"""

ROWS = (
    (-0.8, 1.128, 0.5369, 1.1449, 0.2824, 0.3951, 0.7118),
    (-0.4, 1.171, 0.4356, 1.1183, 0.202, 0.202, 0.4846),
    (0.0, 1.08, 0.3866, 1.1178, 0.1123, 0.0954, 0.2488),
    (0.1, 1.067, 0.3692, 1.099, 0.084, 0.0694, 0.1801),
    (0.2, 1.043, 0.3536, 1.0665, 0.0516, 0.0417, 0.1067),
    (0.3, 1.014, 0.3377, 1.0191, 0.0141, 0.0112, 0.0277),
    (0.3333, 1.0, 0.3333, 1.0, 0.0, 0.0, 0.0),
    (0.4, 0.971, 0.3243, 0.9564, 0.0306, 0.0237, 0.0577),
    (0.45, 0.947, 0.3172, 0.9186, 0.056, 0.0433, 0.1061),
    (0.49, 0.926, 0.3121, 0.8866, 0.0784, 0.0604, 0.1482),
)
