"""How long a call waits."""

import math
import time

# Longest wait of one request: well below what proxies and the client's own time limit allow.
WAIT_S = 45


class Deadline:
    """A point of time that may never come."""

    def __init__(self, timeout_s: float | None) -> None:
        self._end = None if timeout_s is None else time.monotonic() + timeout_s

    def left_s(self) -> float | None:
        return None if self._end is None else max(self._end - time.monotonic(), 0.0)

    def is_over(self) -> bool:
        return self.left_s() == 0.0

    def wait_s(self) -> int:
        """Whole seconds that one request may wait; a bit more than is left rather than less."""
        left = self.left_s()
        return WAIT_S if left is None else min(math.ceil(left), WAIT_S)
