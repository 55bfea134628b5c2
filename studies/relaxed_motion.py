#!/usr/bin/python3
"""A block of steel and polymer in motion, reduced beside the full basis: ramps, rolling and impact.

    studies/relaxed_motion.py build/release/src/app/elastogear scripts docs/relaxed_motion.svg

The cases of tests/app/creep.py. A force that grows, or a way by which the punch is pressed in, within 0.1 ms to 10,000 s; a steel ring
that rolls 16 mm over a longer block; the impact of the punch at 0.5 m/s by the number of columns of three bases. Largest errors over
all times, each over the largest value.
"""
import os
import pathlib
import sys
import tempfile

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "app"))
import creep

RISES, ROLLINGS, MODES = (1e-4, 1e-2, 1, 1e2, 1e4), (1e-2, 0.1, 1, 10, 1e2, 1e4), 100
KINDS = {"both": "one Poisson's ratio", "shear": "shear alone relaxes", "apart": "shear and bulk apart", "two": "two polymers"}
TOUCHING = 75  # displacements of the nodes of the block that may touch
BASES = {"modal_residual": ((50, 100, 150, 175, 200), 0), "modal_attachment": ((25, 75, 125), TOUCHING), "craig_bampton": ((100, 150, 200), 0)}


def split(errors):
    """Largest error of motion and of stress."""
    return (max(error for what, error in errors.items() if not what.startswith("stress")),
            max(error for what, error in errors.items() if what.startswith("stress")))


def show(what, errors):
    motion, stress = split(errors)
    print(f"{what}: displacement and force {motion:.1e}, stresses {stress:.1e}", flush=True)
    return motion, stress


def curve(axis, numbers, values, label):
    line = axis.plot(numbers, [100 * stress for _, stress in values], "o-", label=label)[0]
    axis.plot(numbers, [100 * motion for motion, _ in values], "o:", color=line.get_color(), markersize=3)


def ramps(axis):
    for kind, label in KINDS.items():
        worst = []
        for rise in RISES:
            both = [show(f"{kind}, {MODES} modes, {load} within {rise:g} s", creep.errors_on_ramp(creep.Case(kind, MODES), load, rise))
                    for load in creep.LOADS]
            worst.append([max(pair) for pair in zip(*both)])
        curve(axis, RISES, worst, label)
    for kind in KINDS:
        for duration in ROLLINGS:
            show(f"{kind}, {MODES} modes, rolling for {duration:g} s", creep.errors_of_rolling(creep.Case(kind, MODES), duration))


def impacts(axis):
    for basis, (numbers, more) in BASES.items():
        values = [show(f"impact, {basis}, {n + more} columns", creep.errors_of_impact(creep.Case("both", n), basis)) for n in numbers]
        curve(axis, [n + more for n in numbers], values, basis)


def main():
    figure = os.path.abspath(sys.argv[3])
    plt.rcParams.update({"svg.hashsalt": "relaxed_motion", "font.size": 9})
    drawing, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), sharey=True, layout="constrained")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        creep.meshes()
        impacts(right)
        ramps(left)
        os.chdir("/")
    left.set(xlabel="rise of the load [s] (100 modes)", ylabel="largest error [%]", xscale="log", yscale="log")
    right.set(xlabel="columns of the basis, of 300 displacements (impact)")
    for axis in (left, right):
        axis.axhline(1, color="0.5", linewidth=0.8, linestyle="--")
        axis.grid(alpha=0.3)
    right.legend(fontsize=8, loc="lower left")
    left.plot([], [], "k-", label="stresses")
    left.plot([], [], "k:", label="displacement, contact force")
    left.legend(fontsize=7, loc="upper right")
    drawing.savefig(figure, metadata={"Date": None})


main()
