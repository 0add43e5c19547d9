"""Observer of a reference's run: energies, probes, reactions and actuators' forces as rows, and strains."""

import numpy as np

from fem_reference.discrete.elements import DiscreteElements
from fem_reference.discrete.energies import energies
from fem_reference.motion.generalised_alpha import Sampled
from sheetbench.answers.solution import Status
from sheetbench.numerics.continuation.path import Fault
from sheetbench.runs.record import columns_of
from sheetbench.scenes import Scene


class ReferenceObserver:
    """Observer (`sheetbench.runs.run`) of a reference."""

    least_energy = 0.0

    def __init__(self, model: DiscreteElements, scene: Scene):
        self._model, self._points = model, scene.probe_points()
        nothing = np.zeros(model.size)
        self._reactions = list(model.reactions(nothing))
        flat = model.shape(nothing, 0.0)
        held = [*self._reactions, *model.item_support_forces(flat)]
        self.columns = columns_of(scene, held, model.wrenches(flat, nothing)[1])

    def rows(self, samples: Sampled) -> np.ndarray:
        """Return the numbers of samples, (k, width)."""
        model, rows = self._model, []
        for motion in samples.motions:
            kinds = energies(model, motion)
            probes = model.sample(model.displacement(motion.q), self._points)
            reactions = model.reactions(motion.exerted)
            forces = [reactions[name] for name in self._reactions]
            shape = model.shape(motion.q, motion.time, motion.v)
            forces += [force.sum(axis=0) for _, force in model.item_support_forces(shape).values()]
            wrenches = model.wrenches(shape, motion.exerted, motion.a)[1]
            forces += [wrench.ravel() for wrench in wrenches.values()]
            rows.append(np.concatenate([[0.0, *kinds, 0.0, 0.0], probes.ravel(), *forces]))
        table = np.array(rows)
        table[:, 0], table[:, 4], table[:, 5] = samples.time, samples.dissipated, samples.work
        return table

    def inspect(self, samples: Sampled, count: int) -> tuple[np.ndarray, Fault | None]:
        """Return stretches of the first samples before one with an inverted element, and its fault."""
        stretches = np.empty(count)
        for i, motion in enumerate(samples.motions[:count]):
            if inverted := self._model.inverted_element(motion.q):
                return stretches[:i], Fault(Status.INVERTED, inverted)
            stretches[i] = self._model.shape(motion.q, motion.time).stretch
        return stretches, None

    def beyond(self, stretch: float) -> str:
        """Return a clause if a stretch exceeds the range of the law of strain, else ""."""
        return self._model.beyond(stretch)

    def fastest(self, samples: Sampled, i: int) -> str:
        """Return the place of the fastest node in the flat sheet, in words."""
        motion, model = samples.motions[i], self._model
        speed = np.abs(model.displacement(motion.v)).max(axis=1)
        node = int(np.argmax(np.where(np.isfinite(speed), speed, np.inf)))
        x, y, _ = model.mesh(np.zeros((model.nodes, 3))).points[node]
        return f"x = {x:.4g} m, y = {y:.4g} m"

    def frame(self, samples: Sampled, i: int) -> np.ndarray:
        """Return the displacement (n, 3) [m] of the nodes."""
        return self._model.displacement(samples.motions[i].q)
