"""`pip install` into a fresh environment, without a network, of what a build has made: wheel_test.py BUILD REPOSITORY"""
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

BUILD, REPOSITORY = map(Path, sys.argv[1:3])
SHOWN = """
import importlib.metadata, elastogear
print(elastogear.__file__)
print(elastogear.__version__ == importlib.metadata.version("elastogear"))
print("48 tet4" in elastogear.describe({mesh!r}))
"""


def run(*words):
    done = subprocess.run(list(map(str, words)), stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode != 0:
        raise AssertionError(f"{' '.join(map(str, words))}:\n{done.stdout}")
    return done.stdout


class Wheel(unittest.TestCase):
    def test_a_fresh_environment_finds_the_module_its_types_and_its_licence(self):
        with tempfile.TemporaryDirectory() as folder:
            environment = Path(folder, "env")
            run(sys.executable, "-m", "venv", "--system-site-packages", environment)
            run(environment / "bin/pip", "install", "--no-index", "--config-settings", f"build-dir={BUILD}", REPOSITORY)
            said = run(environment / "bin/python3", "-I", "-c", SHOWN.format(mesh=str(REPOSITORY / "meshes/bar.msh"))).split()
            self.assertTrue(said[0].startswith(str(environment)), said)
            self.assertEqual(said[1:], ["True", "True"])
            package = Path(said[0]).parent
            self.assertTrue((package / "_elastogear.pyi").exists() and (package / "py.typed").exists())
            self.assertTrue(list(package.parent.glob("elastogear-*.dist-info/LICENSE")))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
