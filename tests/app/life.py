#!/usr/bin/python3
"""Life of gears whose stresses are known in closed form: each tooth of either gear bears one pulse of tension a revolution.

    life.py PATH/TO/elastogear PATH/TO/scripts

The stress file of a sweep over one pitch is written here. Damage by Palmgren and Miner follows from a pulse's height by hand.
"""
import json
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np

TEETH = {"pinion": 17, "wheel": 23}
SENSE = {"pinion": 1, "wheel": -1}  # in which they turn
PER_PITCH = 8
DIP = 3  # pitches from the pulse of compression to that of tension, so that they do not overlap
KNEE, KNEE_CYCLES, SLOPE, STRENGTH = 100e6, 1e6, 5, 800e6

DRIVE = """
drive: cylindrical
element_order: 1
module: 3 mm
face_width: 15 mm
pinion: {teeth: 17, profile_shift: 0.3%s}
wheel: {teeth: 23, profile_shift: 0.1}
torque: 100 N m
speed: 1500 rpm
life:
  sn: {knee_stress: 100 MPa, knee_cycles: 1e6, slope: 5, below: original}
  mean_stress: goodman
  tensile_strength: 800 MPa
"""


def pulse(angle, height):
    """Of a tooth that stands `angle` rad away from the mesh, one pitch of the pinion wide."""
    return height * np.clip(1 - np.abs(angle) / 0.4, 0, None)


def write_stresses(path, height, pitches=1, uneven=0.0, error=None):
    """Two nodes a tooth, of which the second bears half, and compression of half that before it. height: Pa, by gear."""
    roll = np.arange(pitches * PER_PITCH) / PER_PITCH
    with h5py.File(path, "w") as file:
        file.attrs["format"], file.attrs["version"] = np.bytes_("elastogear stress"), 1
        run = file.create_group("provenance/run")
        run.attrs["analysis"], run.attrs["creeps"] = np.bytes_("sweep"), 0
        run.create_group("drive").attrs.update({"roll": 0.0, "torque": 100.0, "speed": 0.0})
        file["time"] = roll
        for body, z in TEETH.items():
            tooth = np.repeat(np.arange(z), 2)
            angle = 2 * np.pi * tooth / z
            radius = np.where(np.arange(2 * z) % 2, 0.02, 0.021)
            X = np.stack([radius * np.cos(angle), radius * np.sin(angle), 0 * radius], axis=1)
            X[3] *= 1 + uneven
            place = angle + SENSE[body] * 2 * np.pi * roll[:, None] / z  # in the world
            place = (place + np.pi) % (2 * np.pi) - np.pi
            full = pulse(place, height[body])
            before = (place + SENSE[body] * DIP * 2 * np.pi / z + np.pi) % (2 * np.pi) - np.pi
            half = pulse(place, height[body] / 2) - pulse(before, height[body] / 4)
            principal = np.where(np.arange(2 * z) % 2, full, half)
            stress = np.zeros(principal.shape + (6,))
            stress[..., 2] = principal
            group = file.create_group(body + "/root")
            group["nodes"] = np.arange(100, 100 + 2 * z, dtype=np.int32)
            group["X"], group["stress"] = X, stress
            group["von_mises"], group["rankine"] = np.abs(principal), np.maximum(principal, 0)
            if error is not None:
                group["error"] = group["mesh_error"] = group["contact_error"] = group["time_error"] = error / 4 * np.abs(principal)
                group["peak_error"] = group["error"][:].max(axis=1)
    return max(np.abs(pulse(SENSE[b] * 2 * np.pi * roll / TEETH[b], 1)).max() for b in TEETH)


def goodman(low, high):
    return (high - low) / 2 / (1 - max(0, (high + low) / 2) / STRENGTH)


def expected(heights, blocks, ratio):
    """heights: Pa at 100 N m and 200 N m; blocks: torque and revolutions."""
    damage = 0
    for torque, revolutions in blocks:
        height = np.interp(torque, (100, 200), heights)
        damage += revolutions * ratio * (goodman(0, height) / KNEE)**SLOPE / KNEE_CYCLES
    return damage


def verdict_on(body, text):
    """The words on a gear above the figures of all of them: it lasts where the damage is below 1."""
    line = next(line for line in text.splitlines() if line.split()[:2] == [body, "root"])
    return " ".join(line.split()[2:]).split(": damage")[0]


def main():
    program, scripts = map(os.path.abspath, sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        look(program, scripts)
        os.chdir("/")
    print("lives are right")


def look(program, scripts):
    def run(*options, fails=None, drive="drive.yaml"):
        done = subprocess.run([program, "life", drive, *options], capture_output=True, text=True, check=False)
        if fails is None:
            assert done.returncode == 0, done.stderr
            return done.stdout
        assert done.returncode != 0 and fails in done.stderr, f"{options}: {fails} is not in {done.stderr}"
        return done.stderr

    with open("drive.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE % "")
    heights = {"pinion": (200e6, 300e6), "wheel": (240e6, 400e6)}
    for i, name in enumerate(("100.h5", "200.h5")):
        peak = write_stresses(name, {body: h[i] for body, h in heights.items()})
        assert peak == 1
    two = ("-files", "100.h5,200.h5", "-file_torques", "100 N m,200 N m")

    # A torque that was swept, one between two, and hours at the drive's speed: 2 h at 1500 rpm are 180,000 revolutions.
    text = run(*two, "-duty_cycle", "100 N m, 1e5, 150 N m, 2 h")
    blocks = ((100, 1e5), (150, 180e3))
    assert "no rating standard" in text and "the same of every tooth" in text
    with open("drive_life.json", encoding="utf-8") as file:
        summary = json.load(file)
    for one, (body, z) in zip(summary["sets"], TEETH.items()):
        damage = expected(heights[body], blocks, 17 / z)
        assert abs(one["damage"] / damage - 1) < 1e-9, (body, one["damage"], damage)
        assert abs(sum(one["damage_by_block"]) / damage - 1) < 1e-9
        assert one["node"] % 2 == 1
        life = one["life"]
        assert abs(life["revolutions_of_first_gear"] * damage / 280e3 - 1) < 1e-9
        assert abs(life["revolutions_of_this_gear"] / life["revolutions_of_first_gear"] - 17 / z) < 1e-9
        assert abs(life["hours"] * damage / (2 + 1e5 / 1500 / 60) - 1) < 1e-9
        with h5py.File("drive_life.h5") as file:
            found = file[f"{body}/root/damage"][:]
            assert np.allclose(found[1::2], damage, rtol=1e-9) and np.ptp(found[::2]) < 1e-12 * damage
            # The second nodes bear one cycle from compression to tension.
            by_hand = sum(n * 17 / z * (goodman(-h / 4, h / 2) / KNEE)**SLOPE / KNEE_CYCLES
                          for t, n in blocks for h in [np.interp(t, (100, 200), heights[body])])
            assert abs(found[0] / by_hand - 1) < 1e-9, (found[0], by_hand)
            cycles = file[f"{body}/root/critical/cycles"]
            assert abs(cycles["damage"][:].sum() / damage - 1) < 1e-9
            assert file[f"{body}/root/critical/history"].shape == (2, z * PER_PITCH)

    described = subprocess.run([program, "info", "drive_life.h5"], capture_output=True, text=True, check=True).stdout
    assert "2 blocks, 280000 revolutions" in described and "damage of wheel/root: 46 nodes" in described, described
    subprocess.run([os.path.join(scripts, "life.py"), "drive_life.h5", "--out", "pictures"], capture_output=True, check=True)
    assert sorted(os.listdir("pictures")) == ["life_pinion_root.png", "life_wheel_root.png"]

    # Stresses that err by a fifth have the life of such that are larger by a fifth.
    assert "error of the stress is not estimated" in text and summary["sets"][0]["life_with_error"] is None
    write_stresses("erring.h5", {body: h[0] for body, h in heights.items()}, error=0.2)
    text = run("-files", "erring.h5", "-duty_cycle", "100 N m, 1e5")
    assert "life at the stress and its estimated error" in text and "not estimated" not in text
    assert [verdict_on(body, text) for body in TEETH] == ["reached", "open within the error of the stress, a finer mesh decides"], text
    with open("drive_life.json", encoding="utf-8") as file:
        summary = json.load(file)
    for one, (body, z) in zip(summary["sets"], TEETH.items()):
        lives = []
        for name, factor in (("", 1), ("_with_error", 1.2)):
            damage = expected([factor * h for h in heights[body]], ((100, 1e5),), 17 / z)
            assert abs(one["damage" + name] / damage - 1) < 1e-9, (body, name, one, damage)
            lives.append(one["life" + name]["hours"] * damage)
        assert abs(lives[0] / lives[1] - 1) < 1e-9
        with h5py.File("drive_life.h5") as file:
            assert abs(file[f"{body}/root/damage_with_error"][:].max() / one["damage_with_error"] - 1) < 1e-12
    assert {verdict_on(body, run("-files", "erring.h5", "-duty_cycle", "100 N m, 1e6")) for body in TEETH} == {"not reached"}
    assert verdict_on("pinion", run("-files", "100.h5", "-file_torques", "100 N m", "-duty_cycle", "100 N m, 1e5")) == (
        "reached by the stress, whose error is not estimated")

    # Survival, a CSV file, a gear's own curve.
    with open("cycle.csv", "w", encoding="utf-8") as file:
        file.write("torque [kN m], time [min], speed [1/min]\n0.1, 120, 1500\n")
    run(*two, "-duty_cycle", "cycle.csv", "-survival", "0.9", "-sn_scatter", "1.3", "-wheel_sn_knee_stress", "200 MPa")
    with open("drive_life.json", encoding="utf-8") as file:
        pinion, wheel = json.load(file)["sets"]
    factor = 1.3**(SLOPE / 2)
    assert abs(pinion["damage"] / (factor * expected(heights["pinion"], ((100, 180e3),), 1)) - 1) < 1e-9
    assert abs(wheel["damage"] * 2**SLOPE / (factor * expected(heights["wheel"], ((100, 180e3),), 17 / 23)) - 1) < 1e-9

    # Two pitches agree with one; the torque is that of the file.
    write_stresses("pitches.h5", {body: h[0] for body, h in heights.items()}, pitches=2)
    assert "others differ by at most" in run("-files", "pitches.h5", "-duty_cycle", "100 N m, 1e5")

    one = ("-files", "100.h5", "-duty_cycle")
    before = sorted(os.listdir())
    run(*one, "300 N m, 1e5", fails="lies outside those whose stresses are known, 100 N m")
    run(*one, "-100 N m, 1e5", "-proportional", "true", fails="lies outside")
    run(*one, "100 N m, 1e5, 200 N m", fails="must be pairs of a torque")
    run(*one, "100 N m, -5", fails="must be > 0")
    run(*one, "100 MPa, 5", fails="is no unit of it")
    run(*one, "100 N m, 5 mm", fails="is no unit of it")
    run(*one, "100 N m, 2 h", "-speed", "0", fails="needs the speed")
    run(*one, "nosuch.csv", fails="nosuch.csv: there is no such file")
    run("-files", "100.h5", fails="-duty_cycle is missing")
    run("-duty_cycle", "100 N m, 1e5", fails="sweep the drive first")
    run("-files", "nosuch.h5", "-duty_cycle", "100 N m, 1e5", fails="nosuch.h5")
    run(*one, "100 N m, 1e5", "-file_torques", "1,2", fails="one for each")
    run(*one, "100 N m, 1e5", "-stress_pinion", "tip", fails="holds no stresses of pinion tip")
    run(*one, "100 N m, 1e5", "-stress_wheeel", "root", fails="wheeel")
    run(*one, "100 N m, 1e5", "-sn_slope", "0.2", fails="strength of pinion: S-N curve: slope 0.2")
    run(*one, "100 N m, 1e5", "-survival", "0.99", fails="needs its scatter")
    run(*one, "100 N m, 1e5", "-mean_stress", "gerber", fails="none, goodman, fkm")
    run(*one, "100 N m, 1e5", "-tensile_strength", "100 MPa", fails="reaches the tensile strength")
    run(*one, "100 N m, 1e5", "-output", "100.h5", fails="100.h5")
    os.rename("drive_life_wheel_root_cycles.csv", "kept.csv")
    os.mkdir("drive_life_wheel_root_cycles.csv")
    run(*one, "100 N m, 1e5", "-stress_wheel", "root,tip", fails="a folder has it")  # before it is known that there is no set tip
    os.rmdir("drive_life_wheel_root_cycles.csv")
    os.rename("kept.csv", "drive_life_wheel_root_cycles.csv")
    with open("bare.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE[:DRIVE.index("life:")] % "")
    run(*one, "100 N m, 1e5", drive="bare.yaml", fails="-sn_knee_stress is missing")
    with open("varied.yaml", "w", encoding="utf-8") as file:
        file.write(DRIVE % ", pitch_deviation: [3, 10 um]")
    run(*one, "100 N m, 1e5", drive="varied.yaml", fails="teeth of pinion differ")
    assert sorted(set(os.listdir()) - {"bare.yaml", "varied.yaml"}) == before
    write_stresses("uneven.h5", {"pinion": 1e6, "wheel": 1e6}, uneven=1e-3)
    run("-files", "uneven.h5", "-duty_cycle", "100 N m, 1", fails="no node of its own lies within")
    foreign_nodes(program, run)


def foreign_nodes(program, run):
    """A stress file of nodes that the body has not."""
    subprocess.run([program, "reduce", "drive.yaml", "-size", "tiny", "-modes", "0"], capture_output=True, check=True)
    one = ("-files", "100.h5", "-duty_cycle", "100 N m, 1e5", "-size", "tiny")
    assert "drive_life_pinion.vtu" in run(*one)
    with h5py.File("100.h5", "r+") as file:
        file["pinion/root/nodes"][3] = 10**6
    run(*one, fails="100.h5: names node 1000000 of pinion root, beyond the")
    run(*one, "-damage_field", "false")
    with h5py.File("100.h5", "r+") as file:
        file["pinion/root/nodes"][3] = -5
    run(*one, fails="100.h5: nodes of pinion/root have negative numbers")


if __name__ == "__main__":
    main()
