"""Elastic bars of meshes/make.py under loads at markers."""

import os
import subprocess
import sys

import numpy as np
from vtk import vtkXMLUnstructuredGridReader
from vtk.util.numpy_support import vtk_to_numpy

from drives import Chain, cylindrical
from lab import Broken, alike, at_most, between, choice

MAKE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "meshes", "make.py")


STEEL = {"E": 210e9, "nu": 0.3, "rho": 7850.0}


def write_bar(lab, cells, size):
    """Writes bar.inp of this many cells of these sizes, m; returns its text."""
    command = ["bar", *map(str, cells), *map(str, size)]
    text = subprocess.run([sys.executable, MAKE, *command], capture_output=True, text=True, check=True).stdout
    with open(lab.path("bar.inp"), "w") as file:
        file.write(text)
    lab.log.append(f"$ {MAKE} {' '.join(command)} > bar.inp")
    return text


def bar(lab):
    """Writes bar.inp with random cells; returns its nodes' coordinates, m."""
    random = lab.random
    size = [between(random, 0.01, 0.03, 2) for _ in range(3)]
    cells = [int(random.integers(4, 9)), int(random.integers(1, 3)), int(random.integers(1, 3))]
    rows = []
    for line in write_bar(lab, cells, size).split("*NODE")[1].splitlines()[1:]:
        if line.startswith("*"):
            break
        rows.append([float(x) for x in line.split(",")[1:4]])
    return np.array(rows)


def field_of(lab, begins):
    """Undeformed points in their placement and displacements of the last field file whose name begins so, m."""
    names = sorted(name for name in os.listdir(lab.folder) if name.startswith(begins) and name.endswith(".vtu"))
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(lab.path(names[-1]))
    reader.Update()
    data = reader.GetOutput().GetPointData()
    name = next(data.GetArrayName(i) for i in range(data.GetNumberOfArrays()) if data.GetArrayName(i).startswith("displacement"))
    return vtk_to_numpy(reader.GetOutput().GetPoints().GetData()), vtk_to_numpy(data.GetArray(name))


def a_sensor_is_where_the_field_is(lab):
    """A sensor at a node and the displacement field of the same run tell of the same node: equal to 1e-6 of the largest displacement,
    float32 of stored modes aside."""
    X = bar(lab)
    free = np.flatnonzero(X[:, 0] > X[:, 0].min() + 1e-9)
    loaded, seen = lab.random.choice(free, 2, replace=False)
    if lab.random.random() < 0.5:
        seen = loaded
    marker = [f"{n + 1}" for n in (loaded, seen)]
    keys = {
        "mesh": "bar.inp", "material": STEEL, "restrain": ["FIX"], "surface": ["TOP"],
        "stress_nodes": ["FIX"], "markers": [int(m) for m in dict.fromkeys(marker)], "modes": int(lab.random.integers(3, 15)),
        "output": "bar.h5"
    }
    basis = choice(lab.random, None, "modal", "modal_residual", "full")
    if basis:
        keys["basis"] = basis
    lab.write("bar.yaml", keys)
    lab.run("reduce", "bar.yaml")
    lab.write("run.yaml", {
        "bodies": ["bar"], "bar": {"file": "bar.h5", "joint": "fixed"}, "analysis": "static", "static_steps": 1,
        "loads": ["push"], "push": {"marker": f"bar.{marker[0]}", "force": [float(f) for f in lab.random.normal(size=3) * 100]},
        "sensors": {"seen": f"bar.{marker[1]}"}, "output": "run.h5"
    })
    lab.run("simulate", "run.yaml")
    lab.run("recover", "-result", "run.h5", "-output", "stress.h5", "-field_times", "all", "-fields", "field", "-stress_bar", "FIX")
    _, field = field_of(lab, "field")
    field = field[seen]
    alike(f"displacement of node {marker[1]}, load at {marker[0]}", lab.read("run.h5", "sensors/seen/position")[-1] - X[seen], field, 1e-6)


def the_static_response_to_loads_at_markers_is_whole(lab):
    """At rest a body gives way as its mesh does, however few modes it has: the modes and the static response that the default basis
    adds make up the answer of all degrees of freedom, within a hundredth."""
    X = bar(lab)
    loaded = int(lab.random.choice(np.flatnonzero(X[:, 0] > X[:, 0].min() + 1e-9))) + 1
    force = [float(f) for f in lab.random.normal(size=3) * 100]
    keys = {"mesh": "bar.inp", "material": STEEL, "restrain": ["FIX"], "surface": ["TOP"],
            "stress_nodes": ["FIX"], "markers": [loaded]}
    places = []
    for name, basis in (("few", {"modes": int(lab.random.integers(3, 15))}), ("full", {"basis": "full"})):
        lab.write(f"{name}.yaml", {**keys, **basis, "output": f"{name}.h5"})
        lab.run("reduce", f"{name}.yaml")
        lab.write(f"{name}_run.yaml", {
            "bodies": ["bar"], "bar": {"file": f"{name}.h5", "joint": "fixed"}, "analysis": "static", "static_steps": 1,
            "loads": ["push"], "push": {"marker": f"bar.{loaded}", "force": force}, "sensors": {"seen": f"bar.{loaded}"},
            "output": f"{name}_run.h5"
        })
        lab.run("simulate", f"{name}_run.yaml")
        places.append(lab.read(f"{name}_run.h5", "sensors/seen/position")[-1] - X[loaded - 1])
    alike("displacement of the loaded node", *places, 0.01)


def a_pressure_is_the_force_that_it_makes(lab):
    """A pressure on the plane top of a bar is an even traction, as a force at the marker of that face set is, whose nodes weigh by their
    area: sensors and stresses are equal at rest and in time, in every basis, to what the balance of forces leaves."""
    random = lab.random
    X = bar(lab)
    seen = int(random.choice(np.flatnonzero(X[:, 0] > X[:, 0].min() + 1e-9))) + 1
    size = X.max(axis=0) - X.min(axis=0)
    p = between(random, 1e4, 1e6) * choice(random, -1, 1)
    keys = {"mesh": "bar.inp", "material": STEEL, "restrain": ["FIX"], "surface": ["TOP"], "stress_nodes": ["FIX"],
            "markers": ["TOP", seen], "basis": choice(random, "modal", "modal_residual", "full"), "output": "bar.h5"}
    if keys["basis"] != "full":
        keys.update(modes=int(random.integers(3, 15)), damping_ratio=0.02)
    lab.write("bar.yaml", keys)
    lab.run("reduce", "bar.yaml")
    analysis = {"analysis": "static", "static_steps": 1} if random.random() < 0.5 else {
        "ts_dt": 1e-5, "ts_max_time": 1e-3, "output_dt": 1e-4, "push_signal": ["ramp", 1.0, 3e-4]}
    stresses, places = [], []
    for name, load in (("p", {"pressure": p}), ("f", {"force": [0.0, 0.0, -p * float(size[0] * size[1])]})):
        lab.write(f"{name}.yaml", {
            "bodies": ["bar"], "bar": {"file": "bar.h5", "joint": "fixed"}, **analysis, "loads": ["push"],
            "push": {"marker": "bar.TOP", **load}, "sensors": {"seen": f"bar.{seen}"}, "output": f"{name}.h5"
        })
        lab.run("simulate", f"{name}.yaml")
        lab.run("recover", "-result", f"{name}.h5", "-output", f"{name}_stress.h5", "-stress_bar", "FIX")
        places.append(lab.read(f"{name}.h5", "sensors/seen/position") - X[seen - 1])
        stresses.append(lab.read(f"{name}_stress.h5", "bar/FIX/stress"))
    alike("displacement, by pressure and by force", *places, 1e-6)
    alike("stress at the held end, by pressure and by force", *stresses, 1e-6)


def a_pulse_is_resolved_in_time(lab):
    """Steps that a run chooses resolve the stress of an undamped bar under a short pulse: the largest stress at its held end is that of
    steps of a three-hundredth of its shortest period within 2 %, its history within 5 %, and its estimated error in time holds."""
    random = lab.random
    cells, size = [int(random.integers(18, 31)), 2, 2], [0.02, 0.01, 0.01]
    write_bar(lab, cells, size)
    end = 9 * cells[0] + int(random.integers(1, 10))  # a node of the free end
    lab.write("bar.yaml", {"mesh": "bar.inp", "material": STEEL, "restrain": ["FIX"], "surface": ["TOP"], "stress_nodes": ["FIX"],
                           "markers": [end], "basis": "modal", "modes": int(random.integers(14, 25)), "damping_alpha": 0,
                           "damping_beta": 0, "output": "bar.h5"})
    lab.run("reduce", "bar.yaml")
    highest, length = float(lab.read("bar.h5", "modes/frequency")[-1]), between(random, 1e-4, 4e-4)
    with open(lab.path("pulse.csv"), "w") as file:
        file.write("time,factor\n" + "".join(f"{length * t:.12g},{max(0, np.sin(np.pi * t)):.12g}\n" for t in np.linspace(0, 1, 401)) + "1,0\n")
    force = [0.0, *(float(f) for f in random.normal(size=2) * 300)]
    found = []
    for name, steps in (("default", {}), ("small", {"ts_dt": 1 / highest / 300, "ts_alpha_radius": 1})):
        lab.write(f"{name}.yaml", {"bodies": ["bar"], "bar": {"file": "bar.h5", "joint": "fixed"}, "loads": ["push"],
                                   "push": {"marker": f"bar.{end}", "force": force, "signal": ["table", "pulse.csv"]}, **steps,
                                   "ts_max_time": 4e-3, "output_dt": 2e-5, "output": f"{name}.h5"})
        lab.run("simulate", f"{name}.yaml")
        lab.run("recover", "-result", f"{name}.h5", "-stress_bar", "FIX", "-mode_acceleration", "false", "-output", f"{name}_stress.h5")
        found.append(lab.read(f"{name}_stress.h5", "bar/FIX/von_mises"))
    stress, exact = found
    alike("largest stress at the held end", stress.max(), exact.max(), 0.02)
    at_most("deviation of the history, root of squares", np.linalg.norm(stress - exact) / np.linalg.norm(exact), 0.05)
    beyond = np.abs(stress - exact) - lab.read("default_stress.h5", "bar/FIX/time_error")
    at_most("stresses farther off than their estimated error in time, share", np.mean(beyond > 2e-3 * exact.max()), 0.05)


def a_sensor_on_a_flank_is_where_the_field_is(lab):
    """A sensor at the node of a flank that bears the largest force, and the field of the same run at that node, by its largest elastic
    displacement: equal to 1e-4."""
    keys = cylindrical(lab.random)
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    Chain(lab, "one", keys, first=True, verbs=("reduce", "simulate"))
    body = choice(lab.random, "pinion", "wheel")
    rows = slice(*lab.read("one.h5", f"bodies/{body}/contact_forces/offset")[-2:])
    force, number = (lab.read("one.h5", f"bodies/{body}/contact_forces/{name}")[rows] for name in ("force", "node"))
    node = int(lab.read(f"one_{body}.h5", "surface/nodes")[number[np.linalg.norm(force, axis=1).argmax()]])
    keys[body]["markers"] = [node + 1]
    keys["sensors"] = {"seen": f"{body}.{node + 1}"}
    Chain(lab, "two", keys, verbs=("reduce", "simulate"))
    lab.run("recover", "two.yaml", "-result", "two.h5", "-output", "stress.h5", "-field_times", "all", "-fields", "field")
    points, field = field_of(lab, f"field_{body}")
    alike("elastic displacement of the flank", lab.read("two.h5", "sensors/seen/position")[-1] - points[node], field[node], 1e-4)


def a_cell_that_is_twice_there_is_named(lab):
    """A cell that is twice in a mesh has twice its mass and stiffness: reduce says which one."""
    text = write_bar(lab, [int(n) for n in lab.random.integers(1, 5, 3)], [0.01, 0.02, 0.03])
    cells = text.split("ELSET=ALL\n")[1].split("*")[0].splitlines()
    twice = choice(lab.random, *cells).split(", ")
    again = str(int(lab.random.integers(1000, 9999)))
    with open(lab.path("bar.inp"), "w") as file:
        file.write(text.replace(cells[-1] + "\n", cells[-1] + "\n" + ", ".join([again, *twice[1:]]) + "\n", 1))
    lab.write("bar.yaml", {"mesh": "bar.inp", "material": STEEL, "restrain": ["FIX"], "surface": ["TOP"], "modes": 3, "output": "bar.h5"})
    done = lab.call("reduce", "bar.yaml")
    said = done.stdout + done.stderr
    if "twice" not in said or twice[0] not in said.replace(",", " ").split() or again not in said.replace(",", " ").split():
        raise Broken(f"cells {twice[0]} and {again} are the same, reduce says: {said[-400:]}")


def a_spinning_bar_has_its_coriolis_forces(lab):
    """A free bar that spins about its axis and is pushed sideways: with the inertia of the default it bends as with all of it, or the
    run says that it does not. A frequency that is off by a hundredth, of which the run has to warn, shifts two periods by 0.13 rad."""
    random, cells = lab.random, int(lab.random.integers(6, 14))
    width = between(random, 0.01, 0.02, 2)
    write_bar(lab, [cells, 1, 1], [2 * width, width, between(random, 0.5, 1, 2) * width])
    end = 4 * (cells + 1)
    lab.write("bar.yaml", {"mesh": "bar.inp", "material": STEEL, "restrain": "none", "surface": ["TOP"], "invariants": "full",
                           "modes": int(random.integers(4, 10)), "markers": [end], "output": "bar.h5"})
    lab.run("reduce", "bar.yaml")
    lowest = float(lab.read("bar.h5", "modes/frequency")[0])
    spin = 2 * np.pi * lowest * float(random.uniform(0.001, 0.5))
    keys = {
        "bodies": ["bar"], "bar": {"file": "bar.h5", "joint": "free", "omega0": [spin, 0.0, 0.0]},
        "loads": ["push"], "push": {"marker": f"bar.{end}", "force": [0.0, between(random, 1, 10), 0.0]},
        "ts_max_time": 2 / lowest, "output_dt": 2 / lowest / 50
    }
    said = {}
    for level in ("affine", "full"):
        lab.write(f"{level}.yaml", {**keys, **({} if level == "affine" else {"inertia": level}), "output": f"{level}.h5"})
        said[level] = lab.run("simulate", f"{level}.yaml")
    if "Coriolis" not in said["affine"]:
        alike("elastic coordinates", *(lab.read(f"{level}.h5", "bodies/bar/q") for level in ("affine", "full")), 0.15)
