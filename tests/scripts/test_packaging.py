"""The version, and the versions of PETSc and SLEPc that CMake takes, are the same wherever they stand; recipes can be read."""
import ast
import os
import re
import subprocess
import sys
import unittest

import yaml

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")


def read(*names):
    with open(os.path.join(ROOT, *names), encoding="utf-8") as file:
        return file.read()


def found(pattern, *names):
    """What the pattern's group is in a file."""
    match = re.search(pattern, read(*names), re.MULTILINE)
    assert match, f"{os.path.join(*names)} has no {pattern}"
    return match[1]


def conda_recipe():
    """The recipe as YAML, with the words of Jinja in place of their values."""
    lines = [line for line in read("packaging", "conda", "meta.yaml").splitlines() if not line.startswith("{%")]
    return yaml.safe_load(re.sub(r"\{\{ *(.*?) *\}\}", lambda word: word[1].replace('"', ""), "\n".join(lines)))


class Packaging(unittest.TestCase):
    def test_version(self):
        version = found(r"^project\(elastogear VERSION ([\d.]+)", "CMakeLists.txt")
        self.assertEqual(found(r"^version: ([\d.]+)$", "CITATION.cff"), version)
        self.assertEqual(found(r'^\{% set version = "([\d.]+)" %\}$', "packaging", "conda", "meta.yaml"), version)
        self.assertEqual(found(r"^## \[([\d.]+)\] - ", "CHANGELOG.md"), version)

    def test_petsc(self):
        oldest = found(r"petsc>=([\d.]+)", "cmake", "Dependencies.cmake")
        newer = found(r"VERSION_LESS ([\d.]+)\)", "cmake", "Dependencies.cmake")
        newest = f"3.{int(newer.split('.')[1]) - 1}"
        spack = read("packaging", "spack", "packages", "elastogear", "package.py")
        for library in ("petsc", "slepc"):
            self.assertIn(f"{library} >={oldest},<{newer}", conda_recipe()["requirements"]["host"])
            self.assertIn(f'"{library}@{oldest}:{newest}', spack)

    def test_recipes(self):
        recipe = ast.parse(read("packaging", "spack", "packages", "elastogear", "package.py"))
        self.assertEqual([node.name for node in recipe.body if isinstance(node, ast.ClassDef)], ["Elastogear"])
        self.assertEqual(yaml.safe_load(read("packaging", "spack", "repo.yaml"))["repo"]["namespace"], "elastogear")
        self.assertEqual(conda_recipe()["package"], {"name": "elastogear", "version": "version"})

    def test_page_of_a_drive_needs_no_plots(self):
        """The packages on which the .deb depends are enough for the page that `run` makes: neither matplotlib nor VTK."""
        without = "import sys; sys.modules.update(matplotlib=None, vtk=None); import report; print(report.PROGRAM)"
        subprocess.run([sys.executable, "-B", "-c", without], cwd=os.path.join(ROOT, "scripts"), check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    unittest.main()
