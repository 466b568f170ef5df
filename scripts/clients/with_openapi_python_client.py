"""A client made by openapi-python-client repairs a mesh, reads a report, waits for a job and reads its events.

    with_openapi_python_client.py URL MESH.off
"""

import io
import sys

from meshmend_client import Client
from meshmend_client.api.jobs import create_job, get_job, get_job_events, get_job_result
from meshmend_client.api.operations import analyze, repair
from meshmend_client.models import Format, JobState, Operation
from meshmend_client.types import File


def main(url, path):
    client = Client(base_url=url, timeout=60)
    with open(path, "rb") as file:
        content = file.read()
    mesh = lambda: File(payload=io.BytesIO(content), file_name="part.off", mime_type="application/octet-stream")

    repaired = repair.sync_detailed(client=client, body=mesh(), output_format=Format.STL)
    assert repaired.status_code == 200, repaired.content
    assert repaired.parsed.payload.read() == repaired.content and len(repaired.content) > 84
    assert repaired.headers["meshmend-fidelity"] in ("exact", "faithful", "changed")

    report = analyze.sync(client=client, body=mesh())
    assert report.input_.format_ == Format.OFF, report.input_

    job = create_job.sync(client=client, body=mesh(), operation=Operation.REPAIR)
    ended = get_job.sync(id=job.id, client=client, wait=60)
    assert ended.state == JobState.SUCCEEDED, ended
    events = get_job_events.sync_detailed(id=job.id, client=client)
    assert b"event: state" in events.content and b"succeeded" in events.content, events.content
    result = get_job_result.sync(id=job.id, client=client)
    assert result.payload.read(3) == b"OFF"
    print("openapi-python-client: repaired, read a report, waited for a job, read its events")


main(*sys.argv[1:])
