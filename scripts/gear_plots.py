#!/usr/bin/python3
"""Plots of what `elastogear evaluate` reads off: transmission error with its orders, load sharing, line load, contact pattern of each
flank on its own coordinates, stress at the roots over the roll angle.
Run: scripts/gear_plots.py EVALUATION.h5 [--case CASE] --out FOLDER"""
import argparse
import os
import sys

import numpy as np

import results
from plots import COLOURS, STYLES, line_styles, plt, readable, save

HEAT = "YlOrRd"
MOST_ORDERS = 10
MOST_PAIRS = 12  # in one legend
NOTICEABLE = 0.12  # of the largest stress: roots below it are not drawn


class Pair:
    """The figures of one pair in one case."""

    def __init__(self, group, case, name):
        self.group, self.case, self.name = group, case, name
        self.roll = group["roll"][:]

    def has(self, path):
        return path in self.group

    def __getitem__(self, path):
        return self.group[path][()]

    def title(self, what):
        return f"{what}: {self.name.replace(':', ' and ')}"

    def file(self, what):
        return f"{what}_{self.name.replace(':', '_')}"


def roll_axis(axes, pair):
    axes.set_xlabel("roll angle in pitches")
    axes.set_xlim(pair.roll.min(), pair.roll.max())


def plot_transmission_error(pair, folder):
    error = "transmission_error"
    orders = pair.has(error + "/order")
    figure, panels = plt.subplots(1, 2 if orders else 1, figsize=(10, 4) if orders else (7, 4), squeeze=False)
    axes = panels[0, 0]
    axes.plot(pair.roll, 1e6 * pair[error + "/loaded"], color=COLOURS[0], label="loaded")
    if pair.has(error + "/unloaded") and np.ptp(pair[error + "/unloaded"]) > 0:
        axes.plot(pair.roll, 1e6 * pair[error + "/unloaded"], "--", color=COLOURS[1], label="without load")
    axes.axhline(1e6 * pair[error + "/mean"], color=COLOURS[0], linewidth=0.8, linestyle=":",
                 label=f"mean {1e6 * pair[error + '/mean']:.1f} µm, peak to peak {1e6 * pair[error + '/peak_to_peak']:.2f} µm")
    roll_axis(axes, pair)
    axes.set_ylabel(f"transmission error in µm, radius {1e3 * pair[error + '/radius']:.1f} mm")
    axes.legend(frameon=False, fontsize=8)
    if orders:
        order, amplitude = pair[error + "/order"], 1e6 * pair[error + "/amplitude"]
        shown = order <= MOST_ORDERS + 0.5
        if pair.has("time"):
            panels[0, 1].plot(order[shown], amplitude[shown], color=COLOURS[0], linewidth=1)
        else:
            panels[0, 1].bar(order[shown], amplitude[shown], width=0.6 * order[0], color=COLOURS[0])
        panels[0, 1].set(xlabel="order of the mesh frequency", ylabel="amplitude in µm", xlim=(0, MOST_ORDERS + 0.5))
    figure.suptitle(pair.title("Transmission error"))
    save(figure, folder, pair.file("transmission_error"))


def on_its_way(pair, column):
    """Places of one pair of teeth and its shares, in the order of its way through the mesh."""
    share, place = pair["teeth/share"][:, column], pair["teeth/place"][:, column]
    order = np.argsort(place)
    return place[order], share[order]


def plot_load_sharing(pair, folder):
    if not pair.has("teeth/share"):
        return
    figure, (over_roll, way) = plt.subplots(1, 2, figsize=(11, 4))
    tooth, share = pair["teeth/tooth"].astype(int), 100 * pair["teeth/share"]
    for (column, teeth), (style, colour) in zip(enumerate(tooth), line_styles()):
        label = f"{teeth[0]} : {teeth[1]}" if column < MOST_PAIRS else None
        over_roll.plot(pair.roll, share[:, column], style, color=colour, label=label)
    places, shares = (np.concatenate(x) for x in zip(*(on_its_way(pair, i) for i in range(len(tooth)))))
    touched = places[shares > 0]
    if touched.size:
        order = np.argsort(places)
        way.plot(places[order], 100 * shares[order], ".-", color=COLOURS[0], markersize=4)
        way.set_xlim(touched.min() - 0.2, touched.max() + 0.2)
    roll_axis(over_roll, pair)
    over_roll.set(ylabel="share of the normal force in %", ylim=(0, 105))
    over_roll.legend(title="teeth", frameon=False, fontsize=8)
    way.set(xlabel="place of a pair of teeth on its way, pitches", ylim=(0, 105),
            title=f"operating contact ratio {pair['teeth/contact_ratio']:.3f}")
    figure.suptitle(pair.title("Load sharing"))
    save(figure, folder, pair.file("load_sharing"))


def plot_line_load(pair, folder):
    if not pair.has("line_load/mean"):
        return
    z, width, mean, all_ = (pair["line_load/" + name] for name in ("z", "width", "mean", "value"))
    face_load_factor = f", $K_{{H\\beta}}$ = {pair['line_load/KHbeta']:.3f}" if pair.has("line_load/KHbeta") else ""  # on parallel axes
    factor, unit = 1e-3, "N/mm"
    figure, axes = plt.subplots(figsize=(7, 4))
    axes.fill_between(1e3 * z, factor * all_.min(axis=0), factor * all_.max(axis=0), color=COLOURS[0], alpha=0.2, linewidth=0,
                      label="range over the roll angle")
    axes.plot(1e3 * z, factor * mean, "o-", color=COLOURS[0], markersize=3, label="mean over the roll angle")
    axes.axhline(factor * np.average(mean, weights=width), color="black", linewidth=0.8, linestyle=":", label="mean over the width")
    axes.set(xlabel="along the axis in mm", ylabel=f"line load of all teeth in {unit}", ylim=(min(0, factor * all_.min()), None),
             title=pair.title("Load over the face width") + face_load_factor)
    axes.legend(frameon=False)
    save(figure, folder, pair.file("line_load"))


def cell_edges(middles):
    half = (middles[1] - middles[0]) / 2
    return np.append(middles - half, middles[-1] + half)


def plot_pattern(pair, name, folder):
    group = pair.group["pattern/" + name]
    coordinate = "length_of_roll" if "length_of_roll" in group else "radius"
    pressure = np.ma.masked_equal(group["pressure"][:] / 1e6, 0)
    figure, axes = plt.subplots(figsize=(7, 4.5))
    axes.set_facecolor("#f4f4f4")
    axes.grid(False)
    image = axes.pcolormesh(1e3 * cell_edges(group["z"][:]), 1e3 * cell_edges(group[coordinate][:]), pressure, cmap=HEAT, vmin=0)
    of_pressure = "by H. Hertz" if pair.has("pressure/by_hertz") and pair["pressure/by_hertz"] > 0 else "means over the faces"
    figure.colorbar(image, label=f"contact pressure, {of_pressure}, in MPa")
    axes.set(xlabel="along the axis in mm", ylabel=f"{coordinate.replace('_', ' ')} in mm",
             title=f"Contact pattern: {name.replace('_', ', ')} flanks, {100 * group['covered'][()]:.0f} % touched")
    save(figure, folder, f"pattern_{name}")


def plot_roots(pair, gear, folder):
    root = "root/" + gear
    figure, (over_roll, way) = plt.subplots(1, 2, figsize=(11, 4.2))
    tension, tooth = pair[root + "/tension"] / 1e6, pair[root + "/tooth"].astype(int)
    peak = tension.max()
    for column, (style, colour) in zip(np.flatnonzero(tension.max(axis=0) > NOTICEABLE * peak), line_styles()):
        over_roll.plot(pair.roll, tension[:, column], style, color=colour, label=f"tooth {tooth[column]}")
    roll_axis(over_roll, pair)
    over_roll.set(ylabel="stress in MPa", title="largest principal stress at each tooth", ylim=(None, 1.12 * peak))
    over_roll.legend(frameon=False, fontsize=8, loc="best")
    if pair.has(root + "/way/place"):
        place = pair[root + "/way/place"]
        for name, label, colour, style in (("tension", "largest principal", COLOURS[0], "-"), ("von_mises", "von Mises", COLOURS[1], "--")):
            way.plot(place, pair[f"{root}/way/{name}"] / 1e6, style, color=colour, label=label)
        far = np.abs(place[pair[root + "/way/tension"] > NOTICEABLE * 1e6 * peak]).max(initial=0.5)
        way.set_xlim(-far - 0.5, far + 0.5)
        way.legend(frameon=False, fontsize=8, loc="best")
    way.set(xlabel="place of a tooth on its way, pitches", title="nodes of the largest ones on the way of a tooth")
    node, tension = int(pair[root + "/largest_tension_node"]), root + "/largest_tension"
    parts = (("error", "reduction"), ("mesh_error", "mesh"), ("contact_error", "resolution of the contact"), ("time_error", "steps in time"))
    errors = [(by, pair[f"{tension}_{name}"] / 1e6) for name, by in parts if pair.has(f"{tension}_{name}")]
    two_digits = [f"{by} {float(f'{error:.2g}'):g} MPa" for by, error in errors]
    told = "\nestimated errors: " + ", ".join(two_digits) if errors else ""
    figure.suptitle(f"Stress at the roots of the {gear}: tension at most {pair[tension] / 1e6:.4g} MPa at node {node}{told}", fontsize=10)
    save(figure, folder, "root_stress_" + gear)


def plot_force_orders(pair, folder):
    if not pair.has("force/order"):
        return
    order, amplitude = pair["force/order"], pair["force/amplitude"]
    shown = order <= MOST_ORDERS + 0.5
    factor, unit = readable(amplitude.max(), "N")
    figure, axes = plt.subplots(figsize=(7, 4))
    axes.plot(order[shown], factor * amplitude[shown], STYLES[0], color=COLOURS[0], linewidth=1)
    axes.set(xlabel="order of the mesh frequency", ylabel=f"amplitude of the contact force in {unit}", xlim=(0, MOST_ORDERS + 0.5),
             title=pair.title("Orders of the contact force") + f", dynamic factor {pair['force/dynamic_factor']:.3f}")
    save(figure, folder, pair.file("force_orders"))


def plot_pair(pair, folder):
    plot_transmission_error(pair, folder)
    plot_load_sharing(pair, folder)
    plot_line_load(pair, folder)
    for name in pair.group.get("pattern", ()):
        plot_pattern(pair, name, folder)
    for gear in pair.group.get("root", ()):
        plot_roots(pair, gear, folder)
    plot_force_orders(pair, folder)


def pairs_of(file, case):
    """The pairs of a case; the first case where none is named."""
    cases = file["cases"]
    if case and case not in cases:
        sys.exit(f"{file.filename}: has no case '{case}'; it has: {', '.join(cases)}")
    name = case or next(iter(cases))
    return [Pair(cases[name][pair], name, pair) for pair in cases[name] if ":" in pair]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("evaluation", help="file of `elastogear evaluate`")
    parser.add_argument("--case", help="default: the first one")
    parser.add_argument("--out", default=".", help="folder for the pictures, made when missing")
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    with results.open_file(options.evaluation, "evaluation") as file:
        for pair in pairs_of(file, options.case):
            plot_pair(pair, options.out)


if __name__ == "__main__":
    main()
