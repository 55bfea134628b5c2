#!/usr/bin/python3
"""Pictures of a life file: damage along the roots of one tooth, the stress of the most damaged node over a revolution, and its
cycles in Haigh's plane. Run: scripts/life.py drive_life.h5 --out FOLDER"""
import argparse
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import LogNorm

import results
from plots import COLOURS, save

MPA = 1e-6
NO_DAMAGE = 1e-12  # of the largest: is drawn as this


def of_tooth(group):
    """Place along the root (mm, at the mean radius, from the tooth's middle), height over the face (mm) and damage of the nodes of
    the most damaged tooth."""
    damage, X = group["damage"][:], group["X"][:]
    tooth = group["tooth"][int(damage.argmax())]
    chosen = group["tooth"][:] == tooth
    angle = np.unwrap(np.arctan2(X[chosen, 1], X[chosen, 0]), period=2 * np.pi)
    angle = (angle - angle[0] + np.pi) % (2 * np.pi) - np.pi
    radius = np.hypot(X[chosen, 0], X[chosen, 1])
    return 1e3 * radius.mean() * (angle - angle.mean()), 1e3 * X[chosen, 2], damage[chosen], tooth


def plot_damage(axes, group):
    along, z, damage, tooth = of_tooth(group)
    if damage.max() == 0:
        axes.set_title("no damage")
        return
    shown = np.maximum(damage, NO_DAMAGE * damage.max())
    points = axes.scatter(along, z, c=shown, s=24, norm=LogNorm(vmax=damage.max(), vmin=max(shown.min(), 1e-6 * damage.max())))
    plt.colorbar(points, ax=axes, label="damage in a duty cycle")
    axes.set_xlabel(f"along the root of tooth {tooth} in mm")
    axes.set_ylabel("z in mm")


def plot_history(axes, group, torque):
    roll = group["critical/roll"][:]
    for stress, T, colour in zip(group["critical/history"][:], torque, COLOURS):
        axes.plot(roll, MPA * stress, color=colour, label=f"{T:.4g} N m")
    axes.set_xlabel("roll angle in pitches")
    axes.set_ylabel("largest principal stress, signed, in MPa")
    axes.legend()


def plot_cycles(axes, group, torque):
    cycles = group["critical/cycles"]
    block, largest = cycles["block"][:], max(cycles["damage"][:].max(initial=0), 1e-300)
    for b, (T, colour) in enumerate(zip(torque, COLOURS)):
        size = 10 + 200 * np.sqrt(cycles["damage"][:][block == b] / largest)
        axes.scatter(MPA * cycles["mean"][:][block == b], MPA * cycles["range"][:][block == b] / 2, s=size, color=colour, alpha=0.6,
                     label=f"{T:.4g} N m")
    axes.set_xlabel("mean stress in MPa")
    axes.set_ylabel("amplitude in MPa; area: damage")
    axes.legend()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("life")
    parser.add_argument("--out", default=".")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    with results.open_file(options.life, "life") as file:
        torque = file["duty_cycle/torque"][:]
        for body in sorted(set(file) - {"duty_cycle", "provenance"}):
            for name, group in file[body].items():
                figure, axes = plt.subplots(1, 3, figsize=(15, 4.5))
                plot_damage(axes[0], group)
                plot_history(axes[1], group, torque)
                plot_cycles(axes[2], group, torque)
                save(figure, options.out, f"life_{body}_{name}")


if __name__ == "__main__":
    main()
