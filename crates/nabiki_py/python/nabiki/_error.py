"""Errors."""

from __future__ import annotations

import errno
import os


class Error(ValueError):
    """A file, a setting or an argument that cannot be used. Its text is one line; its parts are attributes, as far as known.

    If the system refuses a file, the exception is also an `OSError` with `filename` and `errno`, such as `FileNotFoundError`.
    For an unknown attribute it is also an `AttributeError`.
    """

    file: str | None
    """The file."""
    line: int | None
    """The line in the file, counted from 1."""
    thing: str | None
    """The setting by its key, or the argument by its name."""
    value: str | None
    """The value that was refused."""
    way_out: str | None
    """What is allowed, or what to do."""

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
        return type(self), self.args, self._parts()

    def _parts(self) -> dict[str, object]:
        return {"file": self.file, "line": self.line, "thing": self.thing, "value": self.value, "way_out": self.way_out}


# As a traceback names it.
Error.__module__ = "nabiki"


class FileError(Error, OSError):
    """A file that the system refuses: `errno`, `strerror` and `filename` are those of the system."""

    def __str__(self) -> str:
        return str(self.args[0])

    def _parts(self) -> dict[str, object]:
        return super()._parts() | {"errno": self.errno, "strerror": self.strerror, "filename": self.filename}


class MissingFile(FileError, FileNotFoundError):
    """A file, or its folder, that is not there."""


class ClosedFile(FileError, PermissionError):
    """A file that may not be read, or not be written."""


class TakenFile(FileError, FileExistsError):
    """A file that is there already."""


class FolderForFile(FileError, IsADirectoryError):
    """A folder where there should be a file."""


class FileForFolder(FileError, NotADirectoryError):
    """A file where there should be a folder."""


class UnknownAttribute(Error, AttributeError):
    """An attribute that is not there."""


_OF_SYSTEM: dict[int, type[FileError]] = {
    errno.ENOENT: MissingFile,
    errno.EACCES: ClosedFile,
    errno.EEXIST: TakenFile,
    errno.EISDIR: FolderForFile,
    errno.ENOTDIR: FileForFolder,
}


def refused(
    text: str,
    system: str | None,
    filename: str | None,
    *,
    file: str | None,
    line: int | None,
    thing: str | None,
    value: str | None,
    way_out: str | None,
) -> Error:
    """The exception of a refusal. Where the system refuses a file, `system` is the name of its error, `ENOENT`, and `filename` that file."""
    number = getattr(errno, system, None) if system else None
    kind = Error if number is None else _OF_SYSTEM.get(number, FileError)
    error = kind(text, file=file, line=line, thing=thing, value=value, way_out=way_out)
    if isinstance(error, FileError) and number is not None:
        error.errno, error.strerror, error.filename = number, os.strerror(number), filename
    return error


def unknown(error: Error) -> UnknownAttribute:
    """The same of an attribute."""
    return UnknownAttribute(
        str(error), file=error.file, line=error.line, thing=error.thing, value=error.value, way_out=error.way_out
    )
