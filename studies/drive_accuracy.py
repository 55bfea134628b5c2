#!/usr/bin/python3
"""What `elastogear drive.yaml` says by default, beside the same on much finer meshes, as the tables of docs/validation/gears.md:

    studies/drive_accuracy.py --elastogear build/release/src/app/elastogear --out drive_accuracy [--drives readme,c14]

The finest mesh has `--times` (default 3) times the counts of size tiny. Where the default one is as fine already, there is no true
error. What is there already is read again.
"""
import argparse
import json
import os
import subprocess
import sys
import time

import h5py

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "scripts"))
import figures

COMMON = "drive: cylindrical\n"
DRIVES = {
    "readme": ("README's pair, 17/43 teeth", """module: 3 mm
face_width: 25 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 43, profile_shift: 0.1}
torque: 300 N m
"""),
    "fzg_a": ("FZG A, 16/24 teeth", """module: 4.5 mm
centre_distance: 91.5 mm
face_width: 20 mm
pinion: {teeth: 16, profile_shift: 0.8635, tip_diameter: 88.77 mm}
wheel: {teeth: 24, profile_shift: -0.5, tip_diameter: 112.5 mm}
torque: 534.5 N m
"""),
    "c14": ("FZG C14, 16/24 teeth", """module: 4.5 mm
centre_distance: 91.5 mm
face_width: 14 mm
pinion: {teeth: 16, profile_shift: 0.1817, tip_diameter: 82.635 mm}
wheel: {teeth: 24, profile_shift: 0.1715, tip_diameter: 118.544 mm}
torque: 200 N m
"""),
    "helical": ("helical, 25 deg, 19/41 teeth", """module: 2 mm
helix_angle: 25 deg
face_width: 16 mm
pinion: {teeth: 19, profile_shift: 0.2}
wheel: {teeth: 41}
torque: 40 N m
"""),
    "internal": ("internal, 21/72 teeth", """module: 2 mm
face_width: 16 mm
gears: [pinion, ring]
pinion: {teeth: 21, profile_shift: 0.1}
ring: {teeth: 72, internal: true, profile_shift: -0.2}
torque: 60 N m
"""),
    "planets": ("planet stage, 24/24/72 teeth", """module: 2 mm
face_width: 16 mm
gears: [sun, planet_1, planet_2, planet_3, ring]
sun: {teeth: 24}
planet_1: {teeth: 24, mate: sun}
planet_2: {teeth: 24, mate: sun, direction: 120 deg}
planet_3: {teeth: 24, mate: sun, direction: 240 deg}
ring: {teeth: 72, internal: true, mate: [planet_1, planet_2, planet_3]}
torque: 120 N m
"""),
    "pa66": ("wheel of PA66, 17/43 teeth", """module: 2 mm
face_width: 15 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 43, profile_shift: 0.1, material: {E: 2.8 GPa, nu: 0.4, rho: 1140}}
torque: 5 N m
"""),
    "steering": ("steering worm, 2/41, ZI, cylindrical wheel", """drive: worm
module: 2 mm
pressure_angle: 15 deg
centre_distance: 50 mm
worm: {starts: 2}
wheel: {teeth: 41, bore: 24 mm}
torque: 4 N m
"""),
    "crane": ("crane worm, 1/40, ZI, throated wheel", """drive: worm
module: 6.3 mm
diameter_quotient: 10
worm: {starts: 1}
wheel: {teeth: 40, form: throated}
torque: 40 N m
"""),
}
FIGURES = (("transmission_error/mean", "transmission error, mean", "um", 1e6), ("transmission_error/peak_to_peak", "peak to peak", "um", 1e6),
           ("stiffness/secant_mean", "mesh stiffness", "N/um", 1e-6), ("pressure/hertz_peak", "flank pressure", "MPa", 1e-6),
           ("line_load/KHbeta", "KHbeta", "", 1))
ERRORS = ("_mesh_error", "_error")


class Figure:
    def __init__(self, items, name):
        self.value = items[name]["value"]
        self.error = sum(max(0, items[name + of]["value"]) for of in ERRORS if name + of in items)


def flat(groups, path=""):
    """Items by their whole paths."""
    if "value" in groups:
        return {path: groups}
    return {name: item for key, group in groups.items() if isinstance(group, dict) for name, item in flat(group, f"{path}/{key}" if path else key).items()}


def run(options, key, folder, *more):
    """Figures of the pairs by name, and the seconds that the run took."""
    os.makedirs(folder, exist_ok=True)
    path = os.path.join(folder, "drive.yaml")
    with open(path, "w", encoding="utf-8") as file:
        text = DRIVES[key][1]
        file.write(text if text.startswith("drive:") else COMMON + text)
    start, stamp = time.monotonic(), os.path.join(folder, "seconds.txt")
    if not os.path.exists(stamp):
        with open(os.path.join(folder, "log.txt"), "w", encoding="utf-8") as log:
            subprocess.run([os.path.abspath(options.elastogear), "run", "drive.yaml", "-report", "none", *more], cwd=folder, stdout=log, stderr=log, check=True)
        with open(stamp, "w", encoding="utf-8") as file:
            file.write(f"{time.monotonic() - start:.0f}")
    with open(os.path.join(folder, "drive_evaluation.json"), encoding="utf-8") as file:
        pairs = json.load(file)["cases"][0]["pairs"]
    with open(stamp, encoding="utf-8") as file:
        return {name: flat(of) for name, of in pairs.items()}, float(file.read())


def roots(pairs):
    """The largest tension of each kind of gear, planets together."""
    found = {}
    for name, items in pairs.items():
        for path in items:
            if path.startswith("root/") and path.endswith("/largest_tension"):
                kind = path.split("/")[1].rstrip("0123456789").rstrip("_")
                figure = Figure(items, path)
                if kind not in found or found[kind].value < figure.value:
                    found[kind] = figure
    return found


def compare(options, key):
    """Rows of a drive: (figure, default, finest), and the refinement of the default meshes."""
    default, _ = run(options, key, os.path.join(options.out, key), *(["-accuracy", options.accuracy] if options.accuracy else []))
    finest, _ = run(options, key, os.path.join(options.out, f"{key}_{options.times}"), "-refinement", options.times, "-modes", "0")
    rows = [(f"root of the {kind}", "MPa", 1e-6, figure, roots(finest)[kind]) for kind, figure in roots(default).items()]
    pair = next(iter(default))
    rows += [(label, unit, factor, Figure(default[pair], path), Figure(finest[pair], path)) for path, label, unit, factor in FIGURES
             if path in default[pair]]
    with h5py.File(os.path.join(options.out, key, "drive_evaluation.h5")) as file:
        refinement = float(file["provenance"].attrs["option_refinement"])
    return rows, refinement


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True)
    parser.add_argument("--out", required=True)
    parser.add_argument("--times", default="3", help="counts of the finest mesh over those of size tiny")
    parser.add_argument("--drives", default=",".join(DRIVES), help="of " + ", ".join(DRIVES))
    parser.add_argument("--accuracy", help="asked for in place of the default, '1 %%'")
    options = parser.parse_args()
    print("| drive | figure | default | finest | off by | estimate |\n|---|---|---|---|---|---|")
    within, all_of = 0, 0
    for key in options.drives.split(","):
        rows, refinement = compare(options, key)
        is_finer = float(options.times) > refinement
        for i, (label, unit, factor, default, finest) in enumerate(rows):
            off, estimate = (100 * x / abs(finest.value) for x in (abs(default.value - finest.value), default.error))
            if is_finer:
                within, all_of = within + (off <= estimate), all_of + 1
            name = f"{DRIVES[key][0]}; counts times {refinement:g}" if i == 0 else ""
            if is_finer:
                figures.figure(DRIVES[key][0], label, off / 100, unit="%")
            right = f"{factor * finest.value:.4g} {unit} | {off:.2f} %" if is_finer else "– | –"
            print(f"| {name} | {label} | {factor * default.value:.4g} {unit} | {right} | {estimate:.2f} % |".replace("  ", " "), flush=True)
    print(f"\n{within} of {all_of} true errors are within the estimate.")


if __name__ == "__main__":
    main()
