"""A client made by openapi-generator (python) repairs a mesh, reads a report, waits for a job and reads its events.

    with_openapi_generator.py URL MESH.off
"""

import sys

from meshmend_generated import ApiClient, Configuration, JobsApi, OperationsApi
from meshmend_generated.models import Format, JobState, Operation


# The generated code sends JSON wherever an operation takes it too, unless it is told what the bytes are.
MESH = {"_content_type": "application/octet-stream"}


def main(url, path):
    with open(path, "rb") as file:
        mesh = file.read()
    with ApiClient(Configuration(host=url)) as client:
        operations, jobs = OperationsApi(client), JobsApi(client)
        repaired = operations.repair_with_http_info(body=mesh, output_format=Format.STL, **MESH)
        assert repaired.status_code == 200 and len(repaired.data) > 84
        assert repaired.headers["meshmend-fidelity"] in ("exact", "faithful", "changed")

        report = operations.analyze(body=mesh, **MESH)
        assert report.input.format == Format.OFF, report.input

        job = jobs.create_job(body=mesh, operation=Operation.REPAIR, **MESH)
        ended = jobs.get_job(id=job.id, wait=60)
        assert ended.state == JobState.SUCCEEDED, ended
        events = jobs.get_job_events_without_preload_content(id=job.id).read()
        assert b"event: state" in events and b"succeeded" in events, events
        assert bytes(jobs.get_job_result(id=job.id)).startswith(b"OFF")
    print("openapi-generator: repaired, read a report, waited for a job, read its events")


main(*sys.argv[1:])
