"""Actuators: chains and prescribed motions, bound to the sheet's edges."""

from lumped.actuators.actuator import Drive
from lumped.actuators.coupling import Coupling

__all__ = ["Coupling", "Drive"]
