#!/usr/bin/python3
"""Worn depth of two spur gears (m = 3 mm, 17/23 teeth, 9 mm wide) on meshes of two sizes, after one sweep, beside the closed form
k F' v_s / v_r with the forces of the first mesh:

    studies/wear_meshes.py --elastogear build/release/src/app/elastogear --out wear_meshes [--sizes tiny small]

Where one pair bears the force per width is that of the torque, F' = T / (r_b b), so that the depth there is known: v_s is the
sliding speed and v_r the speed of the contact along the flank, both of the rigid involutes.
"""
import argparse
import os

import numpy as np

from drive_runs import Drive, involute, results

MODULE, TEETH, SHIFTS, WIDTH, TORQUE, K, TURNS = 3e-3, (17, 23), (0.3, 0.1), 9e-3, 50, 1e-18, 1e6
DRIVE = f"""drive: cylindrical
module: 3 mm
face_width: 9 mm
pinion: {{teeth: {TEETH[0]}, profile_shift: {SHIFTS[0]}}}
wheel: {{teeth: {TEETH[1]}, profile_shift: {SHIFTS[1]}}}
torque: {TORQUE} N m
modes: 4
stress_nodes: ''
wear: {{coefficient: 1e-9 mm^3/(N m), increment: 1 mm, revolutions: {TURNS:g}, cells_along: 24, cells_across: 4}}
"""
ALPHA = np.radians(20)


def working_angle():
    """Transverse; teeth without thinning would have no backlash."""
    wanted = involute(ALPHA) + 2 * np.tan(ALPHA) * sum(SHIFTS) / sum(TEETH)
    low, high = 0.1, 1.0
    for _ in range(100):
        middle = (low + high) / 2
        low, high = (middle, high) if involute(middle) < wanted else (low, middle)
    return low


def closed_form(gear, u):
    """Depth where one pair bears, m, of gear 0 or 1 at lengths of roll u, after all revolutions of the first gear."""
    r_b = [MODULE * z / 2 * np.cos(ALPHA) for z in TEETH]
    line = sum(r_b) * np.tan(working_angle())  # m, between the base circles' points of touch
    # Speeds per rad of the first gear: of the contact along both flanks, which are length of roll times angular speed.
    omega = (1, TEETH[0] / TEETH[1])
    own, mate = u * omega[gear], (line - u) * omega[1 - gear]
    return K * TURNS * omega[gear] * TORQUE / r_b[0] / WIDTH * np.abs(own - mate) / own


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--sizes", nargs="+", default=["tiny", "small"])
    parser.add_argument("--positions", type=int, default=32)
    options = parser.parse_args()
    os.makedirs(options.out, exist_ok=True)
    path = os.path.join(options.out, "drive.yaml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(DRIVE)
    first = {}
    for size in options.sizes:
        drive = Drive(options.elastogear, path, os.path.join(options.out, size), ["-size", size])
        drive.reduce()
        drive.run("wear", "-sweep_positions", options.positions, "-output", "wear.h5")
        with results.open_file(os.path.join(drive.folder, "wear.h5"), "wear") as file:
            for i, gear in enumerate(("pinion", "wheel")):
                depth, u = file[gear]["left"][:].mean(axis=1), file[gear]["roll"][:]
                known = first.setdefault(gear, depth)
                share = depth / closed_form(i, u)
                single = share > 0.97  # about where one pair bears
                print(f"{size} {gear}: mass {1e6 * file[gear]['mass'][-1]:.4f} mg, largest depth {1e6 * depth.max():.4f} um, "
                      f"from the first mesh {100 * np.abs(depth - known).max() / known.max():.2f} % of its largest, "
                      f"{100 * np.abs(depth - known).sum() / known.sum():.2f} % in the mean; over the closed form in {single.sum()} cells "
                      + " ".join(f"{value:.3f}" for value in share), flush=True)


if __name__ == "__main__":
    main()
