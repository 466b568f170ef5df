"""Makes the synchronous half of the Python client of the asynchronous one, word by word, and the same of the scenario.

    without_async.py _async.py > _sync.py
"""

import re
import sys

# In this order.
WORDS = [
    (r"^\"\"\"The client\..*$", '"""The client, made of `_async.py` by scripts/clients/without_async.py: change that one."""'),
    (r"\bawait anyio\.sleep\b", "time.sleep"),
    (r"\banyio\.run\((\w+)\)", r"\1()"),
    (r"\bawait anyio\.open_file\b", "open"),
    (r"^import anyio\n", ""),
    (r"^import uuid\n", "import time\nimport uuid\n"),
    (r"\basync (def|for|with)\b", r"\1"),
    (r"\bawait ", ""),
    (r"\bAsync(Meshmend|Result|Mesh)\b", r"\1"),
    (r"\bimport Mesh, Body, Mesh, ", "import Body, Mesh, "),
    (r"\bAsyncIterator\b", "Iterator"),
    (r"\bIterator, Callable, Mapping\b", "Callable, Iterator, Mapping"),
    (r"\bhttpx\.AsyncClient\b", "httpx.Client"),
    (r"\b__aenter__\b", "__enter__"),
    (r"\b__aexit__\b", "__exit__"),
    (r"\ba(close|read|iter_raw|iter_bytes|pieces)\b", r"\1"),
]


def main(path):
    with open(path, encoding="utf-8") as file:
        text = file.read()
    for pattern, replacement in WORDS:
        text = re.sub(pattern, replacement, text, flags=re.MULTILINE)
    left = re.findall(r".*(?:\basync\b|\bawait\b|\banyio\b).*", text.replace("_async.py", "").replace("without_async.py", ""))
    if left:
        sys.exit(f"asynchronous words are left: {left}")
    sys.stdout.write(text)


main(*sys.argv[1:])
