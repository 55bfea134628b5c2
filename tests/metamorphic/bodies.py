"""Elastic bars of meshes/make.py under loads at markers."""

import os
import subprocess
import sys

import numpy as np
from vtk import vtkXMLUnstructuredGridReader
from vtk.util.numpy_support import vtk_to_numpy

from lab import alike, between, choice

MAKE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "meshes", "make.py")


def bar(lab):
    """Writes bar.inp with random cells; returns its nodes' coordinates, m."""
    random = lab.random
    size = [between(random, 0.01, 0.03, 2) for _ in range(3)]
    cells = [int(random.integers(4, 9)), int(random.integers(1, 3)), int(random.integers(1, 3))]
    with open(lab.path("bar.inp"), "w") as file:
        subprocess.run([sys.executable, MAKE, "bar", *map(str, cells), *map(str, size)], stdout=file, check=True)
    lab.log.append(f"$ {MAKE} bar {' '.join(map(str, cells + size))} > bar.inp")
    with open(lab.path("bar.inp")) as file:
        lines = file.read().split("*NODE")[1].splitlines()[1:]
    rows = []
    for line in lines:
        if line.startswith("*"):
            break
        rows.append([float(x) for x in line.split(",")[1:4]])
    return np.array(rows)


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
        "mesh": "bar.inp", "material": {"E": 210e9, "nu": 0.3, "rho": 7850.0}, "restrain": ["FIX"], "surface": ["TOP"],
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
    lab.run("recover", "-result", "run.h5", "-output", "stress.h5", "-field_times", "all", "-fields", "field")
    names = sorted(name for name in os.listdir(lab.folder) if name.startswith("field") and name.endswith(".vtu"))
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(lab.path(names[-1]))
    reader.Update()
    data = reader.GetOutput().GetPointData()
    name = next(data.GetArrayName(i) for i in range(data.GetNumberOfArrays()) if data.GetArrayName(i).startswith("displacement"))
    field = vtk_to_numpy(data.GetArray(name))[seen]
    alike(f"displacement of node {marker[1]}, load at {marker[0]}", lab.read("run.h5", "sensors/seen/position")[-1] - X[seen], field, 1e-6)
