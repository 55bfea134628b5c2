#!/usr/bin/python3
"""Deviation from the unreduced bodies against the number of modes, for each basis: one figure and one table of the examples
that scripts/example has run with several bases and mode numbers.

    scripts/example impact  --size small --law penalty --bases modal,modal_residual --modes 10,25,50,100,200
    scripts/example turn_in --size small --law penalty --bases modal,modal_residual --modes 10,25,50,100,200
    studies/convergence.py out/examples/small --out convergence.svg --table convergence.md
"""
import argparse
import csv
import glob
import os
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
from plots import COLOURS

EXAMPLES = {"impact": "impact, at the largest force", "turn_in": "turn-in, at rest"}
STYLES = {"modal": ("--", "o"), "modal_residual": ("-", "s"), "modal_attachment": ("-.", "D"), "krylov": (":", "^"),
          "craig_bampton": ((0, (5, 1, 1, 1, 1, 1)), "v")}
PLACES = ("worm root", "worm flank", "wheel root", "wheel flank", "contact force")
FORCE = "force worm:wheel [N]"


def rows_of(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def place(nodes):
    """worm root, worm flank, ... of a row "wheel tooth_41_left all 45"; none for single nodes."""
    body, node_set, kind, _ = nodes.split(" ", 3)
    return f"{body} {'root' if node_set == 'root' else 'flank'}" if kind == "all" else None


def deviations(folder, label):
    """Deviation in % by place: of the von Mises stress over all nodes of a set, and of the contact force."""
    found = {place(row["nodes"]): float(row["von Mises [%]"])
             for row in rows_of(os.path.join(folder, f"{label}_against_full_stress_1.csv"))}
    for row in rows_of(os.path.join(folder, f"{label}_against_full_result_1.csv")):
        if row["signal"] == FORCE:
            found["contact force"] = float(row["deviation [%]"])
    return {key: value for key, value in found.items() if key}


def series(folder):
    """{basis: {modes: deviations}}"""
    bases = {}
    for path in glob.glob(os.path.join(folder, "*_against_full_stress_1.csv")):
        label = os.path.basename(path).split("_against_")[0]
        match = re.fullmatch(r"(\w+?)_(\d+)", label)
        bases.setdefault(match[1], {})[int(match[2])] = deviations(folder, label)
    return {basis: dict(sorted(bases[basis].items())) for basis in STYLES if basis in bases}


def draw(found, path):
    figure, panels = plt.subplots(1, len(found), figsize=(2 + 4.2 * len(found), 4.2), sharey=True, squeeze=False)
    for axes, (example, bases) in zip(panels[0], found.items()):
        for basis, modes in bases.items():
            style, marker = STYLES[basis]
            for name, colour in zip(PLACES, COLOURS):
                axes.loglog(list(modes), [modes[n].get(name) for n in modes], color=colour, linestyle=style, marker=marker,
                            markersize=4)
        axes.axhline(1, color="0.6", linewidth=1)
        axes.set_title(EXAMPLES[example], fontsize=11)
        counts = sorted({n for modes in bases.values() for n in modes})
        axes.set_xticks(counts, [str(n) for n in counts])
        axes.minorticks_off()
        axes.set_xlabel("modes a body")
    panels[0][0].set_ylabel("deviation from the full basis in %")
    bases = [basis for basis in STYLES if any(basis in example for example in found.values())]
    keys = [Line2D([], [], color=colour, label=name) for name, colour in zip(PLACES, COLOURS)]
    keys += [Line2D([], [], color="0.2", linestyle=STYLES[basis][0], marker=STYLES[basis][1], markersize=4, label=basis)
             for basis in bases]
    panels[0][-1].legend(handles=keys, loc="center left", bbox_to_anchor=(1.02, 0.5), fontsize=9, frameon=False)
    figure.savefig(path, metadata={"Date": None} if path.endswith(".svg") else None)


def percent(value):
    """Two digits, and no exponent of numbers above 99."""
    return f"{value:.2g} %" if value < 99.5 else f"{value:.0f} %"


def write_table(found, path):
    lines = ["| example | basis | modes | " + " | ".join(PLACES) + " |", "|---" * (3 + len(PLACES)) + "|"]
    for example, bases in found.items():
        for basis, modes in bases.items():
            for n, values in modes.items():
                cells = [percent(values[name]) if name in values else "" for name in PLACES]
                lines.append(f"| {example} | {basis} | {n} | " + " | ".join(cells) + " |")
    with open(path, "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", help="out/examples/SIZE")
    parser.add_argument("--out", default="convergence.svg", help="figure to write")
    parser.add_argument("--table", help="Markdown table to write")
    options = parser.parse_args()
    found = {example: series(os.path.join(options.folder, example)) for example in EXAMPLES}
    found = {example: bases for example, bases in found.items() if bases}
    if not found:
        parser.error(f"{options.folder}: no tables of impact or turn_in there; run scripts/example first")
    draw(found, options.out)
    if options.table:
        write_table(found, options.table)


if __name__ == "__main__":
    main()
