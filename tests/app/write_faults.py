#!/usr/bin/python3
"""A write, a rename, a sync or an allocation that fails ends reduce, simulate, a sweep, evaluate and run with an error that says so, without a
signal and without a temporary file; what was there stays as it was or is new and whole, and the same command, given again, makes what it
makes undisturbed.

    write_faults.py PATH/TO/elastogear PATH/TO/libfaults.so
"""
import errno
import glob
import os
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np

program, faults = (os.path.abspath(path) for path in sys.argv[1:])
DRIVE = """
drive: cylindrical
module: 3 mm
face_width: 9 mm
size: tiny
element_order: 1
pinion: {teeth: 12, profile_shift: 0.5}
wheel: {teeth: 13, profile_shift: 0.3}
torque: 20 N m
modes: 0
sweep_positions: 2
analysis: sweep
"""
REDUCE, SWEEP, EVALUATE = ["reduce", "drive.yaml"], ["simulate", "drive.yaml"], ["evaluate", "drive.yaml"]
MODES = ["-modes", "4"]
MOTION = [*SWEEP, *MODES, "-analysis", "dynamic", "-speed", "1000 rpm", "-ts_dt", "1e-6", "-ts_max_time", "1e-5"]
RUN = ["run", "drive.yaml", "-report", "none"]
# verb: the command, what goes before it, outputs
TABLE = {
    "reduce": ([*REDUCE, *MODES], [], ["pinion.h5", "wheel.h5"]),
    "simulate": (MOTION, [[*REDUCE, *MODES]], ["drive_result.h5"]),
    "sweep": (SWEEP, [REDUCE], ["drive_result.h5"]),
    "evaluate": (EVALUATE, [REDUCE, SWEEP], ["drive_evaluation.h5"]),
    "run": (RUN, [], ["pinion.h5", "wheel.h5", "drive_result.h5", "drive_evaluation.h5"]),
}
DISK = (errno.EIO, "nput/output error")
# call: its error, what the message says of it, the first that is struck, and the factor from one to the next. Of allocations those of 64 kB
# and more count, and the first are left out: Open MPI makes them as it starts, and ends by itself.
CALLS = {"write": (*DISK, 1, 2.3), "rename": (*DISK, 1, 2.3), "fsync": (*DISK, 1, 2.3), "alloc": (errno.ENOMEM, "memory", 12, 3)}


def start(command, **environment):
    return subprocess.run([program, *command], capture_output=True, text=True, check=False, env={**os.environ, **environment})


def good(command):
    done = start(command)
    assert done.returncode == 0, f"{command}: {done.stdout[-1000:]}{done.stderr}"


def datasets(path):
    found = {}
    with h5py.File(path) as file:
        file.visititems(lambda name, item: found.update({name: np.asarray(item[()]).tobytes()}) if isinstance(item, h5py.Dataset) else None)
    return {name: value for name, value in found.items() if "time" not in name.split("/")[-1] and not name.startswith("provenance")}


def is_cut(name, said):
    """Is it the result of a run that ended early, and says so?"""
    with h5py.File(name) as file:
        return file.attrs.get("complete") == 0 and re.search(f"The result until t = .* s is in {name}", said)


def strike(verb, call, number, whole, again):
    """Returns whether there was such a call. again: the command is given once more, undisturbed."""
    (command, _, outputs), (error, text, *_) = TABLE[verb], CALLS[call]
    for name in outputs:
        if os.path.exists(name):
            os.remove(name)
    if os.path.exists("struck"):
        os.remove("struck")
    done = start(command, LD_PRELOAD=f"{faults}:{os.environ.get('LD_PRELOAD', '')}", FAULT=str(error),
                 FAULT_AT=str(number), FAULT_CALL=call,
                 FAULT_FILE="." if call == "rename" else os.getcwd(),  # whose names may be relative
                 FAULT_LOG=os.path.join(os.getcwd(), "struck"), ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0")
    if not os.path.exists("struck"):
        return False
    with open("struck", encoding="utf-8") as file:
        what = f"{verb}, {call} number {number}, {file.read().strip()}"
    assert done.returncode >= 0, f"{what}: ends with signal {-done.returncode}: {done.stderr}"
    left = [path for path in glob.glob("**", recursive=True) if ".tmp" in path]
    assert not left, f"{what}: leaves {left}"
    if done.returncode == 0:  # locks are signed where they can be, and some libraries do without memory
        assert what.endswith(".lock") or call == "alloc" and all(map(os.path.exists, outputs)), f"{what}: is not noticed: {done.stderr}"
    else:
        assert "error:" in done.stderr and text in done.stderr, f"{what}: {done.stderr}"
    for name in outputs:
        assert not os.path.exists(name) or datasets(name) == whole[name] or is_cut(name, done.stderr), f"{what}: leaves another {name}"
    if again:
        good(command)
        for name in outputs:
            assert datasets(name) == whole[name], f"{what}: {name} differs afterwards"
    return True


def main():
    with open(faults, "rb") as file:
        library = file.read()
    for verb, (command, before, outputs) in TABLE.items():
        with tempfile.TemporaryDirectory() as folder:
            os.chdir(folder)
            with open("drive.yaml", "w", encoding="utf-8") as file:
                file.write(DRIVE)
            for earlier in before:
                good(earlier)
            good(command)
            whole = {name: datasets(name) for name in outputs}
            counts = []
            for call, (_, _, number, factor) in CALLS.items():
                struck = 0
                while strike(verb, call, number, whole, again=struck % 3 == 1):
                    struck += 1
                    number = int(factor * number)
                counts.append(f"{struck} of {call}")
                assert struck or call == "alloc" and b"FAULT_SIZE" not in library, f"{verb}: has no {call}"
            print(f"{verb}: {', '.join(counts)}", flush=True)
            os.chdir("/")


if __name__ == "__main__":
    main()
