"""What moves: the discrete sheets, as the integrators and the runner of motions have them."""

from fem_reference.discrete.energies import Energies, Motion, energies, spent
from fem_reference.discrete.sheet import Discrete as Moving

__all__ = ["Energies", "Motion", "Moving", "energies", "spent"]
