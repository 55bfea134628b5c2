"""Makes the wheel of `pip install .` by CMake, without network: the hook build_wheel of PEP 517.

The release preset is built, which a build by scripts/build has done already; `--config-settings build-dir=FOLDER` takes what a
build in FOLDER has made, as it is. The wheel needs the shared libraries that scripts/setup installs (PETSc, SLEPc, HDF5, Open MPI).
"""
import base64
import hashlib
import os
import re
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
NAME = "elastogear"


def version():
    return re.search(r"project\(elastogear VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


def run(*words):
    subprocess.run(words, cwd=ROOT, check=True, stdout=sys.stderr)


def build(prefix, tree):
    """Installs the package below `prefix` and returns its folder. tree: of a build that is there; empty: one is made."""
    if not tree:
        run("cmake", "--preset", "release", "--log-level=WARNING", "-DELASTOGEAR_PYTHON_MODULE=ON")
        run("cmake", "--build", "--preset", "release", "--parallel", str(os.cpu_count()), "--target", "_elastogear")
    run("cmake", "--install", tree or "build/release", "--component", "python", "--prefix", prefix)
    found = list(Path(prefix).glob(f"**/{NAME}/__init__.py"))
    if not found:
        raise SystemExit("The Python module was not built: scripts/setup installs pybind11-dev and python3-dev")
    return found[0].parent


def check_interpreter(package):
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    if not (package / f"_elastogear{suffix}").exists():
        built = ", ".join(path.name for path in package.glob("_elastogear*.so"))
        raise SystemExit(f"The module is for Debian's /usr/bin/python3 ({built}), this Python needs {suffix}")


def metadata():
    return (f"Metadata-Version: 2.1\nName: {NAME}\nVersion: {version()}\n"
            "Summary: Stresses in gears under transient load by elastic multibody models\n"
            "License: BSD-3-Clause\nLicense-File: LICENSE\nRequires-Python: >=3.9\nRequires-Dist: numpy\n")


def tags():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"


def write(path, files):
    """files: bytes by their names in the wheel."""
    record = f"{NAME}-{version()}.dist-info/RECORD"
    lines = []
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as wheel:
        for name, content in files.items():
            digest = base64.urlsafe_b64encode(hashlib.sha256(content).digest()).rstrip(b"=").decode()
            lines.append(f"{name},sha256={digest},{len(content)}")
            wheel.writestr(name, content)
        wheel.writestr(record, "\n".join([*lines, f"{record},,"]) + "\n")


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    info = f"{NAME}-{version()}.dist-info"
    with tempfile.TemporaryDirectory() as prefix:
        package = build(prefix, (config_settings or {}).get("build-dir"))
        check_interpreter(package)
        files = {f"{NAME}/{path.name}": path.read_bytes() for path in sorted(package.iterdir()) if path.is_file()}
    files[f"{info}/METADATA"] = metadata().encode()
    files[f"{info}/WHEEL"] = f"Wheel-Version: 1.0\nGenerator: {NAME}\nRoot-Is-Purelib: false\nTag: {tags()}\n".encode()
    files[f"{info}/LICENSE"] = (ROOT / "LICENSE").read_bytes()
    name = f"{NAME}-{version()}-{tags()}.whl"
    write(Path(wheel_directory) / name, files)
    return name
