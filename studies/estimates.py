#!/usr/bin/python3
"""How honest the estimated errors of stresses are: over the peak von Mises stress of every set of runs that scripts/example
has made, beside the unreduced bodies. Prints the table of docs/validation/recovery.md, section Estimated errors of stresses.

    scripts/example impact --size tiny --law penalty --bases modal,modal_residual --modes 10,25,50,100,200       and so on
    studies/estimates.py out/examples/tiny/impact out/examples/tiny/turn_in ...
"""
import argparse
import os
import sys

import numpy as np

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
from page import example as runs

NEGLIGIBLE = 0.01  # of the unreduced stress: an estimate below this may be larger than three times the error


def errors(folder, wanted):
    """Rows (basis, estimated error, true error, both as shares of the unreduced stress) of the runs BASIS_MODES that are wanted."""
    example = runs.Example(os.path.basename(os.path.normpath(folder)), folder)
    example.labels = [label for label in example.labels if label in wanted]
    return [(label.rsplit("_", 1)[0], peak.error / true.value, abs(peak.value - true.value) / true.value)
            for label, _, _, peak, true in runs.peaks(example)]


def table_row(name, rows):
    estimate, true = (np.array([row[i] for row in rows]) for i in (1, 2))
    return (f"| {name} | {len(rows)} | {100 * np.median(true):.3g} % | {100 * np.median(estimate):.3g} % | "
            f"{np.median(estimate / true):.2g} | {100 * np.mean(true <= 2 * estimate):.4g} % | "
            f"{100 * np.mean((estimate < 3 * true) | (estimate < NEGLIGIBLE)):.3g} % |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", help="out/examples/SIZE/EXAMPLE")
    parser.add_argument("--modes", type=int, nargs="+", default=[10, 25, 50, 100, 200])
    parser.add_argument("--bases", nargs="+", default=["modal", "modal_residual"])
    options = parser.parse_args()
    wanted = {f"{basis}_{modes}" for basis in options.bases for modes in options.modes}
    found = {}
    for folder in options.folders:
        size, example = os.path.normpath(folder).split(os.sep)[-2:]
        for basis, estimate, true in errors(folder, wanted):
            for name in (f"{example.replace('_', '-')}, {size}, `{basis}`", f"all, `{basis}`", "all"):
                found.setdefault(name, []).append((basis, estimate, true))
    print("| runs | cases | true error, median | estimate, median | estimate / true, median | true below twice the estimate | "
          "estimate below 3 x true, or below 1 % |\n|---|---|---|---|---|---|---|")
    for name in sorted(found, key=lambda name: (name == "all", name.startswith("all"))):
        print(table_row(name, found[name]))


if __name__ == "__main__":
    main()
