"""Compilation of the kernels, each once, before the tests' processes start, which would each compile them
all.

    python tests/helpers/kernels.py

Two processes, since that is what small machines have: one for equilibria and implicit steps, the other for
explicit ones and the shell. Where all is in the cache, three seconds.
"""

import multiprocessing

DURATION = 1e-3  # s: kernels are compiled whatever the duration


def equilibria() -> None:
    """Call the kernels of statics, linear algebra and implicit integrators."""
    from dynamic_cases import make_scene, springs

    import lumped

    still, damped = make_scene(), make_scene(damping_time=1e-3)
    lumped.solve(still, springs(still, 3))
    lumped.modes(still, springs(still, 3), 3)
    for integrator in ("generalised-alpha", "esdirk"):
        lumped.simulate(damped, springs(damped, 3), DURATION, integrator=integrator)


def explicit() -> None:
    """Call the kernels of explicit integrators and the shell."""
    from dynamic_cases import make_scene, springs

    import fem_reference
    import lumped

    fem_reference.solve(make_scene(), "shell", elements=2)
    damped = make_scene(damping_time=1e-3)
    lumped.simulate(damped, springs(damped, 3), DURATION, integrator="verlet")


if __name__ == "__main__":
    processes = [multiprocessing.get_context("spawn").Process(target=half) for half in (equilibria, explicit)]
    for process in processes:
        process.start()
    for process in processes:
        process.join()
    raise SystemExit(max(abs(process.exitcode or 0) for process in processes))
