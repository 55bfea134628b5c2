#!/usr/bin/python3
"""The local approach of flanks by H. Hertz at points of least gap, of spur gears in one file:

    tests/app/approach.py ELASTOGEAR EXAMPLES SCRIPTS

The approach of the mesh (contact_approach mesh) makes size tiny stiffer than size small by more than 8 %; with that by H. Hertz less than
0.4 of this is left (3.8 of 12 % over a pitch, validation 43). A run in time closes its energies with what changes of the approach take, and goes on to the bit where it is
stopped. Where the approach is not known, it is that of the mesh, and refused if asked for.
"""
import os
import subprocess
import sys
import tempfile
import time

import h5py
import numpy as np

ELASTOGEAR, DRIVE = os.path.abspath(sys.argv[1]), os.path.abspath(os.path.join(sys.argv[2], "drives", "spur_c14.yaml"))
MINIMA = ["-contact_points", "minima"]
MESH, HERTZ = [*MINIMA, "-contact_approach", "mesh"], [*MINIMA, "-contact_approach", "hertz"]
POSITIONS = 16  # of a pitch: the mean of few depends on where pairs of teeth come and go


def run(*arguments, fails=False):
    done = subprocess.run([ELASTOGEAR, *arguments], capture_output=True, text=True, check=False)
    assert (done.returncode != 0) == fails, done.stdout + done.stderr
    return done.stdout + done.stderr


def stiffness(size, approach):
    size = ["-size", size, "-element_order", "1", "-modes", "5"]
    said = run("simulate", DRIVE, *size, "-verbose", "-analysis", "sweep", "-sweep_positions", str(POSITIONS), *approach)
    assert ("approach by H. Hertz" in said) == (approach is HERTZ), said
    with h5py.File("spur_c14_result.h5") as file:
        assert file["contact/pinion:wheel"].attrs["approach"] == (b"mesh" if approach is MESH else b"hertz")
    run("evaluate", DRIVE, *size, *approach)
    with h5py.File("spur_c14_evaluation.h5") as file:
        return file["cases/spur_c14_result/pinion:wheel/stiffness/secant"][:].mean()


def check_stiffness():
    found = {}
    for size in ("small", "tiny"):  # bodies of size tiny stay for what follows
        run("reduce", DRIVE, "-size", size, "-element_order", "1", "-modes", "5")
        found[size] = stiffness(size, MESH), stiffness(size, HERTZ)
    for size, (mesh, hertz) in found.items():
        print(f"{size}: {mesh / 1e6:.1f} N/um, with the approach by H. Hertz {hertz / 1e6:.1f}")
        assert hertz < 0.9 * mesh
    (tiny_mesh, tiny), (small_mesh, small) = found["tiny"], found["small"]
    assert tiny_mesh > 1.08 * small_mesh
    assert abs(tiny / small - 1) < 0.4 * (tiny_mesh / small_mesh - 1)


def check_resumed():
    moving = [DRIVE, *HERTZ, "-size", "tiny", "-element_order", "1", "-modes", "5", "-analysis", "dynamic", "-speed", "10 rad/s", "-ts_dt", "2e-6", "-ts_max_time",
              "4e-5"]
    run("simulate", *moving, "-output", "whole.h5")
    with open("stopped.log", "w", encoding="utf-8") as log, subprocess.Popen(
            [ELASTOGEAR, "simulate", *moving, "-output", "parts.h5", "-checkpoint_every", "0"], stdout=log, stderr=log) as process:
        while process.poll() is None and not os.path.exists("parts.h5.partial/state.h5"):
            time.sleep(1e-3)
        process.terminate()
    run("simulate", *moving, "-output", "parts.h5")
    with h5py.File("whole.h5") as whole, h5py.File("parts.h5") as parts:
        for name in ("contact/pinion:wheel/force", "bodies/wheel/rigid", "energy/elastic", "energy/approach", "energy/balance"):
            assert np.array_equal(whole[name][:], parts[name][:]), name
        assert np.abs(whole["contact/pinion:wheel/force"][:]).max() > 0


def check_refused():
    still = [DRIVE, "-size", "tiny", "-element_order", "1", "-modes", "5"]
    for lacks, options in (("needs the law 'unilateral' and the points 'minima'", ["-contact_points", "nodes"]),
                           ("has no residual flexibility", ["-pinion_residual", "false"])):
        said = run("simulate", *still, "-verbose", *options)
        assert "as the mesh has it" in said and lacks in said, said
        assert lacks in run("simulate", *still, *options, "-contact_approach", "hertz", fails=True)
    assert "as the mesh has it" not in run("simulate", *still, "-verbose", *MESH)
    assert "contact_approach" in run("simulate", DRIVE, "-contact_approach", "herz", fails=True)


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    check_stiffness()
    check_resumed()
    check_refused()
