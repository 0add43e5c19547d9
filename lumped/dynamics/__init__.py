"""Dynamics of the lattice: integrators by name, streaming runs, histories."""

from lumped.dynamics.integrators import INTEGRATORS
from lumped.dynamics.simulation import simulate

__all__ = ["INTEGRATORS", "simulate"]
