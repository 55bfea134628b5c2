#!/usr/bin/env python3
"""What docs/tutorial.md, docs/evaluation.md and README.md show is what the program prints: the drive of section 1, the meshes and the wheel's
body of section 2.

    tutorial.py PATH/TO/elastogear PATH/TO/docs/tutorial.md"""
import os
import re
import subprocess
import sys
import tempfile

DIGITS = 2e-5  # relative: of numbers that are printed with six digits
program = os.path.abspath(sys.argv[1])
with open(sys.argv[2], encoding="utf-8") as file:
    page = file.read()
with open(os.path.join(os.path.dirname(sys.argv[2]), "..", "README.md"), encoding="utf-8") as file:
    readme = file.read()
with open(os.path.join(os.path.dirname(sys.argv[2]), "evaluation.md"), encoding="utf-8") as file:
    evaluation = file.read()
NUMBER = re.compile(r"-?\d+\.?\d*(?:e-?\d+)?")


def run(command):
    done = subprocess.run([program, *command.split()[1:]], capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"FAIL: {command}\n{done.stdout[-2000:]}\n{done.stderr[-2000:]}")
    return done.stdout


def shown(text, heading):
    """The lines below a heading of a page, but for those that are cut off, times, and the report, which is left out here."""
    lines = []
    for line in text.split(heading)[1].split("\n"):
        if not line.startswith("    ") or line.startswith("    elastogear"):
            break
        if "..." not in line and " about " not in line and not line.strip().startswith("report "):
            lines.append(line)
    return lines


def alike(line, printed):
    """Do two lines have the same words and, to their digits, the same numbers?"""
    if NUMBER.sub("#", " ".join(line.split())) != NUMBER.sub("#", " ".join(printed.split())):
        return False
    pairs = zip(map(float, NUMBER.findall(line)), map(float, NUMBER.findall(printed)))
    return all(abs(a - b) <= DIGITS * max(abs(a), abs(b)) for a, b in pairs)


def check(lines, command, output):
    missing = [line.strip() for line in lines if not any(alike(line, printed) for printed in output.split("\n"))]
    assert lines and not missing, f"{command} does not print {missing} but\n{output}"


def write(name, text):
    with open(name, "w", encoding="utf-8") as file:
        file.write(text)


blocks = re.findall(r"```yaml\n(.*?)```", page, re.DOTALL)
design = next(block for block in blocks if block.startswith("z1:"))
worm = next(block for block in blocks if block.startswith("part: worm"))
wheel = next(block for block in blocks if block.startswith("part: wheel"))
with tempfile.TemporaryDirectory() as work:
    os.chdir(work)
    write("design.yaml", design)
    write("worm.yaml", worm)
    write("wheel.yaml", wheel)
    for commands in ("elastogear mesh design.yaml worm.yaml && elastogear mesh design.yaml wheel.yaml", "elastogear info wheel.msh"):
        check(shown(page, f"    {commands}\n"), commands, [run(command) for command in commands.split(" && ")][-1])
    commands = "elastogear reduce worm.yaml && elastogear reduce wheel.yaml"
    check(shown(page, f"    {commands}\n"), commands, run("elastogear reduce wheel.yaml"))

    drive = next(block for block in blocks if block.startswith("drive:"))
    askew = next(block for block in blocks if block.startswith("wheel:"))
    command = "elastogear drive.yaml -report none"
    write("drive.yaml", drive)
    output = run(command)
    check(shown(page, "    elastogear drive.yaml\n"), command, output)
    check(shown(readme, "It prints\n\n"), command, output)
    write("drive.yaml", re.sub(r"^wheel:.*\n", askew, drive, flags=re.MULTILINE))
    check(shown(page.split("skew: 0.02 deg")[1], "    elastogear drive.yaml\n"), command, run(command))
    write("drive.yaml", drive)
    command = "elastogear drive.yaml -size tiny -report none"
    check(shown(evaluation, "README's pair at size tiny:\n\n"), command, run(command))
print("all good")
