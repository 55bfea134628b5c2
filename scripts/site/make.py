"""Makes the site of documents and interface: make.py FOLDER PYTHONPATH

FOLDER is made anew and has the pages in `html`; PYTHONPATH holds the built package elastogear. Warnings of Doxygen and
Sphinx are errors.
"""
import os
import shutil
import subprocess
import sys
from pathlib import Path

from citations import ROOT
from pages import stage

MATHJAX = Path("/usr/share/javascript/mathjax")
MATHJAX_PARTS = ("MathJax.js", "config/TeX-AMS_CHTML.js", "jax/output/CommonHTML", "jax/element/mml", "fonts/HTML-CSS/TeX/woff", "extensions")


def run(command, **options):
    if subprocess.run(command, **options).returncode != 0:
        sys.exit(f"api: {command[0] if command[0] == 'doxygen' else 'Sphinx'} failed")


def copy_mathjax(folder):
    """What formulas need to be set without a network."""
    for part in MATHJAX_PARTS:
        source, goal = MATHJAX / part, folder / part
        goal.parent.mkdir(parents=True, exist_ok=True)
        shutil.copytree(source, goal) if source.is_dir() else shutil.copy(source, goal)


def make(folder, python_path):
    if folder.exists() and any(folder.iterdir()) and not (folder / "source/index.md").exists():
        sys.exit(f"api: {folder} holds something else; name a new folder")
    shutil.rmtree(folder, ignore_errors=True)
    xml, source, extra = folder / "xml", folder / "source", folder / "extra"
    for path in (xml, source, extra / "docs"):
        path.mkdir(parents=True)
    settings = (ROOT / "scripts/site/Doxyfile").read_text(encoding="utf-8") + f"OUTPUT_DIRECTORY = {folder}\nXML_OUTPUT = xml\n"
    run(["doxygen", "-"], input=settings, text=True, cwd=ROOT)
    stage(source, xml)
    copy_mathjax(extra / "_static/mathjax")
    for picture in ROOT.glob("docs/*.png"):
        shutil.copy(picture, extra / "docs")
    environment = {**os.environ, "PYTHONPATH": python_path, "ELASTOGEAR_EXTRA": str(extra),
                   "PYTHONDONTWRITEBYTECODE": "1", "LC_ALL": "C.UTF-8"}
    run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-j", "auto", "-b", "html", "-c", str(ROOT / "scripts/site"),
         "-d", str(folder / "doctrees"), str(source), str(folder / "html")], env=environment)
    print(f"api: {folder / 'html/index.html'}")


if __name__ == "__main__":
    if len(sys.argv) != 3 or not Path(sys.argv[2], "elastogear").is_dir():
        sys.exit("usage: make.py FOLDER PYTHONPATH, a folder that holds the built package: scripts/build makes build/release/python")
    make(Path(sys.argv[1]).resolve(), os.path.abspath(sys.argv[2]))
