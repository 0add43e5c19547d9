"""Who answers: the lattice on a thread of this process, the shell in a process of its own, both warmed up.

Each solves one question at a time, whichever page asks.
"""

from __future__ import annotations

import asyncio
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Any

import numpy as np

from comparisons.calibration.answer import to_toml as springs_to_toml
from comparisons.live import answers
from comparisons.live.answers import Answered, Sampled
from comparisons.live.panel import Question
from comparisons.models.resolve import resolve
from comparisons.runs.executors import Processes, single_threaded
from sheetbench.scenes import Scene
from sheetbench.scenes.toml import to_toml


class Models:
    """Lattice and shell, to be awaited."""

    def __init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="lattice")
        self._process = Processes(1)

    async def warm_up(self, scene: Scene, question: Question) -> None:
        """Let both solve the question once, so that nothing is left to import or compile."""
        with single_threaded():  # as the process starts
            shell = self._shell(scene, question, scene.probe_points())
        await asyncio.gather(shell, self.lattice(scene, question), return_exceptions=True)

    async def lattice(self, scene: Scene, question: Question, last: Answered | None = None) -> Answered:
        """As `answers.lattice`."""
        return await self._on_thread(partial(answers.lattice, scene, question, last))

    async def shell(self, answered: Answered) -> dict[str, Any]:
        """Return the shell's message for the question that the lattice has answered."""
        sampled = await self._shell(answered.scene, answered.question, answered.masses)
        return answers.compared(answered, sampled)

    async def text(self, scene: Scene, question: Question) -> str:
        """Return what is to be copied, as TOML: the lattice's [springs], or the scene."""
        if question.copy == "scene":
            return to_toml(scene)
        springs = await self._on_thread(lambda: resolve(scene, question.lattice, "springs").springs)
        return springs_to_toml(springs)

    def close(self) -> None:
        """End both, whatever they are at."""
        self._thread.shutdown(wait=False, cancel_futures=True)
        self._process.abandon()

    def _shell(self, scene: Scene, question: Question, masses: np.ndarray) -> asyncio.Future[Sampled]:
        return asyncio.wrap_future(self._process.submit(answers.shell, scene, question, masses))

    async def _on_thread(self, work: Any) -> Any:
        return await asyncio.get_running_loop().run_in_executor(self._thread, work)
