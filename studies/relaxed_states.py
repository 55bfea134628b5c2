#!/usr/bin/python3
"""How many states of relaxation, in which static responses are found, a block of steel and polymer takes.

    studies/relaxed_states.py build/release/src/app/elastogear scripts docs/relaxed_states.svg

A steel punch on the block of tests/app/creep.py, under a force and pressed in and held, at rest over ten decades of time: the
largest error of displacement, contact force and of all stresses beside the full basis, each over its largest value, by the number of
states beside the instantaneous one and by the number of modes.
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

STATES, MODES = (1, 2, 3, 4, 5), (5, 10, 20, 50, 100, 200)
KINDS = {"both": "steel and a polymer of one Poisson's ratio", "shear": "shear alone relaxes", "apart": "shear and bulk relax apart",
         "two": "two polymers"}


def errors(case):
    """Largest error of displacement and force, and of stresses."""
    found = [creep.errors_at_rest(case, load) for load in creep.LOADS]
    return (max(max(e["s"], e["force"]) for e in found), max(e[key] for e in found for key in e if key.startswith("stress")))


def curve(axis, numbers, cases, label):
    values = [errors(case) for case in cases]
    for number, (motion, stress) in zip(numbers, values):
        print(f"{label}, {number}: displacement and force {motion:.1e}, stresses {stress:.1e}", flush=True)
    line = axis.plot(numbers, [100 * stress for _, stress in values], "o-", label=label)[0]
    axis.plot(numbers, [100 * motion for motion, _ in values], "o:", color=line.get_color(), markersize=3)


def main():
    figure = os.path.abspath(sys.argv[3])
    plt.rcParams.update({"svg.hashsalt": "relaxed_states", "font.size": 9})
    drawing, (left, right) = plt.subplots(1, 2, figsize=(9, 3.8), sharey=True, layout="constrained")
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        creep.meshes()
        for kind, label in KINDS.items():
            curve(left, STATES, [creep.Case(kind, states=str(n)) for n in STATES], label)
        for n in (1, 2, 3):
            curve(right, MODES, [creep.Case("shear", modes=modes, states=str(n)) for modes in MODES], f"{n} states" if n > 1 else "1 state")
        os.chdir("/")
    left.set(xlabel="states of relaxation with static responses (20 modes)", ylabel="largest error over ten decades of time [%]",
             yscale="log", ylim=(7e-5, 200), xticks=STATES)
    right.set(xlabel="modes (shear alone relaxes)", xscale="log", xticks=MODES, xticklabels=MODES)
    right.minorticks_off()
    for axis in (left, right):
        axis.axhline(1, color="0.5", linewidth=0.8, linestyle="--")
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8, loc="lower left")
    left.plot([], [], "k-", label="stresses")
    left.plot([], [], "k:", label="displacement, contact force")
    left.legend(fontsize=7, loc="upper right")
    drawing.savefig(figure, metadata={"Date": None})


main()
