#!/usr/bin/python3
"""One command makes what the verbs make, and makes anew what has changed and nothing else.

    run.py PATH/TO/elastogear PATH/TO/mpirun
"""
import json
import os
import re
import resource
import subprocess
import sys
import tempfile

import h5py

ELASTOGEAR, MPIRUN = os.path.abspath(sys.argv[1]), sys.argv[2]
DRIVE = """drive: cylindrical
element_order: 1
module: 3 mm
face_width: 9 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 23, profile_shift: 0.1}
torque: 50 N m
modes: 4
sweep_positions: 3
"""


def run(*arguments, ranks=0):
    # The page is tested apart.
    page = ["-report", "none"] if arguments[0] in ("run", "drive.yaml", "accurate.yaml") and "-report" not in arguments else []
    command = [ELASTOGEAR, *arguments, *page]
    if ranks:
        command = [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-n", str(ranks), *command]
    done = subprocess.run(command, capture_output=True, text=True, check=False, env={**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1"})
    assert done.returncode == 0, f"{arguments}: {done.stdout[-800:]}{done.stderr}"
    return done.stdout


def made(said):
    """Which of bodies and result were made anew."""
    return "the bodies are there" not in said, "the result is there" not in said


def figures(file="drive_evaluation.json"):
    with open(file, encoding="utf-8") as text:
        return json.load(text)


def write(**changed):
    with open("drive.yaml", "w", encoding="utf-8") as file:
        lines = [line for line in DRIVE.splitlines() if line.split(":")[0] not in changed]
        file.write("\n".join(lines) + "\n" + "".join(f"{key}: {value}\n" for key, value in changed.items()))


def accurate():
    """Meshes are refined until the estimate is below what is asked, and figures have their errors."""
    drive = "\n".join(line for line in DRIVE.splitlines() if line.split(":")[0] not in ("element_order", "modes"))
    with open("accurate.yaml", "w", encoding="utf-8") as file:
        file.write(drive + "\naccuracy: 60 %\n")
    said = run("accurate.yaml")
    assert said.count("are there") == 0 and "60 % asked" in said, said
    pair = figures("accurate_evaluation.json")["cases"][0]["pairs"]["pinion:wheel"]
    of_mesh = [pair["root"]["pinion"]["largest_tension"], pair["root"]["pinion"]["largest_tension_mesh_error"]]
    assert 0 < of_mesh[1]["value"] < 0.6 * of_mesh[0]["value"], of_mesh
    # What limits the accuracy is made smaller by the same key; the mesh's error holds that of the contact's resolution.
    limit = next(line for line in said.splitlines() if "limited by" in line)
    assert "the mesh" in limit and "-accuracy" in limit and "-size" not in limit, limit
    of_modes = pair["root"]["pinion"]["largest_tension_error"]["value"]
    assert abs(of_modes - 1e-3 * of_mesh[0]["value"]) < 1e-3 * of_mesh[0]["value"], of_modes
    assert "largest_tension_contact_error" not in pair["root"]["pinion"]
    for group, name in (("transmission_error", "peak_to_peak"), ("stiffness", "secant_mean"), ("line_load", "KHbeta")):
        assert name + "_mesh_error" in pair[group], f"{group}/{name} has no error"
    shares = {name: pair["stiffness"][name + "_mesh_error"]["value"] / pair["stiffness"][name]["value"] for name in ("secant_mean", "secant_per_width")}
    assert abs(shares["secant_mean"] - shares["secant_per_width"]) < 1e-9, shares
    # Each order of the transmission error has its own, and the lowest ones are on the screen with it.
    with h5py.File("accurate_evaluation.h5") as file:
        error = next(iter(file["cases"].values()))["pinion:wheel/transmission_error"]
        amplitude, errors = error["amplitude"][()], error["amplitude_mesh_error"][()]
    assert errors.shape == amplitude.shape and errors.min() == sorted(errors[:5])[len(errors[:5]) // 2] > 0, errors
    assert re.search(r"orders of the mesh 1: [\d.]+ \+- [\d.]+", said), said
    assert pair["teeth"]["largest_share"]["value"] == 1 and "largest_share_mesh_error" not in pair["teeth"], pair["teeth"]
    assert made(run("accurate.yaml")) == (False, False)
    parts = ("largest_tension_mesh_error", "largest_tension_error")
    life_with_error({of: sum(pair["root"][of][part]["value"] for part in parts) / pair["root"][of]["largest_tension"]["value"]
                     for of in ("pinion", "wheel")})
    # A finer mesh where that is asked; the coarser ones are there. Without the memory for it the forecast is that of the mesh's first
    # run, and the next start gives the same answer and makes nothing.
    asked = ("-accuracy", "%g %%" % (90 * of_mesh[1]["value"] / of_mesh[0]["value"]))
    first = within(1, "accurate.yaml", *asked)
    forecast = accuracy_in(first)
    assert "not reached: the next mesh would take about" in forecast and made(first) == (False, False), first
    assert accuracy_in(within(1, "accurate.yaml", *asked)) == forecast
    needed = 1e9 * float(re.search(r"and ([\d.]+) GB", forecast)[1])
    assert accuracy_in(within(0.98 * needed, "accurate.yaml", *asked)) == forecast
    finer = run("accurate.yaml", *asked)
    assert "1.5/accurate_evaluation.h5" in run("accurate.yaml", "-accuracy", "60 %") and "2 times" in finer, finer
    # Another load is solved on all meshes whose bodies are there.
    said = run("accurate.yaml", "-torque", "45 N m")
    assert re.findall(r"mesh +counts ([\d.]+) times", said) == ["1", "1.5", "2"] and said.count("the bodies are there") == 3, said
    # Bodies of static responses alone are not for motions.
    refused = subprocess.run([ELASTOGEAR, "simulate", "accurate.yaml", "-analysis", "dynamic", "-ts_max_time", "1e-6"],
                             capture_output=True, text=True, check=False)
    assert refused.returncode != 0 and "has no modes" in refused.stderr, refused.stderr


def within(memory, *arguments):
    """A run under `ulimit -m` of so many bytes."""
    before = resource.getrlimit(resource.RLIMIT_RSS)
    resource.setrlimit(resource.RLIMIT_RSS, (int(memory), before[1]))
    try:
        return run(*arguments)
    finally:
        resource.setrlimit(resource.RLIMIT_RSS, before)


def accuracy_in(said):
    return next(line for line in said.splitlines() if line.split()[:1] == ["accuracy"])


def life_with_error(share):
    """Bodies of a run tell no error of their mesh: a life takes that of the largest tension. Damage goes with the stress to the fifth."""
    strength = ("-sn_knee_stress", "1 MPa", "-mean_stress", "none", "-duty_cycle", "50 N m, 1e5", "-damage_field", "false")
    said = run("life", "accurate.yaml", *strength)
    assert "is not estimated" not in said, said
    for of in figures("accurate_life.json")["sets"]:
        times = of["damage_with_error"] / of["damage"]
        assert abs(times / (1 + share[of["body"]])**5 - 1) < 1e-6, (of["body"], times, share)
    # The evaluation is not of another result.
    run("simulate", "accurate.yaml", "-analysis", "sweep", "-refinement", "1.5", "-modes", "0", "-output", "other.h5")
    said = run("life", "accurate.yaml", *strength, "-files", "other.h5", "-output", "other_life.h5")
    assert "is not estimated" in said, said


def page():
    """The page is made of the drive as it was run, kept while nothing has changed, and left out where that is asked."""
    assert not os.path.exists("drive_report.html")
    said = run("drive.yaml", "-report", "page")
    if "not made" in said:  # without npm
        assert "report.py" in said, said
        return
    made_at = os.stat("drive_report.html").st_mtime_ns
    run("drive.yaml", "-report", "page")
    assert os.stat("drive_report.html").st_mtime_ns == made_at, "made again"
    run("drive.yaml", "-report", "page", "-torque", "45 N m")
    with open("drive_report.html", encoding="utf-8") as file:
        assert "45 in this run" in file.read()


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        write()
        assert made(run("drive.yaml")) == (True, True)
        first = figures()
        assert made(run("run", "drive.yaml")) == (False, False)
        assert figures() == first
        for verb in (("reduce",), ("simulate", "-analysis", "sweep"), ("evaluate",)):
            run(verb[0], "drive.yaml", *verb[1:])
        assert figures() == first, "the verbs give others"
        # What another command line has said is not said by this one.
        run("drive.yaml", "-torque", "30 N m")
        assert re.search("by the command line of simulate torque 30 N m for 50 N m of the drive file", run("evaluate", "drive.yaml"))
        assert made(run("drive.yaml")) == (False, True)
        assert figures() == first
        # An equilibrium at one roll angle is no sweep.
        run("simulate", "drive.yaml")
        assert "one roll angle alone" in run("evaluate", "drive.yaml")
        assert made(run("drive.yaml")) == (False, True)
        assert figures() == first
        # A speed moves nothing at rest without friction; what is read off takes it.
        write(speed="100 rad/s")
        assert made(run("drive.yaml")) == (False, False)
        write(torque="40 N m")
        assert made(run("drive.yaml")) == (False, True)
        assert figures() != first
        write(face_width="10 mm")
        assert made(run("drive.yaml")) == (True, True)
        write()
        assert made(run("drive.yaml", ranks=2)) == (True, True)
        assert made(run("drive.yaml")) == (False, False)
        # A result as former versions of the program left it cannot be evaluated.
        with h5py.File("drive_result.h5", "r+") as file:
            del file["provenance/run"]
        assert made(run("drive.yaml")) == (False, True)
        # Bodies that were made anew by their own verb have another result.
        run("reduce", "drive.yaml", "-modes", "8")
        assert made(run("drive.yaml")) == (False, True)
        accurate()
        page()
        os.chdir("/")
    print("one command makes all")


if __name__ == "__main__":
    main()
