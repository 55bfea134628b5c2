"""What the tests of the Python module share: a drive that is reduced once, and the program beside the module."""
import ctypes
import os
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import warnings

import elastogear as eg

PROGRAM = os.path.abspath(sys.argv[1])
SPUR = {
    "drive": "cylindrical", "element_order": 1, "module": "3 mm", "face_width": "25 mm", "torque": "300 N m", "modes": 4,
    "basis": "modal", "pinion": {"teeth": 17, "profile_shift": 0.3}, "wheel": {"teeth": 43, "profile_shift": 0.1},
}
MOTION = {"ts_dt": 1e-6, "ts_max_time": 4e-5, "contact_surface": "facets", "contact_points": "nodes"}
REST = {"roll": 0.25, "contact_law": "unilateral"}
ENDLESS = {**MOTION, "ts_max_time": 1e3}


def blas_core():
    """The processor that OpenBLAS takes this one for here; empty with another BLAS."""
    try:
        name = ctypes.CDLL("libopenblas.so.0").openblas_get_corename
    except (OSError, AttributeError):
        return ""
    name.restype = ctypes.c_char_p
    return name().decode()


def command(*words):
    """Runs the program with this process's kernels of BLAS, where results are to be equal to the bit."""
    core = blas_core()
    environment = {**os.environ, "OPENBLAS_CORETYPE": core} if core else None
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, env=environment)


def python(script):
    """Runs a script in an interpreter of its own."""
    return subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=600)


def set_up():
    """A drive that is reduced once, in a folder of its own."""
    warnings.simplefilter("ignore", eg.Warning)
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    unittest.addModuleCleanup(os.chdir, "/")
    os.chdir(folder.name)
    WithDrive.drive = eg.Drive(SPUR)
    WithDrive.drive.reduce()


class WithDrive(unittest.TestCase):
    drive: eg.Drive

    def interrupter(self):
        """An event: Ctrl-C comes a little after it is set."""
        under_way = threading.Event()

        def interrupt():
            under_way.wait()
            time.sleep(0.05)
            os.kill(os.getpid(), signal.SIGINT)
        thread = threading.Thread(target=interrupt)
        thread.start()
        self.addCleanup(thread.join)
        self.addCleanup(under_way.set)
        return under_way


def main():
    """Runs the tests of the script that was started with the program's path and unittest's arguments."""
    del sys.argv[1]
    unittest.main(verbosity=2)
