#!/usr/bin/python3
"""The motion of a drive begins loaded: gears without speed stay in the equilibrium of a static analysis, on bearings, too, and gears that
turn begin without the blow of a torque that is put on flanks which do not touch yet.

    loaded_start.py PATH/TO/elastogear
"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
DRIVE = """drive: cylindrical
element_order: 1
module: 3 mm
face_width: 20 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 23, profile_shift: 0.1}
torque: 80 N m
modes: 8
"""


def run(*arguments):
    done = subprocess.run([ELASTOGEAR, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0, f"{arguments}: {done.stdout[-800:]}{done.stderr}"
    return done.stdout


def force(file):
    with h5py.File(file) as result:
        return np.linalg.norm(result["contact/pinion:wheel/force"][:], axis=1)


def check_rest(*options):
    run("simulate", "drive.yaml", *options, "-output", "static.h5")
    said = run("simulate", "drive.yaml", *options, "-analysis", "dynamic", "-ts_max_time", "4e-5", "-output_dt", "2e-6", "-output", "rest.h5")
    assert "the equilibrium under its torque" in said, said
    still, moving = force("static.h5")[-1], force("rest.h5")
    assert abs(moving / still - 1).max() < 1e-3, (options, still, moving)


def check_turning():
    still = force("static.h5")[-1]
    run("simulate", "drive.yaml", "-analysis", "dynamic", "-speed", "1000 rpm", "-moduli", "relaxing", "-ts_max_time", "2e-4", "-output_dt", "1e-6", "-output", "turn.h5")
    moving = force("turn.h5")
    assert abs(moving[0] / still - 1) < 1e-3 and abs(moving / still - 1).max() < 0.2, (still, moving)


def check_others():
    """What says itself how a motion begins is left alone; a torque that is put on in time begins with none."""
    said = run("simulate", "drive.yaml", "-analysis", "dynamic", "-pinion_rotation_motion", "speed,1", "-ts_dt", "1e-6", "-ts_max_time", "2e-6",
               "-output", "led.h5")
    assert "begins with" not in said, said
    said = run("simulate", "drive.yaml", "-analysis", "dynamic", "-pinion_torque", "ramp,80,1e-4", "-ts_dt", "1e-6", "-ts_max_time", "2e-6",
               "-output", "ramp.h5")
    assert force("ramp.h5")[0] == 0, (said, force("ramp.h5"))


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("drive.yaml", "w", encoding="utf-8") as file:
            file.write(DRIVE)
        run("reduce", "drive.yaml")
        check_rest()
        check_turning()
        check_rest("-pinion_bearing_radial", "200 N/um", "-wheel_bearing_radial", "200 N/um")
        check_others()
        os.chdir("/")
    print("motions of drives begin loaded")


if __name__ == "__main__":
    main()
