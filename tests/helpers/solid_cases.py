"""A block, for the tests of the solid."""

from sheetbench.scenes import Material, Scene, Sheet


def block(thickness: float = 0.4, poisson: float = 0.3, supports=(), loads=()) -> Scene:
    return Scene(
        name="block",
        sheet=Sheet(length_x=1.0, length_y=1.0, thickness=thickness),
        material=Material(young=1.0e6, poisson=poisson, density=1000.0),
        supports=supports,
        loads=loads,
    )
