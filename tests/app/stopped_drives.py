#!/usr/bin/python3
"""A drive in time that is asked to stop (SIGTERM) after any of its steps, and once more as it goes on, ends in the result of one that was not:
equal to the bit in every dataset, at stations, by penalty at nodes and where a gear is viscoelastic. What another program left is refused with the remedy.

    stopped_drives.py PATH/TO/elastogear PATH/TO/libfaults.so [SEED]

The steps are drawn anew in each run of the test, from the seed that it prints.
"""
import os
import random
import re
import subprocess
import sys
import tempfile

import h5py

PROGRAM, FAULTS = (os.path.abspath(path) for path in sys.argv[1:3])
SEED = int(sys.argv[3]) if len(sys.argv) > 3 else random.SystemRandom().randrange(10**6)
DRIVE = """drive: cylindrical
module: 3 mm
face_width: 9 mm
size: tiny
element_order: 1
pinion: {teeth: 12, profile_shift: 0.5}
wheel: {teeth: 13, profile_shift: 0.3}
torque: 20 N m
modes: 4
analysis: dynamic
speed: 1000 rpm
contact: {friction: 0.1, friction_speed: 0.01}
ts_max_time: 1e-5
output_dt: 7e-7
"""
POLYMER = ["-pinion_material_E", "3e9", "-pinion_material_nu", "0.4", "-pinion_material_rho", "1400", "-pinion_material_prony_tau", "1e-5,1e-3", "-pinion_material_prony",
           "0.2,0.3", "-moduli", "relaxing", "-torque", "0.5 N m"]
# What is reduced anew, or nothing; options of simulate.
CASES = {
    "stations, steps that the run chooses": ([], []),
    "stations, a rigid wheel, fixed steps": ([], ["-wheel_rigid", "-ts_dt", "1e-6"]),
    "penalty at nodes, friction that sticks": ([], ["-contact_law", "penalty", "-contact_points", "nodes", "-contact_friction_law", "stick"]),
    "a viscoelastic pinion at stations": (POLYMER, POLYMER),
    "a viscoelastic pinion at nodes, no penalty": ([], [*POLYMER, "-contact_points", "nodes"]),
}


def start(*arguments, after=None):
    """after: SIGTERM comes when that many checkpoints are there, of which each step makes one."""
    environment = dict(os.environ)
    if after:
        environment.update(LD_PRELOAD=f"{FAULTS}:{os.environ.get('LD_PRELOAD', '')}", FAULT="term", FAULT_AT=str(after), FAULT_CALL="renamed",
                           FAULT_FILE="state.h5", ASAN_OPTIONS=os.environ.get("ASAN_OPTIONS", "") + ":verify_asan_link_order=0")
        arguments = (*arguments, "-checkpoint_every", "0")
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=False, env=environment)


def good(*arguments):
    done = start(*arguments)
    assert done.returncode == 0, f"{arguments}: {done.stdout[-1000:]}{done.stderr}"
    return done.stdout


def refused(pattern, *arguments):
    done = start(*arguments)
    assert done.returncode != 0 and re.search(pattern, done.stderr), f"{arguments}: {pattern}: {done.stdout[-1000:]}{done.stderr}"


def stopped(after, *arguments):
    done = start(*arguments, after=after)
    assert done.returncode != 0 and "stopped by signal 15" in done.stderr, f"{arguments}, after {after}: {done.stdout[-1000:]}{done.stderr}"
    return done.stdout


def numbers(path):
    """Shape and bytes of every dataset of numbers."""
    found = {}
    with h5py.File(path) as file:
        assert file.attrs["complete"] == 1, path
        file.visititems(lambda name, item: found.update({name: (item.shape, item[()].tobytes())})
                        if isinstance(item, h5py.Dataset) and item.dtype != object else None)
    return found


def steps_of(screen):
    return int(re.search(r"^ *time steps +(\d+)", screen, re.M).group(1))


def check(name, options, draw):
    run = ["simulate", "drive.yaml", *options]
    steps = steps_of(good(*run, "-output", "whole.h5"))
    whole = numbers("whole.h5")
    with h5py.File("whole.h5") as file:
        assert all(pair["count"][:].max() > 0 for pair in file["contact"].values()), name
    first = draw.randint(1, steps - 4)
    second = draw.randint(1, steps - first - 3)
    stopped(first, *run, "-output", "cut.h5")
    stopped(second, *run, "-output", "cut.h5")
    assert "continued after" in good(*run, "-output", "cut.h5")
    cut = numbers("cut.h5")
    different = [key for key in whole.keys() | cut.keys() if whole.get(key) != cut.get(key)]
    print(f"{name}: {steps} steps, stopped after {first} and {second} more, {len(whole)} datasets", flush=True)
    assert not different, f"{name}: differ from the whole run: {sorted(different)}"


def check_refusals():
    """A checkpoint with a number less, and one of an earlier format, are none to go on from, nor is any for a sweep; they stay as they are."""
    run = ["simulate", "drive.yaml", "-output", "other.h5"]
    stopped(3, *run)
    os.remove("other.h5")
    refused(r"other.h5.partial holds a run that did not end, until t = .*-output leaves it there, -resume discard removes it", *run,
            "-analysis", "sweep", "-sweep_positions", "2")
    with h5py.File("other.h5.partial/state.h5", "r+") as file:
        state = file["state"][:]
        del file["state"]
        file.create_dataset("state", data=state[:-1], chunks=(len(state) - 1,), fletcher32=True).attrs["unit"] = "1"
    for way in "auto", "anyway":
        refused(r"other.h5.partial: .*another version of the program.*-resume discard begins anew", *run, "-resume", way)
    assert not os.path.exists("other.h5")
    with h5py.File("other.h5.partial/state.h5", "r+") as file:
        file.attrs["version"] = file.attrs["version"] - 1
    refused(r"state.h5: has version \d+ .*-resume discard begins anew", *run, "-resume", "anyway")
    good(*run, "-resume", "discard")
    assert numbers("other.h5").keys() and not os.path.exists("other.h5.partial")


def main():
    print("seed", SEED)
    draw = random.Random(SEED)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        with open("drive.yaml", "w", encoding="utf-8") as file:
            file.write(DRIVE)
        good("reduce", "drive.yaml")
        check_refusals()
        for name, (anew, options) in CASES.items():
            if anew:
                good("reduce", "drive.yaml", *anew)
            check(name, options, draw)
        os.chdir("/")


if __name__ == "__main__":
    main()
