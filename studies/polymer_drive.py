#!/usr/bin/python3
"""The reference worm drive with its wheel of steel and with teeth and rim of PA66 on a steel hub, at three temperatures, in one table.

    studies/polymer_drive.py --elastogear build/release/src/app/elastogear --out polymer_drive
    studies/polymer_drive.py --elastogear build/release/src/app/elastogear --out polymer_drive --full

Size tiny, 50 modes a body, the files of examples/worm_gear: the impact at 14 rad/s; 2 and 4 N m on the worm for an hour, the wheel
held; rolling with the worm at 1200 1/min and 82 N m on the wheel, which grow within 5 ms, for 55 ms, more than a turn of the worm.
With --full the wheel of PA66 at 50 °C in 50, 100 and 200 modes beside the unreduced one, under a worm of 100 modes, all with a penalty:
impact for 0.5 ms, the hour under 4 N m, the first 2.6 ms of rolling without the damping of the material, which residual flexibility lacks.
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
SPEED, TORQUE, RATIO, TEETH = 14.0, 4.0, 20.5, 41  # rad/s, N m, of the worm
WORM_SPEED, ROLLING, PITCH = 40 * np.pi, 55e-3, 25e-3  # rad/s, s, s
DRIVEN = """bodies: [worm, wheel]
worm:
  file: worm.h5
  joint: revolute
  axis: [0, 0, 1]
  position: [0, 0.05, 0]
  rotation: [2.221441469079183, 0, 2.221441469079183]
  rotation_motion: [speed, {speed}]
  damping: {{beta: 5e-6}}
wheel:
  joint: revolute
  axis: [0, 0, 1]
  angle0: 0.07662421106316569
  omega0: {wheel_speed}
  torque: [ramp, {torque}, 5e-3]
  damping: {{beta: 5e-6}}
contact: {{pairs: [worm:wheel], two_pass: true}}
ts: {{dt: 4e-6, max_time: {duration}}}
simulate: {{output_dt: 5e-5}}
"""


MODES = (50, 100, 200)  # of the wheel beside the unreduced one
CASES = {"impact": ("impact.yaml", "wheel", "-ts_max_time 0.5e-3"),
         "creep": ("turn_in.yaml", "worm", "-analysis static -time_under_load 3600"),
         "rolling": ("driven.yaml", "wheel", "-worm_damping_beta 0 -wheel_damping_beta 0 -ts_dt 2e-6 -ts_max_time 2.6e-3 -output_dt 2e-5")}


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


def stiffness(angle, at):
    """kN m/rad at the wheel, between half the torque and the whole."""
    return 1e-3 * RATIO**2 * TORQUE / 2 / (angle[1][at] - angle[0][at])


def rolling_rows(result):
    """Of the last pitch, after the start has died away."""
    late = result["time"][:] > ROLLING - PITCH
    turned = {body: result[f"bodies/{body}/rigid"][:, 0] - result[f"bodies/{body}/rigid"][0, 0] for body in ("worm", "wheel")}
    assert turned["worm"][-1] > 2 * np.pi
    error = 1e3 * (turned["wheel"] - turned["worm"] / RATIO)[late]
    force = np.linalg.norm(result["contact/worm:wheel/force"][:], axis=1)[late]
    teeth = (np.linalg.norm(result["contact/worm:wheel/groups/b/force"][:], axis=2) > 0).sum(axis=1)[late]
    relaxation = result["energy/relaxation"][:][late] if "energy/relaxation" in result else np.zeros(late.sum())
    power = (relaxation[-1] - relaxation[0]) / (result["time"][-1] - result["time"][:][late][0])
    return {"rolling: force, mean and most [N]": f"{force.mean():.0f}, {force.max():.0f}",
            "teeth in contact, mean (contact ratio) and most": f"{teeth.mean():.2f}, {teeth.max()}",
            "range of the transmission error [mrad]": f"{np.ptp(error):.2f}",
            "heat of the material [W]": f"{power:.3f}",
            "of each tooth in its contact [mJ]": f"{1e3 * power * PITCH:.2f}",
            "mean of each tooth [mW]": f"{1e3 * power / TEETH:.2f}",
            "largest error of the balance of energy [mJ]": f"{1e3 * abs(result['energy/balance'][:]).max():.3f}"}


def rows_of(drive):
    """What the table says of one wheel."""
    rows = {}
    with h5py.File(drive.simulate("impact", "impact.yaml")) as result:
        rows["impact: peak force [N]"] = f"{peak_force(result):.0f}"
        rows["speed after 0.5 ms, away from the worm, over that before"] = f"{-result['bodies/wheel/rigid_velocity'][-1, 0] / SPEED:.3f}"
        rows["taken by the material [mJ]"] = f"{taken(result):.2f}"
    rows["largest stress at the wheel's roots [MPa]"] = f"{drive.root_stress('impact', 'impact.yaml').max():.1f}"
    held = ["-analysis", "static"] if drive.name == "steel" else ["-analysis", "static", "-time_under_load", 3600]
    angle = []
    for torque, what in ((TORQUE / 2, "turn_in_half"), (TORQUE, "turn_in")):
        with h5py.File(drive.simulate(what, "turn_in.yaml", *held, "-worm_torque", torque)) as result:
            angle.append(result["bodies/worm/rigid"][:, 0])
    loaded = 0 if drive.name != "steel" else -1
    turn = np.degrees(angle[1])
    rows["turn-in: the worm's turn at once, after an hour [degrees]"] = f"{turn[loaded]:.2f}, {turn[-1]:.2f}"
    rows["stiffness of the mesh at once, after an hour [kN m/rad]"] = f"{stiffness(angle, loaded):.1f}, {stiffness(angle, -1):.1f}"
    stress = drive.root_stress("turn_in", "turn_in.yaml")
    rows["stress at the wheel's roots at once, after an hour [MPa]"] = f"{stress[loaded]:.1f}, {stress[-1]:.1f}"
    with h5py.File(drive.simulate("rolling", os.path.abspath("driven.yaml"))) as result:
        return rows | rolling_rows(result)


def beside_full(program, steps):
    """Largest differences over all times from the unreduced wheel, each over the largest value."""
    names = {"worm": "worm.yaml", "wheel": "wheel_pa66.yaml"}
    for body, file in names.items():
        steps.run(f"mesh of the {body}", [program, "mesh", str(EXAMPLES / file), "-mesh", f"{body}.msh"], f"{body}_mesh.log")

    def reduce(body, basis, modes, output):
        mesh = ["-mesh", f"{body}.msh"]
        steps.run(output, [program, "reduce", str(EXAMPLES / names[body]), *mesh, "-basis", basis, "-modes", str(modes), "-output", output], output + ".log")

    reduce("worm", "modal_residual", 100, "worm_100.h5")
    reduce("wheel", "full", 1, "wheel_full.h5")
    for modes in MODES:
        reduce("wheel", "modal_residual", modes, f"wheel_{modes}.h5")
    print("\n| | modes | motion | force, a vector | stress, worm's roots | stress, wheel's roots | taken by the material |\n|---|---|---|---|---|---|---|")
    for what, (file, body, options) in CASES.items():
        found = {}
        for wheel in ("full", *MODES):
            files = ["-worm_file", "worm_100.h5", "-wheel_file", f"wheel_{wheel}.h5"]
            result, stress = f"{what}_{wheel}.h5", f"{what}_{wheel}_stress.h5"
            path = str(EXAMPLES / file) if file != "driven.yaml" else os.path.abspath(file)
            steps.run(f"{what}, {wheel}", [program, "simulate", path, *files, "-contact_law", "penalty", *options.split(), "-output", result], result + ".log")
            steps.run(f"{what}, {wheel}, stress", [program, "recover", path, *files, "-result", result, "-stress_worm", "root", "-stress_wheel", "root",
                                                  "-field_times", "", "-output", stress], stress + ".log")
            with h5py.File(result) as run, h5py.File(stress) as at:
                angle = run[f"bodies/{body}/rigid"][:, 0]
                found[wheel] = [angle - angle[0], run["contact/worm:wheel/force"][:], at["worm/root/stress"][:], at["wheel/root/stress"][:],
                                run["energy/relaxation"][:]]
        for modes in MODES:
            off = [abs(a - b).max() / abs(b).max() for a, b in zip(found[modes], found["full"])]
            print(f"| {what} | {modes} | " + " | ".join(f"{100 * value:.2g} %" for value in off) + " |", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--elastogear", required=True, help="the program")
    parser.add_argument("--out", default="polymer_drive", help="folder for all files")
    parser.add_argument("--full", action="store_true", help="beside the unreduced wheel")
    arguments = parser.parse_args()
    program = os.path.abspath(arguments.elastogear)
    os.makedirs(arguments.out, exist_ok=True)
    os.chdir(arguments.out)
    steps, columns = Steps(), {}
    with open("driven.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVEN.format(speed=WORM_SPEED, wheel_speed=WORM_SPEED / RATIO, torque=-TORQUE * RATIO, duration=ROLLING))
    if arguments.full:
        beside_full(program, steps)
        return
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
