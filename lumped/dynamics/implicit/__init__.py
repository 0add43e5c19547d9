"""Implicit integrators: Newton's iteration with kept factors, compiled stages, ESDIRK, generalised-alpha."""
