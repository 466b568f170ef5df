"""When a request is sent again, and after which pause."""

import random
from dataclasses import dataclass

from .errors import ConnectionFailedError, MeshmendError, ProblemError, UnexpectedAnswerError

# Too slow an upload, too many requests, and whatever a service or proxy in between says when it is away for a moment.
PASSING = frozenset({408, 429, 502, 503})
# The job itself ended so: the same key gives the same job again.
FINAL = frozenset({"worker-lost"})


@dataclass(frozen=True)
class Retries:
    """How often and how patiently a request is sent again."""

    attempts_max: int = 6
    """Most requests for one call, the first one included."""
    pause_s: float = 0.5
    """Pause after the first failure; it doubles with each further one."""
    pause_max_s: float = 30.0
    """Longest pause of ours. A longer `Retry-After` is waited for only up to `retry_after_max_s`."""
    retry_after_max_s: float = 300.0
    """A `Retry-After` beyond this is not waited for: the error is raised."""

    def pause_before(self, attempt: int, error: MeshmendError) -> float | None:
        """Seconds to wait before the given attempt, from 2; none when it is not to be made."""
        if attempt > self.attempts_max or not _is_passing(error):
            return None
        asked = error.retry_after_s if isinstance(error, ProblemError | UnexpectedAnswerError) else None
        own = min(self.pause_s * 2.0 ** (attempt - 2), self.pause_max_s)
        if asked is None:
            # Anything from half to all, so that clients that failed together do not come back together.
            return own * random.uniform(0.5, 1.0)
        # Never before the server's time, and not all at it.
        return asked + own * random.uniform(0.0, 0.5) if asked <= self.retry_after_max_s else None


def _is_passing(error: MeshmendError) -> bool:
    if isinstance(error, ProblemError):
        return error.status in PASSING and error.code not in FINAL
    if isinstance(error, UnexpectedAnswerError):
        return error.status in PASSING or error.status == 504
    return isinstance(error, ConnectionFailedError)
