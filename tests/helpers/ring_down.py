"""The damping of a mode that rings down, from even samples."""

import numpy as np


def damping_ratio(swing: np.ndarray, per_period: float) -> float:
    """The pole that the swing and what fades beside it leave in samples (Prony's method), the first ten left
    out: its −Re s/|s|."""
    rows = np.lib.stride_tricks.sliding_window_view(swing / swing[0], 6)[10:]
    weights = np.linalg.lstsq(rows[:, :5], rows[:, 5], rcond=1e-10)[0]
    roots = np.roots([1.0, *-weights[::-1]])
    pole = np.log(roots[np.argmin(np.abs(np.angle(roots) - 2.0 * np.pi / per_period))])
    return float(-pole.real / abs(pole))
