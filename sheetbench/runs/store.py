"""Storage of a run's samples: in memory, or in a folder that grows during the run and can be resumed.

A folder holds `run.json` (its settings, version and source of the code), `samples.bin` (rows of float64, one
a sample), `frames.bin` (displacements (rows, 3) float64, one a frame) and `checkpoint.npz`. Samples and
frames are appended; the other files are replaced as a whole. The checkpoint holds the number of bytes and the
CRC-32 of the appended files. Rows after a checkpoint are dropped on resuming and computed again, so that a
resumed run gives an equal file to the last bit; a run of other code is refused. Memory does not grow with the
duration. A folder has one writer at a time; links in it are not followed.
"""

import json
import os
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any, BinaryIO, Self

import numpy as np

from sheetbench.errors import BadInput
from sheetbench.files import UNSUPPORTED, only_writer, replacing, writing
from sheetbench.sources import source, version

APPENDED = ("samples", "frames")
Shapes = dict[str, tuple[int, ...]]  # shape of a row of each
CHECKSUM = "{}_crc32"  # key in the checkpoint, for the counted bytes of a file


class MemoryStore:
    """Samples in memory, which cannot be resumed. shapes: of a row of each of `APPENDED`."""

    def __init__(self, shapes: Shapes):
        self._parts = {name: [np.empty((0, *shape))] for name, shape in shapes.items()}

    def append(self, name: str, rows: np.ndarray) -> None:
        """Append samples (k, width), or frames (k, rows, 3)."""
        self._parts[name].append(rows.copy())

    def checkpoint(self, content: dict[str, Any]) -> None:
        """Do nothing."""

    def resume(self) -> dict[str, Any] | None:
        """Return None: there is no checkpoint."""
        return None

    def rows(self, name: str) -> np.ndarray:
        """Return all samples, (n, width), or frames, (n, rows, 3)."""
        return np.concatenate(self._parts[name])


class FolderStore:
    """Context manager of samples in a folder.

    description: data for JSON on the run, stored with the version and the digest of the code. Entering raises
    BadInput for a folder with another run, in use or without permission to write, and for damaged files.
    """

    def __init__(self, folder: Path, shapes: Shapes, description: dict[str, Any]):
        self.folder, self._shapes = folder, shapes
        code = {"version": version(), "source": source()}
        self._description = json.loads(json.dumps({**description, **code}))
        self._checksums = dict.fromkeys(APPENDED, 0)

    def __enter__(self) -> Self:
        with writing(self.folder):
            self.folder.mkdir(parents=True, exist_ok=True)
        with ExitStack() as held:
            held.enter_context(only_writer(self.folder))
            self._check_description()
            self._held = held.pop_all()
        return self

    def __exit__(self, *error: object) -> None:
        self._held.close()

    def append(self, name: str, rows: np.ndarray) -> None:
        """Append samples (k, width), or frames (k, rows, 3)."""
        written = np.ascontiguousarray(rows, dtype=float).tobytes()
        with self._open(name, os.O_WRONLY | os.O_APPEND) as file:
            file.write(written)
        self._checksums[name] = zlib.crc32(written, self._checksums[name])

    def checkpoint(self, content: dict[str, Any]) -> None:
        """Replace the checkpoint, after all appended rows are on disk."""
        sizes = {name: self._sync(name) for name in APPENDED}
        checksums = {CHECKSUM.format(name): self._checksums[name] for name in APPENDED}
        with replacing(self.folder / "checkpoint.npz") as partial, partial.open("wb") as file:
            np.savez(file, **{**content, **sizes, **checksums})
            file.flush()
            os.fsync(file.fileno())

    def resume(self) -> dict[str, Any] | None:
        """Return the last checkpoint and cut the files back to it; without one empty them and return None.

        Raises BadInput for a damaged checkpoint, and for files that are missing, too short or altered.
        """
        path = self.folder / "checkpoint.npz"
        if not path.exists():
            self._truncate(dict.fromkeys(APPENDED, 0))
            return None
        try:
            content = dict(np.load(path))
            sizes = {name: int(content[name]) for name in APPENDED}
            self._checksums = {name: int(content[CHECKSUM.format(name)]) for name in APPENDED}
        except (OSError, ValueError, LookupError, EOFError, zipfile.BadZipFile) as error:
            raise self._damage_error(path, f"is damaged ({error})") from None
        for name, size in sizes.items():
            appended = self._file(name)
            present = appended.stat().st_size if appended.exists() else 0
            if present < size:
                fault = f"holds {present} of the {size} bytes that the checkpoint counts"
                raise self._damage_error(appended, fault)
            written = np.memmap(appended, np.uint8, "r", shape=size).data if size else b""
            if zlib.crc32(written) != self._checksums[name]:
                raise self._damage_error(appended, "was changed after the run wrote it: its checksum differs")
        self._truncate(sizes)
        return content

    def rows(self, name: str) -> np.ndarray:
        """Return all samples, (n, width), or frames, (n, rows, 3), mapped from the file."""
        path, shape = self._file(name), self._shapes[name]
        if path.stat().st_size == 0:
            return np.empty((0, *shape))
        return np.memmap(path, dtype=float, mode="r").reshape(-1, *shape)

    def _check_description(self) -> None:
        """Write the run's description, or compare it with the description in the folder."""
        path = self.folder / "run.json"
        if not path.exists():
            if (self.folder / "checkpoint.npz").exists():
                raise self._damage_error(path, "is missing beside a checkpoint")
            with replacing(path) as partial:
                text = json.dumps({"asked": self._description}, sort_keys=True)
                partial.write_text(text, encoding="utf-8")
        try:
            stored = dict(json.loads(path.read_text(encoding="utf-8"))["asked"])
        except (OSError, ValueError, TypeError, LookupError) as error:
            raise self._damage_error(path, f"is damaged ({error})") from None
        requested = self._description
        differing = [key for key in {**stored, **requested} if stored.get(key) != requested.get(key)]
        if differing and set(differing) <= {"version", "source"}:
            raise BadInput(
                f"{self.folder}: holds a run of other code of sheetbench ({stored.get('version')}, source "
                f"{stored.get('source')}), which cannot be resumed; choose another folder or remove this one"
            )
        if differing:
            raise BadInput(
                f"{self.folder}: holds another run (of another {', '.join(differing)}); "
                "choose another folder or remove this one"
            )

    def _truncate(self, sizes: dict[str, int]) -> None:
        """Cut the appended files to their sizes [bytes], or make them."""
        for name, size in sizes.items():
            with self._open(name, os.O_WRONLY | os.O_CREAT) as file:
                os.ftruncate(file.fileno(), size)

    def _damage_error(self, path: Path, fault: str) -> BadInput:
        return BadInput(f"{path}: {fault}; remove the folder {self.folder} to start the run over")

    def _file(self, name: str) -> Path:
        return self.folder / f"{name}.bin"

    @contextmanager
    def _open(self, name: str, flags: int) -> Iterator[BinaryIO]:
        path = self._file(name)
        with writing(path), os.fdopen(os.open(path, flags | UNSUPPORTED, 0o666), "wb") as file:
            yield file

    def _sync(self, name: str) -> int:
        with self._open(name, os.O_WRONLY | os.O_APPEND) as file:
            os.fsync(file.fileno())
            return os.fstat(file.fileno()).st_size
