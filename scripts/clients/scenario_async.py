"""What a client must be able to do, against the real server with a difficult neighbour in between.

    scenario_async.py NEIGHBOUR_URL NAME FIXTURES FOLDER

The other scenarios do the same, step by step, and must print the same lines. `scenario_sync.py` is made of this file.
"""

import hashlib
import json
import pathlib
import sys
import time
import urllib.request
from collections.abc import AsyncIterator
from typing import Any, cast

import anyio

from meshmend import AsyncMeshmend, ConnectionFailedError, IntegrityError, JobEvent, MeshmendError, NotFinishedError
from meshmend import NotRepairableError, ProblemError, Retries, StagePassed, StateChanged, UnexpectedAnswerError, UploadOf
from meshmend import WebhookError, verify_webhook
from meshmend.types import Job, PlanRequest

SECRET = "whsec_MfKQ9r8GKYqrTwjUPD8ILPZIo2LaLaSw"
OTHER_SECRET = "whsec_AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"


def check(holds: object, *what: object) -> None:
    if not holds:
        raise AssertionError(what)


async def error_of(call: Any) -> MeshmendError:
    """The error that a call ends with."""
    try:
        await call()
    except MeshmendError as error:
        return error
    raise AssertionError("the call was to fail")


class Scenario:
    def __init__(self, url: str, name: str, fixtures: str, folder: str) -> None:
        self.url, self.name = url, name
        self.fixtures, self.folder = pathlib.Path(fixtures), pathlib.Path(folder)
        self.crossing = self.fixtures / "intersection/self_intersection.off"
        self.sheet = self.fixtures / "boundary/open_sheet.off"
        self.cube = self.fixtures / "valid/cube.off"
        self.client = self.through("plain")

    def through(self, manner: str) -> AsyncMeshmend:
        return AsyncMeshmend(f"{self.url}/{self.name}/{manner}/", retries=Retries(pause_s=0.05))

    def known(self, what: str) -> list[dict[str, Any]]:
        with urllib.request.urlopen(f"{self.url}/{self.name}/{what}") as answer:
            return cast(list[dict[str, Any]], json.load(answer))

    def asked(self, manner: str, method: str, end: str = "") -> list[dict[str, Any]]:
        """What the neighbour was asked in this manner, without what it was asked by its own name."""
        asked = self.known("asked")
        return [e for e in asked if (e["manner"], e["method"]) == (manner, method) and e["path"].endswith(end)]

    def slow_mesh(self) -> bytes:
        """A mesh that takes the server a while, and is no other client's, so that no earlier result is given."""
        content = (self.folder / "slow.stl").read_bytes()
        return self.name.encode().ljust(80)[:80] + content[80:]

    async def until_final(self, client: AsyncMeshmend, job: Job) -> Job:
        return await client.wait(job["id"], timeout_s=120)

    # --- the steps

    async def wrong_input(self) -> str:
        torn = await error_of(lambda: self.client.repair(b"OFF\n3 1 0\n0 0 0\nx"))
        assert isinstance(torn, ProblemError)
        unknown = await error_of(lambda: cast(Any, self.client).repair(self.cube, wal_mm=1))
        assert isinstance(unknown, ProblemError)
        check(unknown.problem.get("suggestion") == "wall_mm", unknown.problem)
        missing = await error_of(lambda: self.client.repair(UploadOf("00000000-0000-7000-8000-000000000000")))
        assert isinstance(missing, ProblemError)
        return f"{torn.code} at line {torn.problem.get('line')}; {unknown.status} {unknown.code}; {missing.code}"

    async def repaired(self) -> str:
        content = self.crossing.read_bytes()
        results = [
            await self.client.repair(content, output_format="stl"),
            await self.client.repair(self.crossing, output_format="stl"),
        ]
        results.append(await self.client.repair(UploadOf(results[0].job_id), output_format="stl"))
        mesh = await results[0].read()
        path = self.folder / f"{self.name}.stl"
        for result in results:
            check(result.sha256() == results[0].sha256(), result.report)
            await result.save(path)
            check(path.read_bytes() == mesh)
        verdict = results[0].report["verdict"]
        return f"{verdict['outcome']}, {verdict['fidelity']}, {len(mesh)} bytes, {results[0].sha256()}"

    async def brought(self) -> str:
        client, content = self.through("torn"), self.crossing.read_bytes()
        upload = await client.upload(self.crossing)
        asked = self.asked("torn", "PATCH")
        # The second request brings what the first one did not.
        check(int(asked[-1]["content-length"]) == len(content) - len(content) // 2, asked)
        results = [await client.repair(mesh, output_format="stl") for mesh in (upload, await client.upload(content))]
        gone = await error_of(lambda: client.repair(UploadOf(upload_id="00000000-0000-7000-8000-000000000000")))
        assert isinstance(gone, ProblemError)
        return f"{results[0].sha256()}, {results[1].sha256()}; {gone.code}"

    async def refused(self) -> str:
        error = await error_of(lambda: self.client.repair(self.sheet, require="faithful"))
        assert isinstance(error, NotRepairableError) and error.report is not None
        job = await self.client.submit(self.sheet, operation="repair", require="faithful")
        later = await error_of(lambda: self.client.result(job["id"]))
        assert isinstance(later, NotRepairableError) and later.report is not None
        check(later.report["verdict"] == error.report["verdict"], later.report["verdict"])
        return f"{error.status} {error.code}, {error.report['verdict']['outcome']}"

    async def described(self) -> str:
        report = await self.client.analyze(self.crossing)
        certificate = (await self.client.verify(self.cube))["certificate"] or (await self.client.verify(self.cube))["input_certificate"]
        plan = await self.client.plan(self.crossing)
        again = await self.client.repair(self.crossing, plan=cast(PlanRequest, plan))
        before = report["before"]
        assert before is not None
        defects = sorted(defect["code"] for defect in before["defects"])
        return f"{','.join(defects)}; printable {str(certificate['printable']).lower()}; by its plan {again.report['verdict']['outcome']}"

    async def made(self) -> str:
        steps = json.loads((self.fixtures / "modeller/hip_roof.off.options.json").read_text())
        obj = self.fixtures / "valid/cube.obj"
        results = {
            "convert": await self.client.convert(obj, output_format="ply", material=b"newmtl a\nKd 1 0 0\n"),
            "simplify": await self.client.simplify(self.cube, targets=[{"faces": 12}, {"faces": 8}]),
            "fill": await self.client.fill_holes(self.fixtures / "boundary/boundary_loop.off", method="auto"),
            "cut": await self.client.cut_stitch(self.fixtures / "non_manifold/non_manifold_edge.off"),
            "model": await self.client.modeller(self.fixtures / "modeller/hip_roof.off", **steps),
            "combine": await self.client.boolean([self.cube, obj.read_bytes()], set_operation="intersection"),
        }
        sizes = {name: len(await result.read()) for name, result in results.items()}
        sizes["level 2"] = len(await results["simplify"].read(level=2))
        return ", ".join(f"{name} {size}" for name, size in sizes.items())

    async def drawn(self) -> str:
        sides = await self.client.render(self.crossing, views="four", width=320, height=240)
        job = await self.client.submit(self.crossing, operation="repair", thumbnail=True)
        await self.until_final(self.client, job)
        pictures = [sides, await self.client.thumbnail(job["id"])]
        check(all(picture.startswith(b"\x89PNG\r\n") for picture in pictures))
        check((await self.client.render(self.crossing, picture_format="glb")).startswith(b"glTF"))
        return f"{hashlib.sha256(sides).hexdigest()}, {len(pictures[1])} bytes"

    async def followed(self) -> str:
        client = self.through("cut")
        job = await client.submit(self.slow_mesh(), operation="repair")
        heard: list[JobEvent] = []
        async for event in client.events(job["id"]):
            heard.append(event)
            # It would go on for long; after three passes enough is heard.
            if [isinstance(each, StagePassed) for each in heard].count(True) == 3:
                await self.client.cancel(job["id"])
        fractions = [event.fraction for event in heard if isinstance(event, StagePassed)]
        check(len(fractions) >= 3 and fractions == sorted(fractions), fractions)
        asked = self.asked("cut", "GET", "/events")
        # Each connection brings one event, and the next one begins after it.
        check([entry.get("last-event-id") for entry in asked] == [None, *(event.id for event in heard[:-1])], asked)
        again: list[JobEvent] = []
        ended = await self.client.wait(job["id"], on_event=again.append)
        states = [[event.state for event in events if isinstance(event, StateChanged)] for events in (heard, again)]
        check(states[0] == states[1], states)
        rest = [event async for event in client.events(job["id"], last_event_id=heard[-1].id)]
        return f"{','.join(states[0])}; passes heard; {ended['state']}; {len(rest)} left"

    async def cancelled(self) -> str:
        job = await self.client.submit(self.slow_mesh(), operation="repair", cancel_after_s=600)
        unfinished = await error_of(lambda: self.client.result(job["id"], timeout_s=0.0))
        assert isinstance(unfinished, NotFinishedError) and unfinished.job["id"] == job["id"]
        await self.client.cancel(job["id"])
        ended = await self.until_final(self.client, job)
        error = await error_of(lambda: self.client.result(job["id"]))
        assert isinstance(error, ProblemError)
        return f"{ended['state']}; {error.code}"

    async def sent_again(self) -> str:
        words = []
        for manner in ("busy", "lost"):
            client, label = self.through(manner), {"try": f"{self.name}-{manner}"}
            begun = time.monotonic()
            await client.submit(self.cube, operation="verify", labels=label, idempotency_key=f"{self.name}-{manner}-1")
            # The first answer says that it is to be a second.
            check(manner != "busy" or time.monotonic() - begun >= 1.0)
            asked = self.asked(manner, "POST", "/v1/jobs")
            check({entry["idempotency-key"] for entry in asked} == {f"{self.name}-{manner}-1"}, asked)
            made = await self.client.jobs(labels=label)
            words.append(f"{manner} {[entry['status'] for entry in asked]} makes {len(made['jobs'])}")
        away = self.through("away")
        check((await away.version())["version"] and len(self.asked("away", "GET")) == 2)
        nobody = AsyncMeshmend("http://127.0.0.1:9", retries=Retries(attempts_max=2, pause_s=0.01))
        check(isinstance(await error_of(nobody.version), ConnectionFailedError))
        return "; ".join(words)

    async def streamed(self) -> str:
        content = self.crossing.read_bytes()
        results = [await self.client.repair(stream_of(content), output_format="stl")]
        with open(self.crossing, "rb") as file:
            results.append(await self.client.repair(file, output_format="stl"))
        # Of neither is it known before how long it is.
        check(all("content-length" not in entry for entry in self.asked("plain", "POST", "/v1/repair")[-2:]))
        error = await error_of(lambda: self.through("away").verify(stream_of(content)))
        assert isinstance(error, UnexpectedAnswerError)
        return f"{results[0].sha256()}, {results[1].sha256()}; sent once: {error.status}, {len(self.asked('away', 'POST'))}"

    async def guarded(self) -> str:
        short = await self.through("short").repair(self.crossing, output_format="stl")
        path = self.folder / f"{self.name}-guarded.stl"
        await short.save(path)
        check(len(self.asked("short", "GET", "/result")) == 2)
        size = path.stat().st_size
        path.unlink()
        bent = await self.through("bent").repair(self.crossing, output_format="stl")
        errors = [await error_of(lambda: bent.save(path)), await error_of(bent.read)]
        check(all(isinstance(error, IntegrityError) for error in errors), errors)
        left = list(self.folder.glob(f"*{self.name}-guarded*"))
        return f"{size} bytes at the second try; {len(left)} files of bent bytes"

    async def called(self) -> str:
        hook = {"url": f"{self.url}/{self.name}/hook", "secret": SECRET}
        job = await self.client.submit(self.cube, operation="repair", labels={"order": "17"}, webhook=cast(Any, hook))
        calls = await self.calls_of(2)
        ids = set()
        for call in calls:
            body, headers = call["body"].encode(), call["headers"]
            message_id, message = verify_webhook(body, headers, [OTHER_SECRET, SECRET])
            ids.add(message_id)
            check((message["type"], message["data"]["id"]) == ("job.succeeded", job["id"]), message)
            sent_at = int(next(value for name, value in headers.items() if name.lower() == "webhook-timestamp"))
            wrong: list[tuple[bytes, dict[str, str], str, float | None]] = [
                (body + b" ", headers, SECRET, None), (body, headers, OTHER_SECRET, None), (body, {}, SECRET, None),
                (body, headers, SECRET, sent_at + 301.0), (body, headers, SECRET, sent_at - 301.0),
            ]
            for content, named, secret, now in wrong:
                try:
                    verify_webhook(content, named, secret, now=now)
                except WebhookError:
                    continue
                raise AssertionError((content, named, secret, now))
        while (delivery := (await self.client.deliveries(job["id"]))["deliveries"][0])["state"] == "pending":
            await anyio.sleep(0.05)
        await self.client.redeliver(job["id"], delivery["id"])
        await self.calls_of(3)
        check(ids == {delivery["id"]}, ids)
        return f"{delivery['state']} after {[each['status'] for each in delivery['tries']]}; sent again when asked"

    async def calls_of(self, count: int) -> list[dict[str, Any]]:
        for _ in range(600):
            if len(calls := self.known("calls")) >= count:
                return calls
            await anyio.sleep(0.1)
        raise AssertionError("no call came")

    async def tidied(self) -> str:
        page = await self.client.jobs(limit=1, state="succeeded")
        after = await self.client.jobs(limit=1, state="succeeded", cursor=page["next"] or "")
        check(page["jobs"][0]["id"] != after["jobs"][0]["id"])
        job_id = page["jobs"][0]["id"]
        await self.client.delete(job_id)
        gone = await error_of(lambda: self.client.job(job_id))
        assert isinstance(gone, ProblemError)
        limits = await self.client.limits()
        check(limits["upload_bytes_max"] > 0 and limits["webhook_attempts_max"] > 0)
        formats = {entry["name"] for entry in await self.client.formats()}
        check({"stl", "off"} <= formats and await self.client.policies())
        codes = {entry["code"] for entry in await self.client.errors()}
        return f"{gone.code}; it is explained: {str(gone.code in codes).lower()}"


async def stream_of(content: bytes) -> AsyncIterator[bytes]:
    for begin in range(0, len(content), 50):
        yield content[begin : begin + 50]


STEPS = [
    "wrong_input", "repaired", "brought", "refused", "described", "made", "drawn", "followed", "cancelled", "sent_again",
    "guarded", "called", "streamed", "tidied",
]


async def main() -> None:
    scenario = Scenario(*sys.argv[1:])
    for step in STEPS:
        print(f"{step}: {await getattr(scenario, step)()}", flush=True)


if __name__ == "__main__":
    anyio.run(main)
