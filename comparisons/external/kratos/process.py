"""The process in which Kratos solves: `python -m comparisons.external.kratos.process PROBLEM ANSWER`.

Kratos has its own process because it prints on import and a crash in it ends the process. The arrays of the
file PROBLEM are described in `comparisons.external.kratos.model`. ANSWER holds displacement (n, 3) [m], the
load factor of the last converged step, and the number of iterations, each with one factorisation.

Newton's method runs at increasing load factors, each step from the last step's state.
"""

import sys
from time import perf_counter
from typing import Any

import numpy as np

CORRECTION = 1e-8  # of the displacement: the last of a step; the residual is rounding by then
ITERATIONS = 25  # per step
COMPONENTS = "XYZ"


def solve(problem: Any) -> dict[str, Any]:
    """Solve the problem of the given arrays."""
    import KratosMultiphysics as kratos
    import KratosMultiphysics.StructuralMechanicsApplication as mechanics

    kratos.Logger.GetDefaultOutput().SetSeverity(kratos.Logger.Severity.WARNING)
    part = kratos.Model().CreateModelPart("sheet", 2)
    part.ProcessInfo[kratos.DOMAIN_SIZE] = 3
    motions = (kratos.DISPLACEMENT, kratos.ROTATION, kratos.REACTION, kratos.REACTION_MOMENT)
    loads = (kratos.VOLUME_ACCELERATION, mechanics.POINT_LOAD, mechanics.SURFACE_LOAD)
    pressures = (kratos.POSITIVE_FACE_PRESSURE, kratos.NEGATIVE_FACE_PRESSURE)
    for variable in (*motions, *loads, *pressures):
        part.AddNodalSolutionStepVariable(variable)
    nodes = [part.CreateNewNode(i, *map(float, at)) for i, at in enumerate(problem["positions"], 1)]
    material = part.CreateNewProperties(1)
    young, poisson, density, thickness = map(float, problem["material"])
    material[kratos.YOUNG_MODULUS], material[kratos.POISSON_RATIO] = young, poisson
    material[kratos.DENSITY], material[kratos.THICKNESS] = density, thickness
    material[kratos.CONSTITUTIVE_LAW] = mechanics.LinearElasticPlaneStress2DLaw()
    corners = (problem["elements"] + 1).tolist()
    kind = f"ShellThinElementCorotational3D{len(corners[0])}N"
    for i, corner in enumerate(corners, 1):
        part.CreateNewElement(kind, i, corner, material)
    loaded = np.flatnonzero(problem["force"].any(axis=1))
    for i, node in enumerate(loaded.tolist(), 1):
        part.CreateNewCondition("PointLoadCondition3D1N", i, [node + 1], material)
    pressure = float(problem["pressure"])
    if pressure:
        for i, corner in enumerate(corners, len(loaded) + 1):
            part.CreateNewCondition(f"SurfaceLoadCondition3D{len(corner)}N", i, corner, material)

    def components(name: str) -> list[Any]:
        return [kratos.KratosGlobals.GetVariable(f"{name}_{axis}") for axis in COMPONENTS]

    unknowns = [*components("DISPLACEMENT"), *components("ROTATION")]
    reactions = [*components("REACTION"), *components("REACTION_MOMENT")]
    for variable, reaction in zip(unknowns, reactions, strict=True):
        kratos.VariableUtils().AddDof(variable, reaction, part)
    held = problem["held"]
    for node, unknown in np.argwhere(held):
        nodes[node].Fix(unknowns[unknown])
    from KratosMultiphysics import python_linear_solver_factory as factory

    scheme = kratos.ResidualBasedIncrementalUpdateStaticScheme()
    parameters = kratos.Parameters('{"solver_type": "LinearSolversApplication.sparse_lu"}')
    criteria = kratos.DisplacementCriteria(CORRECTION, 1e-15)
    builder = kratos.ResidualBasedBlockBuilderAndSolver(factory.ConstructSolver(parameters))
    strategy = kratos.ResidualBasedNewtonRaphsonStrategy(
        part, scheme, criteria, builder, ITERATIONS, False, False, True
    )
    strategy.SetEchoLevel(0)
    strategy.Initialize()
    reached, iterations, start = 0.0, 0, perf_counter()
    answer = np.zeros_like(problem["positions"])
    for step, load_factor in enumerate(problem["load_factors"].tolist(), 1):
        part.CloneTimeStep(float(step))
        part.ProcessInfo[kratos.STEP] = step
        acceleration = kratos.Array3([load_factor * float(c) for c in problem["acceleration"]])
        for node in nodes:
            node.SetSolutionStepValue(kratos.VOLUME_ACCELERATION, acceleration)
            if pressure:
                node.SetSolutionStepValue(kratos.NEGATIVE_FACE_PRESSURE, load_factor * pressure)
        for node in loaded.tolist():
            force = kratos.Array3([load_factor * float(c) for c in problem["force"][node]])
            nodes[node].SetSolutionStepValue(mechanics.POINT_LOAD, force)
        for node, unknown in np.argwhere(held):
            value = float(problem["value"][step - 1, node, unknown])
            nodes[node].SetSolutionStepValue(unknowns[unknown], value)
        strategy.InitializeSolutionStep()
        strategy.Predict()
        converged = strategy.SolveSolutionStep()
        strategy.FinalizeSolutionStep()
        iterations += int(part.ProcessInfo[kratos.NL_ITERATION_NUMBER])
        if not converged:
            break
        reached = load_factor
        answer = np.array([list(node.GetSolutionStepValue(kratos.DISPLACEMENT)) for node in nodes])
    seconds = perf_counter() - start
    return {"displacement": answer, "load_factor": reached, "iterations": iterations, "seconds": seconds}


if __name__ == "__main__":
    with np.load(sys.argv[1]) as file:
        arrays = solve(dict(file))
    np.savez(sys.argv[2], **arrays)
