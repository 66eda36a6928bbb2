# SPDX-License-Identifier: GPL-3.0-or-later
# Copyright the Neural Mesh authors

"""How far a batch is and the time left, on standard error: one line that is renewed, or plain lines in a file."""

import sys
import time

BAR = 30  # characters
SECONDS_BETWEEN_LINES = 10  # where lines stay, such as in the log of a cluster's job


def duration(seconds: float) -> str:
    if seconds < 60:
        return f"{seconds:.0f} s"
    minutes = round(seconds / 60)
    return f"{minutes} min" if minutes < 60 else f"{minutes // 60} h {minutes % 60} min"


class Progress:
    def __init__(self, total: int) -> None:
        self._total = total
        self._done = 0
        self._failed = 0
        self._start = self._shown = time.monotonic()
        self._renews = sys.stderr.isatty()
        if self._renews:
            self._show(self._start)

    def add(self, failed: bool) -> None:
        """Counts a cloud that is finished."""
        self._done += 1
        self._failed += failed
        now = time.monotonic()
        if self._renews or now - self._shown >= SECONDS_BETWEEN_LINES or self._done == self._total:
            self._show(now)

    def close(self) -> None:
        if self._renews:
            print(file=sys.stderr)

    def _show(self, now: float) -> None:
        self._shown = now
        text = f"{self._done} of {self._total}"
        if self._failed:
            text += f", {self._failed} failed"
        if 0 < self._done < self._total:
            text += f", {duration((now - self._start) / self._done * (self._total - self._done))} left"
        if self._renews:
            filled = BAR * self._done // self._total
            print(f"\r[{'#' * filled}{' ' * (BAR - filled)}] {text}\033[K", end="", file=sys.stderr, flush=True)
        else:
            print(text, file=sys.stderr, flush=True)
