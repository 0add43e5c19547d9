"""Files of results: whole or absent, with one writer at a time, and a line on the reason of a failure.

A file is written under a temporary name and renamed when it is complete; until then an older file stays.
Only a regular file is replaced: links, devices, pipes and folders are refused. The temporary file of a killed
writer is removed by the next writer of that name.
"""

import errno
import fcntl
import os
import re
import stat
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from sheetbench.errors import BadInput

LOCK = ".lock"
PARTIAL = re.compile(r"\.(?P<stem>.+)\.(?P<process>\d+)\.partial(?P<suffix>\..*)?")
KINDS = ((stat.S_ISLNK, "link"), (stat.S_ISDIR, "folder"))
UNSUPPORTED = os.O_CLOEXEC | os.O_NOFOLLOW
AGAIN, ELSEWHERE = "run the same command again", "choose another folder"
REMEDIES = {
    **dict.fromkeys((errno.ENOSPC, errno.EDQUOT), f"free some and {AGAIN}"),
    errno.EFBIG: "raise the limit, or write elsewhere",
    **dict.fromkeys((errno.EACCES, errno.EPERM), f"make it writable, or {ELSEWHERE}"),
    errno.EROFS: ELSEWHERE,
    errno.EISDIR: "a folder is there: move it away",
    errno.ENAMETOOLONG: "choose a shorter one",
    errno.EEXIST: f"a file is there: {ELSEWHERE}",
    errno.ENOTDIR: f"a part of the path is a file: {ELSEWHERE}",
    errno.ELOOP: "a link is there: remove it",
    errno.ENOENT: f"the folder is gone: {AGAIN}",
    errno.EIO: f"the disk is at fault: {ELSEWHERE}",
    **dict.fromkeys((errno.ENOLCK, errno.ENOTSUP), f"this file system has no locks: {ELSEWHERE}"),
}


@contextmanager
def writing(path: Path) -> Iterator[None]:
    """Turn errors of writing a file, as a full disk, into BadInput with the file's name and a remedy."""
    try:
        yield
    except OSError as error:
        if error.errno not in REMEDIES or _is_elsewhere(error.filename, path):
            raise
        reason = (error.strerror or str(error)).lower()
        raise BadInput(f"{path}: cannot be written, {reason}: {REMEDIES[error.errno]}") from error


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Yield a temporary path with the suffix of `path`; the file there replaces `path` at the end."""
    partial = path.with_name(f".{path.stem}.{os.getpid()}.partial{path.suffix}")
    with writing(path):
        require_file(path)
        _remove_partial_files(path)
        partial.unlink(missing_ok=True)  # of a killed writer that had this process's number
        os.close(os.open(partial, os.O_CREAT | os.O_EXCL | UNSUPPORTED, 0o666))
        try:
            yield partial
            os.replace(partial, path)
        finally:
            with suppress(OSError):
                partial.unlink(missing_ok=True)


def require_file(path: Path) -> None:
    """Raise BadInput if a path is something else than a regular file, which must not be replaced."""
    with writing(path):
        try:
            mode = os.lstat(path).st_mode
        except FileNotFoundError:
            return
    if not stat.S_ISREG(mode):
        kind = next((name for of, name in KINDS if of(mode)), "device, pipe or socket")
        raise BadInput(f"{path}: cannot be written, a {kind} is there: choose another name, or remove it")


@contextmanager
def only_writer(folder: Path) -> Iterator[None]:
    """Lock a folder for writing, until the end of the block or of the process.

    Raises BadInput if another process holds the lock. The empty file `.lock` stays.
    """
    path = folder / LOCK
    with writing(path):
        file = os.fdopen(os.open(path, os.O_RDWR | os.O_CREAT | UNSUPPORTED, 0o666), "r+")
    with file:
        try:
            with writing(path):
                fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            wait = "another process writes here; wait until it has ended, or choose another folder"
            raise BadInput(f"{folder}: {wait}") from None
        yield


def _is_elsewhere(file: object, path: Path) -> bool:
    """Return whether an error names a file outside the folder of `path` and its parents."""
    if not isinstance(file, str):
        return False
    return Path(file).parent != path.parent and not path.is_relative_to(file)


def _remove_partial_files(path: Path) -> None:
    """Remove the temporary files of killed writers of a path."""
    for name in os.listdir(path.parent):
        match = PARTIAL.fullmatch(name)
        same = match and (match["stem"], match["suffix"] or "") == (path.stem, path.suffix)
        if match and same and not _is_alive(int(match["process"])):
            (path.parent / name).unlink(missing_ok=True)


def _is_alive(process: int) -> bool:
    try:
        with suppress(PermissionError, OverflowError):
            os.kill(process, 0)
    except ProcessLookupError:
        return False
    return True
