#!/usr/bin/python3
"""Patch test of contact integrated over faces between meshes of first and second order that do not match:

    tests/app/patch.py ELASTOGEAR SCRIPTS

Two blocks of 1 m, one displaced by PRESSED into the other, free to widen: one pressure and one displacement all over the
interface. In the full basis with a penalty, and with residual flexibility without one.
"""
import os
import subprocess
import sys
import tempfile

import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
sys.path.append(os.path.abspath(sys.argv[2]))
import results
from figures import figure

E, NU, PRESSED, STIFFNESS = 2e11, 0.3, 1e-4, 1.6e13  # Pa, -, m, Pa/m
UNILATERAL = 1e-4  # of the compliance of the penalty, that contact without one keeps
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
HEX_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
TETS = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
TET_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
CELLS = {"C3D8": ((range(8),), ()), "C3D20": ((range(8),), HEX_EDGES), "C3D4": (TETS, ()), "C3D10": (TETS, TET_EDGES)}
# Sides of a cell by its corners, in the numbering of Abaqus.
SIDES = {8: ((0, 1, 2, 3), (4, 7, 6, 5), (0, 4, 5, 1), (1, 5, 6, 2), (2, 6, 7, 3), (3, 7, 4, 0)),
         4: ((0, 1, 2), (0, 3, 1), (1, 3, 2), (2, 3, 0))}


def mesh(path, kind, n, low, high, touching):
    """n x n x 2 cells between z = low and high; the surface TOUCH at z = touching."""
    parts, edges = CELLS[kind]
    nodes, cells = {}, []
    number = lambda x: nodes.setdefault(tuple(np.round(x, 9)), len(nodes) + 1)
    for i, j, k in np.ndindex(n, n, 2):
        corners = (np.array([i, j, k]) + CORNERS) / [n, n, 2]
        corners[:, 2] = low + (high - low) * corners[:, 2]
        for part in parts:
            x = corners[list(part)]
            cells.append([number(p) for p in x] + [number((x[a] + x[b]) / 2) for a, b in edges])
    X = np.array(list(nodes))
    with open(path, "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {x[0]:.12g}, {x[1]:.12g}, {x[2]:.12g}\n" for i, x in enumerate(X)))
        file.write(f"*ELEMENT, TYPE={kind}, ELSET=ALL\n" + "".join(f"{i + 1}, " + ", ".join(map(str, c)) + "\n" for i, c in enumerate(cells)))
        far = low + high - touching
        for name, axis, at in (("FAR", 2, far), ("X0", 0, 0), ("Y0", 1, 0)):
            file.write(f"*NSET, NSET={name}\n" + "".join(f"{i + 1},\n" for i in np.flatnonzero(abs(X[:, axis] - at) < 1e-9)))
        n_corners = 8 if len(parts) == 1 else 4
        file.write("*SURFACE, NAME=TOUCH, TYPE=ELEMENT\n")
        for c, cell in enumerate(cells):
            for s, side in enumerate(SIDES[n_corners]):
                if all(abs(X[cell[a] - 1, 2] - touching) < 1e-9 for a in side):
                    file.write(f"{c + 1}, S{s + 1}\n")


def run(*arguments):
    done = subprocess.run([ELASTOGEAR, *arguments], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(" ".join(arguments) + "\n" + done.stdout + done.stderr)


def largest_error(folder, upper, lower, basis):
    """Of the pressures, relative."""
    paths = []
    for name, (kind, n), low, high in (("upper", upper, 0, 1), ("lower", lower, -1, 0)):
        path = os.path.join(folder, f"{name}_{kind}_{n}_{basis}")
        paths.append(path + ".h5")
        mesh(path + ".inp", kind, n, low, high, 0)
        run("reduce", "-mesh", path + ".inp", "-material_E", str(E), "-material_nu", str(NU), "-material_rho", "8000",
            "-restrain", "FAR:z,X0:x,Y0:y", "-surface", "TOUCH", "-basis", basis, "-modes", "10", "-output", path + ".h5")
    unilateral = basis != "full"
    result = os.path.join(folder, "pressed.h5")
    run("simulate", "-bodies", "upper,lower", "-upper_file", paths[0], "-lower_file", paths[1], "-upper_joint", "fixed",
        "-lower_joint", "fixed", "-upper_position", f"0,0,{-PRESSED}", "-contact_pairs", "upper:lower", "-contact_points", "faces",
        "-contact_law", "unilateral" if unilateral else "penalty", "-contact_stiffness", str(STIFFNESS), "-analysis", "static",
        "-contact_two_pass", "false", "-output", result)
    pressure = PRESSED / (2 / E + (UNILATERAL if unilateral else 1) / STIFFNESS)
    with results.open_file(result, "result") as file:
        points = file["contact/upper:lower/points"]
        last = slice(*points["offset"][-2:])
        return abs(points["pressure"][last] / pressure - 1).max()


def main():
    bounds = {"full": 1e-10, "modal_residual": 2e-6}  # static responses are in single precision
    quantities = {"full": "pressure", "modal_residual": "pressure with residual flexibility"}
    with tempfile.TemporaryDirectory() as folder:
        for upper, lower in ((("C3D20", 3), ("C3D20", 2)), (("C3D10", 2), ("C3D10", 3)), (("C3D20", 2), ("C3D8", 3)),
                             (("C3D4", 3), ("C3D20", 2)), (("C3D10", 3), ("C3D20", 2)), (("C3D8", 3), ("C3D10", 2))):
            for basis, bound in bounds.items():
                error = largest_error(folder, upper, lower, basis)
                print(f"{upper[0]:5s} {upper[1]} on {lower[0]:5s} {lower[1]}, {basis}: largest error of the pressure {error:.1e}")
                figure("patch test of second order", quantities[basis], error, bound)


main()
