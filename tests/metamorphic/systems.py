"""Small systems without meshes, and what must hold of them."""

import numpy as np

from lab import alike, at_most, between, choice, near

GROWTH = 0.01  # of the energy turned over: more is what the program itself has to warn of


def oscillator(random):
    """A mass on a spring along its slide, some periods."""
    mass, stiffness = between(random, 0.1, 10), between(random, 1e3, 1e9)
    period = 2 * np.pi * np.sqrt(mass / stiffness)
    amplitude = between(random, 1e-7, 1e-3)
    keys = {
        "bodies": ["a"],
        "a": {"mass": mass, "inertia": [1e-3, 1e-3, 1e-3, 0, 0, 0], "joint": "prismatic", "axis": [0, 0, 1],
              "velocity0": float(amplitude / period * 2 * np.pi)},
        "bushings": ["spring"],
        "spring": {"markers": ["ground", "a.frame"], "stiffness": [stiffness] * 3}
    }
    if random.random() < 0.3:
        keys["gravity"] = [0, 0, -9.81]
    return keys, float(period * between(random, 10, 100))


def rotor(random):
    """A rigid rotor that spins on two bearings, hit sideways."""
    mass, radius = between(random, 0.5, 5), between(random, 0.02, 0.1)
    polar = mass * radius**2 / 2
    across = polar * between(random, 0.6, 2)
    stiffness, arm = between(random, 1e6, 1e9), between(random, 0.02, 0.1)
    keys = {
        "bodies": ["rotor"],
        "rotor": {"mass": mass, "inertia": [across, across, polar, 0, 0, 0], "joint": "free",
                  "points": ["left", 0, 0, -arm, "right", 0, 0, arm],
                  "omega0": [between(random, 1e-3, 1), 0, choice(random, 0.0, between(random, 1, 1000))],
                  "velocity0": [between(random, 1e-3, 0.3), 0, 0]},
        "bushings": ["left", "right"]
    }
    for name in keys["bushings"]:
        along = choice(random, 1.0, 0.1)
        keys[name] = {"markers": ["ground", f"rotor.{name}"], "stiffness": [stiffness, stiffness, stiffness * along]}
    period = 2 * np.pi * np.sqrt(mass / stiffness / 2)
    return keys, float(period * between(random, 10, 60))


def double_pendulum(random):
    """Two rods, the upper one on an ideal hinge, the lower one on a stiff bushing that lets it turn."""
    length, mass = between(random, 0.1, 0.5), between(random, 0.2, 2)
    across = mass * length**2 / 12
    start = float(random.uniform(0.3, 2.5))
    stiffness = between(random, 1e4, 1e7)
    joint = length * np.array([np.sin(start), -np.cos(start), 0])
    rod = {"mass": mass, "inertia": [across, across / 10, across, 0, 0, 0]}
    keys = {
        "bodies": ["upper", "lower"],
        "upper": {**rod, "joint": "revolute", "axis": [0, 0, 1], "point": [0, length / 2, 0],
                  "position": [0, -length / 2, 0], "angle0": start, "points": ["end", 0, -length / 2, 0]},
        "lower": {**rod, "joint": "free", "position": [float(x) for x in joint - [0, length / 2, 0]],
                  "points": ["top", 0, length / 2, 0]},
        "bushings": ["hinge"],
        "hinge": {"markers": ["upper.end", "lower.top"], "stiffness": [stiffness] * 3},
        "gravity": [0, -9.81, 0]
    }
    return keys, between(random, 0.1, 0.6)


SYSTEMS = {"oscillator": oscillator, "rotor": rotor, "double_pendulum": double_pendulum}


def system(random):
    kind = choice(random, *SYSTEMS)
    return SYSTEMS[kind](random)


def outputs(random, end):
    """Options of when states are written, or none."""
    kind = choice(random, "steps", "dt", "times", "every")
    if kind == "dt":
        return {"output_dt": float(end / random.integers(3, 200))}
    if kind == "times":
        return {"output_times": [float(t) for t in np.sort(random.uniform(0.05, 0.95, 5)) * end]}
    return {"output_every": int(random.integers(2, 20))} if kind == "every" else {}


def steps(random):
    """Options of steps that the run chooses, or none: the default."""
    keys = {}
    if random.random() < 0.3:
        keys["step_error"] = between(random, 3e-6, 1e-3)
    if random.random() < 0.5:
        keys["ts_alpha_radius"] = choice(random, 0.0, 0.3, 0.6, 0.9, 1.0)
    return keys


def energies(lab, name):
    """Stored energy and its balance with loads and losses at each output time, J."""
    stored = lab.read(name, "energy/kinetic") + lab.read(name, "energy/elastic") + lab.read(name, "energy/bushing")
    return stored, lab.read(name, "energy/balance")


def energy_is_not_made(lab):
    """An undamped system under constant loads has no more energy than it started with and its loads brought in, whatever steps are
    chosen and whenever states are written: numerical damping may take some. Allowed is a hundredth of the energy turned over,
    far above what the local errors of this many periods add up to."""
    keys, end = system(lab.random)
    keys.update(ts_max_time=end, output="result.h5", **outputs(lab.random, end), **steps(lab.random))
    lab.write("system.yaml", keys)
    lab.run("simulate", "system.yaml")
    stored, balance = energies(lab, "result.h5")
    at_most("energy made, share of the energy turned over", balance.max() / stored.max(), GROWTH)


def fixed_steps_make_no_energy(lab):
    """The same with steps of a given size and without numerical damping, of some twenty-five to two hundred a period, whose energy
    swings around its value by the square of omega dt: within 8 % of what is turned over."""
    keys, end = SYSTEMS[choice(lab.random, "oscillator", "rotor")](lab.random)
    keys.update(ts_max_time=end, output="result.h5", ts_dt=float(end / 10 / lab.random.integers(250, 800)))
    lab.write("system.yaml", keys)
    lab.run("simulate", "system.yaml")
    stored, balance = energies(lab, "result.h5")
    at_most("energy made, share of the energy turned over", np.abs(balance).max() / stored.max(), 0.08)


def output_times_change_nothing(lab):
    """What is written when steps are given is the same whichever steps of the run are asked for: a subset, equal to the bit."""
    keys, end = system(lab.random)
    every = int(lab.random.integers(2, 9))
    keys.update(ts_max_time=end, ts_dt=float(end / lab.random.integers(200, 500)))
    lab.write("system.yaml", keys)
    lab.run("simulate", "system.yaml", "-output", "all.h5")
    lab.run("simulate", "system.yaml", "-output", "some.h5", "-output_every", every)
    times, some = lab.read("all.h5", "time"), lab.read("some.h5", "time")
    rows = np.searchsorted(times, some)
    near("times", times[rows], some, 0)
    for body in keys["bodies"]:
        near(f"coordinates of {body}", lab.read("some.h5", f"bodies/{body}/rigid"),
             lab.read("all.h5", f"bodies/{body}/rigid")[rows], 0)


def equal_results(lab, keys, name, other, what):
    for dataset in ("rigid", "rigid_velocity"):
        for body in keys["bodies"]:
            near(f"{what}: {dataset} of {body}", lab.read(other, f"bodies/{body}/{dataset}"),
                 lab.read(name, f"bodies/{body}/{dataset}"), 0)
    near(f"{what}: time", lab.read(other, "time"), lab.read(name, "time"), 0)


def a_rerun_and_a_resumed_run_change_nothing(lab):
    """A run is a function of its input, to the bit; so is one that was stopped after some of its steps and goes on."""
    keys, end = system(lab.random)
    fixed = lab.random.random() < 0.5
    keys.update(ts_max_time=end, **outputs(lab.random, end),
                **({"ts_dt": float(end / lab.random.integers(100, 300))} if fixed else steps(lab.random)))
    lab.write("system.yaml", keys)
    lab.run("simulate", "system.yaml", "-output", "result.h5")
    lab.run("simulate", "system.yaml", "-output", "again.h5")
    equal_results(lab, keys, "result.h5", "again.h5", "a rerun")
    lab.call("simulate", "system.yaml", "-output", "cut.h5", "-ts_max_steps", int(lab.random.integers(5, 90)))
    lab.run("simulate", "system.yaml", "-output", "cut.h5")
    equal_results(lab, keys, "result.h5", "cut.h5", "a resumed run")


def reunitted(keys):
    """The same input with other units behind its numbers."""
    units = {"mass": ("g", 1e3), "position": ("mm", 1e3), "point": ("mm", 1e3),
             "ts_max_time": ("ms", 1e3), "ts_dt": ("us", 1e6), "output_dt": ("ms", 1e3)}

    def write(key, value):
        if isinstance(value, dict):
            return {name: write(name, below) for name, below in value.items()}
        if key not in units:
            return value
        unit, factor = units[key]
        if isinstance(value, list):
            return [f"{repr(x * factor)} {unit}" for x in value]
        return f"{repr(value * factor)} {unit}"

    return write("", keys)


def units_of_a_system_change_nothing(lab):
    """The unit in which a number is written is no part of the system. Rounding of the conversion, 1e-16, grows in a motion by its
    condition: 1e-6 of the largest coordinate is far above it in as few periods."""
    keys, end = SYSTEMS[choice(lab.random, "oscillator", "rotor")](lab.random)
    keys.update(ts_max_time=end, ts_dt=float(end / lab.random.integers(200, 500)))
    lab.write("si.yaml", keys)
    lab.write("other.yaml", reunitted(keys))
    lab.run("simulate", "si.yaml", "-output", "si.h5")
    lab.run("simulate", "other.yaml", "-output", "other.h5")
    for body in keys["bodies"]:
        alike(f"coordinates of {body}", lab.read("other.h5", f"bodies/{body}/rigid")[-1],
              lab.read("si.h5", f"bodies/{body}/rigid")[-1], 1e-6)


def turned(keys, matrix):
    """The system with its world turned: directions and places of the world, and bodies against their frames not."""
    result = {key: dict(value) if isinstance(value, dict) else value for key, value in keys.items()}
    for body in result["bodies"]:
        own = result[body]
        own["position"] = [float(x) for x in matrix @ own.get("position", [0, 0, 0])]
        own["rotation"] = rotation_vector(matrix)
        if own["joint"] == "free":
            own["velocity0"] = [float(x) for x in matrix @ own.get("velocity0", [0, 0, 0])]
    if "gravity" in result:
        result["gravity"] = [float(x) for x in matrix @ result["gravity"]]
    for bushing in result["bushings"]:
        if result[bushing]["markers"][0] == "ground":
            result[bushing]["axes"] = rotation_vector(matrix)
        else:
            result[bushing]["frame"] = "body"
    return result


def random_rotation(random):
    axis = random.normal(size=3)
    axis /= np.linalg.norm(axis)
    cross = np.cross(np.eye(3), -axis)
    angle = random.uniform(0.2, 2.5)
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def rotation_vector(matrix):
    axis = np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])
    angle = np.arctan2(np.linalg.norm(axis), np.trace(matrix) - 1)
    return [float(x) for x in axis / np.linalg.norm(axis) * angle]


def a_turned_world_changes_nothing(lab):
    """Nothing distinguishes directions of the world: a system that is turned as a whole moves alike, energies are the same. As
    above rounding grows in a motion, by chaos of the pendulum too: 1e-5 of the largest energy."""
    keys, end = system(lab.random)
    keys.update(ts_max_time=min(end, 0.2), ts_dt=float(min(end, 0.2) / lab.random.integers(200, 500)))
    matrix = random_rotation(lab.random)
    lab.write("system.yaml", keys)
    lab.write("turned.yaml", turned(keys, matrix))
    lab.run("simulate", "system.yaml", "-output", "result.h5")
    lab.run("simulate", "turned.yaml", "-output", "turned.h5")
    for part in ("kinetic", "bushing"):
        alike(f"{part} energy", lab.read("turned.h5", f"energy/{part}"), lab.read("result.h5", f"energy/{part}"), 1e-5)
