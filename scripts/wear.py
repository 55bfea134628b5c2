#!/usr/bin/python3
"""Pictures of a wear file: worn depth of the flanks of each gear over diameter and face width, and depth and mass over the
revolutions. Run: scripts/wear.py drive_wear.h5 --out FOLDER"""
import argparse
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import results
from plots import COLOURS, save


def bodies(file):
    return sorted(set(file) - {"revolutions", "provenance"})


def worn_sides(group):
    return [side for side in ("left", "right") if group[side][:].max() > 0]


def plot_flanks(file, folder):
    for body in bodies(file):
        group = file[body]
        for side in worn_sides(group):
            figure, axes = plt.subplots(figsize=(6, 4.5))
            depth = 1e6 * group[side][:]
            picture = axes.pcolormesh(1e3 * group["z"][:], 1e3 * group["diameter"][:], depth, shading="nearest", vmin=0)
            plt.colorbar(picture, ax=axes, label="worn depth in µm")
            axes.set_xlabel("z in mm")
            axes.set_ylabel("diameter in mm")
            axes.set_title(f"{body}, {side} flanks")
            save(figure, folder, f"wear_{body}_{side}")


def plot_course(file, folder):
    figure, (depth, mass) = plt.subplots(1, 2, figsize=(10, 4))
    for body, colour in zip(bodies(file), COLOURS):
        depth.plot(file["revolutions"][:], 1e6 * file[body]["largest_depth"][:], color=colour, marker="o", markersize=3, label=body)
        mass.plot(file["revolutions"][:], 1e6 * file[body]["mass"][:], color=colour, marker="o", markersize=3, label=body)
    for axes, label in ((depth, "largest depth in µm"), (mass, "worn mass in mg")):
        axes.set_xlabel("revolutions of the first gear")
        axes.set_ylabel(label)
        axes.legend()
    save(figure, folder, "wear_course")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("wear")
    parser.add_argument("--out", default=".")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    with results.open_file(options.wear, "wear") as file:
        plot_flanks(file, options.out)
        plot_course(file, options.out)


if __name__ == "__main__":
    main()
