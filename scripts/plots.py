#!/usr/bin/python3
"""Plots of a simulation: contact force per contact area, speed of the bodies, stress at the most stressed node of each
body, energies. Run: scripts/plots.py RESULT.h5 STRESS.h5 [--body-file worm=worm.h5] [--node worm=123] --out FOLDER"""
import argparse
import itertools
import os

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import results

# Okabe & Ito: distinguishable with all common forms of colour blindness.
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9")
STYLES = ("-", "--", ":")
NOTICEABLE = 0.01  # of the largest force: weaker contact areas are not drawn
ENERGIES = {"kinetic": ("-", "kinetic"), "elastic": ("-", "elastic"), "contact": ("-", "contact"),
            "dissipated": ("--", "dissipated"), "work": (":", "work of loads")}
SI_PREFIXES = ((1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"))

plt.rcParams.update({"figure.dpi": 150, "figure.constrained_layout.use": True, "axes.grid": True, "grid.alpha": 0.3,
                     "axes.spines.top": False, "axes.spines.right": False, "lines.linewidth": 1.5,
                     "axes.formatter.useoffset": False})


def readable(largest, unit):
    """Factor and unit name in which a quantity with this largest magnitude reads well."""
    for size, prefix in SI_PREFIXES:
        if largest >= size:
            return 1 / size, prefix + unit
    return 1.0, unit


def time_axis(axes, time):
    """Labels the time axis; returns the times in the unit of the label."""
    factor, unit = readable(float(time[-1]), "s")
    axes.set_xlabel(f"time in {unit}")
    axes.set_xlim(time[0] * factor, time[-1] * factor)
    return time * factor


def line_styles():
    return itertools.cycle(itertools.product(STYLES, COLOURS))


def save(figure, folder, name):
    path = os.path.join(folder, name + ".png")
    figure.savefig(path)
    plt.close(figure)
    print(path)


def plot_contact_force(result, name, folder):
    pair, time = result["contact"][name], result["time"][:]
    total, slave = results.total_force(pair), name.split(":")[1]
    groups = {label: force for label, force in results.group_forces(pair).items()
              if force.max() > NOTICEABLE * total.max()}
    factor, unit = readable(total.max(), "N")
    figure, axes = plt.subplots(figsize=(8, 4.5))
    t = time_axis(axes, time)
    axes.plot(t, total * factor, color="black", linewidth=2, label="all contact areas")
    for (label, force), (style, colour) in zip(groups.items(), line_styles()):
        axes.plot(t, force * factor, style, color=colour, label=f"{slave} {label.replace('_', ' ')}")
    axes.set(ylabel=f"contact force in {unit}", title=f"Contact force {name.replace(':', ' on ')}", ylim=(0, None))
    axes.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    save(figure, folder, "contact_force_" + name.replace(":", "_"))


def plot_speed(result, body, folder):
    """One line per joint coordinate; a body without any is held and gets no plot."""
    speed = result["bodies"][body]["rigid_velocity"]
    if speed.shape[1] == 0:
        return
    units = sorted({results.speed_unit(result["bodies"][body], i) for i in range(speed.shape[1])})
    figure, axes = plt.subplots(figsize=(7, 4))
    t = time_axis(axes, result["time"][:])
    for i in range(speed.shape[1]):
        axes.plot(t, speed[:, i], STYLES[i % len(STYLES)], color=COLOURS[i % len(COLOURS)], label=f"coordinate {i + 1}")
    if speed.shape[1] > 1:
        axes.legend(frameon=False)
    axes.axhline(0, color="black", linewidth=0.6)
    axes.set(ylabel=f"speed in {' or '.join(units)}", title=f"Speed of the {body}")
    save(figure, folder, "speed_" + body)


def stress_title(history, body_file):
    text = f"Stress of the {history.body} at node {history.node} ({history.set.replace('_', ' ')})"
    if body_file is None:
        return text
    with results.open_file(body_file, "body") as body:
        n_modes = results.mode_count(body)
    return text + (f", {n_modes} modes" if n_modes else ", full finite-element basis")


def error_text(history):
    """What the band around the von Mises stress is."""
    if history.error is None:
        return "Error of the reduction not estimated: not to be trusted"
    peak, error = history.von_mises.max(), history.error[history.von_mises.argmax()]
    doubt = "\nnot to be trusted" if error > results.TRUSTED * peak else ""
    return f"Band: estimated error of\nthe reduction, at the peak\n{error / 1e6:.2g} MPa ({100 * error / max(peak, 1e-300):.2g} %){doubt}"


def plot_stress(history, time, body_file, folder):
    """Six components in the body frame, von Mises and the largest principal stress (Rankine)."""
    figure, axes = plt.subplots(3, 3, figsize=(11, 8.5))
    figure.suptitle(stress_title(history, body_file))
    for i, (component, panel) in enumerate(zip(results.COMPONENTS, axes.flat)):
        symbol = "σ" if i < 3 else "τ"
        panel.plot(time_axis(panel, time), history.tensor[:, i] / 1e6, color=COLOURS[0])
        panel.set_title(f"${symbol}_{{{component}}}$", fontsize=12)
    for panel, values, label in zip(axes[2], (history.von_mises, history.rankine), ("von Mises", "Rankine")):
        panel.plot(time_axis(panel, time), values / 1e6, color=COLOURS[1])
        panel.set_title(label, fontsize=11)
    if history.error is not None:
        axes[2, 0].fill_between(time_axis(axes[2, 0], time), np.maximum(history.von_mises - history.error, 0) / 1e6,
                                (history.von_mises + history.error) / 1e6, color=COLOURS[1], alpha=0.25, linewidth=0)
    for panel in axes[:, 0]:
        panel.set_ylabel("stress in MPa")
    axes[2, 2].set_axis_off()
    axes[2, 2].text(0, 0.5, error_text(history), transform=axes[2, 2].transAxes, va="center")
    save(figure, folder, "stress_" + history.body)


def plot_energy(result, folder):
    energy, time = result["energy"], result["time"][:]
    initial = sum(energy[name][0] for name in ("kinetic", "elastic", "contact"))
    figure, (upper, lower) = plt.subplots(2, 1, figsize=(8, 6.5), sharex=True, height_ratios=(2.5, 1))
    factor, unit = readable(max(np.abs(energy[name][:]).max() for name in energy), "J")
    t = time_axis(lower, time)
    for (name, (style, label)), colour in zip(ENERGIES.items(), COLOURS):
        upper.plot(t, energy[name][:] * factor, style, color=colour, label=label)
    upper.set(ylabel=f"energy in {unit}", title="Energies and their balance")
    upper.legend(loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False)
    share = 100 / initial if initial > 0 else factor
    lower.plot(t, energy["balance"][:] * share, color="black")
    lower.set_ylabel("balance in %\nof initial energy" if initial > 0 else f"balance in {unit}")
    save(figure, folder, "energy")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", help="result file of `elastogear simulate`")
    parser.add_argument("stress", help="stress file of `elastogear recover`")
    parser.add_argument("--body-file", action="append", default=[], metavar="BODY=FILE", help="names the basis in titles")
    parser.add_argument("--node", action="append", default=[], metavar="BODY=NUMBER",
                        help="mesh node to plot; default: the one with the largest von Mises stress")
    parser.add_argument("--out", default=".", help="folder for the pictures, made when missing")
    return parser.parse_args()


def main():
    options = arguments()
    os.makedirs(options.out, exist_ok=True)
    body_files = results.key_values(options.body_file, "--body-file")
    nodes = results.key_values(options.node, "--node")
    with results.open_file(options.result, "result") as result:
        for body, path in body_files.items():
            results.require_body_of_run(result, body, path)
        for name in result["contact"]:
            plot_contact_force(result, name, options.out)
        for body in result["bodies"]:
            plot_speed(result, body, options.out)
        plot_energy(result, options.out)
    with results.open_file(options.stress, "stress") as stress:
        histories = results.most_stressed_nodes(stress)
        histories.update({body: results.chosen_node(stress, body, int(node)) for body, node in nodes.items()})
        for body, history in histories.items():
            plot_stress(history, stress["time"][:], body_files.get(body), options.out)


if __name__ == "__main__":
    main()
