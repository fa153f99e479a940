# SPDX-License-Identifier: Apache-2.0
"""Signatures that inspect, help() and editors can read, of what is written in C++."""

from __future__ import annotations

import __future__
import ast
import inspect
import re
import types
from typing import Any


def _python_function(function: Any) -> types.FunctionType:
    """A function of Python with the signature and the docstring of one of nanobind, which it calls."""
    text, doc, defaults = function.__nb_signature__[0]
    names = [f"_default_{i}" for i in range(len(defaults or ()))]
    text = re.sub(r"\\(\d+)", lambda number: f"_default_{number[1]}", text)
    tree = ast.parse(text + ": pass")
    (head,) = tree.body
    assert isinstance(head, ast.FunctionDef)
    call = ast.parse("_call()", mode="eval").body
    assert isinstance(call, ast.Call)
    place = head.args
    call.args = [ast.Name(each.arg, ast.Load()) for each in place.posonlyargs + place.args]
    call.keywords = [ast.keyword(each.arg, ast.Name(each.arg, ast.Load())) for each in place.kwonlyargs]
    if place.vararg:
        call.args.append(ast.Starred(ast.Name(place.vararg.arg, ast.Load()), ast.Load()))
    if place.kwarg:
        call.keywords.append(ast.keyword(None, ast.Name(place.kwarg.arg, ast.Load())))
    head.body = [ast.Return(call)]
    annotations = __future__.annotations.compiler_flag  # they stay text
    code = compile(ast.fix_missing_locations(tree), "<mercurysim>", "exec", annotations, dont_inherit=True)
    names_of_code: dict[str, Any] = {"_call": function, **dict(zip(names, defaults or ()))}
    exec(code, names_of_code)
    made: types.FunctionType = names_of_code[head.name]
    made.__doc__, made.__module__ = doc, "mercurysim"
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
            names[name] = _python_function(thing)
        elif isinstance(thing, type) and thing.__module__ == "mercurysim._mercury":
            for member, value in list(vars(thing).items()):
                if not _is_function(value):
                    continue
                if member == "__init__":
                    parameters = list(inspect.signature(_python_function(value)).parameters.values())[1:]
                    setattr(thing, "__signature__", _ClassSignature(thing, inspect.Signature(parameters)))
                elif not member.startswith("_"):
                    made = _python_function(value)
                    made.__qualname__ = f"{thing.__name__}.{member}"
                    setattr(thing, member, made)
