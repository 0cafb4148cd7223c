# SPDX-License-Identifier: MIT
"""Findings of libcsgmesh as Python's exceptions and warnings."""
from __future__ import annotations

import errno
import os
import sys
import warnings
from dataclasses import dataclass, field
from typing import Any, Callable, Optional

_HERE = os.path.dirname(os.path.abspath(__file__))


@dataclass(frozen=True)
class Diagnostic:
    """One finding: what is wrong, where, and what to do about it."""

    severity: str  #: "note", "warning" or "error"
    code: str  #: as "E0107"; the language manual lists them
    message: str  #: one sentence
    file: Optional[str]  #: as it was named; None: it is about no file
    line: int  #: 1-based; 0: it is about no text
    column: int  #: in bytes, 1-based
    end_line: int
    end_column: int
    hint: Optional[str]  #: what to do
    source_line: Optional[str]
    library: Optional[str]  #: the library of scenes whose file it is in
    lenient: bool  #: a warning that would be an error in a strict text
    text: str = field(repr=False)  #: as the command line prints it, with the line and a caret
    made_at: Optional[str] = None  #: of a solid that was made in Python: "file.py:12"

    def __str__(self) -> str:
        return self.text.rstrip("\n") + (f"\nmade in {self.made_at}" if self.made_at else "")


class SceneWarning(UserWarning):
    """A warning of csgmesh; `diagnostic` has its place and hint."""

    def __init__(self, diagnostic: Diagnostic):
        super().__init__(str(diagnostic))
        self.diagnostic = diagnostic


class Error(Exception):
    """What went wrong. The first error's file, line, column, code, message and hint are its own; `diagnostics` has all findings."""

    def __init__(self, message: str, diagnostics: Optional[list[Diagnostic]] = None):
        super().__init__(message)
        self.diagnostics: list[Diagnostic] = list(diagnostics or [])
        first = next((d for d in self.diagnostics if d.severity == "error"), None)
        self.file: Optional[str] = first.file if first else None
        self.line: int = first.line if first else 0
        self.column: int = first.column if first else 0
        self.code: Optional[str] = first.code if first else None
        self.message: str = first.message if first else message
        self.hint: Optional[str] = first.hint if first else None
        self.source_line: Optional[str] = first.source_line if first else None
        self.made_at: Optional[str] = first.made_at if first else None


class ArgumentError(Error, ValueError):
    """Options that are out of range or contradict each other."""


class SceneSyntaxError(Error):
    """The text is not in the language."""


class SceneError(Error):
    """A text without a meaning: an unknown name, a negative radius."""


class LimitError(Error):
    """A limit was reached: max_steps, max_depth, max_nodes or timeout."""


class OutOfMemoryError(Error, MemoryError):
    """max_memory was reached, or there is no more memory."""


class FileError(Error, OSError):
    """A file cannot be read or written."""


class MissingFileError(FileError, FileNotFoundError):
    """A file is not there."""


class FormatError(Error, ValueError):
    """A mesh file that is broken, or not of the format that it claims."""


class UnsupportedError(Error, NotImplementedError):
    """This build has nothing for it: csgmesh.features says which libraries it lacks."""


class InternalError(Error):
    """A bug in csgmesh; please report it."""


_KINDS: dict[str, type[Error]] = {
    "ERR_ARGUMENT": ArgumentError, "ERR_SYNTAX": SceneSyntaxError, "ERR_SCENE": SceneError, "ERR_LIMIT": LimitError,
    "ERR_MEMORY": OutOfMemoryError, "ERR_IO": FileError, "ERR_FORMAT": FormatError, "ERR_UNSUPPORTED": UnsupportedError,
}

#: (line, column) of a text -> the place in a Python file that its solid was made at
Origin = Callable[[int, int], Optional[str]]


def diagnostics_of(findings: list[dict[str, Any]], origin: Optional[Origin]) -> list[Diagnostic]:
    out = []
    for f in findings:
        made_at = origin(f["line"], f["column"]) if origin and f["line"] and f["file"] == "solid" else None
        code = f"{f['severity'][0].upper()}{f['number']:04d}"
        out.append(Diagnostic(
            severity=f["severity"], code=code, message=f["message"], file=f["file"], line=f["line"], column=f["column"],
            end_line=f["end_line"], end_column=f["end_column"], hint=f["hint"], source_line=f["source_line"],
            library=f["library"], lenient=f["lenient"], text=f["text"], made_at=made_at))
    return out


def missing_file(path: str) -> MissingFileError:
    error = MissingFileError(f"{path} is not there")
    error.errno, error.strerror, error.filename = errno.ENOENT, os.strerror(errno.ENOENT), path
    error.file = path
    return error


def caller_level() -> int:
    """The stacklevel that warnings.warn needs to name the first line outside of this package."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back and os.path.dirname(os.path.abspath(frame.f_code.co_filename)) == _HERE:
        level, frame = level + 1, frame.f_back
    return level


def failure(status: str, doing: str, diagnostics: list[Diagnostic]) -> Error:
    errors = [d for d in diagnostics if d.severity == "error"]
    kind = _KINDS.get(status, InternalError)
    if not errors:
        return kind(f"{doing}: {_PLAIN.get(status, 'failed (' + status + ')')}", diagnostics)
    more = len(errors) - 1
    text = str(errors[0]) + (f"\n({more} more error{'s' if more > 1 else ''}: see .diagnostics)" if more else "")
    return kind(text, diagnostics)


_PLAIN = {
    "ERR_ARGUMENT": "the options are out of range or contradict each other", "ERR_MEMORY": "there is no more memory",
    "ERR_SCENE": "there is nothing to be made: no surface", "ERR_UNSUPPORTED": "this build has nothing for it",
    "CANCELLED": "it was cancelled",
}


def settle(status: str, doing: str, diagnostics: list[Diagnostic]) -> None:
    """Raises what has failed, and warns of what has not."""
    if status != "OK":
        raise failure(status, doing, diagnostics)
    for d in diagnostics:
        if d.severity == "warning":
            warnings.warn(SceneWarning(d), stacklevel=caller_level())
