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
schemathesis.openapi.media_type("model/gltf-binary", meshes("glb"))
schemathesis.openapi.media_type("model/gltf+json", meshes("gltf"))
# A piece of an upload may be any bytes.
schemathesis.openapi.media_type("application/offset+octet-stream", meshes("off"))
# Without a name the content tells the format.
schemathesis.openapi.media_type("application/octet-stream", meshes("stl", "obj", "off", "ply", "glb", "gltf"))


# At most one of these may be given.
TARGETS = {"faces", "ratio", "error_mm", "targets"}

# A full turn goes with neither of these.
VIEWS = {"views", "projection"}

# The members of each step of a plan beside `step`, where it has any. The schema leaves the steps open, the reader does not.
STEP_MEMBERS = {
    "split-polygons": {"degenerate"},
    "remove-parts": {"triangles"},
    "drop-duplicates": {"opposite"},
    "remove-crossing": {"rings"},
    "snap": {"epsilon"},
    "mend-thin-faces": {"needles", "caps", "folds"},
    "fill-holes": {"all", "except"},
    "thicken": {"wall"},
    "nest": {"nesting", "chosen"},
}


@schemathesis.hook
def before_call(context, case, kwargs):
    """An option, and the operation of a job, may stand in the query, in the body and in parts of it, but not with
    different values, which a schema cannot say: well-formed requests name each once, and one target at most."""
    if not (case.meta and case.meta.generation.mode.is_positive):
        return
    named = set()
    for place in [*places(case.body if isinstance(case.body, dict) else {}), case.query]:
        if place.get("vertex_colors") == "priority":
            # Needs a format that has colours, which a schema cannot say either.
            place["vertex_colors"] = "kept"
        if "turntable" in place:
            # All pictures together have a largest size.
            place["turntable"] = 2
        if isinstance(place.get("plan"), dict):
            for step in place["plan"].get("steps") or []:
                for name in step.keys() - STEP_MEMBERS.get(step["step"], set()) - {"step"}:
                    del step[name]
        for name in list(place):
            is_other_view = (name == "turntable" and named & VIEWS) or (name in VIEWS and "turntable" in named)
            if name in named or (name in TARGETS and named & TARGETS) or is_other_view:
                del place[name]
            named.add(name)
    if case.path == "/v1/jobs" and case.method == "POST" and "operation" not in named:
        case.query["operation"] = "verify"
    if case.path in ("/v1/repair", "/v1/jobs") and case.method == "POST" and "wrap_cells" not in named:
        # What is rebuilt is rebuilt coarsely, because that is quick.
        case.query["wrap_cells"] = 16


def places(body):
    """The objects of a body that hold options."""
    parts = [body.get("job", {}), body.get("params", {})] if "mesh" in body else [body]
    return [place for part in parts for place in (part, part.get("params", {})) if isinstance(place, dict)]
