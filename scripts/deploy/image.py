"""The image can be built from what .dockerignore leaves: Cargo finds the targets that its manifest names, the compiler the files that
sources include, and the Dockerfile what it copies. Nothing is built, and no container is started.
"""

import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main():
    kept = [line[1:] for line in (ROOT / ".dockerignore").read_text().splitlines() if line.startswith("!")]
    files = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard", "--", *kept], cwd=ROOT, check=True,
                           capture_output=True, text=True).stdout.splitlines()
    with tempfile.TemporaryDirectory() as folder:
        context = pathlib.Path(folder)
        for name in files:
            (context / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(ROOT / name, context / name)
        missing = [*not_included(context), *not_copied(context)]
        # The first thing that Cargo does before it builds.
        host = subprocess.run(["rustc", "--print", "host-tuple"], check=True, capture_output=True, text=True).stdout.strip()
        read = subprocess.run(["cargo", "fetch", "--locked", "--target", host], cwd=context, capture_output=True, text=True)
        if read.returncode:
            missing.append(read.stderr)
    if missing:
        sys.exit("the image cannot be built:\n" + "\n".join(missing))
    print(f"the image is built from {len(files)} files, which are enough")


def not_included(context):
    """Files that sources include and that are not there."""
    for source in (context / "src").rglob("*.rs"):
        for name in re.findall(r'include_(?:str|bytes)!\(\s*"([^"]+)"', source.read_text()):
            if not (source.parent / name).exists():
                yield f"{source.relative_to(context)} includes {name}"


def not_copied(context):
    """Files that the Dockerfile copies from the folder of the build, or runs there, and that are not there."""
    text = (ROOT / "Dockerfile").read_text()
    for name in re.findall(r"/build/(?!target/)(\S+)", text) + re.findall(r"(?<= )scripts/\S+", text):
        if not list(context.glob(name)):
            yield f"the Dockerfile needs {name}"


main()
