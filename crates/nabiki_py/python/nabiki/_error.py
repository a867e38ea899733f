"""What is refused."""

from __future__ import annotations


class Error(ValueError):
    """A file, a setting or an argument that cannot be used. Its text is one line; what is known of it stands in its attributes."""

    file: str | None
    """The file that is meant."""
    line: int | None
    """Its line, from 1."""
    thing: str | None
    """The setting by its key, or the argument by its name."""
    value: str | None
    """What it was."""
    way_out: str | None
    """What it may be, or what to do."""

    def __init__(
        self,
        text: str,
        *,
        file: str | None = None,
        line: int | None = None,
        thing: str | None = None,
        value: str | None = None,
        way_out: str | None = None,
    ) -> None:
        super().__init__(text)
        self.file, self.line, self.thing, self.value, self.way_out = file, line, thing, value, way_out

    def __reduce__(self) -> tuple[object, ...]:
        parts = {"file": self.file, "line": self.line, "thing": self.thing, "value": self.value, "way_out": self.way_out}
        return Error, self.args, parts
