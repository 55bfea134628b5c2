#!/usr/bin/python3
"""A steel punch on a block of a steel and a polymer half, reduced with residual flexibility beside the full basis:

    tests/app/creep.py ELASTOGEAR SCRIPTS [FIGURES]

Pressed in and held, and under a force, over ten decades of time; an impact; a run that begins with what the block remembers
of an hour under load. Relative moduli of shear and bulk together and apart, and a block all of polymer. Elements are plain:
incompatible modes relax otherwise in the static responses of the relaxed body (docs/theory.md, section 1.4).
"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
sys.path.append(os.path.abspath(sys.argv[2]))
import results

TAU = (1e-5, 1e-2, 10, 1e4)  # s
SERIES = {"both": ("prony", "0.15,0.15,0.15,0.15"), "apart": ("prony_g", "0.15,0.15,0.15,0.15"), "alike": ("prony", "0.15,0.15,0.15,0.15")}
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
SIDES = ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0))
STEEL = {"E": 210e9, "nu": 0.3, "rho": 7850}
POLYMER = {"E": 3e9, "nu": 0.38, "rho": 1200}


def mesh(path, n, low, high, touching):
    """Hexahedra; cells below and above the middle are HUB and RIM, the face set TOUCH is at z = touching, nodes FAR are opposite."""
    nodes, cells, upper = {}, [], []
    low, high = np.array(low), np.array(high)
    for i, j, k in np.ndindex(*n):
        x = low + (np.array([i, j, k]) + CORNERS) / n * (high - low)
        cells.append([nodes.setdefault(tuple(np.round(p, 9)), len(nodes) + 1) for p in x])
        upper.append(2 * k >= n[2])
    X = np.array(list(nodes))
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {x[0]:.12g}, {x[1]:.12g}, {x[2]:.12g}\n" for i, x in enumerate(X)))
        for name, part in (("HUB", False), ("RIM", True)):
            file.write(f"*ELEMENT, TYPE=C3D8, ELSET={name}\n")
            file.write("".join(f"{c + 1}, " + ", ".join(map(str, cells[c])) + "\n" for c in range(len(cells)) if upper[c] == part))
        sets = {"FAR": abs(X[:, 2] - (low[2] + high[2] - touching)) < 1e-9, "NEAR": abs(X[:, 2] - touching) < 1e-9,
                "INSIDE": abs(X[:, 2] - (low[2] + (high[2] - low[2]) / 4)) < 1e-9}
        for name, chosen in sets.items():
            file.write(f"*NSET, NSET={name}\n" + "".join(f"{i + 1},\n" for i in np.flatnonzero(chosen)))
        file.write("*SURFACE, NAME=TOUCH, TYPE=ELEMENT\n")
        for c, cell in enumerate(cells):
            for s, side in enumerate(SIDES):
                if all(abs(X[cell[a] - 1, 2] - touching) < 1e-9 for a in side):
                    file.write(f"{c + 1}, S{s + 1}\n")


def run(*arguments):
    done = subprocess.run([ELASTOGEAR, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")
    return done.stdout


def material(name, constants, series=None):
    words = [f"-material_{name}_{key}={value}" for key, value in constants.items()]
    if series:
        words += [f"-material_{name}_prony_tau={','.join(map(str, TAU))}", f"-material_{name}_{series[0]}={series[1]}"]
    return [word for pair in words for word in pair.split("=", 1)]


def reduce(kind, basis, modes=20):
    """Files of block and punch."""
    series = SERIES[kind]
    hub = material("HUB", POLYMER, series) if kind == "alike" else material("HUB", STEEL)
    common = ["-element", "plain", "-restrain", "FAR", "-surface", "TOUCH", "-basis", basis, "-modes", modes]
    names = [f"block_{kind}_{basis}_{modes}.h5", f"punch_{basis}_{modes}.h5"]
    if not os.path.exists(names[0]):
        run("reduce", "-mesh", "block.inp", *hub, *material("RIM", POLYMER, series), "-stress_nodes", "NEAR,INSIDE", *common,
            "-output", names[0])
    if not os.path.exists(names[1]):
        run("reduce", "-mesh", "punch.inp", *material("HUB", STEEL), *material("RIM", STEEL), *common, "-output", names[1])
    return names


def simulate(files, output, *more):
    run("simulate", "-bodies", "block,punch", "-block_file", files[0], "-punch_file", files[1], "-block_joint", "fixed",
        "-punch_joint", "prismatic", "-punch_axis", "0,0,-1", "-contact_pairs", "block:punch", "-contact_two_pass", "true",
        "-contact_depth", "1e-3", "-output", output, *more)
    with results.open_file(output, "result") as file:
        contact = file["contact/block:punch"]
        return {"time": file["time"][:], "s": file["bodies/punch/rigid"][:][:, 0],
                "force": np.linalg.norm(contact["force"][:], axis=1), "balance": abs(file["energy/balance"][:]).max(),
                "relaxation": file["energy/relaxation"][-1]}


def stresses(result, name):
    run("recover", "-result", result, "-stress_block", "NEAR,INSIDE", "-output", name)
    with h5py.File(name) as file:
        return {where: file[f"block/{where}/stress"][:] for where in ("NEAR", "INSIDE")}


def off(values, reference):
    return abs(values - reference).max() / abs(reference).max()


def check(what, value, bound):
    print(f"{what}: {value:.2e}")
    if not value < bound:
        sys.exit(f"{what}: {value:.3e}, must be below {bound:.0e}")


LOADS = {"under a force": ["-punch_force", 2000], "held": ["-punch_translation_motion", "speed,4e-6", "-ts_max_time", 1]}


def compare_rest(kind, modes, bounds):
    """Over ten decades: displacement, force and stresses."""
    files = {basis: reduce(kind, basis, modes) for basis in ("full", "modal_residual")}
    for load, words in LOADS.items():
        found, sigma = {}, {}
        for basis, names in files.items():
            output = f"rest_{basis}.h5"
            found[basis] = simulate(names, output, *words, "-analysis", "static", "-static_steps", 2, "-time_under_load", 1e6,
                                    "-contact_stiffness", 1e14)
            sigma[basis] = stresses(output, "stress.h5")
        what = f"{kind}, {modes} modes, {load}"
        assert found["full"]["time"][0] == 0 and found["full"]["time"][-1] == 1e6
        for key in ("s", "force"):
            check(f"{what}: {key}", off(found["modal_residual"][key], found["full"][key]), bounds[0])
        for where in ("NEAR", "INSIDE"):
            check(f"{what}: stress {where}", off(sigma["modal_residual"][where], sigma["full"][where]), bounds[1])
        change = found["full"]["force" if load == "held" else "s"]
        assert not 0.8 < change[-1] / change[0] < 1.2, change


def compare_memory(kind, bound):
    """The block is loaded for an hour, then all but a fortieth of the load is taken off within 0.5 ms: what is left of its print."""
    with open("load.csv", "w", encoding="utf-8") as file:
        file.write("time,force\n0,2000\n1e-4,2000\n6e-4,50\n1,50\n")
    found = {}
    for basis in ("full", "modal_residual"):
        names = reduce(kind, basis)
        simulate(names, "hour.h5", *LOADS["under a force"], "-analysis", "static", "-static_steps", 2, "-time_under_load", 3600,
                 "-contact_stiffness", 1e14)
        more = ["-ts_dt", 5e-6, "-ts_max_time", 1.5e-3, "-ts_alpha_radius", 0.5, "-contact_stiffness", 1e14]
        found[basis] = simulate(names, "after.h5", "-punch_force", "table,load.csv", "-initial_file", "hour.h5", *more)
    full, reduced = found["full"]["s"], found["modal_residual"]["s"]
    check(f"{kind}, motion after an hour under load", off(reduced, full), bound)
    print(f"print: {reduced[0]:.3e} m under load, {reduced[-1]:.3e} m left")
    assert 0.3 * reduced[0] < reduced[-1] < 0.9 * reduced[0]


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        mesh("block.inp", (4, 4, 4), (0, 0, -0.01), (0.02, 0.02, 0), 0)
        mesh("punch.inp", (2, 2, 2), (0.004, 0.006, 0), (0.014, 0.016, 0.01), 0)
        compare_rest("alike", 20, (1e-6, 1e-6))
        compare_rest("both", 20, (5e-3, 4e-2))
        compare_rest("apart", 20, (5e-3, 6e-2))
        compare_memory("both", 1e-2)


main()
