#!/usr/bin/python3
"""Sweeps of drives with reduced bodies beside the unreduced ones (basis: full) on the same meshes: transmission error and stresses at
the roots over the roll angle, as `evaluate` reads them off.

    studies/sweep_full.py --elastogear build/release/src/app/elastogear --out sweep_full --size tiny examples/drives/*.yaml

Stresses of reduced and of full bodies are compared position by position (the largest of all teeth) and for each tooth; shares are
those of the largest one of the sweep. A folder that holds results keeps them.
"""
import argparse
import os
import shutil
import subprocess
import sys

import h5py
import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import figures


def run(program, folder, *words):
    done = subprocess.run([os.path.abspath(program), *map(str, words)], cwd=folder, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"{folder}: {' '.join(map(str, words))}: {done.stderr[-2000:]}")


def full_files(folder):
    """Options that name the unreduced bodies in place of the reduced ones."""
    bodies = sorted(name[:-3] for name in os.listdir(folder) if name in ("pinion.h5", "wheel.h5", "ring.h5", "worm.h5"))
    return [word for body in bodies for word in (f"-{body}_file", f"{body}_full.h5")]


def make(program, drive, folder, size, positions):
    """Both evaluation files of a drive."""
    os.makedirs(folder, exist_ok=True)
    name = os.path.basename(drive)
    shutil.copy(drive, folder)
    common = ["-size", size]
    paths = [os.path.join(folder, f"{kind}_evaluation.h5") for kind in ("reduced", "full")]
    if not os.path.exists(paths[0]):
        run(program, folder, "reduce", name, *common)
        run(program, folder, "simulate", name, *common, "-analysis", "sweep", "-sweep_positions", positions, "-output", "reduced_result.h5",
            "-contact_points", "minima")
        run(program, folder, "evaluate", name, *common, "-result", "reduced_result.h5", "-output", "reduced_evaluation.h5")
    files = full_files(folder)
    if not os.path.exists(paths[1]):
        if not os.path.exists(os.path.join(folder, "full_result.h5")):
            run(program, folder, "reduce", name, *common, "-basis", "full", *files)
            run(program, folder, "simulate", name, *common, *files, "-analysis", "sweep", "-sweep_positions", positions, "-contact_law",
                "unilateral", "-output", "full_result.h5")
        run(program, folder, "evaluate", name, *common, *files, "-result", "full_result.h5", "-output", "full_evaluation.h5")
    return paths


def only_pair(file):
    (case,) = file["cases"].values()
    (pair,) = [group for name, group in case.items() if ":" in name]
    return pair


def compare(name, paths):
    with h5py.File(paths[0], "r") as a, h5py.File(paths[1], "r") as b:
        reduced, full = only_pair(a), only_pair(b)
        error = [1e6 * pair["transmission_error/loaded"][:] for pair in (reduced, full)]
        off = np.abs(error[0] - error[1])
        print(f"{name}: {off.size} positions; transmission error {error[1].min():.3f} to {error[1].max():.3f} um, off by at most "
              f"{off.max():.5f} um, {100 * (off / np.abs(error[1])).max():.4f} %")
        for gear, group in full["root"].items():
            for kind in ("tension", "von_mises"):
                f, r = group[kind][:], reduced[f"root/{gear}/{kind}"][:]
                at_position = np.abs(r.max(axis=1) / f.max(axis=1) - 1).max()
                print(f"  root of {gear}, {kind}: up to {1e-6 * f.max():.2f} MPa; largest at a position off by at most "
                      f"{100 * at_position:.4f} %, of any tooth by {100 * np.abs(r - f).max() / f.max():.4f} % of the largest")
                figures.figure(f"sweep, {name}", f"largest {kind.replace('_', ' ')}", at_position, unit="%")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drives", nargs="+")
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--size", default="tiny")
    parser.add_argument("--positions", type=int, default=16)
    options = parser.parse_args()
    for drive in options.drives:
        name = os.path.basename(drive).removesuffix(".yaml")
        folder = os.path.join(options.out, f"{name}_{options.size}")
        compare(f"{name}, {options.size}", make(options.elastogear, drive, folder, options.size, options.positions))


if __name__ == "__main__":
    main()
