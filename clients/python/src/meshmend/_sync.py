"""The client, made of `_async.py` by scripts/clients/without_async.py: change that one."""

import hashlib
import os
import time
import uuid
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self, Unpack, cast

import httpx

from . import types
from .errors import ConnectionFailedError, IntegrityError, MeshmendError, NotFinishedError, UnexpectedAnswerError
from .errors import ProblemError, answer_error, problem_error
from .events import FINAL_STATES, EventReader, JobEvent, StateChanged
from .retries import Retries
from .upload import Body, Mesh, UploadOf, body_of, json_body_of
from .upload import TUS, KeptMesh, Rest, announced, size_of
from .waiting import Deadline

JSON = "application/json"


class Result:
    """What an operation made: its report, and the mesh, which is fetched when it is asked for."""

    def __init__(self, client: "Meshmend", job_id: str, report: types.Report) -> None:
        self._client = client
        self.job_id = job_id
        self.report = report

    def read(self, *, level: int = 1) -> bytes:
        """The mesh, its SHA-256 compared with the certificate's. `level`: which target of a simplification."""
        return self._client._read(self.job_id, self.sha256(level), level)

    def save(self, path: str | os.PathLike[str], *, level: int = 1) -> None:
        """Writes the mesh to a file, which is there only when its SHA-256 is the certificate's."""
        self._client._save(self.job_id, self.sha256(level), level, Path(path))

    def sha256(self, level: int = 1) -> str:
        """SHA-256 that the certificate states for the mesh, in hexadecimal."""
        levels = self.report["levels"]
        certificate = levels[level - 1]["certificate"] if levels else self.report["certificate"]
        if certificate is None:
            raise IntegrityError("the report has no certificate for a result")
        return certificate["sha256"]


class Meshmend:
    """A Meshmend service.

    `key` is sent as `Authorization: Bearer`. `http` may bring settings of the caller's own, such as proxies or
    certificates; it is closed with this client. A call is sent again as `retries` says; one that makes a job carries an
    `Idempotency-Key`, so that it makes one job however often it is sent.
    """

    def __init__(
        self, url: str, *, key: str | None = None, retries: Retries = Retries(), http: httpx.Client | None = None
    ) -> None:
        self._url = url.rstrip("/")
        self._headers = {"Authorization": f"Bearer {key}"} if key else {}
        self._retries = retries
        # Keep-alive comments of events come every 15 s, and answers are waited for `wait_s` at most.
        self._http = http or httpx.Client(timeout=httpx.Timeout(15.0, read=90.0, write=60.0))

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        self.close()

    def close(self) -> None:
        """Closes all connections."""
        self._http.close()

    # --- operations with a report as their answer -----------------------------------------------------------------

    def analyze(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.AnalyzeOptions],
    ) -> types.Report:
        """Describes a mesh: counts, measures, defects with witnesses, and the certificate of the file as it is."""
        return (self._run("analyze", [mesh], options, material, idempotency_key, timeout_s)).report

    def verify(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.VerifyOptions],
    ) -> types.Report:
        """Certifies a file as it is."""
        return (self._run("verify", [mesh], options, material, idempotency_key, timeout_s)).report

    def plan(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.PlanOptions],
    ) -> types.Plan:
        """What may be done about each defect: to be edited and given to `repair` as `plan`."""
        report = (self._run("plan", [mesh], options, material, idempotency_key, timeout_s)).report
        return cast(types.Plan, report["plan"])

    def render(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.RenderOptions],
    ) -> bytes:
        """A picture of a mesh, as PNG: from one side or several, defects coloured and marked, or turning; or as GLB."""
        drawn = self._run("render", [mesh], options, material, idempotency_key, timeout_s)
        return self.thumbnail(drawn.job_id, options.get("picture_format", "png"))

    # --- operations with a mesh as their answer -------------------------------------------------------------------

    def repair(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.RepairOptions],
    ) -> Result:
        """Makes a certified valid solid of a mesh. Raises `NotRepairableError` where there is none as asked."""
        return self._run("repair", [mesh], options, material, idempotency_key, timeout_s)

    def convert(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.ConvertOptions],
    ) -> Result:
        """Writes a mesh in another format or unit."""
        return self._run("convert", [mesh], options, material, idempotency_key, timeout_s)

    def simplify(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.SimplifyOptions],
    ) -> Result:
        """Fewer triangles, the same shape."""
        return self._run("simplify", [mesh], options, material, idempotency_key, timeout_s)

    def fill_holes(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.FillHolesOptions],
    ) -> Result:
        """Closes holes."""
        return self._run("fill-holes", [mesh], options, material, idempotency_key, timeout_s)

    def cut_stitch(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.CutStitchOptions],
    ) -> Result:
        """Cuts singular edges and vertices, and stitches."""
        return self._run("cut-stitch", [mesh], options, material, idempotency_key, timeout_s)

    def modeller(
        self, mesh: Mesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.ModellerOptions],
    ) -> Result:
        """Edits a polyhedron by its planes."""
        return self._run("modeller", [mesh], options, material, idempotency_key, timeout_s)

    def boolean(
        self, meshes: Sequence[Mesh] | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.BooleanOptions],
    ) -> Result:
        """Combines solids; a difference is the first without all others."""
        given: Sequence[Mesh | UploadOf] = [meshes] if isinstance(meshes, UploadOf) else meshes
        return self._run("boolean", given, options, material, idempotency_key, timeout_s)

    # --- meshes before their job ----------------------------------------------------------------------------------

    def upload(self, mesh: KeptMesh) -> UploadOf:
        """Brings a mesh to the service before its job, and goes on where a connection broke: give what it returns to an
        operation instead of the mesh. Only requests in a row that bring nothing are counted by `retries`.
        """
        created = _whole(self._send("POST", "/v1/uploads", headers=announced(mesh)))
        upload = UploadOf(upload_id=created.headers["location"].rpartition("/")[2])
        path = f"/v1/uploads/{upload.upload_id}"
        size, stands, attempt = size_of(mesh), 0, 1
        while stands < size:
            try:
                brought = _whole(self._send("PATCH", path, headers=TUS, body=Rest(mesh, stands, size)))
            except MeshmendError as error:
                attempt += 1
                # What an earlier request brought was stored after the service was asked how far it came.
                is_behind = isinstance(error, ProblemError) and error.code == "upload-conflict"
                cause = ConnectionFailedError(str(error)) if is_behind else error
                self._pause(attempt, cause, is_replayable=True)
                brought = _whole(self._send("HEAD", path, headers=TUS))
            before, stands = stands, int(brought.headers["upload-offset"])
            attempt = 1 if stands > before else attempt
        return upload

    # --- jobs -----------------------------------------------------------------------------------------------------

    def submit(
        self, mesh: Mesh | Sequence[Mesh] | UploadOf, *, material: Mesh | None = None,
        idempotency_key: str | None = None, cancel_after_s: int | None = None, **request: Unpack[types.JobRequest],
    ) -> types.Job:
        """Makes a job and does not wait for it. `operation` says what to do; `labels` and `webhook` are optional.

        A list is several meshes, for `boolean`. `cancel_after_s`: the job is ended when it takes longer.
        """
        meshes = cast("Sequence[Mesh | UploadOf]", mesh if isinstance(mesh, list | tuple) else [mesh])
        headers = {} if cancel_after_s is None else {"Cancel-After": str(cancel_after_s)}
        response = self._post_mesh("/v1/jobs", "job", meshes, request, material, idempotency_key, headers)
        return cast(types.Job, response.json())

    def job(self, job_id: str, *, wait_s: int = 0) -> types.Job:
        """A job as it stands, after at most `wait_s` seconds if it has not ended before."""
        return cast(types.Job, self._get(f"/v1/jobs/{job_id}", {"wait": str(wait_s)} if wait_s else {}))

    def jobs(
        self, *, cursor: str | None = None, limit: int | None = None, state: types.JobState | None = None,
        labels: Mapping[str, str] | None = None,
    ) -> types.JobList:
        """A page of the caller's jobs, the latest first; `next` of the page is the `cursor` of the next one."""
        query: dict[str, str | list[str]] = {"label": [f"{name}:{value}" for name, value in (labels or {}).items()]}
        query |= {} if cursor is None else {"cursor": cursor}
        query |= {} if limit is None else {"limit": str(limit)}
        query |= {} if state is None else {"state": state}
        return cast(types.JobList, self._get("/v1/jobs", query))

    def events(self, job_id: str, *, last_event_id: str | None = None) -> Iterator[JobEvent]:
        """What happens to a job, from its begin or after `last_event_id`, to its end. A cut connection is made again."""
        attempt = 1
        while True:
            headers = {"Accept": "text/event-stream"} | ({"Last-Event-ID": last_event_id} if last_event_id else {})
            response = self._send("GET", f"/v1/jobs/{job_id}/events", headers=headers)
            error: Exception | None = None
            try:
                if response.status_code == 204:
                    return
                reader = EventReader()
                for piece in response.iter_raw():
                    # Also a comment, which a long pass has for hours: proxies that cut what is long do not end this.
                    attempt = 1
                    for event in reader.feed(piece):
                        last_event_id = event.id
                        yield event
                        if isinstance(event, StateChanged) and event.state in FINAL_STATES:
                            return
            except httpx.TransportError as cut:
                error = cut
            finally:
                response.close()
            attempt += 1
            self._pause(attempt, _failed(error), is_replayable=True)

    def wait(
        self, job_id: str, *, on_event: Callable[[JobEvent], object] | None = None, timeout_s: float | None = None
    ) -> types.Job:
        """Waits for a job's end, whatever it is. With `on_event`, that is called with each event on the way.

        Raises `NotFinishedError` when `timeout_s` is over before; with `on_event` that is looked at with each event.
        """
        deadline = Deadline(timeout_s)
        if on_event is not None:
            for event in self.events(job_id):
                on_event(event)
                if deadline.is_over():
                    break
        while True:
            job = self.job(job_id, wait_s=deadline.wait_s())
            if job["state"] in FINAL_STATES:
                return job
            if deadline.is_over():
                raise NotFinishedError(job)

    def result(self, job_id: str, *, timeout_s: float | None = None) -> Result:
        """Waits for a job's end. Raises its problem when it did not succeed."""
        job = self.wait(job_id, timeout_s=timeout_s)
        problem = job["problem"]
        if problem is None:
            return Result(self, job_id, self.report(job_id))
        if problem["code"] == "not-repairable":
            # A job tells its problem without the report, which may be long.
            problem = {**problem, "report": self.report(job_id)}
        raise problem_error(problem)

    def report(self, job_id: str) -> types.Report:
        """The report of a job, also of one that was refused."""
        return cast(types.Report, self._get(f"/v1/jobs/{job_id}/report", {}))

    def thumbnail(self, job_id: str, picture_format: types.PictureFormat = "png") -> bytes:
        """The picture of a job that was made with `thumbnail=True` or that draws, in the format that it was made in."""
        return (_whole(self._send("GET", f"/v1/jobs/{job_id}/thumbnail.{picture_format}"))).content

    def cancel(self, job_id: str) -> types.Job:
        """Cancels a job; one that has ended stays as it is."""
        response = self._send("POST", f"/v1/jobs/{job_id}/cancel")
        return cast(types.Job, _json(response))

    def delete(self, job_id: str) -> None:
        """Removes a job with all its files. One that is not there raises `not-found`."""
        (self._send("DELETE", f"/v1/jobs/{job_id}")).close()

    def deliveries(self, job_id: str) -> types.Deliveries:
        """The webhooks of a job, with every try."""
        return cast(types.Deliveries, self._get(f"/v1/jobs/{job_id}/deliveries", {}))

    def redeliver(self, job_id: str, delivery_id: str) -> types.Delivery:
        """Sends a webhook again, with the same `webhook-id`."""
        response = self._send("POST", f"/v1/jobs/{job_id}/deliveries/{delivery_id}/redeliver")
        return cast(types.Delivery, _json(response))

    # --- the service about itself ---------------------------------------------------------------------------------

    def version(self) -> types.Version:
        return cast(types.Version, self._get("/v1/version", {}))

    def limits(self) -> types.Limits:
        return cast(types.Limits, self._get("/v1/limits", {}))

    def formats(self) -> list[types.FormatInfo]:
        return cast(list[types.FormatInfo], self._get("/v1/formats", {}))

    def policies(self) -> list[types.PolicyInfo]:
        return cast(list[types.PolicyInfo], self._get("/v1/policies", {}))

    def errors(self) -> list[types.ErrorInfo]:
        return cast(list[types.ErrorInfo], self._get("/v1/errors", {}))

    # --- how it is done -------------------------------------------------------------------------------------------

    def _run(
        self, operation: str, meshes: Sequence[Mesh | UploadOf], options: Mapping[str, object], material: Mesh | None,
        idempotency_key: str | None, timeout_s: float | None,
    ) -> Result:
        deadline = Deadline(timeout_s)
        headers = {"Accept": JSON, "Prefer": f"wait={deadline.wait_s()}"}
        response = self._post_mesh(f"/v1/{operation}", "params", meshes, options, material, idempotency_key, headers)
        if response.status_code == 202:
            return self.result(response.json()["id"], timeout_s=deadline.left_s())
        job_id = response.links["describedby"]["url"].split("/")[-2]
        return Result(self, job_id, cast(types.Report, response.json()))

    def _post_mesh(
        self, path: str, field: str, meshes: Sequence[Mesh | UploadOf], options: Mapping[str, object],
        material: Mesh | None, idempotency_key: str | None, headers: Mapping[str, str],
    ) -> httpx.Response:
        uploads = [mesh for mesh in meshes if isinstance(mesh, UploadOf)]
        if uploads and (len(meshes) > 1 or material is not None):
            raise ValueError("the upload of an earlier job is used again as it is, alone")
        body = json_body_of(options, uploads[0]) if uploads else body_of(field, options, cast(Sequence[Mesh], meshes), material)
        key = {"Idempotency-Key": idempotency_key or str(uuid.uuid4())}
        return _whole(self._send("POST", path, headers={**headers, **key}, body=body))

    def _get(self, path: str, query: Mapping[str, str | list[str]]) -> Any:
        return _json(self._send("GET", path, query=query, headers={"Accept": JSON}))

    def _send(
        self, method: str, path: str, *, query: Mapping[str, str | list[str]] | None = None,
        headers: Mapping[str, str] | None = None, body: Body | None = None,
    ) -> httpx.Response:
        """Sends a request until its answer is a good one, whose body is still to be read."""
        attempt = 1
        while True:
            sent = {**self._headers, **(headers or {}), **(body.headers() if body else {})}
            content = body.pieces() if body else None
            request = self._http.build_request(method, self._url + path, params=query, headers=sent, content=content)
            error: MeshmendError
            try:
                response = self._http.send(request, stream=True)
                if response.is_success:
                    return response
                error = _error_of(response)
            except httpx.TransportError as cut:
                error = _failed(cut)
            # What was deleted by a request whose answer was lost is gone, as asked.
            if method == "DELETE" and attempt > 1 and isinstance(error, ProblemError) and error.status == 404:
                return response
            attempt += 1
            self._pause(attempt, error, is_replayable=body is None or body.is_replayable)

    def _pause(self, attempt: int, error: MeshmendError, *, is_replayable: bool) -> None:
        pause_s = self._retries.pause_before(attempt, error) if is_replayable else None
        if pause_s is None:
            raise error
        time.sleep(pause_s)

    def _read(self, job_id: str, sha256: str, level: int) -> bytes:
        attempt = 1
        while True:
            try:
                pieces = [piece for piece in self._pieces(job_id, sha256, level)]
                return b"".join(pieces)
            except httpx.TransportError as cut:
                attempt += 1
                self._pause(attempt, _failed(cut), is_replayable=True)

    def _save(self, job_id: str, sha256: str, level: int, path: Path) -> None:
        part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
        attempt = 1
        try:
            while True:
                try:
                    with open(part, "wb") as file:
                        for piece in self._pieces(job_id, sha256, level):
                            file.write(piece)
                    os.replace(part, path)
                    return
                except httpx.TransportError as cut:
                    attempt += 1
                    self._pause(attempt, _failed(cut), is_replayable=True)
        finally:
            part.unlink(missing_ok=True)

    def _pieces(self, job_id: str, sha256: str, level: int) -> Iterator[bytes]:
        """The bytes of a result; the end comes only after all of them have the SHA-256."""
        digest = hashlib.sha256()
        query = {} if level == 1 else {"level": str(level)}
        response = self._send("GET", f"/v1/jobs/{job_id}/result", query=query)
        try:
            for piece in response.iter_bytes():
                digest.update(piece)
                yield piece
        finally:
            response.close()
        if digest.hexdigest() != sha256:
            raise IntegrityError(f"the bytes have the SHA-256 {digest.hexdigest()}, the certificate says {sha256}")


def _json(response: httpx.Response) -> Any:
    return (_whole(response)).json()


def _whole(response: httpx.Response) -> httpx.Response:
    try:
        response.read()
        return response
    except httpx.TransportError as error:
        raise ConnectionFailedError(str(error)) from error
    finally:
        response.close()


def _error_of(response: httpx.Response) -> ProblemError | UnexpectedAnswerError:
    try:
        body = response.read()
    finally:
        response.close()
    headers = response.headers
    return answer_error(response.status_code, headers.get("content-type", ""), body, headers.get("retry-after"))


def _failed(cause: Exception | None) -> ConnectionFailedError:
    error = ConnectionFailedError(str(cause) if cause else "the connection ended early")
    error.__cause__ = cause
    return error
