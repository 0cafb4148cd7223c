# SPDX-License-Identifier: MIT
"""Solids as values: a tree of calls of the scene language that prints as its text. Nothing is computed here; what a solid
is, whether its arguments make sense and what is wrong with them, libcsgmesh says."""
from __future__ import annotations

import bisect
import inspect
import os
import sys
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Callable, ClassVar, Optional, TypeVar

if TYPE_CHECKING:
    from ._modules import Solid
    from ._results import Mesh, Scene
    from ._types import Path

_HERE = os.path.dirname(os.path.abspath(__file__))


# ---- expressions

class Expression:
    """A value of the scene language, as its text. Arithmetic with it makes longer ones; so a Python function of one can be
    a formula: `field(lambda p: 1 - functions.norm(p))`."""

    __slots__ = ("text", "blend")
    __array_ufunc__ = None  # arithmetic with numpy's numbers comes here

    def __init__(self, text: str, blend: bool = False):
        if not isinstance(text, str):
            raise TypeError(f"an expression is made of its text, not of {type(text).__name__}")
        self.text = text
        self.blend = blend  # it says how solids join

    def __str__(self) -> str:
        return self.text

    def __repr__(self) -> str:
        return f"Expression({self.text!r})"

    def __getattr__(self, name: str) -> Expression:
        if name.startswith("__"):
            raise AttributeError(name)
        return Expression(f"{self.text}.{name}")

    def __getitem__(self, index: Any) -> Expression:
        return Expression(f"{self.text}[{expression_text(index)}]")

    def __call__(self, *arguments: Any, **named: Any) -> Expression:
        return call_expression(self.text, arguments, named)

    def __neg__(self) -> Expression:
        return Expression(f"(-{self.text})")

    def __bool__(self) -> bool:
        raise TypeError("the value of an expression is known to the scene only: it cannot decide in Python")


def _binary(sign: str, swapped: bool) -> Callable[[Expression, Any], Expression]:
    def operate(self: Expression, other: Any) -> Expression:
        left, right = (other, self) if swapped else (self, other)
        return Expression(f"({expression_text(left)} {sign} {expression_text(right)})")
    return operate


for _name, _sign in {"add": "+", "sub": "-", "mul": "*", "truediv": "/", "mod": "%", "pow": "^"}.items():
    setattr(Expression, f"__{_name}__", _binary(_sign, False))
    setattr(Expression, f"__r{_name}__", _binary(_sign, True))
for _name, _sign in {"lt": "<", "le": "<=", "gt": ">", "ge": ">="}.items():
    setattr(Expression, f"__{_name}__", _binary(_sign, False))


def _number_text(value: float) -> str:
    if value != value:
        return "(0 / 0)"
    if value in (float("inf"), float("-inf")):
        return "(1 / 0)" if value > 0 else "(-1 / 0)"
    return repr(value)


def _string_text(value: str) -> str:
    marks = {'"': '\\"', "\\": "\\\\", "\n": "\\n", "\t": "\\t", "\r": "\\r"}
    return '"' + "".join(marks.get(letter, letter) for letter in value) + '"'


def _function_text(function: Callable[..., Any]) -> str:
    """Its parameters become names, and what it makes of them the body."""
    parameters = inspect.signature(function).parameters
    names = [name for name, p in parameters.items() if p.kind in (p.POSITIONAL_ONLY, p.POSITIONAL_OR_KEYWORD)]
    if len(names) != len(parameters):
        raise TypeError("a function for the scene has plain parameters only")
    return f"function ({', '.join(names)}) {expression_text(function(*map(Expression, names)))}"


def expression_text(value: Any) -> str:
    """A Python value as the scene language writes it."""
    if isinstance(value, Expression):
        return value.text
    if value is None:
        return "undef"
    if isinstance(value, SolidBase):
        raise TypeError("a solid stands where a value is expected")
    if hasattr(value, "tolist"):  # of numpy
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float):
        return _number_text(value)
    if isinstance(value, os.PathLike):
        value = os.fsdecode(value)
    if isinstance(value, str):
        return _string_text(value)
    if isinstance(value, range):
        last = value[-1] if len(value) else value.start
        return f"[{value.start} : {value.step} : {last}]"
    if isinstance(value, Mapping):
        return "object(" + ", ".join(f"{name} = {expression_text(v)}" for name, v in value.items()) + ")"
    if isinstance(value, Sequence):
        return "[" + ", ".join(map(expression_text, value)) + "]"
    if callable(value):
        return _function_text(value)
    raise TypeError(f"the scene language has no value for a {type(value).__name__}: {value!r}")


def call_expression(name: str, arguments: Sequence[Any], named: Mapping[str, Any], blend: bool = False) -> Expression:
    texts = [expression_text(value) for value in arguments]
    texts += [f"{key} = {expression_text(value)}" for key, value in named.items()]
    return Expression(f"{name}({', '.join(texts)})", blend)


def call_function(name: str, arguments: Sequence[Any], named: Mapping[str, Any], fewest: int, most: int, blend: bool) -> Expression:
    """A built-in function, with as many arguments as the language's table says."""
    count = len(arguments) + len(named)
    if not fewest <= count <= most:
        wanted = str(fewest) if fewest == most else f"{fewest} to {most}" if most < 1000000 else f"at least {fewest}"
        raise TypeError(f"{name}() takes {wanted} argument{'' if wanted == '1' else 's'}, not {count}")
    return call_expression(name, arguments, named, blend)


# ---- solids

_Solid = TypeVar("_Solid", bound="SolidBase")

CODE = "code()"  # the name of what is text already
JOINING = ("union", "intersection", "difference")
SPECIAL = {"fn": "$fn", "fa": "$fa", "fs": "$fs"}
MARKS = {"highlight": "#", "background": "%", "only": "!", "off": "*"}


def _made_at() -> tuple[str, int]:
    """The first line outside of this package."""
    frame = sys._getframe(1)
    while frame.f_back and frame.f_code.co_filename.startswith(_HERE + os.sep):
        frame = frame.f_back
    return frame.f_code.co_filename, frame.f_lineno


class SolidBase:
    """A solid or flat figure. `print(solid)` gives its scene; |, & and - join solids; what else can be done to it, the
    methods say, which are the language's modules."""

    __slots__ = ("_name", "_arguments", "_children", "_mark", "_made_at")
    __array_ufunc__: ClassVar[Any] = None

    _name: str
    _arguments: tuple[tuple[Optional[str], str], ...]  # (name, text)
    _children: tuple[SolidBase, ...]
    _mark: str
    _made_at: tuple[str, int]

    @classmethod
    def _make(cls: type[_Solid], name: str, arguments: Sequence[tuple[Optional[str], str]], children: Sequence[SolidBase],
              mark: str = "") -> _Solid:
        self = cls.__new__(cls)
        self._name, self._arguments, self._children, self._mark = name, tuple(arguments), tuple(children), mark
        self._made_at = _made_at()
        return self

    def __init__(self) -> None:
        raise TypeError("solids are made by functions: sphere(1), union(a, b), code('...')")

    @classmethod
    def _call(cls: type[_Solid], name: str, positional: Sequence[tuple[str, Any]], children: Sequence[Any],
              named: Mapping[str, Any], takes: bool, first: Sequence[SolidBase] = ()) -> _Solid:
        """A module with what was given to it. None is not given; of positional arguments, solids are children."""
        solids = [*first, *(value for _, value in positional if isinstance(value, SolidBase)), *children]
        given = [(key, value) for key, value in positional if value is not None and not isinstance(value, SolidBase)]
        given += [(SPECIAL.get(key, key), value) for key, value in named.items() if value is not None]
        for solid in solids:
            if not isinstance(solid, SolidBase):
                raise TypeError(f"{name}() joins and shapes solids, not {type(solid).__name__}: {solid!r:.60}")
        if solids and not takes:
            raise TypeError(f"{name}() takes no solids")
        has_file = any(key == "file" for key, _ in given)
        if takes and not solids and not has_file and name not in (*JOINING, "group", "hull", "minkowski"):
            raise TypeError(f"{name}() needs a solid: {name}(..., solid), or solid.{name}(...)")
        texts: list[tuple[Optional[str], str]] = [(key, expression_text(value)) for key, value in given]
        if len(texts) == 1 and positional and texts[0][0] == positional[0][0]:
            texts = [(None, texts[0][1])]
        return cls._make(name, texts, solids)

    # ---- joining

    def _join(self: _Solid, name: str, other: Any) -> _Solid:
        if not isinstance(other, SolidBase):
            return NotImplemented
        goes_on = self._name == name and not self._arguments and not self._mark
        return self._make(name, (), (*(self._children if goes_on else (self,)), other))

    def __or__(self: _Solid, other: SolidBase) -> _Solid:
        return self._join("union", other)

    def __and__(self: _Solid, other: SolidBase) -> _Solid:
        return self._join("intersection", other)

    def __sub__(self: _Solid, other: SolidBase) -> _Solid:
        return self._join("difference", other)

    def _blended(self: _Solid, blend: Expression, method: str) -> _Solid:
        if self._name not in JOINING or self._mark:
            raise TypeError(f"{method}() says how the solids of a union, intersection or difference join: "
                            f"(a | b).{method}(...); {self._name}() joins none")
        kept = [(key, text) for key, text in self._arguments if key != "blend"]
        return self._make(self._name, [("blend", blend.text), *kept], self._children)

    def mark(self: _Solid, how: str) -> _Solid:
        """Marked as the language does it: "highlight" (#), "background" (%), "only" (!) or "off" (*)."""
        if how not in MARKS:
            raise ValueError(f"how must be one of {', '.join(MARKS)}, not {how!r}")
        return self._make(self._name, self._arguments, self._children, MARKS[how])

    # ---- text

    def _head(self) -> str:
        if self._name == CODE:
            inner = "\n".join("  " + line for line in self._arguments[0][1].split("\n"))
            return f"{self._mark}group() {{\n{inner}\n}}"
        arguments = ", ".join(text if key is None else f"{key} = {text}" for key, text in self._arguments)
        return f"{self._mark}{self._name}({arguments})"

    def _lines(self) -> list[tuple[str, list[tuple[int, SolidBase]]]]:
        """Lines of the text, each with the columns at which solids begin in it. Without recursion: trees may be deep."""
        lines: list[tuple[str, list[tuple[int, SolidBase]]]] = []
        # (solid, indentation, what stands before it on its line), or a closing brace
        waiting: list[tuple[Optional[SolidBase], int, str, list[tuple[int, SolidBase]]]] = [(self, 0, "", [])]
        while waiting:
            solid, depth, before, begun = waiting.pop()
            indent = "  " * depth
            if solid is None:
                lines.append((indent + "}", []))
                continue
            begun = [*begun, (len((before or indent).encode()) + 1, solid)]
            if solid._name == CODE:
                first, *more = solid._head().split("\n")
                lines.append(((before or indent) + first, begun))
                lines += [(indent + line, [(1, solid)]) for line in more]
                continue
            head = (before or indent) + solid._head()
            if not solid._children:
                lines.append((head + ";", begun))
            elif len(solid._children) == 1 and len(head) < 100:
                waiting.append((solid._children[0], depth, head + " ", begun))
            else:
                lines.append((head + " {", begun))
                waiting.append((None, depth, "", []))
                waiting += [(child, depth + 1, "", []) for child in reversed(solid._children)]
        return lines

    def _text(self) -> list[tuple[str, list[tuple[int, SolidBase]]]]:
        """The same, after the libraries that code() uses."""
        lines = self._lines()
        used = {text: None for _, solids in lines for _, solid in solids for key, text in solid._arguments
                if solid._name == CODE and key == "use"}
        return [(f"use <{path}>", []) for path in used] + lines  # type: ignore[misc]

    def __str__(self) -> str:
        return "\n".join(line for line, _ in self._text())

    def __repr__(self) -> str:
        return str(self)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, SolidBase) and (self is other or str(self) == str(other))

    def __hash__(self) -> int:
        return hash(str(self))

    def _origin(self, line: int, column: int) -> Optional[str]:
        """Where in Python the solid was made whose text is there."""
        begun = [(number, at, solid) for number, (_, solids) in enumerate(self._text(), 1) for at, solid in solids]
        found = bisect.bisect_right([(number, at) for number, at, _ in begun], (line, column)) - 1
        if found < 0:
            return None
        path, at_line = begun[found][2]._made_at
        return f"{path}:{at_line}"

    # ---- what is made of it

    def scene(self, **options: Any) -> Scene:
        """It as a scene, of which one may ask more than of its mesh: csgmesh.parse."""
        from . import _results
        return _results.scene_of(self, options)

    def mesh(self, **options: Any) -> Mesh:
        """Its mesh: csgmesh.mesh."""
        from . import _results
        return _results.mesh(self, **options)

    def write(self, path: Path, **options: Any) -> None:
        """Straight into a file: csgmesh.write."""
        from . import _results
        _results.write(self, path, **options)

    def render(self, **options: Any) -> Any:
        """A picture: csgmesh.render."""
        from . import _results
        return _results.render(self, **options)

    def _repr_html_(self) -> str:
        """In Jupyter: to be turned."""
        return self.mesh(quality="draft")._repr_html_()


def code(text: str, use: Sequence[Path] = ()) -> Solid:
    """What a text of the scene language makes, as a solid. use: libraries whose modules it calls, as `use <file>`."""
    from ._modules import Solid as Made
    if not isinstance(text, str):
        raise TypeError(f"code() takes the text of a scene, not {type(text).__name__}")
    libraries = [use] if isinstance(use, (str, os.PathLike)) else use
    return Made._make(CODE, [(None, text.strip("\n")), *(("use", os.fspath(path)) for path in libraries)], ())
