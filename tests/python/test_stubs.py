"""What type checkers are told of the extension module is what it has, and all that is public is documented."""

import ast
import inspect
import pathlib
import unittest

import kds
from kds import _kds


def public(names):
    return {name for name in names if not name.startswith("_")}


class Stubs(unittest.TestCase):
    def test_the_stub_has_what_the_module_has(self):
        stub = pathlib.Path(_kds.__file__).with_name("_kds.pyi")
        classes, names = {}, set()
        for node in ast.parse(stub.read_text()).body:
            if isinstance(node, ast.ClassDef):
                members = {member.name for member in node.body if isinstance(member, ast.FunctionDef)}
                for base in node.bases:
                    members |= classes[base.id]
                classes[node.name] = members
            elif isinstance(node, ast.FunctionDef):
                names.add(node.name)
            elif isinstance(node, ast.AnnAssign):
                names.add(node.target.id)
        self.assertEqual(names | public(classes), public(vars(_kds)))
        for name in public(classes):
            members = classes[name]
            self.assertEqual(public(members), public(vars(getattr(_kds, name))), name)

    def test_the_kinds_of_events_are_those_of_the_library(self):
        of_walls = {"REST_AT_WALL": "rest", "WAKE_AT_WALL": "wake"}  # which files name as those of bodies
        self.assertEqual([of_walls.get(kind.name, kind.name.lower()) for kind in kds.EventKind], list(_kds.event_kinds))

    def test_all_that_is_public_is_documented(self):
        for name in kds.__all__:
            value = getattr(kds, name)
            if not (inspect.isclass(value) or inspect.isfunction(value)):
                continue
            self.assertTrue(value.__doc__, name)
            for member, function in inspect.getmembers(value):
                if inspect.isfunction(function) and not member.startswith("_"):
                    self.assertTrue(function.__doc__, f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
