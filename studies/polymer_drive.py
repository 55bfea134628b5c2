#!/usr/bin/python3
"""The reference worm drive with its wheel of steel and with teeth and rim of PA66 on a steel hub, at three temperatures, in one table.

    studies/polymer_drive.py --elastogear build/release/src/app/elastogear --out polymer_drive

Size tiny, 50 modes a body, the files of examples/worm_gear: the impact at 14 rad/s; 4 N m on the worm for an hour, the wheel held;
rolling under 4 N m from the start of the teeth's contact, on the faces as they are (contact_surface facets).
"""
import argparse
import os
import pathlib
import sys

import h5py
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
sys.path.append(str(ROOT / "scripts"))
from steps import Steps

EXAMPLES = ROOT / "examples" / "worm_gear"
WHEELS = {"steel": None, "PA66, 20 °C": 20, "PA66, 50 °C": 50, "PA66, 80 °C": 80}
SPEED, TORQUE, RATIO = 14.0, 4.0, 20.5  # rad/s, N m
ROLLING = 6e-3  # s


class Drive:
    """Runs of one wheel; files lie in the present folder."""

    def __init__(self, program, steps, name):
        self.program, self.steps, self.name = program, steps, name
        self.key = "".join(c for c in name if c.isalnum())

    def run(self, verb, what, *words):
        self.steps.run(f"{self.name}: {what}", [self.program, verb, *map(str, words)], f"{self.key}_{what.replace(' ', '_')}.log")

    def reduce(self, temperature):
        wheel = EXAMPLES / ("wheel.yaml" if temperature is None else "wheel_pa66.yaml")
        warm = [] if temperature is None else ["-material_rim_temperature", f"{temperature}degC"]
        self.run("mesh", "mesh", wheel, "-mesh", f"{self.key}.msh")
        self.run("reduce", "reduce", wheel, "-mesh", f"{self.key}.msh", "-modes", 50, *warm, "-output", f"{self.key}.h5")

    def simulate(self, what, file, *more):
        output = f"{self.key}_{what}.h5"
        self.run("simulate", what, EXAMPLES / file, "-wheel_file", f"{self.key}.h5", *more, "-output", output)
        return output

    def root_stress(self, what, file):
        """MPa, largest von Mises stress at the wheel's roots at each output time."""
        output = f"{self.key}_{what}_stress.h5"
        self.run("recover", f"{what} stress", EXAMPLES / file, "-wheel_file", f"{self.key}.h5", "-result", f"{self.key}_{what}.h5",
                 "-field_times", "", "-output", output)
        with h5py.File(output) as stress:
            return 1e-6 * stress["wheel/root/von_mises"][:].max(axis=1)


def taken(result):
    """mJ, taken by the material."""
    return 1e3 * result["energy/relaxation"][-1] if "energy/relaxation" in result else 0.0


def peak_force(result):
    return np.linalg.norm(result["contact/worm:wheel/force"][:], axis=1).max()


def rows_of(drive):
    """What the table says of one wheel."""
    rows = {}
    with h5py.File(drive.simulate("impact", "impact.yaml")) as result:
        rows["impact: peak force [N]"] = f"{peak_force(result):.0f}"
        rows["speed after 0.5 ms, away from the worm, over that before"] = f"{-result['bodies/wheel/rigid_velocity'][-1, 0] / SPEED:.3f}"
        rows["taken by the material [mJ]"] = f"{taken(result):.2f}"
    rows["largest stress at the wheel's roots [MPa]"] = f"{drive.root_stress('impact', 'impact.yaml').max():.1f}"
    held = ["-analysis", "static"] if drive.name == "steel" else ["-analysis", "static", "-time_under_load", 3600]
    with h5py.File(drive.simulate("turn_in", "turn_in.yaml", *held)) as result:
        angle = np.degrees(result["bodies/worm/rigid"][:, 0])
        loaded = 0 if drive.name != "steel" else -1
        rows["turn-in: the worm's turn at once, after an hour [degrees]"] = f"{angle[loaded]:.2f}, {angle[-1]:.2f}"
    stress = drive.root_stress("turn_in", "turn_in.yaml")
    rows["stress at the wheel's roots at once, after an hour [MPa]"] = f"{stress[loaded]:.1f}, {stress[-1]:.1f}"
    with h5py.File(drive.simulate("rolling", "rolling.yaml", "-ts_max_time", ROLLING, "-contact_surface", "facets")) as result:
        late = result["time"][:] > ROLLING / 2
        turned = {body: result[f"bodies/{body}/rigid"][:, 0] - result[f"bodies/{body}/rigid"][0, 0] for body in ("worm", "wheel")}
        error = 1e3 * (turned["wheel"] - turned["worm"] / RATIO)[late]
        teeth = (np.linalg.norm(result["contact/worm:wheel/groups/b/force"][:], axis=2) > 0).sum(axis=1)[late]
        rows["rolling: peak force [N]"] = f"{peak_force(result):.0f}"
        rows["teeth in contact, mean and most"] = f"{teeth.mean():.1f}, {teeth.max()}"
        rows["range of the transmission error [mrad]"] = f"{error.max() - error.min():.2f}"
        rows["taken by the material in 6 ms [mJ]"] = f"{taken(result):.1f}"
        rows["balance of energy [mJ]"] = f"{1e3 * abs(result['energy/balance'][:]).max():.2f}"
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True, help="the program")
    parser.add_argument("--out", default="polymer_drive", help="folder for all files")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.elastogear)
    os.makedirs(arguments.out, exist_ok=True)
    os.chdir(arguments.out)
    steps, columns = Steps(), {}
    worm = Drive(program, steps, "worm")
    worm.run("mesh", "mesh", EXAMPLES / "worm.yaml", "-mesh", "worm.msh")
    worm.run("reduce", "reduce", EXAMPLES / "worm.yaml", "-mesh", "worm.msh", "-modes", 50, "-output", "worm.h5")
    for name, temperature in WHEELS.items():
        drive = Drive(program, steps, name)
        drive.reduce(temperature)
        columns[name] = rows_of(drive)
    print("\n| | " + " | ".join(columns) + " |\n|" + "---|" * (1 + len(columns)))
    for row in columns["steel"]:
        print(f"| {row} | " + " | ".join(column[row] for column in columns.values()) + " |")


main()
