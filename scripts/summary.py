#!/usr/bin/python3
"""One-page text summary of a run: times of the steps, bodies, contact, stresses, energy balance, files.
Run: scripts/summary.py RESULT.h5 STRESS.h5 --body-file worm=worm.h5 ... [--times times.csv] [--folder FOLDER]"""
import argparse
import csv
import os

import numpy as np

import results


def section(title):
    return ["", title, "-" * len(title)]


def step_lines(path):
    """Lines of `step,seconds` as scripts/demo writes them."""
    with open(path, encoding="utf-8", newline="") as file:
        steps = [(name, float(seconds)) for name, seconds in csv.reader(file)]
    steps.append(("total", sum(seconds for _, seconds in steps)))
    return section("Times") + [f"{name:<28}{seconds:8.1f} s" for name, seconds in steps]


def body_lines(name, path):
    with results.open_file(path, "body") as body:
        modes = results.mode_count(body)
        basis = "full finite-element basis"
        if modes:
            frequency = body["modes/frequency"][:]
            basis = f"{modes} modes, {frequency[0] / 1e3:.3g} to {frequency[-1] / 1e3:.4g} kHz"
        mass = float(np.squeeze(body["rigid/mass"][()]))
        mesh = f"{body['mesh/X'].shape[0]} nodes, {body['mesh/cell_type'].shape[0]} elements"
        sizes = f"{body['surface/face'].shape[0]} contact faces, {body['stress/nodes'].shape[0]} stress nodes"
    return [f"{name}: {mesh}, {sizes}", f"  {mass:.4g} kg, {basis}"]


def contact_lines(result):
    lines, time = section("Contact"), result["time"][:]
    for name, pair in result["contact"].items():
        total = results.total_force(pair)
        peak = int(total.argmax())
        lines.append(f"{name}: peak force {total[peak]:.5g} N at {time[peak] * 1e6:.4g} µs, "
                     f"at most {pair['count'][:].max()} nodes in contact, "
                     f"deepest penetration {pair['penetration'][:].max() * 1e6:.3g} µm")
        for label, force in results.group_forces(pair).items():
            if force.max() > 0:
                lines.append(f"  {label:<26} peak {force.max():10.5g} N at {time[force.argmax()] * 1e6:.4g} µs")
    return lines


def motion_lines(result):
    lines = section("Motion")
    for body, state in result["bodies"].items():
        speed = state["rigid_velocity"]
        for i in range(speed.shape[1]):
            unit = results.speed_unit(state, i)
            lines.append(f"{body}: speed {speed[0, i]:.5g} {unit} at the start, {speed[-1, i]:.5g} {unit} at the end")
        if speed.shape[1] == 1 and results.speed_unit(state) == "rad/s" and results.standstill(result, body):
            lines.append(f"warning: {results.standstill(result, body)}")
    return lines


def stress_lines(stress):
    lines, time = section("Stress (largest of each node set, error against the unreduced bodies)"), stress["time"][:]
    for body, name, group in results.stress_sets(stress):
        peak = results.Peak(group)
        lines.append(f"{body} {name}: von Mises {peak.value / 1e6:.4g} MPa at node {group['nodes'][peak.row]}, "
                     f"{time[peak.step] * 1e6:.4g} µs; Rankine {group['rankine'][:].max() / 1e6:.4g} MPa")
        lines.append(f"  {peak.trust()}; {peak.trust_mesh()}; {peak.trust_contact()}")
        if peak.time_error is not None:
            lines.append(f"  {peak.trust_steps()}")
    return lines


def energy_lines(result):
    energy = {name: values[:] for name, values in result["energy"].items()}
    initial = energy["kinetic"][0] + energy["elastic"][0] + energy["contact"][0]
    worst = np.abs(energy["balance"]).max()
    share = f" ({100 * worst / initial:.3g} % of the initial energy)" if initial > 0 else ""
    return section("Energy") + [
        f"at the start {initial:.5g} J, at the end {energy['kinetic'][-1]:.5g} J kinetic, {energy['elastic'][-1]:.5g} J "
        f"elastic, {energy['contact'][-1]:.5g} J contact",
        f"dissipated {energy['dissipated'][-1]:.4g} J, work of loads {energy['work'][-1]:.4g} J, "
        f"largest imbalance {worst:.3g} J{share}"]


def file_lines(folder):
    paths = sorted(os.path.join(root, name) for root, _, names in os.walk(folder) for name in names)
    return section("Files") + [f"{os.path.getsize(path) / 1e6:8.2f} MB  {os.path.relpath(path, folder)}" for path in paths]


def arguments():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("result", help="result file of `elastogear simulate`")
    parser.add_argument("stress", help="stress file of `elastogear recover`")
    parser.add_argument("--body-file", action="append", default=[], metavar="BODY=FILE")
    parser.add_argument("--times", help="CSV of step,seconds")
    parser.add_argument("--folder", help="lists the files in it")
    return parser.parse_args()


def main():
    options = arguments()
    lines = [f"elastogear: {options.result}"]
    if options.times:
        lines += step_lines(options.times)
    lines += section("Bodies")
    with results.open_file(options.result, "result") as result:
        for body, path in results.key_values(options.body_file, "--body-file").items():
            results.require_body_of_run(result, body, path)
            lines += body_lines(body, path)
        lines += contact_lines(result) + motion_lines(result) + energy_lines(result)
    with results.open_file(options.stress, "stress") as stress:
        lines += stress_lines(stress)
    if options.folder:
        lines += file_lines(options.folder)
    print("\n".join(lines))


if __name__ == "__main__":
    main()
