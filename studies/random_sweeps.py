#!/usr/bin/python3
"""Random elastic drives, size tiny, over a pitch under four loads: is every position found, and is its error smooth?

    studies/random_sweeps.py --elastogear build/release/src/app/elastogear --out random_sweeps --drives 100 --seed 1

Drives: external spur (a third) and helical gears to 35 deg, internal ones (a fifth); modules 1 to 6 mm, 9 to 70 teeth, profile shifts
-0.5 to 0.8, faces 3 to 10 modules wide, equal or not, offset along the axis or not, with or without tip relief and lead crowning;
hexahedra of 8 or of 20 nodes, without modes. Worm drives (--worms): of all forms of flank and wheel, either hand, 1 to 6 starts, modules
1 to 8 mm, 28 to 60 teeth, 15 to 25 deg, a fifth of the hobs larger than the worm. Designs that the program refuses, and pairs with a
contact ratio below 1.1 or tips below 0.2 modules, are drawn anew. Before them stand fixed drives: the test gears A of the FZG, and drives
of which positions were once lost.

Each stands at 32 roll angles under 0.001, 0.1, 1 and 5 times the torque whose tangential force is 100 MPa times module and face width,
some 300 MPa at the roots; of worms' wheels 40 MPa. Over a line of the table: positions that are found; the mean transmission error under each load; whether it
falls with the load at every angle (the first gear stays behind the more the larger its torque); outliers, positions whose transmission
error stands out of that of its two neighbours on each side by more than 0.1 of its range at that load and 0.01 um.
"""
import argparse
import os
import re
import shutil
import sys
import time

import h5py
import numpy as np

from drive_runs import Drive, Refused
from random_drives import bore, possible, text_of

LOADS = (0.001, 0.1, 1, 5)  # of the nominal torque
POSITIONS = 32
STRESS = 100e6  # Pa, tangential force over module and face width
STRESS_WORM = 40e6  # Pa, the same of the wheel of a worm
JUMP, LEAST_JUMP = 0.1, 1e-8  # of the range of the transmission error; m
HEAD = ("drive", "order", "found", *(f"{load:g}" for load in LOADS), "monotonous", "outliers", "s")


def mm(value):
    return f"{value:.5g} mm"


def fixed_drives():
    """Numbers of each drive with its order, by its name; torques are those of the drive, in N m."""
    a = {"drive": "cylindrical", "module": "4.5 mm", "centre_distance": "91.5 mm", "face_width": "20 mm",
         "pinion": {"teeth": 16, "profile_shift": 0.8635, "tip_diameter": "88.77 mm"},
         "wheel": {"teeth": 24, "profile_shift": -0.5, "tip_diameter": "112.5 mm"}, "torque": 534.5}
    helical = {"drive": "cylindrical", "module": "2 mm", "helix_angle": "20 deg", "face_width": "16 mm",
               "pinion": {"teeth": 19, "profile_shift": 0.2}, "wheel": {"teeth": 52, "bore": "30 mm"}, "torque": 40}
    spur = {"drive": "cylindrical", "module": "3 mm", "face_width": "25 mm", "pinion": {"teeth": 17, "profile_shift": 0.3},
            "wheel": {"teeth": 43, "profile_shift": 0.1}, "torque": 300}
    rack_d = {"drive": "cylindrical", "module": "3 mm", "rack": "D", "face_width": "45 mm",
              "pinion": {"teeth": 14, "profile_shift": 0.4}, "wheel": {"teeth": 45}, "torque": 150}
    named = {"fzg_a": a, "helical_20": helical, "spur_17_43": spur, "rack_d_14_45": rack_d}
    return {f"{name}_{order}": ({**numbers, "element_order": order}) for name, numbers in named.items() for order in (1, 2)}


def random_drive(random):
    m = random.uniform(1, 6)
    internal = random.random() < 0.2
    beta = 0.0 if random.random() < 0.4 else random.uniform(2, 35)
    z_1 = int(random.integers(14, 30) if internal else random.integers(9, 40))
    z_2 = z_1 + int(random.integers(18, 60) if internal else random.integers(0, 32))
    x_1, x_2 = random.uniform(-0.3, 0.5, 2) if internal else random.uniform(-0.5, 0.8, 2)
    width = random.uniform(3, 10) * m
    pinion = {"teeth": z_1, "profile_shift": round(x_1, 4), "bore": bore(m, z_1, x_1, beta)}
    wheel = {"teeth": z_2, "profile_shift": round(x_2, 4), **({"internal": "true"} if internal else {"bore": bore(m, z_2, x_2, beta)})}
    drive = {"drive": "cylindrical", "module": mm(m), "helix_angle": f"{beta:.4g} deg", "face_width": mm(width)}
    if random.random() < 0.4:
        wheel["face_width"] = mm(width * random.uniform(0.8, 1.25))
    if random.random() < 0.3:
        wheel["axial_offset"] = mm(random.uniform(-0.1, 0.1) * width)
    for gear in (pinion, wheel):
        if random.random() < 0.35:
            gear["tip_relief"] = mm(random.uniform(2e-3, 8e-3) * m)
        if random.random() < 0.35:
            gear["lead_crowning"] = mm(random.uniform(1e-3, 5e-3) * m)
    r_1 = m * z_1 / (2 * np.cos(np.radians(beta)))
    torque = float(f"{STRESS * m * width * r_1 * 1e-9:.4g}")
    return {**drive, "pinion": pinion, "wheel": wheel, "torque": torque, "element_order": int(random.integers(1, 3))}


def random_worm(random):
    m = random.uniform(1, 8)
    starts = int(random.integers(1, 7))
    quotient = random.uniform(max(7, 2.2 * starts), max(14, 2.5 * starts))
    flank, form = str(random.choice(["ZA", "ZN", "ZI", "ZK"])), str(random.choice(["throated", "cylindrical", "helical"]))
    flank = "ZI" if form == "helical" else flank
    teeth, angle = int(random.integers(28, 61)), random.uniform(15, 25)
    drive = {"drive": "worm", "module": mm(m), "pressure_angle": f"{angle:.4g} deg", "diameter_quotient": f"{quotient:.4g}",
             "hand": str(random.choice(["left", "right"])), "worm": {"starts": starts, "flank": flank}, "wheel": {"teeth": teeth, "form": form}}
    if form != "helical" and random.random() < 0.2:
        drive["hob_oversize"] = mm(random.uniform(0.1, 1) * m)
    width = 0.75 * m * (quotient + 2)  # of the worm's tip diameter
    torque = float(f"{STRESS_WORM * m * width * m * starts / 2 * 1e-9:.4g}")
    return {**drive, "torque": torque, "element_order": int(random.integers(1, 3))}


def sweep(drive):
    """Transmission error by load and position, m, nan where no equilibrium was found, and what the program says about these."""
    drive.run("reduce", "-modes", 0)
    try:
        drive.run("simulate")
        said = ""
    except Refused as why:
        said = str(why)
        if "missing in" not in said:
            raise
    drive.run("evaluate")
    found = np.full((len(LOADS), POSITIONS), np.nan)
    with h5py.File(os.path.join(drive.folder, "drive_evaluation.h5"), "r") as file:
        for number, case in file["cases"].items():
            (pair,) = (group for group in case.values() if "transmission_error" in group)
            rolls = np.round(pair["roll"][()] * POSITIONS).astype(int)
            found[int(number) - 1, rolls] = pair["transmission_error/loaded"][()]
    return found, said


def outliers(errors):
    """Positions of one load that stand out of the two neighbours on each side, the pitch being periodic; a step between two levels, where
    a pair of teeth comes or goes, does not."""
    beside = np.array([np.roll(errors, shift) for shift in (-2, -1, 1, 2)])
    out = np.fmax(errors - np.fmax.reduce(beside), np.fmin.reduce(beside) - errors)
    return np.flatnonzero(out > max(JUMP * np.ptp(errors[np.isfinite(errors)]), LEAST_JUMP)) if np.isfinite(errors).any() else out[:0]


def line_of(name, order, errors, seconds):
    """Cells of the table."""
    found = np.isfinite(errors)
    steps = np.diff(errors, axis=0)
    falls = not (steps[np.isfinite(steps)] >= 0).any()
    odd = [f"{load:g}: {', '.join(map(str, at))}" for load, at in zip(LOADS, map(outliers, errors)) if at.size]
    means = [f"{1e6 * np.nanmean(row):.4g}" if np.isfinite(row).any() else "-" for row in errors]
    return [name, str(order), f"{found.sum()} of {found.size}", *means, "yes" if falls else "no", "; ".join(odd) or "-", f"{seconds:.1f}"]


def try_drive(name, numbers, options):
    """The line of a drive in the table; None where the program refuses the design."""
    folder = os.path.join(options.out, name)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    torques = "[" + ", ".join(f"{load * numbers['torque']:.6g} N m" for load in LOADS) + "]"
    rest = {key: value for key, value in numbers.items() if key != "torque"}
    path = os.path.join(folder, "drive.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text_of({**rest, "analysis": "sweep", "sweep_positions": POSITIONS, "torques": torques}))
    drive = Drive(options.elastogear, path, folder, ["-size", "tiny"])
    if not name.startswith("random"):
        return run_drive(name, numbers, drive, options)
    try:
        facts = drive.run("mesh")
    except Refused:
        facts = ""
    module = float(re.match(r"[\d.]+", numbers["module"]).group(0))
    if facts and (numbers["drive"] == "worm" or possible(facts, module)):
        return run_drive(name, numbers, drive, options)
    shutil.rmtree(folder)
    return None


def run_drive(name, numbers, drive, options):
    start = time.process_time() + children()
    try:
        errors, said = sweep(drive)
    except Refused as why:
        errors, said = np.full((len(LOADS), POSITIONS), np.nan), str(why)
    line = line_of(name, numbers["element_order"], errors, time.process_time() + children() - start)
    if said:
        print(f"{name}: {said}", file=sys.stderr, flush=True)
    np.save(os.path.join(options.out, f"{name}.npy"), errors)
    if not said and line[-2] == "-" and line[-3] == "yes" and not options.keep:
        shutil.rmtree(drive.folder)
    return line


def children():
    """CPU time of finished runs, s."""
    times = os.times()
    return times.children_user + times.children_system


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True, help="folder; drives with lost positions or outliers stay in it")
    parser.add_argument("--drives", type=int, default=100, help="random ones")
    parser.add_argument("--worms", action="store_true", help="worm drives in place of cylindrical ones")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", help="a drive's name, random_<number> or one of the fixed ones")
    parser.add_argument("--keep", action="store_true", help="all folders")
    options = parser.parse_args()
    print("| " + " | ".join(HEAD) + " |\n|" + "---|" * len(HEAD), flush=True)
    counts = {"drives": 0, "found": 0, "all": 0}

    def show(name, numbers):
        if options.only not in (None, name):
            return True
        line = try_drive(name, numbers, options)
        if line:
            print("| " + " | ".join(line) + " |", flush=True)
            found, of_all = map(int, line[2].split(" of "))
            counts.update(drives=counts["drives"] + 1, found=counts["found"] + found, all=counts["all"] + of_all)
        return line is not None

    for name, numbers in ({} if options.worms else fixed_drives()).items():
        show(name, numbers)
    random, number, run = np.random.default_rng(options.seed), 0, 0
    while run < options.drives:
        number += 1
        run += show(f"random_{number}", (random_worm if options.worms else random_drive)(random))
    print(f"\n{counts['found']} of {counts['all']} positions of {counts['drives']} drives found")


if __name__ == "__main__":
    main()
