#!/usr/bin/python3
"""Secant mesh stiffness of a spur pair by the rows of faces up its flanks, at minimum-gap points and at stations:

    studies/spur_pair_rows.py --elastogear build/release/src/app/elastogear --mesh build/release/studies/spur_pair_mesh --out spur_pair_rows

Test gears C14 under 400 N m: three teeth of each gear by spur_pair_mesh, as many columns across a tooth as rows up its flanks, bore and
cuts a rigid hub, 10 modes and residual flexibility. The patch is half a millimetre wide.
"""
import argparse
import os

import numpy as np

from drive_runs import results
import figures
from spur_pair_calculix import DRIVE, E, NAMES, NU, Mesh, run

TORQUE = 400  # N m
R_B = 36e-3 * np.cos(np.radians(20))
LAYERS, TEETH, MODES = 2, 3, 10


def reduce(options, folder, rows):
    os.makedirs(folder, exist_ok=True)
    with open(os.path.join(folder, "drive.yaml"), "w", encoding="utf-8") as file:
        file.write(DRIVE)
    run([os.path.abspath(options.mesh), ".", rows, rows, LAYERS, TEETH], folder, "mesh.log")
    for name in NAMES:
        sides = Mesh(os.path.join(folder, name + ".inp")).sides
        flanks = ",".join(sorted(side for side in sides if side.startswith("tooth_") and side.endswith("_left")))
        run([os.path.abspath(options.elastogear), "reduce", "-mesh", name + ".inp", "-material_E", E, "-material_nu", NU, "-material_rho", 7850,
             "-restrain", "hub", "-surface", flanks, "-stress_nodes", "root", "-modes", MODES, "-output", name + ".h5"], folder, f"reduce_{name}.log")


def stiffness(options, folder, roll, points):
    """N/m."""
    name = f"{points}_{roll:g}"
    run([os.path.abspath(options.elastogear), "simulate", "drive.yaml", "-roll", roll, "-torque", TORQUE, "-contact_points", points, "-output",
         name + ".h5"], folder, name + ".log")
    with results.open_file(os.path.join(folder, name + ".h5"), "result") as file:
        turned = file["bodies/pinion/rigid"][-1, 0] - float(file["provenance"].attrs["option_pinion_angle0"])
    return TORQUE / R_B / (turned * R_B)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--mesh", required=True, help="the program spur_pair_mesh")
    parser.add_argument("--out", required=True)
    parser.add_argument("--rows", type=int, nargs="+", default=[4, 8, 16, 32, 64])
    parser.add_argument("--rolls", type=float, nargs="+", default=[0.1, 0.3, 0.7])
    options = parser.parse_args()
    print("| rows | " + " | ".join(f"roll {roll:g}: mesh, H. Hertz, N/um" for roll in options.rolls) + " |")
    coarse = {}
    for rows in options.rows:
        folder = os.path.join(options.out, str(rows))
        reduce(options, folder, rows)
        found = [[stiffness(options, folder, roll, points) / 1e6 for points in ("minima", "stations")] for roll in options.rolls]
        print(f"| {rows} | " + " | ".join(f"{mesh:.1f}, {hertz:.1f}" for mesh, hertz in found) + " |", flush=True)
        coarse[rows] = np.array(found)[:, 0]
    for rows in options.rows[:-1]:
        figures.figure("contact compliance as coarse meshes have it", f"stiffness of C14, {rows} rows",
                       (coarse[rows] / coarse[options.rows[-1]] - 1).max(), unit="%")


if __name__ == "__main__":
    main()
