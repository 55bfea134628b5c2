#!/usr/bin/python3
"""Variants of misalignment and relief of a spur drive (the one of tests/app/micro_geometry.py), swept over 16 roll
angles on the exact mesh with deviations of the contact, against meshes that were made with the deviations.

  studies/sweep_variants.py PATH/TO/elastogear [NUMBER]

Needs a build, numpy and h5py; takes some seconds a variant."""

import os
import random
import sys
import tempfile

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "../tests/app"))
from micro_geometry import DRIVE, R_B, TEETH, UM, WIDTH, Drive, move_flanks, tip_relief  # noqa: E402

SWEEP = ("-analysis", "sweep", "-sweep_positions", "16", "-contact_points", "minima")


def transmission_error(path):
    """Of the pinion along the line of action, m."""
    with h5py.File(path) as file:
        return (file["bodies/pinion/rigid"][:, 0] - 2 * np.pi * file["time"][:] / TEETH[0] + np.pi / 2) * R_B[0]


def root_stress(drive, path, *files):
    """Largest von Mises stress at the roots of both gears at each position, Pa."""
    drive.run("recover", "drive.yaml", "-result", path, "-output", "stress.h5", *files)
    with h5py.File("stress.h5") as file:
        return np.array([file[f"{gear}/root/von_mises"][:].max(axis=1) for gear in ("pinion", "wheel")])


def check(drive, number, relief, crowning, skew):
    def removed(roll, z):
        return tip_relief(0, relief * UM)(roll) + crowning * UM * (2 * z / WIDTH)**2

    move_flanks("pinion.inp", "moved.inp", 0, removed)
    drive.run("reduce", "-mesh", "moved.inp", "-output", "moved.h5", "-surface", "flanks", "-stress_nodes", "root", "-restrain",
              "bore", "-modes", "10", "-material_E", "210e9", "-material_nu", "0.3", "-material_rho", "7850")
    keys = ("-pinion_tip_relief", f"{relief} um", "-pinion_lead_crowning", f"{crowning} um", "-wheel_skew", f"{skew} deg")
    moved = ("-pinion_file", "moved.h5")
    drive.run("simulate", "drive.yaml", *SWEEP, *keys, "-output", "exact_swept.h5")
    drive.run("simulate", "drive.yaml", *SWEEP, *keys, *moved, "-output", "moved_swept.h5")
    a, b = transmission_error("exact_swept.h5"), transmission_error("moved_swept.h5")
    stress = [root_stress(drive, "exact_swept.h5"), root_stress(drive, "moved_swept.h5", *moved)]
    off = [np.abs(a / b - 1).max(), np.abs(stress[0] / stress[1] - 1).max(axis=1)]
    print(f"{number:3}  relief {relief} um, crowning {crowning} um, skew {skew} deg: transmission error off by "
          f"{100 * off[0]:.2f} %, {np.abs(a - b).max() / UM:.3f} um of {b.max() / UM:.1f} um; root stress by "
          f"{100 * off[1][0]:.2f} %, {100 * off[1][1]:.2f} %", flush=True)
    return [off[0], *off[1]]


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 20
    random.seed(1)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("drive.yaml", "w") as text:
            text.write(DRIVE)
        d = Drive(program)
        d.run("reduce", "drive.yaml")
        d.run("mesh", "drive.yaml", "-pinion_mesh_output", "pinion.inp")
        worst = np.max([check(d, i + 1, round(random.uniform(2, 30), 1), round(random.uniform(0, 15), 1),
                              round(random.uniform(-0.03, 0.03), 4)) for i in range(count)], axis=0)
        print(f"largest: transmission error {100 * worst[0]:.2f} %, root stress {100 * worst[1]:.2f} % and "
              f"{100 * worst[2]:.2f} %")
