#!/usr/bin/python3
"""Wear of two small spur gears: the volume of one sweep is k times the sum of force and sliding over all contacts, in the velocities
that the sweep itself reports; both gears lose the same volume; wear goes on in turn with sweeps to a limit of depth. Life recovers
the stresses of a sweep itself; what teeth of either gear bear repeats from pitch to pitch.

    wear.py PATH/TO/elastogear PATH/TO/scripts
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

DRIVE = """
drive: cylindrical
element_order: 1
module: 3 mm
face_width: 9 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 23, profile_shift: 0.1}
torque: 50 N m
modes: 4
sweep_positions: 6
wear: {coefficient: 1e-9 mm^3/(N m), increment: 4 um, density: 8000}
"""
K, DENSITY = 1e-18, 8000


def largest_depths():
    with open("drive_wear.json", encoding="utf-8") as file:
        return {gear["gear"]: (gear["largest_depth_m"], gear.get("largest_depth_mesh_error_m")) for gear in json.load(file)["gears"]}


def check_error_by_mesh(run):
    """Bodies on a coarser mesh, as run leaves them, give the depth an error, by the formula of two meshes and the mean share of both
    gears; those of another input do not."""
    coarse = largest_depths()
    assert all(error is None for _, error in coarse.values()), coarse
    os.makedirs("drive_meshes/1")
    for gear in coarse:
        os.rename(f"{gear}.h5", f"drive_meshes/1/{gear}.h5")
    run("reduce", "-refinement", "1.5")
    text = run("wear", "-revolutions", "1000")
    fine = largest_depths()
    share = {gear: 3 * abs(fine[gear][0] - coarse[gear][0]) / (1.5**2 - 1) / fine[gear][0] for gear in fine}
    for gear, (depth, error) in fine.items():
        expected = depth * max(share[gear], sum(share.values()) / 2)
        assert error > 0 and abs(error / expected - 1) < 1e-9, (gear, error, expected)
    assert text.count(" +- ") == 4 and "by the mesh alone" in text, text
    with h5py.File("drive_wear.h5") as file:
        assert abs(file["wheel/largest_depth_mesh_error"][-1] / fine["wheel"][1] - 1) < 1e-12
    text = run("wear", "-revolutions", "1e12", "-limit", "1 um")  # the depth is known then, and the revolutions are not
    assert re.search(r"wear +\d+ \+- \d+ revolutions", text) and "largest depth 1 um, worn" in text, text
    before = largest_depths(), os.stat("drive_wear_pinion.csv").st_mtime_ns
    run("wear", "-revolutions", "1000", "-sweep_positions", "1", fails="has 1 position")
    assert (largest_depths(), os.stat("drive_wear_pinion.csv").st_mtime_ns) == before
    assert not [name for name in os.listdir() if "partial" in name]
    run("wear", "-revolutions", "1000", "-output", "drive_meshes/1/pinion.h5", fails="would overwrite drive_meshes/1/pinion.h5")
    run("reduce", "-refinement", "1.5", "-wheel_material_E", "3 GPa", "-wheel_material_nu", "0.4", "-wheel_material_rho", "1140")
    text = run("wear", "-revolutions", "1000")
    assert all(error is None for _, error in largest_depths().values()) and "left out" in text, text
    run("reduce", "-pinion_refinement", "2", fails="all gears of a drive have one refinement")
    run("reduce", "-refinement", "1.5", "-face_width", "8 mm")
    run("wear", "-revolutions", "1000", "-face_width", "8 mm")
    assert all(error is None for _, error in largest_depths().values())
    for gear in coarse:
        os.replace(f"drive_meshes/1/{gear}.h5", f"{gear}.h5")


def look(program, scripts):
    def run(verb, *options, fails=None):
        done = subprocess.run([program, verb, "drive.yaml", *options], capture_output=True, text=True, check=False)
        if fails is None:
            assert done.returncode == 0, done.stdout[-2000:] + done.stderr
            return done.stdout
        assert done.returncode != 0 and fails in done.stderr, f"{options}: {fails} is not in {done.stderr}"
        return done.stderr

    with open("drive.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE)
    run("wear", "-revolutions", "10", fails="pinion.h5")
    run("reduce")
    before = sorted(os.listdir())
    run("wear", fails="revolutions is missing")
    run("wear", "-revolutions", "-4", fails="revolutions")
    run("wear", "-revolutions", "4", "-coefficient", "0", fails="-coefficient is missing")
    run("wear", "-revolutions", "4", "-coefficient", "1 mm", fails="is no unit of it")
    run("wear", "-revolutions", "4", "-pinion_pitch_deviation", "3,10 um", fails="its teeth differ")
    run("wear", "-revolutions", "4", "-output", "pinion.h5", fails="pinion.h5")
    assert sorted(os.listdir()) == before

    run("wear", "-revolutions", "1000")  # less than the increment: one sweep
    with h5py.File("drive_wear_sweep.h5") as file:
        points = file["contact/pinion:wheel/points"]
        force, slip = np.linalg.norm(points["force"][:], axis=1), np.linalg.norm(points["slip"][:], axis=1)
        volume = (force * slip).sum() / 6  # m^3 of one passing for k = 1
    with h5py.File("drive_wear.h5") as file:
        for gear, z, turns in (("pinion", 17, 1000), ("wheel", 23, 1000 * 17 / 23)):
            mass = file[gear]["mass"][-1] / (DENSITY * K * z * turns)
            assert abs(mass / volume - 1) < 0.01, (gear, mass, volume)
            assert file[gear]["left"][:].max() > 0 and file[gear]["right"][:].max() == 0
        assert list(file["revolutions"][:]) == [0, 1000]

    check_error_by_mesh(run)

    text = run("wear", "-revolutions", "1e12", "-limit", "6 um", "-coefficient", "1e-9 mm^3/(N m)")
    assert "reaches the limit of depth" in text, text
    with open("drive_wear.csv", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    depth = np.array([[float(value) for value in row] for row in rows[1:]])
    assert len(depth) >= 3 and (np.diff(depth, axis=0) > 0).all()
    assert abs(max(depth[-1, 1], depth[-1, 3]) / 6e-6 - 1) < 1e-6, depth[-1]
    with open("drive_wear.json", encoding="utf-8") as file:
        assert json.load(file)["gears"][0]["gear"] == "pinion"
    described = subprocess.run([program, "info", "drive_wear.h5"], capture_output=True, text=True, check=True).stdout
    assert "wear of wheel: largest depth" in described, described
    subprocess.run([os.path.join(scripts, "wear.py"), "drive_wear.h5", "--out", "pictures"], capture_output=True, check=True)
    run("simulate", "-analysis", "sweep", "-sweep_pitches", "2")
    text = run("life", "-duty_cycle", "50 N m, 1e6, 25 N m, 1e6", "-proportional", "true", "-sn_knee_stress", "50 MPa", "-tensile_strength", "800 MPa")
    different = [float(found) for found in re.findall(r"others differ by at most ([-+.e0-9]+) MPa", text)]
    largest = [float(found) for found in re.findall(r"largest stress there ([-+.e0-9]+) MPa", text)]
    assert len(different) == len(largest) == 2 and max(different) < 0.01 * min(largest), text
    assert os.path.exists("drive_life_wheel.vtu")
    assert sorted(os.listdir("pictures")) == ["wear_course.png", "wear_pinion_left.png", "wear_wheel_left.png"]


def main():
    program, scripts = map(os.path.abspath, sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        look(program, scripts)
        os.chdir("/")
    print("wear is right")


if __name__ == "__main__":
    main()
