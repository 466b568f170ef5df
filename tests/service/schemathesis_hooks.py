"""What schemathesis cannot know: bodies of the mesh media types are the fixtures of the project, valid and broken ones."""

from pathlib import Path

import schemathesis
from hypothesis import strategies

FIXTURES = Path(__file__).resolve().parents[2] / "fixtures"


def meshes(*extensions):
    """The content of every fixture with one of these extensions."""
    files = sorted(path for path in FIXTURES.rglob("*") if path.suffix.lstrip(".") in extensions)
    return strategies.sampled_from([path.read_bytes() for path in files])


schemathesis.openapi.media_type("model/stl", meshes("stl"))
schemathesis.openapi.media_type("model/obj", meshes("obj"))
schemathesis.openapi.media_type("text/off", meshes("off"))
schemathesis.openapi.media_type("application/x-ply", meshes("ply"))
# Without a name the content tells the format; curl sends the last one unless told otherwise.
for media_type in ["application/octet-stream", "application/x-www-form-urlencoded"]:
    schemathesis.openapi.media_type(media_type, meshes("stl", "obj", "off", "ply"))


@schemathesis.hook
def before_call(context, case, kwargs):
    """An option may stand in the query, in the body and in its `params`, but not with different values, which a schema
    cannot say: well-formed requests name each once."""
    if not (case.meta and case.meta.generation.mode.is_positive and isinstance(case.body, dict)):
        return
    is_form = "mesh" in case.body
    outer = case.body.get("job", {}) if is_form else case.body
    inner = (case.body if is_form and "job" not in case.body else outer).get("params", {})
    for name in [name for name in inner if name in outer and inner is not outer]:
        del inner[name]
    for name in [*outer, *inner]:
        case.query.pop(name, None)
