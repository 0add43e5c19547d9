"""A block, for the tests of the solid."""

from cases import sheet

from sheetbench.scenes import Scene


def block(thickness: float = 0.4, poisson: float = 0.3, supports=(), loads=()) -> Scene:
    return sheet(1.0, 1.0, thickness, 1e6, poisson, supports=supports, loads=loads)
