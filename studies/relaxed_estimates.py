#!/usr/bin/python3
"""Estimated errors of stresses of a block of steel and polymer that relaxes, beside its true errors.

    studies/relaxed_estimates.py build/release/src/app/elastogear scripts

The cases of tests/app/creep.py: at rest over ten decades of time, ramps over eight, rolling and an impact, by four pairs of
materials. Of von Mises stresses at all nodes of the contact surface and in the middle of the steel, at all output times.
"""
import os
import pathlib
import sys
import tempfile

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "tests" / "app"))
import creep

KINDS = ("both", "shear", "apart", "two")
FEW, MANY, IMPACTS = (5, 20, 100), (20, 100), (20, 50, 100, 150, 200)
RISES, ROLLINGS = (1e-4, 1, 1e4), (1e-2, 1e2)  # s


def rest():
    for kind in KINDS:
        for modes in FEW:
            for load in creep.LOADS:
                creep.errors_at_rest(creep.Case(kind, modes), load)
                yield


def ramps():
    for kind in KINDS:
        for modes in MANY:
            for load in creep.LOADS:
                for rise in RISES:
                    creep.errors_on_ramp(creep.Case(kind, modes), load, rise)
                    yield


def rolling():
    for kind in KINDS:
        for modes in MANY:
            for duration in ROLLINGS:
                creep.errors_of_rolling(creep.Case(kind, modes), duration)
                yield


def impact():
    for modes in IMPACTS:
        creep.errors_of_impact(creep.Case("both", modes))
        yield


def line(name, found):
    true, estimate = found
    clear = true > 1e-3
    of_clear = "| |"
    if clear.any():
        of_clear = f"{np.median(estimate[clear] / true[clear]):.2g} | {100 * np.mean(true[clear] < 2 * estimate[clear]):.2f} % |"
    print(f"| {name} | {true.size} | {100 * np.median(true):.2g} % | {100 * true.max():.2g} % | {100 * np.median(estimate):.2g} % | "
          f"{100 * np.mean(true < 2 * estimate):.2f} % | {100 * clear.mean():.1f} % | {of_clear}", flush=True)


def main():
    print("| runs | values | true error, median | largest | estimate, median | true below twice the estimate | "
          "true above 0.1 % | estimate / true of these | true below twice the estimate of these |\n" + "|---" * 9 + "|")
    everything = []
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        creep.meshes()
        for runs in (impact, rest, ramps, rolling):
            found = [creep.estimates(*creep.RECOVERED[-2:]) for _ in runs()]
            line(runs.__name__, np.hstack(found))
            everything += found
        os.chdir("/")
    line("all", np.hstack(everything))


main()
