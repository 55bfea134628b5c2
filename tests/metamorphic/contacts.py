"""Elastic bars that hit each other end on, and what must hold of their contact."""

import numpy as np

from bodies import STEEL, write_bar
from lab import alike, at_most, between, choice
from systems import random_rotation, rotation_vector

FREE = {"restrain": "none"}  # its frame is at its centre of mass
HALF_TURN = np.diag([-1.0, -1.0, 1.0])
UNSAID = 0.25  # standard deviation over the mean of a vibration that changes by 0.7 of its mean from turn to turn: a run has to speak of more
WAVE = np.sqrt(STEEL["E"] * STEEL["rho"]) / 2  # force over area and speed of slender bars that hit each other, while waves run


def reduce_bar(lab, cells, size, basis):
    """A bar whose end at the largest x is the contact surface; free, or held at its other end if its basis is the full one."""
    text = write_bar(lab, cells, size)
    count, last = int(np.prod(cells)), cells[1] * cells[2]
    with open(lab.path("bar.inp"), "w") as file:
        file.write(text[:text.index("*SURFACE")] + "*SURFACE, NAME=TIP, TYPE=ELEMENT\n")
        file.writelines(f"{cell}, S4\n" for cell in range(count - last + 1, count + 1))
    lab.write("bar.yaml", {"mesh": "bar.inp", "material": STEEL, "surface": ["TIP"], **basis, "output": "bar.h5"})
    lab.run("reduce", "bar.yaml")


def hit(lab, name, place, world, speed, end):
    """Bar a hits bar b, which is at rest and stands turned by half a turn at `place`, m, at this speed along their common axis x; all
    is turned with the world. Returns what the run says, and times, forces along the axis and across it, N, and the balance of
    energy, J."""
    axis = world @ [1, 0, 0]
    slide = {"file": "bar.h5", "joint": "prismatic", "axis": [1, 0, 0]}
    lab.write(f"{name}.yaml", {
        "bodies": ["a", "b"],
        "a": {**slide, "rotation": rotation_vector(world), "velocity0": float(speed)},
        "b": {**slide, "rotation": rotation_vector(world @ HALF_TURN), "position": [float(x) for x in world @ place]},
        "contact_pairs": ["a:b"], "ts_max_time": float(end), "output": f"{name}.h5"
    })
    said = lab.run("simulate", f"{name}.yaml")
    force = lab.read(f"{name}.h5", "contact/a:b/force")
    along = force @ axis
    return said, lab.read(f"{name}.h5", "time"), np.abs(along), force - np.outer(along, axis), lab.read(f"{name}.h5", "energy/balance")


def contact_that_starts_closed_is_that_of_a_small_gap(lab):
    """Bars that start at no distance hit each other as bars do that have one of a millionth of a cell, or fly a part of a cell before: along
    their axis, with the same impulse. Nodes of bars that start closed lie on each other, where the nearest point alone has no direction."""
    random = lab.random
    cells = [int(random.integers(4, 8)), int(random.integers(1, 4)), int(random.integers(1, 4))]
    size = [between(random, 0.01, 0.03, 2) for _ in range(3)]
    full = random.random() < 0.5
    reduce_bar(lab, cells, size, {"restrain": ["FIX"], "basis": "full"} if full else {**FREE, "modes": int(random.integers(5, 20))})
    length, speed, world = cells[0] * size[0], between(random, 0.01, 2), random_rotation(random)
    end = 3 * length / np.sqrt(STEEL["E"] / STEEL["rho"])
    place = np.array([2 * length, cells[1] * size[1], 0.0] if full else [length, 0.0, 0.0])
    impulses = []
    for name, gap in (("closed", 0.0), ("gap", 1e-6 * size[0]), ("flight", between(random, 0.003, 0.3) * size[0])):
        flight = gap / speed if name == "flight" else 0
        _, time, along, across, balance = hit(lab, name, place + [gap, 0, 0], world, speed, end + flight)
        at_most("force across the axis over that along", np.abs(across).max() / along.max(), 1e-3)
        at_most("energy lost or made over that of the bar", np.abs(balance).max() / (STEEL["rho"] * np.prod(cells) * np.prod(size) * speed**2 / 2),
                0.05)
        impulses.append(np.trapz(along, time))
    for impulse in impulses[1:]:
        alike("impulse", impulse, impulses[0], 0.02)


def pressed(lab, name, place, world, force, keys):
    """Bar a is pressed at rest against bar b, which stands held and turned by half a turn at `place`, m. Returns the force of contact, N,
    and those of its points, ascending."""
    axis = world @ [1, 0, 0]
    lab.write(f"{name}.yaml", {
        "bodies": ["a", "b"],
        "a": {"file": "bar.h5", "joint": "prismatic", "axis": [1, 0, 0], "rotation": rotation_vector(world)},
        "b": {"file": "bar.h5", "joint": "fixed", "rotation": rotation_vector(world @ HALF_TURN), "position": [float(x) for x in world @ place]},
        "contact_pairs": ["a:b"], "contact": keys, "analysis": "static", "static_steps": 1, "loads": ["push"],
        "push": {"marker": "a.frame", "force": [float(f) for f in force * axis]}, "output": f"{name}.h5"
    })
    lab.run("simulate", f"{name}.yaml")
    points = lab.read(f"{name}.h5", "contact/a:b/points/force")[lab.read(f"{name}.h5", "contact/a:b/points/offset")[-2]:]
    return lab.read(f"{name}.h5", "contact/a:b/force")[-1], np.sort(np.linalg.norm(points, axis=1))


def bars_that_touch_are_pressed_along_their_axis(lab):
    """The same at rest under a force: what a bar is pressed with goes along its axis, by points that are loaded alike whether they start
    closed or a millionth of a cell apart, on facets and on smooth surfaces."""
    random = lab.random
    cells = [int(random.integers(2, 5)), int(random.integers(1, 4)), int(random.integers(1, 4))]
    size = [between(random, 0.01, 0.03, 2) for _ in range(3)]
    reduce_bar(lab, cells, size, {"restrain": ["FIX"], "basis": "full"})
    force, world = between(random, 10, 1e4), random_rotation(random)
    keys = {"surface": choice(random, "smooth", "facets")}
    place = np.array([2 * cells[0] * size[0], cells[1] * size[1], 0.0])
    of_points = []
    for name, gap in (("closed", 0.0), ("gap", 1e-6 * size[0])):
        total, points = pressed(lab, name, place + [gap, 0, 0], world, force, keys)
        alike("force of contact", total / force, world @ [1, 0, 0] * np.sign(total @ world @ [1, 0, 0]), 1e-4)
        of_points.append(points)
    alike("forces of points", *of_points, 0.01)


def bars_that_hit_do_not_chatter(lab):
    """Slender bars have the force of a wave until it is back from their ends, however many modes they have, or the run says that its
    force vibrates."""
    cells, speed = int(lab.random.integers(30, 61)), between(lab.random, 0.1, 2)
    side = between(lab.random, 0.004, 0.006, 2)
    length = 80 * side
    reduce_bar(lab, [cells, 1, 1], [length / cells, side, side], {**FREE, "modes": int(cells * lab.random.uniform(2, 5))})
    there_and_back = 2 * length / np.sqrt(STEEL["E"] / STEEL["rho"])
    said, time, along, _, _ = hit(lab, "hit", [length + 1e-8, 0, 0], random_rotation(lab.random), speed, 0.75 * there_and_back)
    on = along[time > 0.2 * there_and_back]
    if "its force" not in said:
        at_most("standard deviation over the mean", on.std() / on.mean(), UNSAID)
    alike("force of the wave", on.mean(), WAVE * side**2 * speed, 0.03)
