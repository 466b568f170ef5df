"""Server-sent events of a job."""

import json
from dataclasses import dataclass

from .types import JobState, Phase, Stage

FINAL_STATES: frozenset[JobState] = frozenset({"succeeded", "failed", "cancelled", "expired"})


@dataclass(frozen=True)
class StateChanged:
    """The job has come into another state."""

    id: str
    state: JobState
    at: str


@dataclass(frozen=True)
class StagePassed:
    """A pass of the job's run begins or ends; `fraction` is how far the run is, from 0 to 1."""

    id: str
    stage: Stage
    phase: Phase
    fraction: float


JobEvent = StateChanged | StagePassed


class EventReader:
    """Takes a stream of events as it comes, piece by piece."""

    def __init__(self) -> None:
        self._rest = b""
        self._name = ""
        self._id = ""
        self._data: list[str] = []

    def feed(self, piece: bytes) -> list[JobEvent]:
        """The events that are complete with this piece. Names that this version does not know are passed over."""
        *lines, self._rest = (self._rest + piece).split(b"\n")
        read = (self._line(line.removesuffix(b"\r").decode()) for line in lines)
        return [event for event in read if event is not None]

    def _line(self, line: str) -> JobEvent | None:
        if not line:
            return self._complete()
        # A line that begins with a colon is a comment that tells that the connection lives.
        field, _, value = line.partition(":")
        value = value.removeprefix(" ")
        if field == "event":
            self._name = value
        elif field == "id":
            self._id = value
        elif field == "data":
            self._data.append(value)
        return None

    def _complete(self) -> JobEvent | None:
        name, data = self._name, "\n".join(self._data)
        self._name, self._data = "", []
        if name == "state":
            content = json.loads(data)
            return StateChanged(self._id, content["state"], content["at"])
        if name == "stage":
            content = json.loads(data)
            return StagePassed(self._id, content["stage"], content["phase"], content["fraction"])
        return None
