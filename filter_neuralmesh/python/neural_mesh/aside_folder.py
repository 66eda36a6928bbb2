# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""A hidden folder beside a result, for files that are not whole yet. Removes those that killed processes have left."""

import contextlib
import fcntl
import os
import platform
import shutil
import tempfile
from pathlib import Path
from typing import IO, Iterator, Optional

PREFIX = ".neural-mesh-"
LOCK = "lock"  # a file that is locked while the process lives; it holds the machine's name


@contextlib.contextmanager
def aside_folder(parent: Path) -> Iterator[Path]:
    """A new folder in `parent`, removed at the end. Throws OSError."""
    for left in parent.glob(f"{PREFIX}*"):
        _remove_if_left(left)
    with tempfile.TemporaryDirectory(prefix=PREFIX, dir=parent) as name:
        lock = _locked(Path(name))
        try:
            yield Path(name)
        finally:
            if lock is not None:
                lock.close()


def _locked(folder: Path) -> Optional[IO[str]]:
    """Makes the file LOCK and keeps it locked while it is open. None where files cannot be locked."""
    unfinished = folder / f"{LOCK}.new"  # the name is given last: who sees a free LOCK knows that its process has ended
    lock = unfinished.open("w", encoding="utf-8")
    try:
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        lock.close()
        return None
    lock.write(platform.node())
    lock.flush()
    unfinished.rename(folder / LOCK)
    return lock


def _remove_if_left(folder: Path) -> None:
    """Removes the folder if a process of this machine and user made it and has ended. Others are left alone: locks may not
    be seen from machine to machine."""
    with contextlib.suppress(OSError):
        if folder.is_symlink() or folder.stat().st_uid != os.getuid():
            return
        with (folder / LOCK).open("r+", encoding="utf-8", errors="replace") as lock:
            if lock.read() == platform.node():
                fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder, ignore_errors=True)
