#!/usr/bin/python3
"""Figures that evaluate reads off sweeps of spur gears, against those of the result itself and closed forms: rigid perfect gears have no
transmission error, the shares of the teeth add up to one, what friction takes is missing in the output, KHbeta of rigid bodies on a
Winkler layer; HDF5, JSON and CSV say the same.

    evaluate.py PATH/TO/elastogear
"""
import csv
import json
import os
import re
import subprocess
import sys
import tempfile

import h5py
import numpy as np

DRIVE = """drive: cylindrical
element_order: 1
module: 3 mm
face_width: 25 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 43, profile_shift: 0.1}
torque: 300 N m
modes: 10
"""
ALPHA, TEETH, T_1, WIDTH = np.radians(20), (17, 43), 300, 25e-3
R_B = [3e-3 * z / 2 * np.cos(ALPHA) for z in TEETH]
UM = 1e-6
SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
RIGID = ("-pinion_rigid", "true", "-wheel_rigid", "true")
LAYER = (*RIGID, "-contact_law", "penalty", "-contact_penalty", "per_area", "-contact_points", "nodes",
         "-contact_stiffness", "2e13")


class Drive:
    def __init__(self, elastogear):
        self.elastogear = elastogear

    def call(self, *arguments):
        return subprocess.run([self.elastogear, *arguments], capture_output=True, text=True, check=False)

    def run(self, *arguments):
        done = self.call(*arguments)
        assert done.returncode == 0, f"{arguments}: {done.stdout[-800:]}{done.stderr}"
        return done.stdout

    def sweep(self, positions, *options):
        self.run("simulate", "drive.yaml", "-analysis", "sweep", "-sweep_positions", str(positions), "-resume", "discard", *options)

    def evaluate(self, *options):
        """Figures of the first case."""
        self.run("evaluate", "drive.yaml", *options)
        return Figures("drive_evaluation")

    def refusal(self, words, *arguments):
        done = self.call(*arguments)
        assert done.returncode != 0 and words in done.stderr, f"{arguments}: '{words}' not in {done.stdout[-200:]}{done.stderr}"


class Figures:
    def __init__(self, stem):
        with open(stem + ".json", encoding="utf-8") as file:
            self.case = json.load(file)["cases"][0]
        self.file = h5py.File(stem + ".h5")
        self.pair = next(iter(self.file["cases"].values()))["pinion:wheel"]

    def __getitem__(self, path):
        return self.pair[path][()]

    def __contains__(self, path):
        return path in self.pair

    def in_json(self, path):
        node = self.case["pairs"]["pinion:wheel"]
        for key in path.split("/"):
            node = node[key]
        return node["value"]


def near(what, value, expected, allowed):
    print(f"{what}: {value:.8g}, expected {expected:.8g} within {allowed:.2g}")
    assert abs(value - expected) <= allowed, what


def check_elastic(drive):
    drive.sweep(16)
    short = drive.run("evaluate", "drive.yaml").splitlines()
    assert len(short) <= 30, short
    for line in (r"tension at the roots +largest principal stress in the fillets", r"  pinion +\d+ \+- \d+ MPa, tooth \d+, root of the left \(drive\) flank, diameter 4\d\.\d mm, z -?\d+\.\d mm",
                 r"  limited by +the mesh, [\d.]+ of [\d.]+ MPa at \w+; remedy: elastogear run with -accuracy in place of -size", r"  flank pressure +1\d{3} MPa by H. Hertz", r"  load sharing .*KHbeta 1\.0"):
        assert any(re.search(line, text) for text in short), f"'{line}' is not printed: {short}"
    text = drive.run("evaluate", "drive.yaml", "-verbose")
    for word in ("transmission error", "mesh stiffness, secant", "operating contact ratio", "a pair of teeth is loaded", "KHbeta", "by H. Hertz", "root of pinion, tension", ", by the mesh ", "loss per coefficient of friction"):
        assert word in text, f"'{word}' is not printed"
    figures = Figures("drive_evaluation")
    with h5py.File("drive_result.h5") as result:
        angle, roll = result["bodies/pinion/rigid"][:, 0], result["time"][:]
        force = np.linalg.norm(result["contact/pinion:wheel/points/force"][:], axis=1).sum() / len(roll)
    # The wheel stands at its nominal angles, the pinion is ahead: the wheel lags.
    error = -(angle + np.pi / 2 - 2 * np.pi * roll / TEETH[0]) * TEETH[0] / TEETH[1] * R_B[1]
    near("transmission error, mean", figures["transmission_error/mean"], error.mean(), 1e-12)
    near("transmission error, largest difference", abs(figures["transmission_error/loaded"] - error).max(), 0, 1e-12)
    near("amplitudes of orders", np.sqrt((figures["transmission_error/amplitude"][:-1]**2).sum() / 2 +
                                         figures["transmission_error/amplitude"][-1]**2), error.std(), 1e-12)
    near("mean stiffness", figures["stiffness/secant_mean"], abs(figures["torque/second"] / R_B[1] / error).mean(), 1)
    near("sum of shares", abs(figures["teeth/share"].sum(axis=1) - 1).max(), 0, 1e-12)
    near("sum of normal forces", figures["teeth/force"].sum(axis=1).mean(), force, 1e-4 * force)
    near("contact ratio", figures["teeth/contact_ratio"], 1.6, 0.15)  # 1.516 rigid, teeth meet earlier under load
    near("path of rigid teeth", figures["teeth/path_ends"] - figures["teeth/path_begins"], 1.516, 1e-3)
    step = 1 / len(roll)
    assert figures["teeth/path_begins"] - 0.1 < figures["teeth/begins"] < figures["teeth/path_begins"] + step
    assert figures["teeth/path_ends"] - step < figures["teeth/ends"] < figures["teeth/path_ends"] + 0.1
    normal_force = figures["teeth/force"].sum(axis=1).mean()  # a little less than forces where ends of teeth cross
    near("line load over the width", figures["line_load/mean"] @ figures["line_load/width"], normal_force, 1e-6 * force)
    near("torque on the wheel", -figures["torque/second_mean"], T_1 * TEETH[1] / TEETH[0], 1e-3 * T_1 * TEETH[1] / TEETH[0])
    assert "losses/efficiency" not in figures and "efficiency" not in text, "an efficiency without friction"
    near("largest tension", figures["root/pinion/largest_tension"], figures["root/pinion/tension"].max(), 1e-3)
    near("KHbeta in JSON", figures.in_json("line_load/KHbeta"), figures["line_load/KHbeta"], 1e-12)
    at_peak = figures["pressure/hertz"].argmax()
    near("peak of Hertz's pressure", figures["pressure/hertz"][at_peak], figures["pressure/hertz_peak"], 1)
    load = np.pi / 2 * figures["pressure/hertz_peak"] * figures["pressure/hertz_half_width"]  # N/m, behind p_0 and b
    mean_load = figures["teeth/force"][at_peak].max() / WIDTH
    near("line load behind Hertz's pressure", load, 1.05 * mean_load, 0.05 * mean_load)
    near("pressure at the contacts, of its largest", figures["pressure/peak"], figures["pressure/hertz_peak"], 0.02 * figures["pressure/hertz_peak"])
    pattern = figures["pattern/wheel_left/pressure"][:].max(axis=0)
    near("pressure at the ends of the face over that of its middle", pattern[[0, -1]].min() / pattern[len(pattern) // 2], 1, 0.1)
    assert figures["root/pinion/largest_tension_error"] < 0.05 * figures["root/pinion/largest_tension"]
    assert 0 < figures["root/pinion/largest_tension_mesh_error"] < 2 * figures["root/pinion/largest_tension"]
    with open("drive_evaluation_pinion_wheel.csv", encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    near("rows of the table", len(rows), len(roll), 0)
    near("transmission error in the table", float(rows[3]["transmission error [m]"]), error[3], 1e-12)
    assert "transmission_error/mean" in drive.run("info", "drive_evaluation.h5")
    drawn = subprocess.run([os.path.join(SCRIPTS, "gear_plots.py"), "drive_evaluation.h5", "--out", "plots"], capture_output=True, text=True, check=False)
    assert drawn.returncode == 0, drawn.stderr
    for name in ("transmission_error_pinion_wheel", "load_sharing_pinion_wheel", "line_load_pinion_wheel", "pattern_wheel_left", "root_stress_pinion"):
        assert os.path.getsize(f"plots/{name}.png") > 10000, f"{name} is not drawn"


def check_friction(drive):
    drive.sweep(32, "-contact_friction", "0.08")
    figures = drive.evaluate()
    near("friction takes what the output lacks", figures["losses/friction_loss"], 1 - figures["losses/efficiency"], 2e-4)
    near("loss", figures["losses/friction_loss"], 0.08 * figures["losses/loss_factor"], 0.03 * figures["losses/friction_loss"])
    loss = figures["losses/friction_loss"]
    drive.sweep(32, "-contact_friction", "0.08", "-side", "coast")
    drive.refusal("give evaluate the option -side coast", "evaluate", "drive.yaml")
    figures = drive.evaluate("-side", "coast")
    near("friction takes what the output lacks, wheel driving", figures["losses/friction_loss"], 1 - figures["losses/efficiency"], 2e-4)
    near("loss with the wheel driving", figures["losses/friction_loss"], loss, 0.05 * loss)


def check_rigid(drive):
    drive.sweep(8, *RIGID, "-contact_law", "unilateral")
    figures = drive.evaluate()
    near("transmission error of rigid gears, peak to peak", figures["transmission_error/peak_to_peak"], 0, 0.2 * UM)
    assert "root" not in figures.pair, "rigid bodies have no stresses"


TORQUES = (1, 75, 150, 225, 300, 375, 450, 600, 900)


def layer(drive):
    """The Winkler layer that the nodes of coarse rigid gears make: at each position lags (m) and the line loads (N/m) that they give, from
    sweeps of aligned gears under TORQUES; KHbeta of the largest one."""
    with open("layer.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE.replace("torque: 300 N m", f"torques: {list(TORQUES)}"))
    drive.run("simulate", "layer.yaml", "-analysis", "sweep", "-sweep_positions", "8", "-resume", "discard", *LAYER)
    drive.run("evaluate", "layer.yaml")
    with h5py.File("layer_evaluation.h5") as file:
        pairs = [case["pinion:wheel"] for case in file["cases"].values()]
        lags = np.array([-pair["transmission_error/loaded"][:] for pair in pairs])
        loads = np.array([pair["line_load/value"][:].mean(axis=1) for pair in pairs])
        return lags.T, loads.T, pairs[-1]["line_load/KHbeta"][()]


def closed_form(lags, loads, gap, z):
    """KHbeta of rigid gears on this layer with the gap (m) at the stations z, in the mean over the positions."""
    load = []
    for lag, line_load in zip(lags, loads):
        low, high = lag[0], lag[-1] + np.ptp(gap)
        for _ in range(60):
            delta = (low + high) / 2
            w = np.interp(delta - gap, lag, line_load, left=0)
            low, high = (delta, high) if np.trapz(w, z) < T_1 / R_B[0] else (low, delta)
        load.append(w)
    mean = np.mean(load, axis=0)
    return mean.max() / (np.trapz(mean, z) / WIDTH)


def check_face_load(drive):
    lags, loads, aligned = layer(drive)
    near("KHbeta, aligned", aligned, 1, 0.005)
    slope, alpha_w = np.radians(0.03), np.arccos(sum(R_B) / 91.14711905291227e-3)
    for options, gap in ((("-wheel_skew", "0.03 deg"), lambda z: slope * np.cos(alpha_w) * z),
                         (("-wheel_lead_crowning", "12 um"), lambda z: 12e-6 * (2 * z / WIDTH)**2)):
        drive.sweep(8, *LAYER, *options)
        figures = drive.evaluate()
        z = figures["line_load/z"]
        expected = closed_form(lags, loads, gap(z), z)
        near(f"KHbeta, {' '.join(options)}", figures["line_load/KHbeta"], expected, 0.05 * expected)
        assert expected > 1.1, "the deviation has no effect"


def check_cases(drive):
    with open("loads.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE.replace("torque: 300 N m", "torques: [1 N m, 200 N m, 300 N m]"))
    drive.run("simulate", "loads.yaml", "-analysis", "sweep", "-sweep_positions", "8")
    text = drive.run("evaluate", "loads.yaml", "-output", "cases.h5")
    assert text.count("pinion:wheel") == 3, text
    assert "secant N/um" in text and "root MPa" in text, text
    with open("cases_cases.csv", encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    near("rows of the table of cases", len(rows), 3, 0)
    errors = [float(row["pinion:wheel transmission_error/mean [m]"]) for row in rows]
    assert errors[0] > errors[1] > errors[2], errors
    with h5py.File("cases.h5") as file:
        cases = list(file["cases"].values())
        assert [text.decode() for text in cases[1]["inputs/heading"][:2]] == ["torque [N m]", "variant"], cases[1]["inputs/heading"][:]
        tangent = [case["pinion:wheel/stiffness/tangent"][:] for case in cases[1:]]
        near("tangent stiffness between the same loads", abs(tangent[0] / tangent[1] - 1).max(), 0, 1e-9)
        secant = cases[2]["pinion:wheel/stiffness/secant"][:]
        assert (tangent[1] > 0.9 * secant).all(), "teeth are not softer under more load"


def check_bearings(drive):
    """Bearings of half the stiffness: what the drive is softer by along the line of action is their own deflection, as the screen says.
    Which case is which, it says, too."""
    with open("held.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE.replace("shift: 0.3", "shift: 0.3, bearings: [left, right]") + """left: {at: -20 mm, radial: 500 N/um, axial: 500 N/um}
right: {at: 20 mm, radial: 500 N/um}
variants: [stiff, soft]
variant_soft: {left: {radial: 250 N/um}, right: {radial: 250 N/um}}
""")
    drive.run("simulate", "held.yaml", "-analysis", "sweep", "-sweep_positions", "4")
    text = drive.run("evaluate", "held.yaml", "-output", "held_cases.h5")
    lines = [line.split() for line in text.splitlines()]
    assert ["case", "torque", "N", "m", "variant", "pair", "root", "of", "root", "MPa"] in [line[:10] for line in lines], text
    for case in (["1", "300", "stiff", "pinion:wheel"], ["2", "300", "soft", "pinion:wheel"]):
        assert any(line[:4] == case and line[4] in ("pinion", "wheel") for line in lines), text
    with open("held_cases_cases.csv", encoding="utf-8") as table:
        stiff, soft = [float(row["pinion:wheel stiffness/secant_mean [N/m]"]) for row in csv.DictReader(table)]
    near("compliance that softer bearings add", 1 / soft - 1 / stiff, 1 / 0.5e9 - 1 / 1e9, 0.02e-9)
    text = drive.run("evaluate", "held.yaml", "-result", "held_result/case_0001.h5")
    assert re.search(r"mesh stiffness .*\(secant, with the deflection of the bearings\)", text), text


def check_in_time(drive):
    """Rigid gears on springs at 200 rad/s, over 2.2 pitches, beside a body that is no gear."""
    with open("drive.yaml", "a", encoding="utf-8") as file:
        file.write("bodies: [pinion, wheel, rotor]\nrotor: {mass: 1, inertia: [1e-3, 1e-3, 1e-3, 0, 0, 0], joint: revolute}\n")
    drive.run("simulate", "drive.yaml", "-analysis", "dynamic", "-speed", "200 rad/s", "-ts_dt", "2e-5", "-ts_max_time", "4.5e-3", "-sensors_hub",
              "wheel.frame", "-output", "run.h5", "-resume", "discard", *LAYER)
    figures = drive.evaluate("-result", "run.h5", "-from", "4e-4")
    roll, time = figures["roll"], figures["time"]
    assert time[0] >= 4e-4
    near("roll angle per time", np.polyfit(time, roll, 1)[0], 200 * TEETH[0] / (2 * np.pi), 0.01 * 200 * TEETH[0] / (2 * np.pi))
    with h5py.File("run.h5") as result:
        force = np.linalg.norm(result["contact/pinion:wheel/force"][:], axis=1)[-len(time):]
        turned = [result[f"bodies/{gear}/rigid"][-len(time):, 0] for gear in ("pinion", "wheel")]
    near("dynamic factor", figures["force/dynamic_factor"], force.max() / force.mean(), 1e-9)
    change = -R_B[1] * np.diff(turned[1] + turned[0] * TEETH[0] / TEETH[1])
    near("dynamic transmission error, its changes", abs(np.diff(figures["transmission_error/loaded"]) - change).max(), 0, 1e-12)
    pitch = np.floor(roll)
    first = np.flatnonzero(np.diff(pitch))[0] + 1
    second = np.flatnonzero(pitch > pitch[first])[0]
    near("range of the first whole pitch", figures["by_pitch/error_peak_to_peak"][0], np.ptp(figures["transmission_error/loaded"][first:second + 1]), 1e-12)
    near("speed of it", figures["by_pitch/speed"][0], 2 * np.pi / TEETH[0] * (roll[second] - roll[first]) / (time[second] - time[first]), 1e-9)
    assert "sensors/hub/acceleration_y/amplitude" in next(iter(figures.file["cases"].values())), "no spectrum of the sensor"
    figures = drive.evaluate("-result", "run.h5", "-to", "1e-3")
    assert any("no orders" in note for note in figures.case["notes"]), figures.case["notes"]


def check_prescribed(drive):
    """The pinion turns as a table says, from where flanks touch on; the wheel bears the torque."""
    time = np.linspace(0, 5e-3, 51)
    np.savetxt("run_up.csv", np.stack([time, 200 * time + 2e4 * time**2], axis=1), delimiter=",")
    drive.run("simulate", "drive.yaml", "-analysis", "dynamic", "-pinion_rotation_motion", "table,run_up.csv", "-speed", "200 rad/s", "-ts_dt", "2e-5",
              "-ts_max_time", "4.5e-3", "-output", "run_up.h5", *LAYER)
    figures = drive.evaluate("-result", "run_up.h5", "-from", "1e-3")
    t = figures["time"]
    near("prescribed roll angle", abs(np.diff(figures["roll"] - (200 * t + 2e4 * t**2) * TEETH[0] / (2 * np.pi))).max(), 0, 1e-5)
    with h5py.File("wheel.h5") as body:
        wheel = T_1 * TEETH[1] / TEETH[0] + body["rigid/inertia"][2, 2] * 4e4 * TEETH[0] / TEETH[1]
    near("torque on the wheel in a run-up, mean", -figures["torque/second_mean"], wheel, 0.05 * wheel)
    speed = figures["by_pitch/speed"]
    assert speed.size >= 1 and 200 + 4e4 * 1e-3 < speed[0] < 200 + 4e4 * 4.5e-3, speed


def check_soft_wheel(drive):
    """Teeth of a polymer bear before and after the path of rigid ones, farther when they have relaxed, and take the load up step by step."""
    os.makedirs("soft", exist_ok=True)
    os.chdir("soft")
    polymer = "{E: 3 GPa, nu: 0.39, rho: 1140, prony_tau: [1 s, 1000 s], prony: [0.25, 0.25]}"
    with open("drive.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE.replace("torque: 300", "torque: 30").replace("profile_shift: 0.1", f"profile_shift: 0.1, material: {polymer}"))
    drive.run("reduce", "drive.yaml")
    beyond = []
    for moduli in ("instantaneous", "long_term"):
        drive.sweep(32, "-moduli", moduli)
        figures = drive.evaluate()
        beyond.append([figures["teeth/path_begins"] - figures["teeth/begins"], figures["teeth/ends"] - figures["teeth/path_ends"]])
        assert figures["root/wheel/largest_tension"] > 0
        place, force = figures["teeth/place"].ravel(), figures["teeth/force"].ravel()
        way = np.argsort(place)
        change = abs(np.diff(force[way][abs(place[way]) < 2])).max()
        assert change < 0.3 * force.max(), f"{moduli}: the force of a tooth changes by {change} N of {force.max()} within a 32nd of a pitch"
        print(f"{moduli}: a tooth bears {beyond[-1][0]:.3f} pitches before and {beyond[-1][1]:.3f} after the path of rigid ones, changes {change:.0f} N of {force.max():.0f}")
    assert min(beyond[0]) > 0.08 and beyond[1][0] > beyond[0][0] and beyond[1][1] > beyond[0][1], beyond
    os.chdir("..")


def check_misuse(drive):
    drive.refusal("there is no such result", "evaluate", "drive.yaml", "-result", "nosuch.h5")
    drive.refusal("-from and -to", "evaluate", "drive.yaml", "-from", "0.1")
    drive.refusal("drive", "evaluate", "-result", "drive_result.h5")
    drive.refusal("is not that of the run", "evaluate", "drive.yaml", "-wheel_teeth", "40")
    drive.refusal("drive_result.h5", "evaluate", "drive.yaml", "-output", "drive_result.h5")
    os.makedirs("empty", exist_ok=True)
    drive.refusal("cases.csv", "evaluate", "drive.yaml", "-result", "empty")
    with open("empty/cases.csv", "w", encoding="utf-8") as file:
        file.write("case,file\n1,nosuch.h5\n")
    drive.refusal("cases.csv, line 2", "evaluate", "drive.yaml", "-result", "empty")
    drive.refusal("result", "evaluate", "drive.yaml", "-result", "pinion.h5")


if __name__ == "__main__":
    program = os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("drive.yaml", "w", encoding="utf-8") as drive_file:
            drive_file.write(DRIVE)
        d = Drive(program)
        d.run("reduce", "drive.yaml")
        check_elastic(d)
        check_misuse(d)
        check_friction(d)
        check_rigid(d)
        check_face_load(d)
        check_cases(d)
        check_bearings(d)
        check_in_time(d)
        check_prescribed(d)
        check_soft_wheel(d)
