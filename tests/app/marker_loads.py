#!/usr/bin/python3
"""Loads and bushings at markers have the whole static response of the body in sensors, fields and stresses: a bar with few modes beside
the same bar in its full basis, at rest, in motion, and in a run that was stopped and goes on; of hexahedra of 8 and of 20 nodes, turned in
the world, with a contact surface and without one.

    marker_loads.py PATH/TO/elastogear
"""
import os
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy as np
import yaml
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

ELASTOGEAR = os.path.abspath(sys.argv[1])
CORNERS = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]])
EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
NODES = np.vstack([CORNERS, [(CORNERS[a] + CORNERS[b]) / 2 for a, b in EDGES]])
CELLS, SIZE = (8, 2, 2), np.array([0.1, 0.02, 0.02])  # -, m
AT_REST = 1e-6  # of static responses, relative to the largest: stored modes and Newton's iterations
IN_MOTION = 2e-3  # of a pulse of six periods of the lowest mode, by the inertia of what is left out
LEFT_OUT = 0.2  # at least, of the stress at the loaded end, by the modes alone


def mesh(nodes_of_cell):
    """bar.inp; node sets FIX and END, CORNER of one node and SIDE of some, surface TOP."""
    nodes, cells = {}, []
    for at in np.ndindex(*CELLS):
        x = (np.array(at) + NODES[:nodes_of_cell]) / CELLS * SIZE
        cells.append([nodes.setdefault(tuple(np.round(p, 9)), len(nodes) + 1) for p in x])
    X = np.array(list(nodes))
    low, high = abs(X) < 1e-9, abs(X - SIZE) < 1e-9
    middle = abs(X[:, 0] - SIZE[0] / 2) < 0.013
    sets = {"FIX": low[:, 0], "END": high[:, 0], "SIDE": middle & high[:, 1], "CORNER": high.all(axis=1)}
    with open("bar.inp", "w", encoding="utf-8") as file:
        file.write("*NODE\n" + "".join(f"{i + 1}, {x[0]:.9g}, {x[1]:.9g}, {x[2]:.9g}\n" for i, x in enumerate(X)))
        file.write(f"*ELEMENT, TYPE=C3D{nodes_of_cell}, ELSET=ALL\n")
        for i, cell in enumerate(cells):
            numbers = [i + 1, *cell]
            file.write(", ".join(map(str, numbers[:16])) + (",\n" + ", ".join(map(str, numbers[16:])) if len(numbers) > 16 else "") + "\n")
        for name, chosen in sets.items():
            file.write(f"*NSET, NSET={name}\n" + "".join(f"{i + 1},\n" for i in np.flatnonzero(chosen)))
        top = [i + 1 for i, cell in enumerate(cells) if high[np.array(cell) - 1, 2].any()]
        file.write("*SURFACE, NAME=TOP, TYPE=ELEMENT\n" + "".join(f"{i}, S2\n" for i in top))


def run(verb, *words, expected=0):
    done = subprocess.run([ELASTOGEAR, verb, *map(str, words)], capture_output=True, text=True, check=False)
    assert done.returncode == expected, f"{verb} {words}: {done.stdout}{done.stderr}"
    return done.stdout


def write(name, **keys):
    with open(name, "w", encoding="utf-8") as file:
        yaml.safe_dump(keys, file)


def field():
    """Displacements and von Mises stresses of all nodes in the last field."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName("field_bar.vtu")
    reader.Update()
    data = reader.GetOutput().GetPointData()
    return vtk_to_numpy(data.GetArray("displacement [m]")), vtk_to_numpy(data.GetArray("von_mises [Pa]"))


def results(name, at):
    run("recover", "-result", f"{name}_run.h5", "-output", "stress.h5", "-stress_bar", "END", "-field_times", at, "-fields", "field")
    with h5py.File(f"{name}_run.h5") as file, h5py.File("stress.h5") as stress:
        found = {f"sensor {s}": file[f"sensors/{s}/position"][:] - file[f"sensors/{s}/position"][0] for s in file["sensors"]}
        found["turn"] = file["sensors/end/rotation"][:] - file["sensors/end/rotation"][0]
        found["bushing"] = file["bushings/spring/force"][:]
        found["stress"] = stress["bar/END/stress"][:]
    found["displacement"], found["von Mises"] = field()
    return found


def alike(what, found, expected, bound):
    for name, reference in expected.items():
        off = np.abs(found[name] - reference).max() / np.abs(reference).max()
        assert off < bound, f"{what}: {name} is {off:.3g} off, allowed {bound}"


def system(**more):
    """Forces and moments at two markers, a spring at a third, in a frame that is turned."""
    write("system.yaml", bodies=["bar"], bar={"joint": "fixed", "position": [0.3, -0.2, 0.1], "rotation": [0.5, -0.8, 1.1]},
          loads=["push", "twist"], push={"marker": "bar.CORNER", "force": [300, -200, 500], "frame": "world", **more.pop("push", {})},
          twist={"marker": "bar.END", "force": [0, 100, 0], "torque": [5, 3, -4], "frame": "body", **more.pop("twist", {})},
          bushings=["spring"], spring={"markers": ["ground", "bar.SIDE"], "stiffness": [1e8, 2e8, 1.5e8], "rotational_stiffness": [1e4] * 3},
          sensors={"end": "bar.END", "corner": "bar.CORNER", "side": "bar.SIDE"}, **more)


def refuse_earlier():
    """Bodies of earlier versions have static responses to contact forces alone."""
    shutil.copy("few.h5", "earlier.h5")
    with h5py.File("earlier.h5", "a") as file:
        del file["modes"].attrs["attachments"]
    done = subprocess.run([ELASTOGEAR, "simulate", "system.yaml", "-bar_file", "earlier.h5", "-output", "none.h5"], capture_output=True,
                          text=True, check=False)
    assert done.returncode != 0 and "reduce the body again" in done.stderr, done.stderr


def look(nodes_of_cell, surface):
    mesh(nodes_of_cell)
    write("body.yaml", mesh="bar.inp", material={"E": 210e9, "nu": 0.3, "rho": 7850.0}, restrain=["FIX"], stress_nodes=["END"],
          markers=["END", "CORNER", "SIDE"], **({"surface": ["TOP"]} if surface else {}))
    for name, words in {"few": ["-modes", 8], "full": ["-basis", "full"], "modal": ["-basis", "modal", "-modes", 8]}.items():
        run("reduce", "body.yaml", *words, "-output", f"{name}.h5")
    what = f"{nodes_of_cell} nodes a cell, {'with' if surface else 'without'} a surface"

    system(analysis="static", static_steps=2)
    found = {}
    for name in ("few", "full", "modal"):
        run("simulate", "system.yaml", "-bar_file", f"{name}.h5", "-output", f"{name}_run.h5")
        found[name] = results(name, 1)
    alike(f"{what}, at rest", found["few"], found["full"], AT_REST)
    if surface:
        refuse_earlier()
    lost = np.abs(found["modal"]["stress"] - found["full"]["stress"]).max() / np.abs(found["full"]["stress"]).max()
    assert lost > LEFT_OUT, lost

    times = np.linspace(0, 1.5e-3, 61)
    with open("pulse.csv", "w", encoding="utf-8") as file:
        file.write("".join(f"{t},{(1 - np.cos(2 * np.pi * t / times[-1])) / 2}\n" for t in times))
    pulse = {"signal": ["table", "pulse.csv"]}
    system(push=pulse, twist=pulse, ts={"dt": 5e-6, "max_time": 1e-3}, output_every=20)
    for name in ("few", "full"):
        run("simulate", "system.yaml", "-bar_file", f"{name}.h5", "-output", f"{name}_run.h5")
        found[name] = results(name, 7.5e-4)
    alike(f"{what}, in motion", found["few"], found["full"], IN_MOTION)

    run("simulate", "system.yaml", "-bar_file", "few.h5", "-output", "cut_run.h5", "-ts_max_steps", 90, expected=1)
    run("simulate", "system.yaml", "-bar_file", "few.h5", "-output", "cut_run.h5")
    alike(f"{what}, resumed", results("cut", 7.5e-4), found["few"], 1e-15)
    print(f"{what}: as the full basis; modes alone leave out {lost:.2f} of the stress at rest")


def pull(nodes_of_cell):
    """A force that is spread by area is an even traction: 100 MPa at every node of the end, and a moment bends it in a straight line: a
    small one, because what acts turns with the end, by its angle squared."""
    mesh(nodes_of_cell)
    run("reduce", "-mesh", "bar.inp", "-material_E", "210e9", "-material_nu", "0", "-material_rho", "7850", "-restrain", "FIX", "-stress_nodes", "END",
        "-markers", "END", "-basis", "full", "-output", "pulled.h5")
    for what, load, stress in (("force", ["-p_force", "40000,0,0"], lambda X: 100e6 + 0 * X[:, 1]),
                               ("moment", ["-p_torque", "0,0,-1"], lambda X: (X[:, 1] - 0.01) / (0.02**4 / 12))):
        run("simulate", "-bodies", "bar", "-bar_file", "pulled.h5", "-loads", "p", "-p_marker", "bar.END", *load, "-analysis", "static", "-output", "p.h5")
        run("recover", "-result", "p.h5", "-output", "p_stress.h5", "-stress_bar", "END")
        with h5py.File("p_stress.h5") as file:
            found, X = file["bar/END/stress"][-1, ..., 0].ravel(), file["bar/END/X"][:].reshape(-1, 3)
        off = np.abs(found - stress(X)).max() / np.abs(stress(X)).max()
        print(f"{nodes_of_cell} nodes a cell, {what} by area: stress at the end off by {off:.2g}")
        assert off < 1e-6 if what == "force" or nodes_of_cell == 20 else off < 0.1, off


def main():
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        pull(8)
        pull(20)
        look(8, True)
        look(8, False)
        look(20, True)
        os.chdir("/")


if __name__ == "__main__":
    main()
