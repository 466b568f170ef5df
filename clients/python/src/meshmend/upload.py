"""Bodies of requests: a form of options and meshes, as pieces of bytes."""

import base64
import json
import os
import uuid
from collections.abc import AsyncIterable, AsyncIterator, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import IO, Union

Mesh = Union[str, os.PathLike[str], bytes, bytearray, memoryview, IO[bytes], Iterable[bytes]]
"""A mesh to send: the path of a file, its bytes, an open binary file, or a stream of pieces."""
AsyncMesh = Union[Mesh, AsyncIterable[bytes]]
"""A mesh to send by an `AsyncMeshmend`: as `Mesh`, or an asynchronous stream of pieces."""

KeptMesh = Union[str, os.PathLike[str], bytes, bytearray, memoryview]
"""A mesh that can be sent again from any place on: the path of a file, or its bytes."""

CHUNK_BYTES = 1 << 16

TUS = {"Tus-Resumable": "1.0.0"}
"""The protocol of uploads that come before their job: https://tus.io/protocols/resumable-upload."""


@dataclass(frozen=True)
class UploadOf:
    """A mesh that the service has: the upload of an earlier job, or one that was made beforehand at `/v1/uploads`."""

    job_id: str | None = None
    upload_id: str | None = None

    def __post_init__(self) -> None:
        if (self.job_id is None) == (self.upload_id is None):
            raise ValueError("name a job or an upload")

    def reference(self) -> dict[str, str | None]:
        """Its name in `input`."""
        return {"upload": self.upload_id} if self.job_id is None else {"job": self.job_id}


@dataclass(frozen=True)
class Part:
    """A part of a form: its own head, and where its bytes come from."""

    head: bytes
    source: AsyncMesh

    def size(self) -> int | None:
        """Bytes of the source; none where only reading it tells."""
        if isinstance(self.source, bytes | bytearray | memoryview):
            return memoryview(self.source).nbytes
        if isinstance(self.source, str | os.PathLike):
            return os.stat(self.source).st_size
        return None

    def pieces(self) -> Iterator[bytes]:
        yield self.head
        if isinstance(self.source, bytes | bytearray | memoryview):
            yield bytes(self.source)
        elif isinstance(self.source, str | os.PathLike):
            with open(self.source, "rb") as file:
                yield from iter(lambda: file.read(CHUNK_BYTES), b"")
        elif isinstance(self.source, Iterable):
            yield from _file_pieces(self.source)
        else:
            raise TypeError("an asynchronous stream needs an AsyncMeshmend")
        yield b"\r\n"


class Body:
    """The body of a POST or PATCH."""

    def __init__(self, content_type: str, parts: Sequence[Part], end: bytes) -> None:
        self.content_type = content_type
        self._parts = parts
        self._end = end

    @property
    def is_replayable(self) -> bool:
        """Whether it can be sent a second time: not when a part is a stream or an open file."""
        return all(part.size() is not None for part in self._parts)

    def headers(self) -> dict[str, str]:
        headers = {"Content-Type": self.content_type}
        sizes = [part.size() for part in self._parts]
        known = [size for size in sizes if size is not None]
        if len(known) == len(sizes):
            heads = sum(len(part.head) + len(b"\r\n") for part in self._parts)
            headers["Content-Length"] = str(sum(known) + heads + len(self._end))
        return headers

    def pieces(self) -> Iterator[bytes]:
        """The body, for a client that waits."""
        for part in self._parts:
            yield from part.pieces()
        yield self._end

    async def apieces(self) -> AsyncIterator[bytes]:
        """The body, for a client that does not."""
        for part in self._parts:
            if isinstance(part.source, AsyncIterable):
                yield part.head
                async for piece in part.source:
                    yield piece
                yield b"\r\n"
            else:
                # Reading a local file does not wait for a network.
                for piece in part.pieces():
                    yield piece
        yield self._end


class Rest(Body):
    """What follows after so many bytes of a mesh. It is sent once: how far it came is asked before more is sent."""

    def __init__(self, mesh: KeptMesh, offset: int, size: int) -> None:
        super().__init__("application/offset+octet-stream", [], b"")
        self._mesh = mesh
        self._offset = offset
        self._size = size

    @property
    def is_replayable(self) -> bool:
        return False

    def headers(self) -> dict[str, str]:
        length = str(self._size - self._offset)
        return {"Content-Type": self.content_type, "Upload-Offset": str(self._offset), "Content-Length": length}

    def pieces(self) -> Iterator[bytes]:
        if isinstance(self._mesh, str | os.PathLike):
            with open(self._mesh, "rb") as file:
                file.seek(self._offset)
                yield from iter(lambda: file.read(CHUNK_BYTES), b"")
        else:
            content = memoryview(self._mesh).cast("B")
            for begin in range(self._offset, content.nbytes, CHUNK_BYTES):
                yield bytes(content[begin : begin + CHUNK_BYTES])

    async def apieces(self) -> AsyncIterator[bytes]:
        for piece in self.pieces():
            yield piece


def announced(mesh: KeptMesh) -> dict[str, str]:
    """What is said of a mesh before it comes: its length and the name of its file."""
    headers = {**TUS, "Upload-Length": str(size_of(mesh))}
    if isinstance(mesh, str | os.PathLike):
        name = os.path.basename(os.fspath(mesh)).encode("utf-8", "surrogateescape")
        headers["Upload-Metadata"] = f"filename {base64.b64encode(name).decode()}"
    return headers


def size_of(mesh: KeptMesh) -> int:
    """Bytes of a mesh."""
    if isinstance(mesh, str | os.PathLike):
        return os.stat(mesh).st_size
    if isinstance(mesh, bytes | bytearray | memoryview):
        return memoryview(mesh).nbytes
    raise TypeError(f"an upload is a path or bytes, which can be read again from where it stands, and no {type(mesh).__name__}")


def body_of(field: str, options: Mapping[str, object], meshes: Sequence[AsyncMesh], material: Mesh | None) -> Body:
    """A form: the options as JSON in `field`, then the meshes, each a part `mesh`, then the material of an OBJ."""
    boundary = f"meshmend-{uuid.uuid4().hex}"
    parts = [_part(boundary, field, json.dumps(options).encode(), "application/json")]
    parts += [_part(boundary, "mesh", mesh, "application/octet-stream") for mesh in meshes]
    if material is not None:
        parts.append(_part(boundary, "material", material, "application/octet-stream"))
    return Body(f"multipart/form-data; boundary={boundary}", parts, f"--{boundary}--\r\n".encode())


def json_body_of(options: Mapping[str, object], upload: UploadOf) -> Body:
    """Options as JSON that name a mesh which the service has."""
    return Body("application/json", [], json.dumps({**options, "input": upload.reference()}).encode())


def _part(boundary: str, field: str, source: AsyncMesh, content_type: str) -> Part:
    name = os.path.basename(os.fspath(source)) if isinstance(source, str | os.PathLike) else ""
    # As browsers write it: what would end the text early is percent-encoded.
    escaped = name.replace("%", "%25").replace('"', "%22").replace("\r", "%0D").replace("\n", "%0A")
    file_name = "" if content_type == "application/json" else f'; filename="{escaped or field}"'
    head = f'--{boundary}\r\nContent-Disposition: form-data; name="{field}"{file_name}\r\nContent-Type: {content_type}\r\n\r\n'
    return Part(head.encode(), source)


def _file_pieces(source: IO[bytes] | Iterable[bytes]) -> Iterator[bytes]:
    read = getattr(source, "read", None)
    return iter(lambda: read(CHUNK_BYTES), b"") if read is not None else iter(source)
