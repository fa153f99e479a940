# SPDX-License-Identifier: Apache-2.0
"""Signatures that inspect, help() and editors can read, of what is written in C++."""

from __future__ import annotations

import __future__
import inspect
import re
from typing import Any


def _signature_of(function: Any) -> inspect.Signature:
    """The signature of a function of nanobind."""
    text, _, defaults = function.__nb_signature__[0]
    text = re.sub(r"\\(\d+)", lambda number: f"_defaults[{number[1]}]", text)
    annotations = __future__.annotations.compiler_flag  # they stay text
    names: dict[str, Any] = {"_defaults": defaults}
    exec(compile(text + ": pass", "<mercurysim>", "exec", annotations, dont_inherit=True), names)
    return inspect.signature(names[text[len("def ") : text.index("(")]])


def _python_function(function: Any, name: str) -> Any:
    """A function of Python with the signature and the docstring of one of nanobind, which it calls."""

    def made(*arguments: Any, **named: Any) -> Any:
        return function(*arguments, **named)

    made.__name__, made.__qualname__, made.__module__ = name.rpartition(".")[2], name, "mercurysim"
    made.__doc__ = function.__nb_signature__[0][1]
    setattr(made, "__signature__", _signature_of(function))
    return made


class _ClassSignature:
    """The signature of a class, which subclasses do not inherit: they may have an __init__ of their own."""

    def __init__(self, kind: type, signature: inspect.Signature) -> None:
        self.kind, self.signature = kind, signature

    def __get__(self, instance: Any, owner: type) -> inspect.Signature:
        if instance is not None or owner is not self.kind:
            raise AttributeError("__signature__")
        return self.signature


def _is_function(value: Any) -> bool:
    return hasattr(type(value), "__nb_signature__") and len(value.__nb_signature__) == 1


def make_readable(names: dict[str, Any]) -> None:
    """Replaces the functions of nanobind among `names`, and the methods of its classes, by functions of Python."""
    for name, thing in list(names.items()):
        if _is_function(thing):
            names[name] = _python_function(thing, name)
        elif isinstance(thing, type) and thing.__module__ == "mercurysim._mercury":
            for member, value in list(vars(thing).items()):
                if not _is_function(value):
                    continue
                if member == "__init__":
                    parameters = list(_signature_of(value).parameters.values())[1:]
                    setattr(thing, "__signature__", _ClassSignature(thing, inspect.Signature(parameters)))
                elif not member.startswith("_"):
                    setattr(thing, member, _python_function(value, f"{thing.__name__}.{member}"))
