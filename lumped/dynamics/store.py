"""Where a run's samples go: to memory, or to a folder that grows while the run goes on and can be resumed.

A folder holds `run.json` (what was asked, and the columns), `samples.bin` (rows of float64, one a sample),
`frames.bin` (displacements (rows, 3) float64, one a frame) and `checkpoint.npz`, replaced as a whole.
Rows after the last checkpoint are dropped on resuming and computed again, so that a resumed run gives the
same file to the last bit. Memory does not grow with the duration.
"""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np

from sheetbench.scenes.errors import BadInput


class MemoryStore:
    """Samples in memory; nothing to resume."""

    def __init__(self, width: int, rows: int):
        self._width, self._rows = width, rows
        self._samples: list[np.ndarray] = []
        self._frames: list[np.ndarray] = []

    def sample(self, row: np.ndarray) -> None:
        """Keep one sample (width,)."""
        self._samples.append(row)

    def frame(self, displacement: np.ndarray) -> None:
        """Keep one frame (rows, 3)."""
        self._frames.append(displacement.copy())

    def checkpoint(self, content: dict[str, Any]) -> None:
        """Nothing to keep."""

    def resume(self) -> dict[str, Any] | None:
        """There is nothing to resume from."""
        return None

    def samples(self) -> np.ndarray:
        """All samples, (n, width)."""
        return np.array(self._samples).reshape(-1, self._width)

    def frames(self) -> np.ndarray:
        """All frames, (n, rows, 3)."""
        return np.array(self._frames).reshape(-1, self._rows, 3)


class FolderStore:
    """Samples in a folder. asked: JSON-able description of the run; a folder of another run is refused."""

    def __init__(self, folder: Path, width: int, rows: int, asked: dict[str, Any]):
        self.folder, self._width, self._rows = folder, width, rows
        folder.mkdir(parents=True, exist_ok=True)
        about, text = folder / "run.json", json.dumps(asked, sort_keys=True)
        if about.exists() and json.loads(about.read_text(encoding="utf-8")) != json.loads(text):
            raise BadInput(f"store = '{folder}': holds another run; choose another folder or empty this one")
        about.write_text(text, encoding="utf-8")
        for name in ("samples.bin", "frames.bin"):
            (folder / name).touch()

    def sample(self, row: np.ndarray) -> None:
        """Append one sample (width,)."""
        self._append("samples.bin", row)

    def frame(self, displacement: np.ndarray) -> None:
        """Append one frame (rows, 3)."""
        self._append("frames.bin", displacement)

    def checkpoint(self, content: dict[str, Any]) -> None:
        """Replace the checkpoint; what was appended so far is on disk before it is."""
        sizes = {name: self._synced(f"{name}.bin") for name in ("samples", "frames")}
        partial = self.folder / "checkpoint.partial.npz"
        with partial.open("wb") as file:
            np.savez(file, **{**content, **sizes})
            file.flush()
            os.fsync(file.fileno())
        os.replace(partial, self.folder / "checkpoint.npz")

    def resume(self) -> dict[str, Any] | None:
        """The last checkpoint, with the files cut back to it; None, and empty files, where there is none."""
        path = self.folder / "checkpoint.npz"
        content = dict(np.load(path)) if path.exists() else None
        for name in ("samples", "frames"):
            os.truncate(self.folder / f"{name}.bin", int(content[name]) if content is not None else 0)
        return content

    def samples(self) -> np.ndarray:
        """All samples, (n, width), mapped from the file."""
        return self._mapped("samples.bin", (self._width,))

    def frames(self) -> np.ndarray:
        """All frames, (n, rows, 3), mapped from the file."""
        return self._mapped("frames.bin", (self._rows, 3))

    def _append(self, name: str, values: np.ndarray) -> None:
        with (self.folder / name).open("ab") as file:
            file.write(np.ascontiguousarray(values, dtype=float).tobytes())

    def _synced(self, name: str) -> int:
        with (self.folder / name).open("rb") as file:
            os.fsync(file.fileno())
            return os.fstat(file.fileno()).st_size

    def _mapped(self, name: str, shape: tuple[int, ...]) -> np.ndarray:
        path = self.folder / name
        if path.stat().st_size == 0:
            return np.empty((0, *shape))
        return np.memmap(path, dtype=float, mode="r").reshape(-1, *shape)
