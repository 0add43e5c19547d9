"""What moves: the discrete sheets, as the integrators and the runner of motions have them."""

from fem_reference.discrete.sheet import Discrete as Moving
from fem_reference.discrete.sheet import Energies, Motion

__all__ = ["Energies", "Motion", "Moving"]
