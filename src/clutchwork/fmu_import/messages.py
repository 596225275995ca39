"""What a run and the process of an FMU say to each other: messages of fixed size, numbers and one text, no objects."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from enum import IntEnum
from typing import BinaryIO, NamedTuple

# bytes of the text of an answer
TEXT = 480


class Command(IntEnum):
    """What a run wants."""

    BEGIN = 1  # instantiate and initialise at a time with inputs
    STEP = 2  # set inputs, then step
    END = 3  # terminate and free


class Answer(IntEnum):
    """How it ended."""

    DONE = 0
    DISCARD = 2
    ERROR = 3
    FATAL = 4
    PENDING = 5
    NO_INSTANCE = 10  # instantiation gave NULL
    NO_LIBRARY = 11  # it cannot be loaded
    TERMINATED = 12  # it asks for the end


class Request(NamedTuple):
    """An order with time [s], length of the step [s] and values of the inputs."""

    order: Command
    time: float
    size: float
    inputs: tuple[float, ...]


class Reply(NamedTuple):
    """What came of an order: outputs, and what the FMU said last."""

    answer: Answer
    outputs: tuple[float, ...]
    text: str


class Format:
    """The messages of one FMU, by the number of its inputs and outputs."""

    def __init__(self, inputs: int, outputs: int) -> None:
        self._request = struct.Struct(f"<i2d{inputs}d")
        self._reply = struct.Struct(f"<i{outputs}d{TEXT}s")
        self._outputs = outputs

    @property
    def reply_size(self) -> int:
        """Bytes of an answer."""
        return self._reply.size

    def request(self, order: Command, time: float, size: float, inputs: Sequence[float]) -> bytes:
        """A request as bytes."""
        return self._request.pack(order, time, size, *inputs)

    def reply(self, answer: Answer, outputs: Sequence[float], text: str) -> bytes:
        """An answer as bytes; a long text is cut."""
        values = outputs or [0.0] * self._outputs
        return self._reply.pack(answer, *values, text.encode("utf-8", "replace")[:TEXT])

    def read_request(self, stream: BinaryIO) -> Request | None:
        """The next request; None where the other side has gone."""
        data = stream.read(self._request.size)
        if len(data) < self._request.size:
            return None
        order, time, size, *inputs = self._request.unpack(data)
        return Request(Command(order), time, size, tuple(inputs))

    def read_reply(self, data: bytes) -> Reply:
        """An answer."""
        answer, *outputs, text = self._reply.unpack(data)
        said = text.rstrip(b"\0").decode("utf-8", "replace")
        return Reply(Answer(answer), tuple(outputs), said)
