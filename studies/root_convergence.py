#!/usr/bin/python3
"""Error of the root stress of the reference worm drive over nodes and computing time, by size and order of the hexahedra.

    studies/root_convergence.py --study build/release/studies/drive_roots --out roots [--figure docs/root_convergence.svg]

Runs the study drive_roots once for each size and order and prints nodes, CPU seconds, and the errors of the largest von Mises
stress, averaged and recovered, beside the references of docs/validation/recovery.md, section Roots (--wheel, --worm, MPa). Bodies are those of
the study: the worm, and five teeth of the wheel on their part of the disc."""
import argparse
import os
import re
import resource
import subprocess

import matplotlib

matplotlib.use("svg")
import matplotlib.pyplot as plt

SIZES = ("tiny", "small", "medium", "paper")


def solved(study, folder, body, mesh):
    """Nodes, CPU seconds, averaged and recovered stress (MPa)."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
    text = subprocess.run([study, body, mesh], cwd=folder, capture_output=True, text=True, check=True,
                          env={**os.environ, "OPENBLAS_NUM_THREADS": "1"}).stdout
    seconds = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before
    found = re.search(r"(\d+) nodes, averaged / recovered: von Mises +([\d.]+) / +([\d.]+)", text)
    return int(found.group(1)), seconds, float(found.group(2)), float(found.group(3))


def draw(rows, path):
    figure, axes = plt.subplots(2, 2, figsize=(8.5, 6.5), sharey=True, layout="constrained")
    for i, body in enumerate(("worm", "wheel")):
        for j, (column, label) in enumerate(((0, "nodes"), (1, "CPU seconds, one core"))):
            for order, marker in ((1, "s"), (2, "o")):
                for kind, style in ((2, ":"), (3, "-")):
                    name = f"{8 if order == 1 else 20} nodes a cell, {'averaged' if kind == 2 else 'recovered'}"
                    of = [row for row in rows[body] if row[0] == order]
                    axes[i, j].loglog([row[1 + column] for row in of], [max(abs(row[1 + kind]), 0.05) for row in of], style,
                                      marker=marker, color=f"C{order - 1}", fillstyle="none" if kind == 2 else "full", label=name)
            axes[i, j].axhline(1, color="black", linewidth=0.8)
            axes[i, j].set(xlabel=label, title=body if j == 0 else "")
            axes[i, j].grid(True, which="both", linewidth=0.3)
        axes[i, 0].set_ylabel("error of the root stress in %")
    axes[0, 1].legend(fontsize="small")
    figure.savefig(path, metadata={"Date": None})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--study", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--worm", type=float, default=171.0, help="MPa")
    parser.add_argument("--wheel", type=float, default=152.0, help="MPa")
    parser.add_argument("--sizes", nargs="+", default=SIZES)
    parser.add_argument("--figure")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    rows = {}
    for body, right in (("worm", options.worm), ("wheel", options.wheel)):
        rows[body] = []
        for order in (1, 2):
            for size in options.sizes:
                nodes, seconds, *stress = solved(os.path.abspath(options.study), options.out, body, f"{size}:{order}")
                errors = [100 * (value / right - 1) for value in stress]
                rows[body].append((order, nodes, seconds, *errors))
                print(f"{body:5} {size:6} {8 if order == 1 else 20:2} nodes a cell: {nodes:7} nodes, {seconds:6.1f} s, "
                      f"averaged {errors[0]:+6.1f} %, recovered {errors[1]:+6.1f} %", flush=True)
    if options.figure:
        draw(rows, options.figure)


if __name__ == "__main__":
    main()
