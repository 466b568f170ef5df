"""What can go wrong, one class for each way to react to it."""

import json
from typing import cast

from .types import Job, Problem, ProblemCode, Report


class MeshmendError(Exception):
    """Any error of this package."""


class ProblemError(MeshmendError):
    """The service said no, or a job ended without what was asked: `problem` is its problem document (RFC 9457)."""

    def __init__(self, problem: Problem, retry_after_s: float | None = None) -> None:
        super().__init__(f"{problem['code']}: {problem['detail']}")
        self.problem = problem
        self.retry_after_s = retry_after_s

    @property
    def code(self) -> ProblemCode:
        """The stable code; `GET /v1/errors` explains each."""
        return self.problem["code"]

    @property
    def status(self) -> int:
        return self.problem["status"]


class NotRepairableError(ProblemError):
    """The repair was refused: no result keeps what the request asks for. `report` says why."""

    @property
    def report(self) -> Report | None:
        return self.problem.get("report")


class UnexpectedAnswerError(MeshmendError):
    """An error that is no problem document, for example of a proxy in between."""

    def __init__(self, status: int, body: bytes, retry_after_s: float | None = None) -> None:
        super().__init__(f"status {status}: {body[:200].decode('utf-8', 'replace')!r}")
        self.status = status
        self.body = body
        self.retry_after_s = retry_after_s


class ConnectionFailedError(MeshmendError):
    """No answer, after all retries; the cause is in `__cause__`."""


class NotFinishedError(MeshmendError, TimeoutError):
    """The time that the caller gives is over. The job goes on: `job` says which."""

    def __init__(self, job: Job) -> None:
        super().__init__(f"job {job['id']} is still {job['state']}")
        self.job = job


class IntegrityError(MeshmendError):
    """The bytes that came are not those that the certificate is about."""


class WebhookError(MeshmendError):
    """A call that must not be believed."""


def problem_error(problem: Problem, retry_after_s: float | None = None) -> ProblemError:
    """The error for a problem document."""
    is_refusal = problem["code"] == "not-repairable"
    return (NotRepairableError if is_refusal else ProblemError)(problem, retry_after_s)


def answer_error(status: int, content_type: str, body: bytes, retry_after: str | None) -> ProblemError | UnexpectedAnswerError:
    """The error for an answer that is none of the expected ones."""
    retry_after_s = float(retry_after) if retry_after is not None and retry_after.isdigit() else None
    if content_type.partition(";")[0].strip() == "application/problem+json":
        try:
            problem = json.loads(body)
        except ValueError:
            problem = None
        if isinstance(problem, dict) and {"code", "status", "detail"} <= problem.keys():
            return problem_error(cast(Problem, problem), retry_after_s)
    return UnexpectedAnswerError(status, body, retry_after_s)
