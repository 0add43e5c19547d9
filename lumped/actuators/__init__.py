"""Actuators: chains of rigid segments and prescribed motions, bound to the sheet's edges."""

from lumped.actuators.actuator import Actuator, Drive
from lumped.actuators.coupling import Coupling

__all__ = ["Actuator", "Coupling", "Drive"]
