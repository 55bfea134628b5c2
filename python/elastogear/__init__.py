"""Stresses in gears under transient load by elastic multibody models.

    import elastogear as eg

    drive = eg.Drive("drive.yaml")          # or a dict of the same keys
    evaluation = drive.run()                # all at once: what an engineer reads off a pitch
    print(evaluation["root/pinion/largest_tension"], evaluation.error("root/pinion/largest_tension"))   # Pa

    drive.reduce()                          # meshes and reduces all gears
    result = drive.simulate()               # equilibrium or motion
    stress = drive.recover()                # stresses at the roots of the teeth
    print(stress["pinion", "root"].von_mises.max())   # Pa

Numbers are in SI units; options may have a unit, "3 mm". docs/python.md tells more.
"""

import glob as _glob
import importlib as _importlib
import os as _os
import sys as _sys

try:
    for _module in ["numpy", "elastogear._elastogear"]:
        _importlib.import_module(_module)
except ImportError as _error:
    if not _glob.glob(_os.path.join(_os.path.dirname(__file__), "_elastogear.*.so")):
        raise ImportError(f"elastogear's module is not built in {_os.path.dirname(__file__)}: run scripts/build") from None
    raise ImportError(f"elastogear is built for Debian's /usr/bin/python3 with numpy, not for {_sys.executable} "
                      f"(Python {_sys.version.split()[0]}): {_error}") from None

from ._elastogear import (Body, Error, Mesh, State, __version__, describe, git_hash,
                          option_table, read_mesh, von_mises)
from .results import Evaluation, Life, Result, Stress, StressSet
from .runs import Count, Drive, Facts, Quantity, Report, Simulation, System, Warning

__all__ = ["Body", "Count", "Drive", "Error", "Evaluation", "Facts", "Life", "Mesh", "Quantity", "Report", "Result", "Simulation", "State", "Stress", "StressSet",
           "System", "Warning", "__version__", "describe", "git_hash", "option_table", "read_mesh", "von_mises"]
