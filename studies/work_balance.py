#!/usr/bin/python3
"""Work balance of a drive at rest over one pitch: without friction the work of the torque on the first gear less that on the held one
is what the elastic bodies store,

    T1 dphi_1 - T2 dphi_2 = dU,

and as U comes back after a pitch, the mean of T2 over it is T1 z2 / z1; rigid perfect gears have it at every moment.

    studies/work_balance.py --elastogear build/release/src/app/elastogear --out work_balance examples/drives/spur_c14.yaml ...

Angles and moments are those of the result, the moment on the held gear that of its contact forces. Derivatives are central
differences over --step of a pitch around each position; the last two columns repeat them over half of it, which shows their own
error. What follows `--` goes to reduce and simulate.
"""
import argparse
import os
import sys

import numpy as np

from drive_runs import Drive, Refused

def rates(before, after):
    """Work of T1, work on the held gear and change of the energy between two near positions, J."""
    return (after.load * (after.angle - before.angle), (after.torque + before.torque) / 2 * after.turned_since(before),
            after.energy - before.energy)


def balance(drive, roll, step):
    """Changes of the energy and what is missing, as shares of T1 dphi_1, over a step around a position and over half of it."""
    row = []
    for half in (step / 2, step / 4):
        driven, transmitted, stored = rates(drive.at(roll - half), drive.at(roll + half))
        row += [stored / driven, (driven - transmitted - stored) / driven]
    return row


def ratio(first, last):
    """dphi_1 / dphi_2 between two positions a whole pitch apart."""
    return (last.angle - first.angle) / last.turned_since(first)


def print_torque(name, torque, expected):
    error = 100 * (torque / expected - 1)
    print(f"{name}: T2 {expected:.4f} N m expected: mean {error.mean():+.4f} %, {error.min():+.3f} to {error.max():+.3f} %", flush=True)


def row_at(drive, roll, step):
    state = drive.at(roll)
    row = [roll, state.torque, state.energy, *balance(drive, roll, step)]
    print("".join(f"{value:13.5g}" for value in row), flush=True)
    return row


def elastic(name, drive, rolls, step):
    print(f"{name}, elastic: roll, T2 (N m), U (J); dU and what is missing, shares of T1 dphi_1, over the step; over half of it")
    first, last = drive.at(rolls[0]), drive.at(rolls[0] + 1)
    rows = []
    for roll in rolls:
        try:
            rows.append(row_at(drive, roll, step))
        except Refused as why:
            print(f"{roll:13.5g} left out: {why}", flush=True)
    rows = np.array(rows)
    print_torque(f"{name}, elastic, {len(rows)} of {len(rolls)} positions", rows[:, 1], first.load * ratio(first, last))
    dU, missing, _, missing_half = 100 * np.abs(rows[:, 3:]).max(axis=0)
    print(f"{name}, elastic: dU up to {dU:.3f} %, missing up to {missing:.4f} %, over half the step {missing_half:.4f} % of T1 dphi_1; "
          f"half of the positions {100 * np.median(np.abs(rows[:, 4])):.2g} %", flush=True)
    return first


def rigid(name, drive, rolls, bodies):
    options = ["-contact_law", "unilateral", "-static_steps", 1]
    for body in bodies:
        options += [f"-{body}_rigid", "true"]
    states = [drive.at(roll, *options) for roll in [*rolls, rolls[0] + 1]]
    print_torque(f"{name}, rigid", np.array([state.torque for state in states[:-1]]), states[0].load * ratio(states[0], states[-1]))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("drives", nargs="+")
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--positions", type=int, default=32)
    parser.add_argument("--step", type=float, default=1 / 256, help="of a pitch")
    end = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    options, more = parser.parse_args(sys.argv[1:end]), sys.argv[end + 1:]
    for path in options.drives:
        name = os.path.splitext(os.path.basename(path))[0]
        drive = Drive(options.elastogear, path, os.path.join(options.out, name), more)
        drive.reduce()
        rolls = np.arange(options.positions) / options.positions
        first = elastic(name, drive, rolls, options.step)
        rigid(name, drive, rolls, (first.first, first.second))


if __name__ == "__main__":
    main()
