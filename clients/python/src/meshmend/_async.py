"""The client. `_sync.py` is made of this file by scripts/clients/without_async.py: change this one and make that one anew."""

import hashlib
import os
import uuid
from collections.abc import AsyncIterator, Callable, Mapping, Sequence
from pathlib import Path
from types import TracebackType
from typing import Any, Self, Unpack, cast

import anyio
import httpx

from . import types
from .errors import ConnectionFailedError, IntegrityError, MeshmendError, NotFinishedError, UnexpectedAnswerError
from .errors import ProblemError, answer_error, problem_error
from .events import FINAL_STATES, EventReader, JobEvent, StateChanged
from .retries import Retries
from .upload import AsyncMesh, Body, Mesh, UploadOf, body_of, json_body_of
from .upload import TUS, KeptMesh, Rest, announced, size_of
from .waiting import Deadline

JSON = "application/json"


class AsyncResult:
    """What an operation made: its report, and the mesh, which is fetched when it is asked for."""

    def __init__(self, client: "AsyncMeshmend", job_id: str, report: types.Report) -> None:
        self._client = client
        self.job_id = job_id
        self.report = report

    async def read(self, *, level: int = 1) -> bytes:
        """The mesh, its SHA-256 compared with the certificate's. `level`: which target of a simplification."""
        return await self._client._read(self.job_id, self.sha256(level), level)

    async def save(self, path: str | os.PathLike[str], *, level: int = 1) -> None:
        """Writes the mesh to a file, which is there only when its SHA-256 is the certificate's."""
        await self._client._save(self.job_id, self.sha256(level), level, Path(path))

    def sha256(self, level: int = 1) -> str:
        """SHA-256 that the certificate states for the mesh, in hexadecimal."""
        levels = self.report["levels"]
        certificate = levels[level - 1]["certificate"] if levels else self.report["certificate"]
        if certificate is None:
            raise IntegrityError("the report has no certificate for a result")
        return certificate["sha256"]


class AsyncMeshmend:
    """A Meshmend service.

    `key` is sent as `Authorization: Bearer`. `http` may bring settings of the caller's own, such as proxies or
    certificates; it is closed with this client. A call is sent again as `retries` says; one that makes a job carries an
    `Idempotency-Key`, so that it makes one job however often it is sent.
    """

    def __init__(
        self, url: str, *, key: str | None = None, retries: Retries = Retries(), http: httpx.AsyncClient | None = None
    ) -> None:
        self._url = url.rstrip("/")
        self._headers = {"Authorization": f"Bearer {key}"} if key else {}
        self._retries = retries
        # Keep-alive comments of events come every 15 s, and answers are waited for `wait_s` at most.
        self._http = http or httpx.AsyncClient(timeout=httpx.Timeout(15.0, read=90.0, write=60.0))

    async def __aenter__(self) -> Self:
        return self

    async def __aexit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None) -> None:
        await self.aclose()

    async def aclose(self) -> None:
        """Closes all connections."""
        await self._http.aclose()

    # --- operations with a report as their answer -----------------------------------------------------------------

    async def analyze(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.AnalyzeOptions],
    ) -> types.Report:
        """Describes a mesh: counts, measures, defects with witnesses, and the certificate of the file as it is."""
        return (await self._run("analyze", [mesh], options, material, idempotency_key, timeout_s)).report

    async def verify(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.VerifyOptions],
    ) -> types.Report:
        """Certifies a file as it is."""
        return (await self._run("verify", [mesh], options, material, idempotency_key, timeout_s)).report

    async def plan(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.PlanOptions],
    ) -> types.Plan:
        """What may be done about each defect: to be edited and given to `repair` as `plan`."""
        report = (await self._run("plan", [mesh], options, material, idempotency_key, timeout_s)).report
        return cast(types.Plan, report["plan"])

    async def render(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.RenderOptions],
    ) -> bytes:
        """A picture of a mesh, as PNG: from one side or several, defects coloured and marked, or turning; or as GLB."""
        drawn = await self._run("render", [mesh], options, material, idempotency_key, timeout_s)
        return await self.thumbnail(drawn.job_id, options.get("picture_format", "png"))

    # --- operations with a mesh as their answer -------------------------------------------------------------------

    async def repair(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.RepairOptions],
    ) -> AsyncResult:
        """Makes a certified valid solid of a mesh. Raises `NotRepairableError` where there is none as asked."""
        return await self._run("repair", [mesh], options, material, idempotency_key, timeout_s)

    async def convert(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.ConvertOptions],
    ) -> AsyncResult:
        """Writes a mesh in another format or unit."""
        return await self._run("convert", [mesh], options, material, idempotency_key, timeout_s)

    async def simplify(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.SimplifyOptions],
    ) -> AsyncResult:
        """Fewer triangles, the same shape."""
        return await self._run("simplify", [mesh], options, material, idempotency_key, timeout_s)

    async def fill_holes(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.FillHolesOptions],
    ) -> AsyncResult:
        """Closes holes."""
        return await self._run("fill-holes", [mesh], options, material, idempotency_key, timeout_s)

    async def cut_stitch(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.CutStitchOptions],
    ) -> AsyncResult:
        """Cuts singular edges and vertices, and stitches."""
        return await self._run("cut-stitch", [mesh], options, material, idempotency_key, timeout_s)

    async def modeller(
        self, mesh: AsyncMesh | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.ModellerOptions],
    ) -> AsyncResult:
        """Edits a polyhedron by its planes."""
        return await self._run("modeller", [mesh], options, material, idempotency_key, timeout_s)

    async def boolean(
        self, meshes: Sequence[AsyncMesh] | UploadOf, *, material: Mesh | None = None, idempotency_key: str | None = None,
        timeout_s: float | None = None, **options: Unpack[types.BooleanOptions],
    ) -> AsyncResult:
        """Combines solids; a difference is the first without all others."""
        given: Sequence[AsyncMesh | UploadOf] = [meshes] if isinstance(meshes, UploadOf) else meshes
        return await self._run("boolean", given, options, material, idempotency_key, timeout_s)

    # --- meshes before their job ----------------------------------------------------------------------------------

    async def upload(self, mesh: KeptMesh) -> UploadOf:
        """Brings a mesh to the service before its job, and goes on where a connection broke: give what it returns to an
        operation instead of the mesh. Only requests in a row that bring nothing are counted by `retries`.
        """
        created = await _whole(await self._send("POST", "/v1/uploads", headers=announced(mesh)))
        upload = UploadOf(upload_id=created.headers["location"].rpartition("/")[2])
        path = f"/v1/uploads/{upload.upload_id}"
        size, stands, attempt = size_of(mesh), 0, 1
        while stands < size:
            try:
                brought = await _whole(await self._send("PATCH", path, headers=TUS, body=Rest(mesh, stands, size)))
            except MeshmendError as error:
                attempt += 1
                # What an earlier request brought was stored after the service was asked how far it came.
                is_behind = isinstance(error, ProblemError) and error.code == "upload-conflict"
                cause = ConnectionFailedError(str(error)) if is_behind else error
                await self._pause(attempt, cause, is_replayable=True)
                brought = await _whole(await self._send("HEAD", path, headers=TUS))
            before, stands = stands, int(brought.headers["upload-offset"])
            attempt = 1 if stands > before else attempt
        return upload

    # --- jobs -----------------------------------------------------------------------------------------------------

    async def submit(
        self, mesh: AsyncMesh | Sequence[AsyncMesh] | UploadOf, *, material: Mesh | None = None,
        idempotency_key: str | None = None, cancel_after_s: int | None = None, **request: Unpack[types.JobRequest],
    ) -> types.Job:
        """Makes a job and does not wait for it. `operation` says what to do; `labels` and `webhook` are optional.

        A list is several meshes, for `boolean`. `cancel_after_s`: the job is ended when it takes longer.
        """
        meshes = cast("Sequence[AsyncMesh | UploadOf]", mesh if isinstance(mesh, list | tuple) else [mesh])
        headers = {} if cancel_after_s is None else {"Cancel-After": str(cancel_after_s)}
        response = await self._post_mesh("/v1/jobs", "job", meshes, request, material, idempotency_key, headers)
        return cast(types.Job, response.json())

    async def job(self, job_id: str, *, wait_s: int = 0) -> types.Job:
        """A job as it stands, after at most `wait_s` seconds if it has not ended before."""
        return cast(types.Job, await self._get(f"/v1/jobs/{job_id}", {"wait": str(wait_s)} if wait_s else {}))

    async def jobs(
        self, *, cursor: str | None = None, limit: int | None = None, state: types.JobState | None = None,
        labels: Mapping[str, str] | None = None,
    ) -> types.JobList:
        """A page of the caller's jobs, the latest first; `next` of the page is the `cursor` of the next one."""
        query: dict[str, str | list[str]] = {"label": [f"{name}:{value}" for name, value in (labels or {}).items()]}
        query |= {} if cursor is None else {"cursor": cursor}
        query |= {} if limit is None else {"limit": str(limit)}
        query |= {} if state is None else {"state": state}
        return cast(types.JobList, await self._get("/v1/jobs", query))

    async def events(self, job_id: str, *, last_event_id: str | None = None) -> AsyncIterator[JobEvent]:
        """What happens to a job, from its begin or after `last_event_id`, to its end. A cut connection is made again."""
        attempt = 1
        while True:
            headers = {"Accept": "text/event-stream"} | ({"Last-Event-ID": last_event_id} if last_event_id else {})
            response = await self._send("GET", f"/v1/jobs/{job_id}/events", headers=headers)
            error: Exception | None = None
            try:
                if response.status_code == 204:
                    return
                reader = EventReader()
                async for piece in response.aiter_raw():
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
                await response.aclose()
            attempt += 1
            await self._pause(attempt, _failed(error), is_replayable=True)

    async def wait(
        self, job_id: str, *, on_event: Callable[[JobEvent], object] | None = None, timeout_s: float | None = None
    ) -> types.Job:
        """Waits for a job's end, whatever it is. With `on_event`, that is called with each event on the way.

        Raises `NotFinishedError` when `timeout_s` is over before; with `on_event` that is looked at with each event.
        """
        deadline = Deadline(timeout_s)
        if on_event is not None:
            async for event in self.events(job_id):
                on_event(event)
                if deadline.is_over():
                    break
        while True:
            job = await self.job(job_id, wait_s=deadline.wait_s())
            if job["state"] in FINAL_STATES:
                return job
            if deadline.is_over():
                raise NotFinishedError(job)

    async def result(self, job_id: str, *, timeout_s: float | None = None) -> AsyncResult:
        """Waits for a job's end. Raises its problem when it did not succeed."""
        job = await self.wait(job_id, timeout_s=timeout_s)
        problem = job["problem"]
        if problem is None:
            return AsyncResult(self, job_id, await self.report(job_id))
        if problem["code"] == "not-repairable":
            # A job tells its problem without the report, which may be long.
            problem = {**problem, "report": await self.report(job_id)}
        raise problem_error(problem)

    async def report(self, job_id: str) -> types.Report:
        """The report of a job, also of one that was refused."""
        return cast(types.Report, await self._get(f"/v1/jobs/{job_id}/report", {}))

    async def thumbnail(self, job_id: str, picture_format: types.PictureFormat = "png") -> bytes:
        """The picture of a job that was made with `thumbnail=True` or that draws, in the format that it was made in."""
        return (await _whole(await self._send("GET", f"/v1/jobs/{job_id}/thumbnail.{picture_format}"))).content

    async def cancel(self, job_id: str) -> types.Job:
        """Cancels a job; one that has ended stays as it is."""
        response = await self._send("POST", f"/v1/jobs/{job_id}/cancel")
        return cast(types.Job, await _json(response))

    async def delete(self, job_id: str) -> None:
        """Removes a job with all its files. One that is not there raises `not-found`."""
        await (await self._send("DELETE", f"/v1/jobs/{job_id}")).aclose()

    async def deliveries(self, job_id: str) -> types.Deliveries:
        """The webhooks of a job, with every try."""
        return cast(types.Deliveries, await self._get(f"/v1/jobs/{job_id}/deliveries", {}))

    async def redeliver(self, job_id: str, delivery_id: str) -> types.Delivery:
        """Sends a webhook again, with the same `webhook-id`."""
        response = await self._send("POST", f"/v1/jobs/{job_id}/deliveries/{delivery_id}/redeliver")
        return cast(types.Delivery, await _json(response))

    # --- the service about itself ---------------------------------------------------------------------------------

    async def version(self) -> types.Version:
        return cast(types.Version, await self._get("/v1/version", {}))

    async def limits(self) -> types.Limits:
        return cast(types.Limits, await self._get("/v1/limits", {}))

    async def formats(self) -> list[types.FormatInfo]:
        return cast(list[types.FormatInfo], await self._get("/v1/formats", {}))

    async def policies(self) -> list[types.PolicyInfo]:
        return cast(list[types.PolicyInfo], await self._get("/v1/policies", {}))

    async def errors(self) -> list[types.ErrorInfo]:
        return cast(list[types.ErrorInfo], await self._get("/v1/errors", {}))

    # --- how it is done -------------------------------------------------------------------------------------------

    async def _run(
        self, operation: str, meshes: Sequence[AsyncMesh | UploadOf], options: Mapping[str, object], material: Mesh | None,
        idempotency_key: str | None, timeout_s: float | None,
    ) -> AsyncResult:
        deadline = Deadline(timeout_s)
        headers = {"Accept": JSON, "Prefer": f"wait={deadline.wait_s()}"}
        response = await self._post_mesh(f"/v1/{operation}", "params", meshes, options, material, idempotency_key, headers)
        if response.status_code == 202:
            return await self.result(response.json()["id"], timeout_s=deadline.left_s())
        job_id = response.links["describedby"]["url"].split("/")[-2]
        return AsyncResult(self, job_id, cast(types.Report, response.json()))

    async def _post_mesh(
        self, path: str, field: str, meshes: Sequence[AsyncMesh | UploadOf], options: Mapping[str, object],
        material: Mesh | None, idempotency_key: str | None, headers: Mapping[str, str],
    ) -> httpx.Response:
        uploads = [mesh for mesh in meshes if isinstance(mesh, UploadOf)]
        if uploads and (len(meshes) > 1 or material is not None):
            raise ValueError("the upload of an earlier job is used again as it is, alone")
        body = json_body_of(options, uploads[0]) if uploads else body_of(field, options, cast(Sequence[AsyncMesh], meshes), material)
        key = {"Idempotency-Key": idempotency_key or str(uuid.uuid4())}
        return await _whole(await self._send("POST", path, headers={**headers, **key}, body=body))

    async def _get(self, path: str, query: Mapping[str, str | list[str]]) -> Any:
        return await _json(await self._send("GET", path, query=query, headers={"Accept": JSON}))

    async def _send(
        self, method: str, path: str, *, query: Mapping[str, str | list[str]] | None = None,
        headers: Mapping[str, str] | None = None, body: Body | None = None,
    ) -> httpx.Response:
        """Sends a request until its answer is a good one, whose body is still to be read."""
        attempt = 1
        while True:
            sent = {**self._headers, **(headers or {}), **(body.headers() if body else {})}
            content = body.apieces() if body else None
            request = self._http.build_request(method, self._url + path, params=query, headers=sent, content=content)
            error: MeshmendError
            try:
                response = await self._http.send(request, stream=True)
                if response.is_success:
                    return response
                error = await _error_of(response)
            except httpx.TransportError as cut:
                error = _failed(cut)
            # What was deleted by a request whose answer was lost is gone, as asked.
            if method == "DELETE" and attempt > 1 and isinstance(error, ProblemError) and error.status == 404:
                return response
            attempt += 1
            await self._pause(attempt, error, is_replayable=body is None or body.is_replayable)

    async def _pause(self, attempt: int, error: MeshmendError, *, is_replayable: bool) -> None:
        pause_s = self._retries.pause_before(attempt, error) if is_replayable else None
        if pause_s is None:
            raise error
        await anyio.sleep(pause_s)

    async def _read(self, job_id: str, sha256: str, level: int) -> bytes:
        attempt = 1
        while True:
            try:
                pieces = [piece async for piece in self._pieces(job_id, sha256, level)]
                return b"".join(pieces)
            except httpx.TransportError as cut:
                attempt += 1
                await self._pause(attempt, _failed(cut), is_replayable=True)

    async def _save(self, job_id: str, sha256: str, level: int, path: Path) -> None:
        part = path.with_name(f".{path.name}.{uuid.uuid4().hex}.part")
        attempt = 1
        try:
            while True:
                try:
                    async with await anyio.open_file(part, "wb") as file:
                        async for piece in self._pieces(job_id, sha256, level):
                            await file.write(piece)
                    os.replace(part, path)
                    return
                except httpx.TransportError as cut:
                    attempt += 1
                    await self._pause(attempt, _failed(cut), is_replayable=True)
        finally:
            part.unlink(missing_ok=True)

    async def _pieces(self, job_id: str, sha256: str, level: int) -> AsyncIterator[bytes]:
        """The bytes of a result; the end comes only after all of them have the SHA-256."""
        digest = hashlib.sha256()
        query = {} if level == 1 else {"level": str(level)}
        response = await self._send("GET", f"/v1/jobs/{job_id}/result", query=query)
        try:
            async for piece in response.aiter_bytes():
                digest.update(piece)
                yield piece
        finally:
            await response.aclose()
        if digest.hexdigest() != sha256:
            raise IntegrityError(f"the bytes have the SHA-256 {digest.hexdigest()}, the certificate says {sha256}")


async def _json(response: httpx.Response) -> Any:
    return (await _whole(response)).json()


async def _whole(response: httpx.Response) -> httpx.Response:
    try:
        await response.aread()
        return response
    except httpx.TransportError as error:
        raise ConnectionFailedError(str(error)) from error
    finally:
        await response.aclose()


async def _error_of(response: httpx.Response) -> ProblemError | UnexpectedAnswerError:
    try:
        body = await response.aread()
    finally:
        await response.aclose()
    headers = response.headers
    return answer_error(response.status_code, headers.get("content-type", ""), body, headers.get("retry-after"))


def _failed(cause: Exception | None) -> ConnectionFailedError:
    error = ConnectionFailedError(str(cause) if cause else "the connection ended early")
    error.__cause__ = cause
    return error
