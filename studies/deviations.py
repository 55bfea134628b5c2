#!/usr/bin/python3
"""Prints the tables of docs/examples.md, in Markdown: runs of scripts/example beside the unreduced bodies.

    scripts/example turn_in --size small --bases modal --law penalty --modes 100,500,1000,2000
    studies/deviations.py out/examples/small/turn_in [--runs modal_100,modal_500]
"""
import argparse
import os
import sys

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
from page import example as runs


def table(title, head, rows):
    print(f"\n**{title}**\n")
    for cells in (head, ["---"] * len(head), *rows):
        print("| " + " | ".join(map(str, cells)) + " |")


MOST = 1e4  # %: larger deviations are those of a value that vanishes


def digits(text):
    """Three significant digits; a dash for what is not a number, or beside nothing."""
    value = float(text)
    if not np.isfinite(value):
        return "-"
    if abs(value) > MOST:
        return "-"
    return f"{value:.0f}" if abs(value) >= 100 else f"{value:.3g}"


def values(example):
    """At the time of the comparison: reduced, unreduced, and the deviation with its sign."""
    rows = []
    for label in example.labels:
        for signal, value, reference, _ in runs.read_csv(example.path(f"{label}_against_full_result_1.csv")):
            if float(reference) == 0:  # nothing to hold a value against
                continue
            rows.append([signal, label, f"{float(value):.5g}", f"{float(reference):.5g}",
                         digits(100 * (float(value) / float(reference) - 1))])
    table("Forces and motion", ["signal", "run", "reduced", "unreduced", "deviation, %"], sorted(rows, key=lambda row: row[0]))


def histories(example):
    """Over time, of runs that have a history to compare."""
    rows = []
    for label in example.labels:
        path = example.path(f"{label}_against_full_result_2.csv")
        if os.path.exists(path):
            rows += [[row[0], label, *map(digits, row[1:2]), *(f"{float(cell):.5g}" for cell in row[2:])]
                     for row in runs.read_csv(path) if float(row[3])]
    if rows:
        table("Forces and motion over time", ["signal", "run", "L2, %", "peak", "unreduced", "peak at, s", "unreduced, s"],
              sorted(rows, key=lambda row: row[0]))


def stresses(example, number, title):
    rows = [[row[0], label, *map(digits, row[1:])] for label in example.labels for row in example.deviations(label, number)]
    table(title, ["nodes", "run", *runs.MEASURES, "unreduced, MPa"], sorted(rows, key=lambda row: row[0].rsplit(" ", 1)[0]))


def times(example):
    rows = [[name, *(f"{figure:.1f}" for figure in figures)] for name, figures in example.steps().items()
            if not name.startswith(("compare", "recover"))]
    table("Times", ["step", "CPU time, s", "wall-clock time, s", "memory, MB"], rows)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="out/examples/SIZE/EXAMPLE")
    parser.add_argument("--runs", type=lambda text: text.split(","), help="BASIS_MODES, separated by commas; default: all")
    options = parser.parse_args()
    example = runs.Example(os.path.basename(os.path.normpath(options.folder)), options.folder)
    example.labels = options.runs or example.labels
    values(example)
    histories(example)
    stresses(example, 1, "Relative deviation of the stress, %")
    stresses(example, 2, "Deviation, % of the unreduced von Mises stress")
    if example.name == "rolling":
        table("Transmission (exactly 20.5)", *runs.transmission(example))
    times(example)


if __name__ == "__main__":
    main()
