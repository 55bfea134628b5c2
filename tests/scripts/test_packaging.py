"""The version, and the versions of PETSc and SLEPc that CMake takes, are the same wherever they stand; recipes can be read;
CMake takes the right MUMPS, and scripts/format the right clang-format."""
import ast
import os
import re
import subprocess
import sys
import tempfile
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


# What pkg-config knows, and the libraries, of a system that has PETSc with 64-bit indices alone, as Debian names them.
PKG_CONFIG = """Name: {name}
Description: none
Version: 3.22.5
Libs: -lc
Libs.private: -lzmumps_64 -ldmumps_64 -lmumps_common_64
"""
PROJECT = """cmake_minimum_required(VERSION 3.25)
project(user LANGUAGES C CXX)
include({dependencies})
message(STATUS "links ${{DMUMPS_LIBRARY}} of ${{PETSC_MODULE_NAME}}, ${{SLEPC_MODULE_NAME}}")
"""


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

    def test_64_bit_indices(self):
        """PETSc's own MUMPS is linked: dmumps_64, beside which dmumps may be there, too."""
        with tempfile.TemporaryDirectory() as folder:
            for name in ("petsc64", "slepc64"):
                with open(os.path.join(folder, name + ".pc"), "w", encoding="utf-8") as file:
                    file.write(PKG_CONFIG.format(name=name))
            for name in ("dmumps", "dmumps_64"):
                open(os.path.join(folder, f"lib{name}.so"), "wb").close()
            with open(os.path.join(folder, "CMakeLists.txt"), "w", encoding="utf-8") as file:
                file.write(PROJECT.format(dependencies=os.path.join(ROOT, "cmake", "Dependencies.cmake")))
            run = subprocess.run(["cmake", "-S", folder, "-B", os.path.join(folder, "build"), f"-DCMAKE_LIBRARY_PATH={folder}"],
                                 env={**os.environ, "PKG_CONFIG_LIBDIR": folder, "PKG_CONFIG_PATH": ""},
                                 capture_output=True, text=True, check=False)
            self.assertIn(f"links {folder}/libdmumps_64.so of petsc64, slepc64", run.stdout, run.stdout + run.stderr)

    def test_recipes(self):
        recipe = ast.parse(read("packaging", "spack", "packages", "elastogear", "package.py"))
        self.assertEqual([node.name for node in recipe.body if isinstance(node, ast.ClassDef)], ["Elastogear"])
        self.assertEqual(yaml.safe_load(read("packaging", "spack", "repo.yaml"))["repo"]["namespace"], "elastogear")
        self.assertEqual(conda_recipe()["package"], {"name": "elastogear", "version": "version"})

    def test_format_refuses_another_version(self):
        """Debian 13's clang-format would lay out 73 lines otherwise."""
        with tempfile.TemporaryDirectory() as folder:
            program = os.path.join(folder, "clang-format")
            with open(program, "w", encoding="utf-8") as file:
                file.write("#!/bin/sh\necho Debian clang-format version 19.1.7 '(3+b1)'\n")
            os.chmod(program, 0o755)
            run = subprocess.run([os.path.join(ROOT, "scripts", "format"), "--check"], env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"},
                                 capture_output=True, text=True, check=False)
        self.assertEqual(run.returncode, 1)
        self.assertIn("version 19, must be 14", run.stderr)

    def test_page_of_a_drive_needs_no_plots(self):
        """The packages on which the .deb depends are enough for the page that `run` makes: neither matplotlib nor VTK."""
        without = "import sys; sys.modules.update(matplotlib=None, vtk=None); import report; print(report.PROGRAM)"
        subprocess.run([sys.executable, "-B", "-c", without], cwd=os.path.join(ROOT, "scripts"), check=True, stdout=subprocess.DEVNULL)


if __name__ == "__main__":
    unittest.main()
