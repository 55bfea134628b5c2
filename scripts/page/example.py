"""The files of an example that scripts/example has run, as studies and the page of scripts/paper read them, and parts of that page."""
import base64
import csv
import glob
import html
import io
import os
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import results
from plots import COLOURS, STYLES

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
INPUT = os.path.join(SCRIPTS, "..", "examples", "worm_gear")
MEASURES = ("xx", "yy", "zz", "xy", "xz", "yz", "von Mises", "Rankine")
AFTER_STATE = 1.1  # as in scripts/chain.py: a rolling run lasts so much longer than until the state that goes to the static analysis
END_OF_REBOUND = 0.35  # ms, as in scripts/chain.py: what comes later is another impact, of the other flanks


def variants(folder):
    """Labels BASIS_MODES of the reduced runs, by basis and number of modes."""
    labels = [os.path.basename(path)[:-10] for path in glob.glob(os.path.join(folder, "*_stress.h5"))]
    reduced = [label for label in labels if re.fullmatch(r"(?!full)\w+_\d+", label)]
    return sorted(reduced, key=lambda label: (label.rsplit("_", 1)[0], int(label.rsplit("_", 1)[1])))


def table(head, rows, paper=()):
    """rows: lists of text; those whose number is in `paper` are marked as the paper's."""
    def line(cells, tag, mark=""):
        return f"<tr{mark}>" + "".join(f"<{tag}>{html.escape(str(cell))}</{tag}>" for cell in cells) + "</tr>"
    body = "".join(line(row, "td", ' class="paper"' if i in paper else "") for i, row in enumerate(rows))
    return f'<div class="scroll" tabindex="0"><table>{line(head, "th")}{body}</table></div>'


def image(data, caption, kind="png"):
    text = base64.b64encode(data).decode()
    return f'<figure><img src="data:image/{kind};base64,{text}" alt="{html.escape(caption)}"><figcaption>{html.escape(caption)}</figcaption></figure>'


def picture(figure, caption):
    stream = io.BytesIO()
    figure.savefig(stream, format="png")
    plt.close(figure)
    return image(stream.getvalue(), caption)


def read_csv(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))[1:]


class Example:
    """The files of one example: the reference's and those of the reduced runs."""

    def __init__(self, name, folder):
        self.name, self.folder, self.labels = name, folder, variants(folder)
        if not self.labels:
            sys.exit(f"{folder}: holds no results of scripts/example {name}")

    def path(self, name):
        return os.path.join(self.folder, name)

    def reference(self, label):
        return "full_at_" + label if self.name == "rolling" else "full"

    def result(self, label):
        return results.open_file(self.path(label + ".h5"), "result")

    def stress(self, label):
        return results.open_file(self.path(label + "_stress.h5"), "stress")

    def deviations(self, label, number):
        """Rows of a table of `elastogear compare` of stresses: 1 relative, 2 of von Mises, 3 over time."""
        return read_csv(self.path(f"{label}_against_full_stress_{number}.csv"))

    def steps(self):
        """Last CPU time (s), wall time (s) and memory (MB) of each step, those that made the bodies first (if they were made here)."""
        rows = []
        for path in filter(os.path.exists, (os.path.join(self.folder, "..", "steps.csv"), self.path("steps.csv"))):
            with open(path, encoding="utf-8", newline="") as file:
                rows += csv.reader(file)
        return {row[0]: [float(value) for value in row[1:]] for row in rows}


def line_style(i):
    """Of the i-th curve of a panel; the first is the reference's."""
    if i == 0:
        return {"color": "black", "linewidth": 2.2}
    return {"color": COLOURS[(i - 1) % len(COLOURS)], "linewidth": 1.2, "linestyle": STYLES[(i - 1) // len(COLOURS) % 3]}


def transmission(example):
    """Head and rows of a table: mean torque ratios, number of tooth pairs in contact, balance of energy."""
    rows = []
    for label in example.labels:
        with example.result(label) as file:
            pair, t, angle = next(iter(file["contact"].values())), file["time"][:], file["bodies/worm/rigid"][:, 0]
            on_wheel, on_worm = pair["torque"][:, 2], results.torque_on_worm(file)
            count = sum((area > 0).astype(int) for area in results.group_forces(pair).values())
            balance, work = np.abs(file["energy/balance"]).max(), np.abs(file["energy/work"]).max()
        turn = t >= np.interp(angle[-1] - 2 * np.pi, angle, t)
        ratios = [abs(np.trapz(on_wheel[part], t[part]) / np.trapz(on_worm[part], t[part])) for part in (t > t[-1] / 2, turn)]
        shares = [f"{100 * (count[t > t[-1] / 2] == n).mean():.0f} %" for n in (1, 2, 3, 4)]
        rows.append([label, *(f"{ratio:.4f} ({100 * (ratio / 20.5 - 1):+.3f} %)" for ratio in ratios), *shares,
                     f"{1e6 * balance:.3g} of {1e6 * work:.3g}"])
    return ["run", "torques, second half", "over the last turn", *(f"{n} pairs" for n in (1, 2, 3, 4)), "balance of energy, uJ"], rows


def rolling_state(time):
    """s: when the state of a rolling run goes to the static analysis."""
    return time[-1] / AFTER_STATE


def peak_steps(example, time):
    """Output times at which a run is held against its reference, and those of the reference."""
    if example.name == "impact":
        until = slice(0, int(np.searchsorted(time * 1e3, END_OF_REBOUND)))
        return until, until
    if example.name == "turn_in":
        return slice(-1, None), slice(-1, None)
    nearest = int(np.abs(time - rolling_state(time)).argmin())
    return slice(nearest, nearest + 1), slice(-1, None)


def peaks(example):
    """Yields (label, body, set, results.Peak of the run, of the unreduced bodies)."""
    for label in example.labels:
        with example.stress(label) as file, example.stress(example.reference(label)) as reference:
            steps, reference_steps = peak_steps(example, file["time"][:])
            for body, name, group in results.stress_sets(file):
                yield label, body, name, results.Peak(group, steps), results.Peak(reference[body][name], reference_steps)
