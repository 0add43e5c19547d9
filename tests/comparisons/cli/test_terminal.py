"""What people see on a terminal: characters that it lacks, a campaign's bar.

What every verb shows there: test_every_verb.py.
"""

import io

import pytest

from comparisons.cli import characters


@pytest.mark.parametrize(
    ("encoding", "text", "printed"),
    [
        ("ascii", "ν = 0.48, κ₀ −1.5e−3 ± 2 %, 9 × 9", "nu = 0.48, kappa0 -1.5e-3 +- 2 %, 9 x 9"),
        ("ascii", "ρ² m⁻¹ Σ ½ é ω̇ │─┼ …", "rho^2 m^-1 Sigma 1/2 e omega |-+ ..."),
        ("latin-1", "µ ± ² × é −", "µ ± ² × é -"),
        ("utf-8", "ν ω̇ ❤", "ν ω̇ ❤"),
        ("ascii", "❤", "?"),
    ],
)
def test_what_an_encoding_lacks_is_spelled(encoding, text, printed):
    stream = io.TextIOWrapper(io.BytesIO(), encoding=encoding)
    characters.adapt(stream)
    stream.write(text)
    stream.flush()
    assert stream.buffer.getvalue().decode(encoding) == printed == characters.spelled(text, encoding)
