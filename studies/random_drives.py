#!/usr/bin/python3
"""Random possible drives of rigid gears, size tiny, over one pitch: unmodified flanks transmit without error.

    studies/random_drives.py --elastogear build/release/src/app/elastogear --out random_drives cylindrical worm

Cylindrical: two external gears of 6 to 120 teeth, helix angle 0 (two of five) to 35 deg, profile shifts -0.5 to 0.8, modules 0.5 to
10 mm, 4 to 15 modules wide. Possible are pairs that the program accepts with a contact ratio of at least 1.1 and tips of at least 0.2
modules. Worm: 1 to 6 starts, 20 to 124 teeth, diameter quotient 7 to 14, pressure angle 14 to 25 deg, the same modules.

Each stands at eight roll angles over a pitch under a torque that gives 2 MPa times module and face width as tangential force. Its
transmission error is how far the first gear is from where exact rigid flanks touch, times its base radius (worm: times z1/z2 and the
wheel's pitch radius); it holds where that is below 0.2 um at every angle. Refused designs are counted by their reasons; where the
message names a value that would do, the drive with it must not be refused for that reason again, and a little beyond it (tip diameters
0.1 %, profile shifts 0.02, values of worm drives 1.5 %) must be.

--numbers 17 40 takes the drives from the 17th to the 40th that are drawn, in place of as many as --designs asks for.
"""
import argparse
import collections
import math
import os
import re
import shutil
import time

import numpy as np

from drive_runs import Drive, Refused

LIMIT = 0.2e-6  # m, transmission error
LOAD = 2e6  # Pa, tangential force over module and face width
ROLLS = np.arange(8) / 8
RIGID_BODIES = ["-basis", "full", "-store", "surface"]  # without eigenmodes, which rigid bodies have no use for
LEAST_CONTACT_RATIO, LEAST_TIP = 1.1, 0.2  # -, modules


def cylindrical(random):
    """Numbers of a drive file, and m that turn rad of the first gear into the transmission error."""
    m, beta = random.uniform(0.5, 10), 0.0 if random.random() < 0.4 else random.uniform(0, 35)
    z_1 = 6 + int(60 * random.random() ** 2)
    z_2 = max(z_1, int(random.uniform(6, 121)))
    width = random.uniform(4, 15) * m
    x_1, x_2 = random.uniform(-0.5, 0.8, 2)
    r_1 = m * z_1 / (2 * np.cos(np.radians(beta)))  # mm
    alpha_t = np.arctan(np.tan(np.radians(20)) / np.cos(np.radians(beta)))
    gears = {"pinion": {"teeth": z_1, "profile_shift": x_1, "bore": bore(m, z_1, x_1, beta)},
             "wheel": {"teeth": z_2, "profile_shift": x_2, "bore": bore(m, z_2, x_2, beta)}}
    drive = {"drive": "cylindrical", "module": f"{m:.6g} mm", "helix_angle": f"{beta:.6g} deg", "face_width": f"{width:.6g} mm",
             "torque": f"{LOAD * m * width * r_1 * 1e-9:.6g} N m", **gears}
    return drive, r_1 * 1e-3 * np.cos(alpha_t), m


def bore(m, z, x, beta):
    """Of a ring 1.5 modules thick under the root, which saves cells; at least a tenth of the root diameter."""
    root = m * z / np.cos(np.radians(beta)) + 2 * m * (x - 1.25)
    return f"{max(0.1 * root, root - 3 * m):.6g} mm"


def worm(random):
    m, alpha = random.uniform(0.5, 10), random.uniform(14, 25)
    z_1 = int(random.uniform(1, 7))
    z_2 = 4 * z_1 + int(random.uniform(16, 100))
    q = random.uniform(7, 14)
    gamma = np.arctan(z_1 / q)
    r_1, r_2 = m / np.cos(gamma) * q / 2, m / np.cos(gamma) * z_2 / 2
    drive = {"drive": "worm", "module": f"{m:.6g} mm", "pressure_angle": f"{alpha:.6g} deg", "diameter_quotient": q,
             "worm": {"starts": z_1}, "wheel": {"teeth": z_2}, "torque": f"{LOAD * 8 * m * m * r_1 * 1e-9:.6g} N m"}
    return drive, r_2 * 1e-3 * z_1 / z_2, m


def text_of(numbers):
    def value(v):
        return "{" + ", ".join(f"{k}: {value(w)}" for k, w in v.items()) + "}" if isinstance(v, dict) else str(v)
    return "".join(f"{key}: {value(v)}\n" for key, v in numbers.items())


def drive_of(numbers, options, name):
    folder = os.path.join(options.out, name)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    path = os.path.join(folder, "drive.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text_of(numbers))
    return Drive(options.elastogear, path, folder, ["-size", "tiny"])


def possible(facts, m):
    """Whether a pair that the program accepts counts; of worm drives all do."""
    ratio = float(re.search(r"contact ratio +([\d.e+-]+)", facts).group(1))
    tips = [float(tip) for tip in re.findall(r"tip thickness +([\d.e+-]+) mm", facts)]
    return ratio >= LEAST_CONTACT_RATIO and all(tip >= LEAST_TIP * m for tip in tips)


def errors(drive, bodies, radius):
    """Transmission error at each roll angle, m."""
    rigid = [word for body in bodies for word in (f"-{body}_rigid", "true")]
    drive.reduce(*RIGID_BODIES)
    found = []
    for roll in ROLLS:
        state = drive.at(roll, *rigid, "-contact_law", "unilateral", "-static_steps", 1)
        found.append((state.angle - state.start) * radius)
    return np.array(found)


def reason(message):
    """What a refusal says, without numbers."""
    message = message.split("error: ")[-1]
    return re.sub(r"-?\d[\d.e+-]*", "#", message)


def cause(message):
    """The reason without the remedy."""
    return reason(message).split(";")[0].split(": take")[0]


def refusal(numbers, options, name):
    """The program's message; empty for a drive that it accepts."""
    try:
        drive_of(numbers, options, name).run("mesh")
        return ""
    except Refused as why:
        return str(why)


def of_gears(numbers, key, unit, **values):
    changed = {gear: {**numbers[gear], key: f"{value:.9g}{unit}"} for gear, value in values.items()}
    return {**numbers, **changed}


# Each of these takes what a message names and returns the drive with it, and drives a little beyond it, one of which must be refused
# for the same cause.

def tip_diameter(numbers, gear, value):
    value = float(value)
    return (of_gears(numbers, "tip_diameter", " mm", **{gear: value * (1 - 1e-6)}),
            [of_gears(numbers, "tip_diameter", " mm", **{gear: value * (1 + 1e-3)})])


def least_shift(numbers, gear, value, away=-0.02):
    return (of_gears(numbers, "profile_shift", "", **{gear: float(value)}),
            [of_gears(numbers, "profile_shift", "", **{gear: float(value) + away})])


def largest_shift(numbers, gear, value):
    return least_shift(numbers, gear, value, 0.02)


def two_shifts(numbers, *values_and_gears):
    shift = {gear: float(value) for value, gear in zip(values_and_gears[::2], values_and_gears[1::2])}
    back = {gear: x - np.copysign(0.02, x - numbers[gear]["profile_shift"]) for gear, x in shift.items()}
    return of_gears(numbers, "profile_shift", "", **shift), [of_gears(numbers, "profile_shift", "", **back)]


def sum_of_shifts(numbers, value):
    def with_sum(total):
        return of_gears(numbers, "profile_shift", "", pinion=total - numbers["wheel"]["profile_shift"])
    return with_sum(float(value) + 1e-5), [with_sum(float(value) - 1e-3)]


def of_worm_drive(numbers, key, value, unit):
    def with_value(value):
        return {**numbers, key: f"{value * (1e3 if unit == 'm' else 1):.9g} {'mm' if unit == 'm' else unit}"}
    value = float(value)
    return with_value(value), [with_value(value * 0.985), with_value(value * 1.015)]


NUMBER = r"(-?[\d.]+(?:e[+-]?\d+)?)"
REMEDIES = ((rf"(pinion|wheel):.*tip_diameter (?:of at most|below) {NUMBER}", tip_diameter),
            (rf"profile_shift of (pinion|wheel) of at least {NUMBER} would", least_shift),
            (rf"profile_shift of (pinion|wheel) of at most {NUMBER} would", largest_shift),
            (rf"profile_shift {NUMBER} of (pinion|wheel) and {NUMBER} of (pinion|wheel) would", two_shifts),
            (rf"their sum must be above {NUMBER}", sum_of_shifts),
            (rf"the nearest value that does, all others kept: (\w+) = {NUMBER} (m|deg)", of_worm_drive))


def remedied(numbers, message, options, name):
    """Whether the value that a message names is the nearest one that would do; None where it names none."""
    for pattern, remedy in REMEDIES:
        found = re.search(pattern, message)
        if not found:
            continue
        mended, beyond = remedy(numbers, *found.groups())

        def again(changed):
            return cause(refusal(changed, options, name)) == cause(message)
        return not again(mended) and any(again(other) for other in beyond)
    return None


class Tally:
    def __init__(self):
        self.held, self.failed, self.refused = 0, [], collections.Counter()
        self.remedies, self.seconds, self.largest = collections.Counter(), [], []

    def count(self):
        return self.held + len(self.failed)


def try_design(kind, drawn, number, options, tally):
    numbers, radius, m = drawn
    name = f"{kind}_{number}"
    start = time.monotonic()
    drive = drive_of(numbers, options, name)
    try:
        facts = drive.run("mesh")
    except Refused as why:
        print(f"{name}: refused: {why}", flush=True)
        tally.refused[reason(str(why))] += 1
        held = remedied(numbers, str(why), options, name)
        tally.remedies[held] += 1
        if held is False:
            print(f"{name}: the value named does not do, or is not the nearest: {why}\n{text_of(numbers)}", flush=True)
        shutil.rmtree(drive.folder)
        return
    if kind == "cylindrical" and not possible(facts, m):
        tally.refused["(accepted, but no possible design)"] += 1
        shutil.rmtree(drive.folder)
        return
    try:
        found = errors(drive, ("pinion" if kind == "cylindrical" else "worm", "wheel"), radius)
        largest = np.abs(found).max()
        why = "" if largest < LIMIT else " ".join(f"{1e6 * e:.3f}" for e in found) + " um"
    except Refused as refused:
        largest, why = np.nan, str(refused)
    tally.seconds.append(time.monotonic() - start)
    tally.largest.append(largest)
    if why:
        tally.failed.append(name)
        print(f"{name}: does not hold: {why}\n{text_of(numbers)}", flush=True)
    else:
        tally.held += 1
        shutil.rmtree(drive.folder)
    print(f"{name}: {1e6 * largest:.4f} um, {tally.seconds[-1]:.1f} s", flush=True)


def report(kind, tally):
    if tally.count() > 0:
        print(f"{kind}: {tally.held} of {tally.count()} hold; transmission error, median {1e6 * np.nanmedian(tally.largest):.4f} um; "
              f"{np.median(tally.seconds):.1f} s a design, {max(tally.seconds):.1f} s the longest")
    print(f"{kind}: refused or passed over: {sum(tally.refused.values())}")
    for why, count in tally.refused.most_common():
        print(f"  {count:5d}  {why}")
    print(f"{kind}: values named in refusals: {tally.remedies[True]} right, {tally.remedies[False]} wrong; "
          f"{tally.remedies[None]} refusals name none", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("kinds", nargs="+", choices=["cylindrical", "worm"])
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--designs", type=int, default=200, help="possible ones")
    parser.add_argument("--numbers", type=int, nargs=2, metavar=("FIRST", "LAST"))
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    for kind in options.kinds:
        random, tally, number = np.random.default_rng(options.seed), Tally(), 0
        first, last = options.numbers or (1, math.inf)
        while number < last and (options.numbers or tally.count() < options.designs):
            number += 1
            drawn = {"cylindrical": cylindrical, "worm": worm}[kind](random)
            if number >= first:
                try_design(kind, drawn, number, options, tally)
        report(kind, tally)


if __name__ == "__main__":
    main()
