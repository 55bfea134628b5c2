#!/usr/bin/python3
"""Two soft balls with static responses hit each other off-centre with friction that follows the speed of sliding:

    tests/app/soft_balls.py ELASTOGEAR SCRIPTS

The run reaches its end and keeps its energy, and the force of the contact is what changes the momentum of each ball.
"""
import os
import subprocess
import sys
import tempfile

import numpy as np

ELASTOGEAR = os.path.abspath(sys.argv[1])
sys.path.append(os.path.abspath(sys.argv[2]))
import results

RADIUS, CELLS, SPEED, OFF = 0.05, 8, 1, 0.05  # m, along a side of the cube that becomes the ball, m/s, m


def run(*arguments):
    done = subprocess.run([ELASTOGEAR, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        sys.exit(f"FAIL: {' '.join(map(str, arguments))}: {done.stdout}{done.stderr}")


def on_ball(x, y, z):
    """Of a point of the cube -1..1."""
    return (x * np.sqrt(1 - y * y / 2 - z * z / 2 + y * y * z * z / 3), y * np.sqrt(1 - z * z / 2 - x * x / 2 + z * z * x * x / 3),
            z * np.sqrt(1 - x * x / 2 - y * y / 2 + x * x * y * y / 3))


def write_ball():
    n = CELLS
    node = lambda i, j, k: 1 + i + (n + 1) * (j + (n + 1) * k)
    axis = np.linspace(-1, 1, n + 1)
    skin = ""
    with open("ball.inp", "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{node(i, j, k)}, " + ", ".join(f"{RADIUS * x:.15g}" for x in on_ball(axis[i], axis[j], axis[k])) + "\n"
                                       for k in range(n + 1) for j in range(n + 1) for i in range(n + 1)))
        file.write("*ELEMENT, TYPE=C3D8, ELSET=ALL\n")
        for cell, (k, j, i) in enumerate(np.ndindex(n, n, n), 1):
            corners = [node(i + x, j + y, k + z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
            file.write(f"{cell}, " + ", ".join(map(str, corners)) + "\n")
            outside = (k == 0, k == n - 1, j == 0, i == n - 1, j == n - 1, i == 0)
            skin += "".join(f"{cell}, S{side}\n" for side, is_outside in enumerate(outside, 1) if is_outside)
        file.write("*SURFACE, NAME=SKIN, TYPE=ELEMENT\n" + skin)


def hit():
    write_ball()
    run("reduce", "-mesh", "ball.inp", "-material_E", 1e6, "-material_nu", 0.45, "-material_rho", 1000, "-restrain", "none", "-surface", "SKIN",
        "-modes", 100, "-output", "ball.h5")
    along = np.sqrt(4 * RADIUS**2 - OFF**2) + 5e-5
    run("simulate", "-bodies", "a,b", "-a_file", "ball.h5", "-b_file", "ball.h5", "-a_joint", "free", "-b_joint", "free", "-b_position",
        f"{along},{OFF},0", "-a_velocity0", f"{SPEED},0,0", "-contact_pairs", "a:b", "-contact_friction", 0.3, "-contact_friction_speed", 0.01,
        "-ts_max_time", 0.015, "-output", "hit.h5")


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    hit()
    with results.open_file("ball.h5", "body") as body, results.open_file("hit.h5", "result") as file:
        mass = float(body["rigid/mass"][()])
        time, force, balance = file["time"][:], file["contact/a:b/force"][:], np.abs(file["energy/balance"][:]).max()
        change = {name: mass * (file[f"bodies/{name}/rigid_velocity"][-1, :3] - file[f"bodies/{name}/rigid_velocity"][0, :3]) for name in "ab"}
    impulse = ((force[1:] + force[:-1]) / 2 * np.diff(time)[:, None]).sum(axis=0)
    energy = mass * SPEED**2 / 2
    print(f"impulse {impulse} N s, changes of momentum {change}, balance {balance:.2g} of {energy:.2g} J")
    for name, momentum in change.items():
        off = min(np.linalg.norm(momentum - impulse), np.linalg.norm(momentum + impulse))
        if off > 0.01 * np.linalg.norm(impulse) or np.linalg.norm(impulse) < 0.1 * mass * SPEED:
            sys.exit(f"FAIL: the momentum of {name} is off by {off} N s")
    if balance > 2e-3 * energy:
        sys.exit("FAIL: the energy is not kept")
print("all good")
