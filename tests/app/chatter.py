#!/usr/bin/python3
"""Contact of bodies whose modes resolve the cells of their meshes does not chatter, and a run whose contact does says so:

    tests/app/chatter.py ELASTOGEAR SCRIPTS MAKE_MESH

Bars that hit each other end on have the force of a wave, rho c A v / 2, until it comes back from the far ends.
"""
import os
import subprocess
import sys
import tempfile

import numpy as np

ELASTOGEAR, MAKE_MESH = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[3])
sys.path.append(os.path.abspath(sys.argv[2]))
import results

E, NU, RHO, LENGTH, SIDE = 210e9, 0.3, 7850, 0.4, 0.005


def run(*arguments):
    done = subprocess.run([ELASTOGEAR, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")
    return done.stdout


def reduce_bar(cells, modes):
    """Free, its end at the largest x is the contact surface."""
    mesh = subprocess.run([MAKE_MESH, "bar", *map(str, (cells, 1, 1, LENGTH / cells, SIDE, SIDE))], capture_output=True, text=True, check=True)
    with open("bar.inp", "w", encoding="utf-8") as file:
        file.write(mesh.stdout[:mesh.stdout.index("*SURFACE")] + f"*SURFACE, NAME=TIP, TYPE=ELEMENT\n{cells}, S4\n")
    name = f"bar_{cells}_{modes}.h5"
    run("reduce", "-mesh", "bar.inp", "-material_E", E, "-material_nu", NU, "-material_rho", RHO, "-restrain", "none", "-surface", "TIP",
        "-basis", "modal_residual", "-modes", modes, "-output", name)
    return name


def hit(bar, *more):
    return run("simulate", "-bodies", "a,b", "-a_file", bar, "-b_file", bar, "-a_joint", "prismatic", "-b_joint", "prismatic", "-a_axis", "1,0,0",
               "-b_axis", "1,0,0", "-b_position", f"{LENGTH + 1e-8},0,0", "-b_rotation", f"0,0,{np.pi}", "-a_velocity0", 1, "-contact_pairs", "a:b",
               "-ts_max_time", 1.2e-4, "-output", "hit.h5", *more)


def expect_the_force_of_a_wave(cells, modes):
    bar = reduce_bar(cells, modes)
    said = hit(bar)
    with results.open_file("hit.h5", "result") as file:
        time, force = file["time"][:], np.linalg.norm(file["contact/a:b/force"][:], axis=1)
    on = (time > 3e-5) & (time < 1.2e-4)
    wave, mean, spread = np.sqrt(E * RHO) * SIDE**2 / 2, force[on].mean(), force[on].std()
    print(f"{cells} cells, {modes} modes: {mean:.1f} N for {wave:.1f} N, standard deviation {spread:.1f} N")
    if "chatters" in said or abs(mean - wave) > 0.02 * wave or spread > 0.05 * wave:
        sys.exit(f"FAIL: {said}")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    expect_the_force_of_a_wave(60, 300)
    expect_the_force_of_a_wave(40, 200)
print("all good")
