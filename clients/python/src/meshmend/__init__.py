"""Client of the Meshmend service: repairs 3D meshes for printing and proves it.

`Meshmend` is for ordinary programs, `AsyncMeshmend` the same for asyncio and trio. The types of requests and answers are
those of the service's contract, in `meshmend.types`.
"""

from . import types
from ._async import AsyncMeshmend, AsyncResult
from ._sync import Meshmend, Result
from .errors import (
    ConnectionFailedError,
    IntegrityError,
    MeshmendError,
    NotFinishedError,
    NotRepairableError,
    ProblemError,
    UnexpectedAnswerError,
    WebhookError,
)
from .events import JobEvent, StagePassed, StateChanged
from .retries import Retries
from .upload import AsyncMesh, KeptMesh, Mesh, UploadOf
from .webhooks import verify_webhook

__all__ = [
    "AsyncMesh",
    "AsyncMeshmend",
    "AsyncResult",
    "ConnectionFailedError",
    "IntegrityError",
    "JobEvent",
    "KeptMesh",
    "Mesh",
    "Meshmend",
    "MeshmendError",
    "NotFinishedError",
    "NotRepairableError",
    "ProblemError",
    "Result",
    "Retries",
    "StagePassed",
    "StateChanged",
    "UnexpectedAnswerError",
    "UploadOf",
    "WebhookError",
    "types",
    "verify_webhook",
]
