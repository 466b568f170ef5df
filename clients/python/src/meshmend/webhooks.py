"""Calls of the service, verified as Standard Webhooks says."""

import base64
import binascii
import hashlib
import hmac
import json
import time
from collections.abc import Mapping, Sequence
from typing import cast

from .errors import WebhookError
from .types import WebhookMessage

TOLERANCE_S = 300.0
"""An older call may be a recorded one, as the specification advises."""


def verify_webhook(
    body: bytes,
    headers: Mapping[str, str],
    secrets: str | Sequence[str],
    *,
    tolerance_s: float = TOLERANCE_S,
    now: float | None = None,
) -> tuple[str, WebhookMessage]:
    """The id and the message of a call whose signature is right for one of the secrets (`whsec_...`).

    `body` is the body as it came, byte for byte. A message may come more than once, always with the same id. Raises
    `WebhookError` for a call that is not signed so, or longer ago (or ahead) than `tolerance_s`.
    """
    named = {name.lower(): value for name, value in headers.items()}
    try:
        message_id, timestamp, signatures = (named[f"webhook-{name}"] for name in ("id", "timestamp", "signature"))
    except KeyError as missing:
        raise WebhookError(f"the header {missing} is missing") from None
    if not (timestamp.isascii() and timestamp.isdigit()):
        raise WebhookError("the time is no number of seconds")
    if abs((time.time() if now is None else now) - int(timestamp)) > tolerance_s:
        raise WebhookError("the call is too old, or a clock is wrong")
    signed = f"{message_id}.{timestamp}.".encode() + body
    wanted = [hmac.digest(_key(secret), signed, hashlib.sha256) for secret in ([secrets] if isinstance(secrets, str) else secrets)]
    given = [_decoded(text.removeprefix("v1,")) for text in signatures.split(" ") if text.startswith("v1,")]
    # All pairs are compared, each in constant time.
    matches = [hmac.compare_digest(one, other) for one in wanted for other in given]
    if not any(matches):
        raise WebhookError("the signature is not right")
    return message_id, cast(WebhookMessage, json.loads(body))


def _key(secret: str) -> bytes:
    try:
        return base64.b64decode(secret.removeprefix("whsec_"), validate=True)
    except binascii.Error:
        raise ValueError("a secret is `whsec_` and base64") from None


def _decoded(text: str) -> bytes:
    try:
        return base64.b64decode(text, validate=True)
    except (binascii.Error, ValueError):
        return b""
