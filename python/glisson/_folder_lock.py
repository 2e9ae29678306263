"""The lock on a folder of results, the same as that of `glisson run`: a second process that would write there is refused.

It is advisory (flock, on the folder itself), and the system frees it when the process ends, however it ends.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import warnings
from collections.abc import Iterator
from pathlib import Path


@contextlib.contextmanager
def alone_in(folder: Path) -> Iterator[None]:
    """Locks a folder against other studies while this one writes; the system frees the lock where the process ends."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise RuntimeError(
                f"{folder}: another run or study is being written there; wait for its end, or give another folder"
            ) from None
        except OSError as error:
            warnings.warn(
                f"{folder}: cannot be locked ({error.strerror}): nothing keeps a second study away", stacklevel=3
            )
        yield
    finally:
        os.close(descriptor)
