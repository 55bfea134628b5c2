#!/usr/bin/python3
"""Body files and results belong to their input: every key of a drive file that is changed after reduce is refused by simulate if bodies
depend on it, and every key that is changed after simulate by evaluate, by name and with both values. The keys are those that the program
itself lists.

    belongs.py PATH/TO/elastogear
"""
import os
import re
import subprocess
import sys
import tempfile

ELASTOGEAR = os.path.abspath(sys.argv[1])
DRIVE = """drive: cylindrical
element_order: 1
module: 3 mm
face_width: 9 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 23, profile_shift: 0.1}
torque: 50 N m
modes: 4
analysis: sweep
sweep_positions: 3
life: {sn_knee_stress: 50 MPa, tensile_strength: 800 MPa, duty_cycle: [50 N m, 1e6]}
wear: {coefficient: 1e-9 mm^3/(N m), increment: 4 um, revolutions: 10}
"""
# Values of keys for which "2" would not do: of other places than the one named, and words.
VALUES = {"drive": "worm", "gears": "pinion,other", "rack": "B", "helix_angle": "5", "pressure_angle": "21", "rack_addendum": "0.95",
          "rack_dedendum": "1.3", "rack_fillet": "0.3", "rack_protuberance": "0.01", "pinion_profile_shift": "0.25",
          "wheel_profile_shift": "0.15", "pinion_internal": "true", "wheel_internal": "true", "pinion_mate": "wheel", "wheel_mate": "pinion",
          "size": "small", "side": "coast", "module": "3.1 mm", "centre_distance": "61.5 mm", "wheel_centre_distance": "61.5 mm",
          "backlash": "0.1 mm", "face_width": "10 mm", "pinion_face_width": "10 mm", "wheel_face_width": "10 mm", "pinion_bore": "14 mm",
          "wheel_bore": "14 mm", "pinion_tip_diameter": "57 mm", "wheel_tip_diameter": "74 mm", "pinion_teeth": "18", "wheel_teeth": "24",
          "pinion_rim_diameter": "30 mm", "wheel_rim_diameter": "40 mm", "analysis": "static", "variants": "a"}
# Keys of a drive on which neither bodies nor results depend, and those of files, which are told by what is in them.
IDLE = {"drawing", "output", "mesh", "checkpoint_every", "resume", "sensor_csv", "ts_max_steps"}
# How modes are found, not what they are.
METHOD = {"window", "symmetry", "completeness", "nodes", "unit"}
# Keys of the gears' contact and of the run: bodies do not depend on them.
CONTACT = re.compile("tip_relief|root_relief|crowning|_slope|end_relief|_twist|pitch_deviation|run_out|topography|_wear$|_offset|inclination"
                     "|skew|bearing|_catalogue$|_at$|_radial$|_axial$|_tilt$|^torque$|^roll$|^side$|^speed$")


def call(*arguments):
    return subprocess.run([ELASTOGEAR, *arguments], capture_output=True, text=True, check=False)


def run(*arguments):
    done = call(*arguments)
    assert done.returncode == 0, f"{arguments}: {done.stdout[-800:]}{done.stderr}"
    return done.stdout


def refusal(words, *arguments):
    done = call(*arguments)
    assert done.returncode == 1 and words in done.stderr, f"{arguments}: '{words}' not in {done.stdout[-300:]}{done.stderr}"
    return done.stderr


def keys(verb, gear="pinion"):
    """Names and units of the options that a verb lists, of one of the gears."""
    rows = re.findall(r"^  -(\S+)(?: \[(.*)\])?$", run(verb, "-help", "all"), re.M)
    assert len(rows) > 100
    return {re.sub("<(gear|body|bearing)>", gear, name): unit for name, unit in rows if not re.search("<(?!gear|body|bearing)", name)}


def changed(entries, drive=DRIVE):
    """A drive file with other values: a dictionary of flat keys."""
    lines = [line for line in drive.splitlines() if line.split(":")[0] not in entries]
    for gear in ("pinion", "wheel"):
        for key in ("teeth", "profile_shift"):
            if f"{gear}_{key}" in entries:
                lines = [re.sub(f"{key}: [0-9.]+", f"{key}: {entries[f'{gear}_{key}']}", line) if line.startswith(gear + ":") else line
                         for line in lines]
    nested = {name: value for name, value in entries.items() if not re.match("(pinion|wheel)_(teeth|profile_shift)$", name)}
    with open("drive.yaml", "w", encoding="utf-8") as file:
        file.write("\n".join(lines) + "\n" + "".join(f"{name}: {value}\n" for name, value in nested.items()))


def value(name):
    return VALUES.get(name, "2")


def is_of_the_gears(name, of_reduction):
    return name not in of_reduction and not CONTACT.search(name) and name not in IDLE and not name.endswith(("_mesh_output", "_file"))


def check_bodies():
    """Keys of reduce, all of one kind at a time: a refusal names them all."""
    everything = keys("reduce")
    drive_only = set(keys("evaluate")) & set(everything)
    of_reduction = set(everything) - drive_only - METHOD - IDLE
    assert {"modes", "material_E", "restrain", "stress_nodes", "damping_beta"} <= of_reduction
    changed({name: value(name) for name in of_reduction if name not in ("stiffness", "mass", "matrix_format", "dofs")})
    said = refusal("is not the body of pinion in this drive", "simulate", "drive.yaml", "-resume", "discard")
    for name in of_reduction - {"stiffness", "mass", "matrix_format", "dofs"}:
        assert f" {name}: " in said, f"{name} is not refused: {said}"
    assert " modes: 4 there, 2 here" in said and "elastogear reduce drive.yaml" in said, said
    # Of one gear, in its section.
    changed({"wheel_modes": "5"})
    assert " modes: 4 there, 5 here" in refusal("wheel.h5: is not the body of wheel", "simulate", "drive.yaml")
    # The gears themselves, one after the other; what makes no drive is refused by its own name.
    n = 0
    for gear in ("pinion", "wheel"):
        for name in sorted(keys("reduce", gear)):
            if name in of_reduction | METHOD or name in ("size", "element_order") or not is_of_the_gears(name, of_reduction):
                continue
            changed({name: value(name)})
            done = call("simulate", "drive.yaml", "-contact_law", "none")
            assert done.returncode == 1 and "contact_law" not in done.stderr, f"{name} is not refused: {done.stderr}"
            n += f" {name}: " in done.stderr
    assert n > 25, n
    for name in ("size", "element_order"):
        changed({name: value(name)})
        refusal(f" {name}: ", "simulate", "drive.yaml")
    # Bodies do not depend on what belongs to the contact and to the run.
    for name in sorted(everything):
        if name in METHOD | (IDLE - {"mesh", "output"}) or (CONTACT.search(name) and name not in of_reduction):
            changed({name: value(name)})
            said = call("simulate", "drive.yaml", "-contact_law", "none").stderr
            assert "is not the body" not in said, f"{name}: {said}"


def check_results():
    """Keys of simulate, which evaluate compares with those of the result."""
    run_keys = set(keys("simulate")) - set(keys("evaluate")) - IDLE
    odd = {"bodies", "pinion_file", "initial_file"}
    changed({name: value(name) for name in run_keys - odd})
    said = refusal("is not that of the run that this drive describes", "evaluate", "drive.yaml")
    for name in run_keys - odd:
        assert f" {name}: " in said, f"{name} is not refused: {said}"
    assert "elastogear simulate drive.yaml" in said
    for name in sorted(set(keys("evaluate")) & set(keys("reduce"))):
        if name in IDLE or name.endswith(("_mesh_output", "_file")) or name in ("pinion_topography", "pinion_wear", "pinion_bearings"):
            continue
        changed({name: value(name)})
        done = call("evaluate", "drive.yaml")
        assert done.returncode == 1, f"{name} is not refused: {done.stdout[-300:]}"
    for name, there, here in (("torque", "50 N m", "60 N m"), ("modes", "4", "5"), ("centre_distance", "not given", "0.0615 m"),
                              ("face_width", "0.009 m", "0.01 m"), ("pinion_tip_relief", "0 m", "1e-05 m"), ("size", "tiny", "small")):
        changed({name: {"torque": "60 N m", "modes": "5", "pinion_tip_relief": "10 um"}.get(name) or value(name)})
        for verb in ("evaluate", "recover", "life"):
            said = refusal(f" {name}: ", verb, "drive.yaml")
            assert f" {name}: {there} there, {here} here" in said, said
    changed({"face_width": "10 mm"})
    refusal(" face_width: 0.009 m there, 0.01 m here", "wear", "drive.yaml")


def check_command_lines():
    """What a command line sets beside the file belongs to the run, and to the file only where the file has not changed."""
    changed({})
    run("simulate", "drive.yaml", "-contact_friction", "0.05", "-torque", "40 N m", "-output", "other.h5")
    run("evaluate", "drive.yaml", "-result", "other.h5")
    run("recover", "drive.yaml", "-result", "other.h5", "-output", "other_stress.h5")
    refusal("those whose stresses are known, 40 N m", "life", "drive.yaml", "-files", "other_stress.h5")
    refusal(" torque: 40 N m there, 30 N m here", "evaluate", "drive.yaml", "-result", "other.h5", "-torque", "30 N m")
    run("reduce", "drive.yaml", "-modes", "3", "-pinion_file", "few_1.h5", "-wheel_file", "few_2.h5")
    few = ("-pinion_file", "few_1.h5", "-wheel_file", "few_2.h5", "-output", "few.h5")
    assert "modes 3 for 4 of the drive file" in run("simulate", "drive.yaml", *few)
    changed({"modes": "5"})
    refusal(" modes: 3 there, 5 here", "simulate", "drive.yaml", *few)
    changed({})
    refusal("", "simulate", "drive.yaml", "-face_width", "10 mm")


def check_tables():
    """A file that a key names is part of the input."""
    def topography(height):
        with open("flank.csv", "w", encoding="utf-8") as file:
            file.write("".join(f"{d},{z},{height}\n" for d in (0.0505, 0.056) for z in (-0.004, 0.004)))
    topography(0)
    changed({"pinion_topography": "flank.csv"})
    run("simulate", "drive.yaml", "-output", "measured.h5")
    run("evaluate", "drive.yaml", "-result", "measured.h5")
    topography(1e-6)
    refusal("pinion_topography: flank.csv before it changed there", "evaluate", "drive.yaml", "-result", "measured.h5")


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        changed({})
        run("reduce", "drive.yaml")
        run("simulate", "drive.yaml")
        for verb in ("evaluate", "recover", "life"):
            run(verb, "drive.yaml")
        # The same numbers written otherwise are the same input.
        changed({"face_width": "0.9 cm", "torque": "0.05 kN m"})
        run("evaluate", "drive.yaml")
        check_bodies()
        check_results()
        check_command_lines()
        check_tables()
        os.chdir("/")
    print("results belong to their input")


if __name__ == "__main__":
    main()
