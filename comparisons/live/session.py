"""The conversation with one open page: questions while sliders move, answers as fast as models solve.

A question that waits is dropped for a newer one, for the lattice and for the shell apart; whatever arrives is
in the order of its questions, and says by its number which one it answers. The shell answers what the
lattice has answered, so that the two can be compared.

While one drags, the lattice's equilibrium is sought from the one before. When one rests it is found from flat
too, as `sheetbench compare` finds it: if the sheet has several equilibria, the page ends with that one.
"""

from __future__ import annotations

import asyncio
import json
import sys
import traceback
from collections.abc import AsyncIterator, Awaitable, Callable
from contextlib import suppress
from typing import Any, Generic, TypeVar

import numpy as np

from comparisons.live.answers import Answered
from comparisons.live.models import Models
from comparisons.live.panel import Panel, Question
from sheetbench.errors import BadInput

PAUSE = 0.3  # s without a new question: one rests
Send = Callable[[str], Awaitable[None]]
T = TypeVar("T")


class Newest(Generic[T]):
    """Room for one value: what is put last is what is got next, in place of what was not got yet."""

    def __init__(self) -> None:
        self._waiting: T | None = None
        self._there = asyncio.Event()

    def put(self, value: T) -> None:
        """Leave a value, in place of one that was not got yet."""
        self._waiting = value
        self._there.set()

    async def comes_within(self, seconds: float) -> bool:
        """Return whether there is a value to be got by then."""
        try:
            await asyncio.wait_for(self._there.wait(), seconds)
        except TimeoutError:
            return False
        return True

    async def get(self) -> T:
        """Return the newest value, as soon as there is one; it is gone then."""
        await self._there.wait()
        self._there.clear()
        found, self._waiting = self._waiting, None
        assert found is not None
        return found


class Session:
    """The conversation with one page."""

    def __init__(self, panel: Panel, models: Models, warm: Awaitable[None], send: Send) -> None:
        """warm: over when the models are ready."""
        self._panel, self._models, self._warm, self._send = panel, models, warm, send
        self._questions: Newest[Question] = Newest()
        self._answered: Newest[Answered] = Newest()
        self._known: np.ndarray | None = None  # rest places of the masses that the page has

    async def run(self, messages: AsyncIterator[str | bytes]) -> None:
        """Answer what comes until nothing comes any more."""
        await self._say({"kind": "panel", **self._panel.document()})
        await self._warm
        await self._say({"kind": "ready"})
        loops = [asyncio.ensure_future(loop()) for loop in (self._lattices, self._shells)]
        try:
            async for message in messages:
                await self._hear(message)
        finally:
            for loop in loops:
                loop.cancel()
            for loop in loops:
                with suppress(asyncio.CancelledError, Exception):
                    await loop

    async def _hear(self, message: str | bytes) -> None:
        try:
            question = self._panel.read(message)
        except BadInput as error:
            await self._say({"kind": "refused", "number": None, "said": str(error)})
            return
        if question.copy:
            text = await self._of(question, self._text(question))
            if text is not None:
                await self._say(
                    {"kind": "text", "number": question.number, "of": question.copy, "text": text}
                )
        else:
            self._questions.put(question)

    async def _lattices(self) -> None:
        last: Answered | None = None
        while True:
            question = await self._questions.get()
            last = await self._of(question, self._lattice(question, last))
            if last is None:
                continue
            await self._tell(last)
            if last.from_flat or await self._questions.comes_within(PAUSE):
                continue
            settled = await self._of(question, self._lattice(question))
            if settled is not None and not settled.agrees(last):
                last = settled
                await self._tell(last)

    async def _tell(self, answered: Answered) -> None:
        await self._say(answered.document(self._known))
        self._known = answered.solution.mesh.points
        self._answered.put(answered)

    async def _shells(self) -> None:
        while True:
            answered = await self._answered.get()
            found = await self._of(answered.question, self._models.shell(answered))
            if found is not None:
                await self._say(found)

    async def _lattice(self, question: Question, last: Answered | None = None) -> Answered:
        return await self._models.lattice(self._panel.scene_of(question), question, last)

    async def _text(self, question: Question) -> str:
        return await self._models.text(self._panel.scene_of(question), question)

    async def _of(self, question: Question, work: Awaitable[T]) -> T | None:
        """Return what the work comes to; None where it is refused or fails, which the page reports in a
        line."""
        try:
            return await work
        except BadInput as error:
            message = str(error)
        except Exception as error:  # a fault of the program: the page goes on, and the terminal shows it
            traceback.print_exception(error, file=sys.stderr)
            message = "a fault of the program; the terminal that it was started from says more"
        await self._say({"kind": "refused", "number": question.number, "said": message})
        return None

    async def _say(self, document: dict[str, Any]) -> None:
        await self._send(json.dumps(document, allow_nan=False))
