#!/usr/bin/python3
"""The local approach of flanks, contact_approach hertz, of spur gears in one file:

    tests/app/approach.py ELASTOGEAR EXAMPLES SCRIPTS

Meshes of size tiny are too stiff by more than a quarter beside those of size small; with the approach both have one stiffness within
some 2 %. A run in time that is stopped goes on to the bit. What it cannot be told of is refused.
"""
import os
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

ELASTOGEAR, DRIVE = os.path.abspath(sys.argv[1]), os.path.abspath(os.path.join(sys.argv[2], "drives", "spur_c14.yaml"))
APPROACH = ["-contact_approach", "hertz"]
POSITIONS = 4


def run(*arguments, fails=False):
    done = subprocess.run([ELASTOGEAR, *arguments], capture_output=True, text=True, check=False)
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr


def stiffness(size, approach):
    size = ["-size", size, "-modes", "5"]
    said = run("simulate", DRIVE, *size, "-analysis", "sweep", "-sweep_positions", str(POSITIONS), *approach)
    assert ("approach by H. Hertz" in said) == bool(approach), said
    run("evaluate", DRIVE, *size)
    with h5py.File("spur_c14_evaluation.h5") as file:
        return file["cases/spur_c14_result/pinion:wheel/stiffness/secant"][:].mean()


def check_stiffness():
    found = {}
    for size in ("small", "tiny"):  # bodies of size tiny stay for what follows
        run("reduce", DRIVE, "-size", size, "-modes", "5")
        found[size] = stiffness(size, []), stiffness(size, APPROACH)
    for size, (mesh, hertz) in found.items():
        print(f"{size}: {mesh / 1e6:.1f} N/um, with the approach by H. Hertz {hertz / 1e6:.1f}")
        assert hertz < 0.9 * mesh
    (tiny_mesh, tiny), (small_mesh, small) = found["tiny"], found["small"]
    assert tiny_mesh > 1.08 * small_mesh
    assert abs(tiny / small - 1) < 0.03


def check_resumed():
    moving = [DRIVE, "-size", "tiny", "-modes", "5", "-analysis", "dynamic", "-speed", "10 rad/s", "-ts_dt", "2e-6", "-ts_max_time",
              "4e-5", *APPROACH]
    run("simulate", *moving, "-output", "whole.h5")
    with open("stopped.log", "w", encoding="utf-8") as log, subprocess.Popen(
            [ELASTOGEAR, "simulate", *moving, "-output", "parts.h5", "-checkpoint_every", "0"], stdout=log, stderr=log) as process:
        while process.poll() is None and not os.path.exists("parts.h5.partial/state.h5"):
            time.sleep(1e-3)
        process.terminate()
    run("simulate", *moving, "-output", "parts.h5")
    with h5py.File("whole.h5") as whole, h5py.File("parts.h5") as parts:
        for name in ("contact/pinion:wheel/force", "bodies/wheel/rigid", "energy/elastic", "energy/balance"):
            assert np.array_equal(whole[name][:], parts[name][:]), name
        assert np.abs(whole["contact/pinion:wheel/force"][:]).max() > 0


def check_refused():
    still = [DRIVE, "-size", "tiny", "-modes", "5", *APPROACH]
    assert "needs the law 'unilateral' and the points 'minima'" in run("simulate", *still, "-contact_points", "nodes", fails=True)
    assert "has no residual flexibility" in run("simulate", *still, "-pinion_residual", "false", fails=True)
    assert "contact_approach" in run("simulate", DRIVE, "-contact_approach", "herz", fails=True)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    check_stiffness()
    check_resumed()
    check_refused()
