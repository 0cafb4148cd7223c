# SPDX-License-Identifier: MIT
"""One call into libcsgmesh: options sorted and put as it wants them, findings settled afterwards."""
from __future__ import annotations

import difflib
import os
import re
import sys
from collections.abc import Mapping
from typing import Any, Optional

from . import _core, _errors
from ._solid import expression_text

Options = Mapping[str, Any]

_CONTEXT = set(_core.option_names["run"])
_OWN = {"only_check"}  # functions of their own set these
_COLORS = {"white": (255, 255, 255, 255), "black": (0, 0, 0, 255), "gray": (128, 128, 128, 255),
           "transparent": (0, 0, 0, 0)}


def path_bytes(path: Any, what: str = "path") -> bytes:
    if not isinstance(path, (str, bytes, os.PathLike)):
        raise TypeError(f"{what} must be the name of a file, not {type(path).__name__}")
    name = os.fsencode(path)
    if b"\0" in name:
        raise ValueError(f"{what} holds a zero byte")
    return name


def existing(path: Any) -> bytes:
    """A file to read. What is not there is said so at once, with the exception that Python has for it."""
    name = path_bytes(path)
    if not os.path.exists(name):
        raise _errors.missing_file(os.fsdecode(name))
    return name


def format_bytes(name: Optional[str]) -> bytes:
    """"" is: by the file's extension."""
    if name is None:
        return b""
    known = [row["name"] for row in _core.formats()]
    if not isinstance(name, str) or name not in known:
        raise ValueError(f"format must be one of {', '.join(known)}, not {name!r}")
    return name.encode()


# ---- options

def defines(given: Any) -> dict[bytes, bytes]:
    if not isinstance(given, Mapping):
        raise TypeError(f"define must be a dict of names and values, not {type(given).__name__}")
    for name in given:
        if not isinstance(name, str) or not re.fullmatch(r"\$?[A-Za-z_][A-Za-z0-9_]*", name):
            raise ValueError(f"define: {name!r} is no name of the scene language")
    return {name.encode(): expression_text(value).encode("utf-8", "surrogatepass") for name, value in given.items()}


def _metadata(given: Any) -> list[bytes]:
    if not isinstance(given, Mapping) or not all(isinstance(part, str) for pair in given.items() for part in pair):
        raise TypeError(f"metadata must be a dict of texts, not {given!r}")
    for key in given:
        if "=" in key:
            raise ValueError(f"metadata: {key!r} has a =")
    return [f"{key}={value}".encode("utf-8", "surrogatepass") for key, value in given.items()]


def _levels(given: Any) -> list[Any]:
    try:
        # of a pair the number is taken for both, and for what was asked for
        four = [(*level, level[1], False) if len(level) == 2 else level for level in given]
        return [(mesh._core, error, measured, bool(proven)) for mesh, error, measured, proven in four]
    except (TypeError, ValueError, AttributeError):
        raise TypeError(f"levels must be a list of (mesh, error) or (mesh, error, measured, proven), not {given!r}") from None


def _include(given: Any) -> list[bytes]:
    folders = [given] if isinstance(given, (str, bytes, os.PathLike)) else given
    return [path_bytes(folder, "include") for folder in folders]


def _level(given: Any) -> Any:
    if not isinstance(given, str):
        return given
    found = re.fullmatch(r"(\d{4})\.(\d{1,2})(?:\.(\d{1,2}))?", given)
    if not found:
        raise ValueError(f"openscad_version must be as '2021.01', not {given!r}")
    year, month, day = (int(part or 0) for part in found.groups())
    return year * 10000 + month * 100 + day


def _text(given: Any) -> Any:
    return given.encode("utf-8", "surrogatepass") if isinstance(given, str) else given


def _color(given: Any) -> Any:
    if not isinstance(given, str):
        return given
    digits = re.fullmatch(r"#([0-9a-fA-F]{6})([0-9a-fA-F]{2})?", given)
    if given not in _COLORS and not digits:
        raise ValueError(f"background must be #rrggbb, #rrggbbaa or one of {', '.join(_COLORS)}, not {given!r}")
    return tuple(bytes.fromhex(digits.group(1) + (digits.group(2) or "ff"))) if digits else _COLORS[given]


def _words(given: Any) -> list[Any]:
    return [given] if isinstance(given, str) else list(given)


def _texts(given: Any) -> list[Any]:
    return [_text(word) for word in _words(given)]


_CONVERT = {"define": defines, "include": _include, "openscad_version": _level, "comment": _text, "metadata": _metadata, "levels": _levels, "background": _color,
            "ignore": _words, "part": _text, "parts": _texts, "parameter_set": _text, "parameter_file": lambda path: path_bytes(path, "parameter_file")}


class Call:
    """The options of one function, by their kinds: those of its context and of `kinds`."""

    def __init__(self, doing: str, options: Options, *kinds: str):
        self.doing = doing
        self.progress = options.get("progress")
        self.echo = options["echo"] if "echo" in options else sys.stdout.write
        self.settings: dict[str, Any] = {}
        self.of: dict[str, dict[str, Any]] = {kind: {} for kind in kinds}
        for name, value in options.items():
            if name not in ("progress", "echo"):
                self._place(name, value, kinds)
        self.run = _core.Run(self.settings, _reporter(self.progress), self.echo)

    def _place(self, name: str, value: Any, kinds: tuple[str, ...]) -> None:
        if value is not None and name in _CONVERT:
            value = _CONVERT[name](value)
        if name in _CONTEXT:
            self.settings[name] = value
            return
        for kind in kinds:
            if name in _core.option_names[kind] and name not in _OWN:
                self.of[kind][name] = value
                return
        known = ["progress", "echo", *_CONTEXT, *(n for kind in kinds for n in _core.option_names[kind])]
        known = [word for word in known if word not in _OWN]
        near = difflib.get_close_matches(name, known, 1)
        raise TypeError(f"{self.doing} has no option '{name}'" + (f": did you mean '{near[0]}'?" if near else ""))

    def settle(self, answer: tuple[str, Any], origin: Optional[_errors.Origin] = None) -> tuple[Any, list[_errors.Diagnostic]]:
        """What a function of _core returned: its result and its findings, or an exception."""
        status, result = answer
        diagnostics = _errors.diagnostics_of(self.run.findings, origin)
        _errors.settle(status, self.doing, diagnostics)
        _finish(self.progress)
        return result, diagnostics


def split(options: Options, *kinds: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Options of these kinds (and of the call), and those of the call with all others."""
    own = {name for kind in kinds for name in _core.option_names[kind]}
    common = _CONTEXT | {"progress", "echo"}
    return ({k: v for k, v in options.items() if k in own or k in common},
            {k: v for k, v in options.items() if k not in own or k in common})


# ---- progress

def _is_bar(progress: Any) -> bool:
    return hasattr(progress, "update") and hasattr(progress, "n")


def _reporter(progress: Any) -> Any:
    """progress(stage, fraction); a bar of tqdm is moved and named."""
    if progress is None or (callable(progress) and not _is_bar(progress)):
        return progress
    if not _is_bar(progress):
        raise TypeError(f"progress must be a function of (stage, fraction) or a bar of tqdm, not {type(progress).__name__}")

    def report(stage: str, fraction: float) -> None:
        progress.set_description(stage, refresh=False)
        progress.n = fraction * (progress.total or 1)
        progress.refresh()
    return report


def _finish(progress: Any) -> None:
    if progress is not None and _is_bar(progress):
        progress.n = progress.total or 1
        progress.refresh()
