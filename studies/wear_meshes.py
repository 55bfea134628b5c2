#!/usr/bin/python3
"""Worn depth of the test gears C14 on meshes of several finenesses, after one sweep, beside the closed form k F' v_s / v_r:

    studies/wear_meshes.py --elastogear build/release/src/app/elastogear --mesh build/release/studies/spur_pair_mesh --out wear_meshes

The meshes are those of spur_pair_calculix.py: some teeth of each gear, with --flanks rows of faces up a flank. Where one pair is loaded,
the force per width is that of the torque, F' = T / (r_b b), and the depth is known: v_s is the sliding speed and v_r the speed of the
contact along the flank, both of the rigid involutes. Its mean over a cell is that of the ends and the middle, by Simpson's rule.
"""
import argparse
import os

import numpy as np

from drive_runs import results
from spur_pair_calculix import NAMES, prepare, run

MODULE, TEETH, WIDTH, DISTANCE, K, TURNS, CELLS = 4.5e-3, (16, 24), 14e-3, 91.5e-3, 1e-18, 1e6, 24
ALPHA = np.radians(20)
R_B = [MODULE * z / 2 * np.cos(ALPHA) for z in TEETH]
LINE = np.sqrt(DISTANCE**2 - sum(R_B)**2)  # m, between the points where the line of action touches the base circles


def closed_form(gear, u, torque):
    """Depth where one pair is loaded, m, at lengths of roll u, after all revolutions of the first gear."""
    omega = (1, TEETH[0] / TEETH[1])  # per rad of the first gear; speeds of the contact along flanks are u omega
    own, mate = u * omega[gear], (LINE - u) * omega[1 - gear]
    return K * TURNS * omega[gear] * torque / R_B[0] / WIDTH * np.abs(own - mate) / own


def mean_over_cells(gear, u, torque):
    """The same, by area: an involute has du u / r_b between lengths of roll."""
    h = (u[1] - u[0]) / 2
    weights = [(1, u - h), (4, u), (1, u + h)]
    return sum(w * closed_form(gear, x, torque) * x for w, x in weights) / sum(w * x for w, x in weights)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--mesh", required=True, help="the program spur_pair_mesh")
    parser.add_argument("--out", required=True)
    parser.add_argument("--flanks", type=int, nargs="+", default=[24, 48], help="rows of faces up a flank")
    parser.add_argument("--torque", type=float, default=200, help="N m on the pinion")
    parser.add_argument("--positions", type=int, default=32)
    options = parser.parse_args()
    options.tooth, options.layers, options.teeth = 8, 2, 3
    before = {}
    for options.flank in options.flanks:
        folder = os.path.join(options.out, f"{options.flank}_{options.tooth}_{options.layers}")
        os.makedirs(folder, exist_ok=True)
        prepare(options, folder)
        run([os.path.abspath(options.elastogear), "wear", "drive.yaml", "-torque", options.torque, "-sweep_positions", options.positions,
             "-coefficient", K, "-revolutions", TURNS, "-increment", 1, "-cells_along", CELLS, "-cells_across", 2, "-output", "wear.h5",
             "-contact_points", "minima"],
            folder, "wear.log")
        with results.open_file(os.path.join(folder, "wear.h5"), "wear") as file:
            for i, gear in enumerate(NAMES):
                depth, u = file[gear]["left"][:].mean(axis=1), file[gear]["roll"][:]
                known, before[gear] = before.get(gear, depth), depth
                difference = np.abs(depth - known)
                print(f"{options.flank} rows, {gear}: mass {1e6 * file[gear]['mass'][-1]:.4f} mg, largest depth {1e6 * depth.max():.4f} um; from the "
                      f"mesh before at most {100 * difference.max() / known.max():.2f} % of its largest, {100 * difference.sum() / known.sum():.2f} % "
                      "in the mean; cell by cell: " + " ".join(f"{1e6 * d:.4f}" for d in depth) + "; over the closed form "
                      + " ".join(f"{d:.3f}" for d in depth / mean_over_cells(i, u, options.torque)), flush=True)


if __name__ == "__main__":
    main()
