"""What editors and type checkers are told."""

import ast
from pathlib import Path

import prowl

PACKAGE = Path(prowl.__file__).parent


def test_every_public_name_is_in_the_stub_with_its_type_and_words():
    assert (PACKAGE / "py.typed").exists()
    stub = ast.parse((PACKAGE / "_prowl.pyi").read_text())
    defined = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef | ast.FunctionDef)}
    for name in prowl.__all__:
        thing = getattr(prowl, name)
        assert name == "__version__" or thing.__doc__, f"{name} says nothing"
        if getattr(thing, "__module__", "").endswith("_prowl"):
            assert name in defined, name
    for node in ast.walk(stub):
        if isinstance(node, ast.FunctionDef):
            assert node.returns is not None, node.name
            for argument in node.args.args[1:] + node.args.kwonlyargs:
                assert argument.annotation is not None and ast.unparse(argument.annotation) != "object", (
                    node.name,
                    argument.arg,
                )
    assert "std::" not in (PACKAGE / "_prowl.pyi").read_text(), "a type that Python does not know"
