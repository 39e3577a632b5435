"""The stubs describe the module, and everything has a docstring whose examples run."""

import ast
import doctest
import importlib
import inspect
import pathlib
import pkgutil

import numpy as np
import pytest

import airlight
from airlight import _native

STUB = ast.parse(pathlib.Path(_native.__file__).with_name("_native.pyi").read_text())


def _parameters(function: ast.FunctionDef):
    """Names of the parameters, with their kinds and defaults, without self or cls."""
    arguments = function.args
    places = [a.arg for a in arguments.posonlyargs + arguments.args]
    defaults = [None] * (len(places) - len(arguments.defaults)) + [ast.unparse(d) for d in arguments.defaults]
    found = [(name, "place", default) for name, default in zip(places, defaults, strict=True)]
    for name, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
        found.append((name.arg, "name", None if default is None else ast.unparse(default)))
    return [item for item in found if item[0] not in ("self", "cls")]


def _signature(function):
    found = []
    for parameter in inspect.signature(function).parameters.values():
        if parameter.name in ("self", "cls"):
            continue
        kind = "name" if parameter.kind is inspect.Parameter.KEYWORD_ONLY else "place"
        default = None if parameter.default is inspect.Parameter.empty else repr(parameter.default).replace("'", '"')
        found.append((parameter.name, kind, default))
    return found


def _plain(parameters):
    return [(name, kind, default if default is None else default.replace("'", '"')) for name, kind, default in parameters]


def _public(names):
    return {name for name in names if not name.startswith("_")}


def _classes():
    return {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}


def test_stubs_list_what_the_module_has():
    functions = {node.name for node in STUB.body if isinstance(node, ast.FunctionDef)}
    assert functions | set(_classes()) == _public(vars(_native))


@pytest.mark.parametrize("name", sorted(_classes()))
def test_stub_of_a_class_matches_it(name):
    stub, cls = _classes()[name], getattr(_native, name)
    members = {node.name: node for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert _public(members) == _public(vars(cls))
    for member, node in members.items():
        decorators = [ast.unparse(d) for d in node.decorator_list]
        if member in ("__reduce__", "__call__"):
            continue
        if member == "__new__":
            assert _signature(cls) == _plain(_parameters(node))
        elif "property" in decorators:
            assert inspect.isdatadescriptor(vars(cls)[member]), member
        else:
            assert isinstance(vars(cls)[member], staticmethod) == ("staticmethod" in decorators), member
            assert _signature(getattr(cls, member)) == _plain(_parameters(node)), member


@pytest.mark.parametrize("name", sorted(n.name for n in STUB.body if isinstance(n, ast.FunctionDef)))
def test_stub_of_a_function_matches_it(name):
    node = next(n for n in STUB.body if isinstance(n, ast.FunctionDef) and n.name == name)
    assert _signature(getattr(_native, name)) == _plain(_parameters(node))


def test_everything_public_has_a_docstring():
    for name in airlight.__all__:
        if name == "__version__":
            continue
        value = getattr(airlight, name)
        assert inspect.getdoc(value), name
        if inspect.isclass(value):
            for member, what in vars(value).items():
                if not member.startswith("_") and member not in getattr(value, "_fields", ()):
                    assert inspect.getdoc(what), f"{name}.{member}"


def _modules():
    # The part of scripts for Blender needs bpy.
    names = [m.name for m in pkgutil.iter_modules(airlight.__path__) if m.name != "_blender_scene"]
    return ["airlight"] + [f"airlight.{name}" for name in names]


@pytest.mark.parametrize("name", _modules())
def test_examples_of_docstrings_run(name):
    module = importlib.import_module(name)
    names = {"airlight": airlight, "np": np}
    names["picture"] = np.zeros((4, 6, 3), np.uint8)
    names["depth"] = np.full((4, 6), 30.0)
    runner = doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE)
    for value in vars(module).values():
        text = inspect.getdoc(value) if getattr(value, "__module__", None) in (name, "airlight") else None
        if text and ">>>" in text:
            test = doctest.DocTestParser().get_doctest(text, dict(names), str(value), None, None)
            runner.run(test)
    assert runner.summarize().failed == 0


def test_package_is_typed():
    assert pathlib.Path(airlight.__file__).with_name("py.typed").exists()
