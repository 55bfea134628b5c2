"""Names that the Python files of the tree take from each other are there: `import views`, then views.axis_of."""
import ast
import os
import subprocess
import sys
import unittest

REPOSITORY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def python_files():
    listed = subprocess.run(["git", "-C", REPOSITORY, "ls-files", "*.py"], capture_output=True, text=True, check=False)
    if listed.returncode == 0:
        return [os.path.join(REPOSITORY, line) for line in listed.stdout.splitlines()]
    return [os.path.join(folder, name) for top in ("scripts", "studies", "tests", "meshes")
            for folder, _, names in os.walk(os.path.join(REPOSITORY, top)) for name in names if name.endswith(".py")]


def defined(tree):
    """All names that a file binds anywhere: more than its module has, but none too few."""
    names = set()
    for node in ast.walk(tree):
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names.add(node.name)
        elif isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store):
            names.add(node.id)
        elif isinstance(node, (ast.Import, ast.ImportFrom)):
            names.update((alias.asname or alias.name).split(".")[0] for alias in node.names)
    return names


def missing(tree, names_of):
    """Names that a file takes from modules of the tree which do not have them. names_of: those of the files of a module's name."""
    modules, found = {}, []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            modules.update({alias.asname or alias.name: alias.name for alias in node.names if alias.name in names_of})
        elif isinstance(node, ast.ImportFrom) and node.module in names_of:
            found += [f"{node.module}.{alias.name}" for alias in node.names if alias.name not in names_of[node.module] | {"*"}]
    for node in ast.walk(tree):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name) and node.value.id in modules:
            if node.attr not in names_of[modules[node.value.id]]:
                found.append(f"{node.value.id}.{node.attr}")
    return found


class Names(unittest.TestCase):
    def test_names_of_other_files_are_there(self):
        trees, names_of = {}, {}
        for path in python_files():
            with open(path, encoding="utf-8") as file:
                trees[path] = ast.parse(file.read())
            names_of.setdefault(os.path.splitext(os.path.basename(path))[0], set()).update(defined(trees[path]))
        self.assertGreater(len(trees), 100)
        self.assertEqual({os.path.relpath(path, REPOSITORY): missing(tree, names_of) for path, tree in trees.items() if missing(tree, names_of)}, {})

    def test_a_name_that_is_not_there_is_found(self):
        names_of = {"views": {"unit"}}
        self.assertEqual(missing(ast.parse("import views\nviews.unit(1)\nviews.axis_of(2)"), names_of), ["views.axis_of"])
        self.assertEqual(missing(ast.parse("from views import unit, axis_of"), names_of), ["views.axis_of"])


if __name__ == "__main__":
    sys.exit(unittest.main())
