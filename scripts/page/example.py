"""Parts of the page of an example that scripts/example has run: the paper's figures and tables with our figures beside the paper's,
and pictures of the von Mises stress (unreduced | reduced; when scripts/example ran with --fields)."""
import base64
import csv
import glob
import html
import io
import os
import re
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import results
from plots import COLOURS, STYLES

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
INPUT = os.path.join(SCRIPTS, "..", "examples", "worm_gear")
INPUTS = {"impact": ["impact"], "turn_in": ["turn_in"], "rolling": ["rolling", "rolling_static"]}
TITLE = {"impact": "Impact (the paper's section 3.1)", "turn_in": "Turn-in (the paper's section 3.2.1)",
         "rolling": "Rolling contact (the paper's section 3.2.2)"}
PAPER_TIMES = {"full": 71000, "modal_100": 17, "modal_500": 70, "modal_1000": 339, "modal_2000": 1374}  # s, Tab. 2
MEASURES = ("xx", "yy", "zz", "xy", "xz", "yz", "von Mises", "Rankine")
PAPER_STRESS = {  # %, Tabs. 3 and 4, 1000 modes
    "turn_in": {"worm": (9.32, 4.59, 31.42, 9.17, 105.90, 122.49, 10.51, 2.77),
                "wheel": (59.04, 212.54, 505.97, 45.78, 84.62, 251.80, 48.18, 22.46)},
    "rolling": {"worm": (1.49, 2.36, 27.71, 15.76, 116.91, 133.27, 16.67, 9.28)}}
STATE_OF_ROLLING = 0.05  # s, as in scripts/example: the state that the static reference is made for
END_OF_REBOUND = 0.35  # ms, as in scripts/example: what comes later is another impact, of the other flanks


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


def image(data, caption):
    text = base64.b64encode(data).decode()
    return f'<figure><img src="data:image/png;base64,{text}" alt="{html.escape(caption)}"><figcaption>{html.escape(caption)}</figcaption></figure>'


def picture(figure, caption):
    stream = io.BytesIO()
    figure.savefig(stream, format="png")
    plt.close(figure)
    return image(stream.getvalue(), caption)


def read_csv(path):
    with open(path, encoding="utf-8", newline="") as file:
        return list(csv.reader(file))[1:]


def share(text):
    value = float(text)
    return f"{value:.2f}" if np.isfinite(value) else "-"


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


def lines(figure_size, panels):
    """Figure of panels [(title, label of y, [(name, x, y)])] in one row."""
    figure, axes = plt.subplots(1, len(panels), figsize=figure_size, squeeze=False)
    for panel, (title, unit, curves) in zip(axes[0], panels):
        for i, (name, x, y) in enumerate(curves):
            panel.plot(x, y, label=name, **line_style(i))
        panel.set(title=title, ylabel=unit, xlabel="time in ms")
    axes[0][0].legend(frameon=False, fontsize=8)
    return figure


def impact_figures(example):
    """Figs. 9 to 12."""
    labels = ["full"] + example.labels
    forces, speed = {}, []
    for label in labels:
        with example.result(label) as file:
            t, pair = file["time"][:] * 1e3, next(iter(file["contact"].values()))
            speed.append((label, t, file["bodies/wheel/rigid_velocity"][:, 0]))
            for area, force in results.group_forces(pair).items():
                forces.setdefault(area, []).append((label, t, force / 1e3))
    most = sorted(forces, key=lambda area: -max(force[t < END_OF_REBOUND].max() for _, t, force in forces[area]))[:2]
    yield picture(lines((11, 3.6), [(area.replace("_", " "), "force in kN", forces[area]) for area in most] + [("wheel", "speed in rad/s", speed)]),
                  "Fig. 9: contact force of both areas of contact, speed of the wheel")
    for number, body in ((10, "worm"), (11, "wheel")):
        yield stress_figure(example, labels, body, "root", f"Fig. {number}: stress at the {body}'s root node")
    with example.stress("full") as file:
        flanks = {body: name for body, name, _ in results.stress_sets(file) if name != "root"}
    panels = []
    for body, name in flanks.items():
        node, histories = node_histories(example, labels, body, name)
        panels.append((f"{body} flank node {node}", r"$\sigma_{xx}$ in MPa",
                       [(label, t, stress[:, 0] / 1e6) for label, t, stress in histories]))
    yield picture(lines((11, 3.6), panels), "Fig. 12: normal stress at a flank node of each body")


def node_histories(example, labels, body, name):
    """The node with the reference's largest von Mises stress, and [(label, time in ms, n_t x 6 in Pa)]."""
    with example.stress("full") as file:
        group = file[body][name]
        row = int(group["von_mises"][:].max(axis=0).argmax())
        node = int(group["nodes"][row])
    histories = []
    for label in labels:
        with example.stress(label) as file:
            histories.append((label, file["time"][:] * 1e3, file[body][name]["stress"][:, row, :]))
    return node, histories


def stress_figure(example, labels, body, name, caption):
    node, histories = node_histories(example, labels, body, name)
    figure, axes = plt.subplots(2, 3, figsize=(11, 6))
    for i, panel in enumerate(axes.flat):
        for j, (label, t, stress) in enumerate(histories):
            panel.plot(t, stress[:, i] / 1e6, label=label, **line_style(j))
        panel.set_title(f"${'σ' if i < 3 else 'τ'}_{{{results.COMPONENTS[i]}}}$ in MPa")
    axes[0][0].legend(frameon=False, fontsize=8)
    return picture(figure, f"{caption} ({node}), over the time in ms")


def no_figures(_):
    return ()


def rolling_figures(example):
    """Fig. 14: force, speed, torque ratio and number of tooth pairs of the last run."""
    label = example.labels[-1]
    with example.result(label) as file:
        t, pair = file["time"][:] * 1e3, next(iter(file["contact"].values()))
        force, torque = results.total_force(pair), pair["torque"][:, 2]
        count = sum((area > 0).astype(int) for area in results.group_forces(pair).values())
        speed = {body: file[f"bodies/{body}/rigid_velocity"][:, 0] for body in file["bodies"]}
    figure, axes = plt.subplots(2, 2, figsize=(11, 6), sharex=True)
    for panel, values, unit in zip(axes.flat, (force / 1e3, speed["worm"], torque, count),
                                   ("contact force in kN", "worm's speed in rad/s", "torque on the wheel in N m",
                                    "tooth pairs in contact")):
        panel.plot(t, values, color=COLOURS[0], linewidth=1)
        panel.set(ylabel=unit, xlabel="time in ms")
    yield picture(figure, f"Fig. 14: rolling contact, {label}")
    yield "<h2>Transmission (exactly 20.5)</h2>" + table(*transmission(example))


def require_rolling(example):
    """A mean over a turn needs the turn."""
    for label in example.labels:
        with example.result(label) as file:
            stopped = results.standstill(file)
        if stopped:
            sys.exit(f"{example.path(label)}.h5: {stopped}. There is no torque ratio of a turn to report")


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


def deviation_section(example):
    """Deviations of the stresses for each variant, at each node, with the paper's rows."""
    for number, title in ((1, "Relative deviation of the stress in %"),
                          (2, "Deviation in % of the reference's von Mises stress")):
        nodes = {}
        for label in example.labels:
            for row in example.deviations(label, number):
                nodes.setdefault(row[0], []).append([label] + [share(cell) for cell in row[1:]])
        yield f"<h2>{title}</h2>"
        for node, rows in nodes.items():
            body = node.split()[0]
            known = PAPER_STRESS.get(example.name, {}).get(body) if number == 1 and " root node" in node else None
            paper = [["paper, 1000 modes", *map(share, known), ""]] if known else []
            yield f"<h3>{html.escape(node)}</h3>" + table(["", *MEASURES, "reference in MPa"], rows + paper,
                                                           range(len(rows), len(rows) + len(paper)))


def peak_steps(example, time):
    """Output times at which a run is held against its reference, and those of the reference."""
    if example.name == "impact":
        until = slice(0, int(np.searchsorted(time * 1e3, END_OF_REBOUND)))
        return until, until
    if example.name == "turn_in":
        return slice(-1, None), slice(-1, None)
    nearest = int(np.abs(time - STATE_OF_ROLLING).argmin())
    return slice(nearest, nearest + 1), slice(-1, None)


def peaks(example):
    """Yields (label, body, set, results.Peak of the run, of the unreduced bodies)."""
    for label in example.labels:
        with example.stress(label) as file, example.stress(example.reference(label)) as reference:
            steps, reference_steps = peak_steps(example, file["time"][:])
            for body, name, group in results.stress_sets(file):
                yield label, body, name, results.Peak(group, steps), results.Peak(reference[body][name], reference_steps)


def peak_section(example):
    """Largest von Mises stress of each set with its estimated error, beside the unreduced bodies."""
    rows = [[f"{label}, {body} {name.replace('_', ' ')}", f"{peak.value / 1e6:.1f}", peak.trust(), peak.trust_mesh(), peak.trust_contact(), f"{true.value / 1e6:.1f}",
             f"{abs(peak.value - true.value) / 1e6:.2g}"] for label, body, name, peak, true in peaks(example)]
    head = ["", "peak in MPa", "estimated error of the reduction", "of the mesh", "of the contact", "unreduced in MPa", "true error in MPa"]
    return "<h2>Largest von Mises stress</h2>" + table(head, rows)


def time_section(example):
    steps = example.steps()
    rows = []
    for name, (cpu, wall, memory) in steps.items():
        label = name.removeprefix("simulate_")
        paper = PAPER_TIMES.get(label, "") if name.startswith("simulate_") and example.name == "impact" else ""
        rows.append([name.replace("_", " "), f"{cpu:.1f}", f"{wall:.1f}", f"{memory:.0f}", paper])
    yield "<h2>Times</h2>" + table(["step", "CPU time in s", "wall time in s", "memory in MB", "paper in s (Tab. 2)"], rows)


def overview_section(example):
    """Forces and motion: the first table of `elastogear compare` of the result files."""
    for label in example.labels:
        rows = [[row[0], *(f"{float(value):.5g}" if np.isfinite(float(value)) else "-" for value in row[1:])]
                for row in read_csv(example.path(f"{label}_against_full_result_1.csv"))]
        yield f"<h3>Forces and motion, {label}</h3>" + table(["", "reduced", "unreduced", "deviation in %"], rows)


def field_of(example, label, body):
    return next(iter(sorted(glob.glob(example.path(f"{label}_{body}*.vtu")))), None)


def picture_section(example):
    """Fig. 13: unreduced beside reduced, in the same colours."""
    label = example.labels[-1]
    fields = {(side, body): field_of(example, side, body) for side in (example.reference(label), label)
              for body in ("worm", "wheel")}
    if not all(fields.values()):
        return
    yield "<h2>Von Mises stress: unreduced | reduced (Fig. 13)</h2>"
    for body in ("worm", "wheel"):
        pair = ""
        for side in (example.reference(label), label):
            out = example.path(f"{side}_{body}_von_mises.png")
            subprocess.run([os.path.join(SCRIPTS, "pictures.py"), "stress", fields[side, body], "--like",
                            fields[example.reference(label), body], "--title", f"{body}, {side}", "--out", out], check=True, stdout=subprocess.DEVNULL)
            with open(out, "rb") as file:
                pair += image(file.read(), f"{body}, {side}")
        yield f'<div class="pair">{pair}</div>'


def inputs(example):
    """The input files as they stand."""
    for name in INPUTS[example.name] + ["worm", "wheel"]:
        with open(os.path.join(INPUT, name + ".yaml"), encoding="utf-8") as file:
            yield f'<details><summary>{name}.yaml</summary><pre tabindex="0">{html.escape(file.read())}</pre></details>'


def sections(example):
    figures = {"impact": impact_figures, "turn_in": no_figures, "rolling": rolling_figures}[example.name]
    parts = (figures, peak_section, deviation_section, picture_section, overview_section, time_section)
    for i, part in enumerate(parts):
        print(f"part {i + 1}/{len(parts)}: {part.__name__.replace('_', ' ')}", file=sys.stderr, flush=True)
        yield "".join(part(example))
