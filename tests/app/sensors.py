#!/usr/bin/python3
"""Sensors of a gear pair move as the nodes of the field that recover writes of the same run, loaded ones and others, at rest and in a sweep.

    sensors.py PATH/TO/elastogear PATH/TO/examples/drives
"""
import os
import subprocess
import sys
import tempfile

import h5py
import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader

ROUNDOFF = 1e-6  # relative to the displacement
LEFT_OUT = 0.1  # of the displacement of a loaded node, at least, by ten modes


def field(path):
    """Places and displacements of all nodes, m."""
    reader = vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    return vtk_to_numpy(grid.GetPoints().GetData()), vtk_to_numpy(grid.GetPointData().GetArray("displacement [m]"))


SIDES = ((0, 3, 2, 1), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7))  # of a hexahedron by its corners


def weights(X, cells, members):
    """Shares of the nodes of a set: of single nodes 1, of a set that outer sides of hexahedra hold those of the sides' areas, by the
    shape functions of 4 nodes and Gauss's rule of 2 x 2 points."""
    sides, weight, inside = {}, np.zeros(len(X)), set(members)
    for cell in cells:
        for side in (tuple(cell[list(s)]) for s in SIDES):
            key = tuple(sorted(side))
            sides[key] = None if key in sides else side  # inside the body two cells have it
    for side in sides.values():
        if len(members) == 1 or side is None or not inside.issuperset(side):
            continue
        x = X[list(side)]
        for u, v in np.array(((-1, -1), (1, -1), (1, 1), (-1, 1))) / np.sqrt(3):
            N = np.array([(1 - u) * (1 - v), (1 + u) * (1 - v), (1 + u) * (1 + v), (1 - u) * (1 + v)]) / 4
            along = (np.array([v - 1, 1 - v, 1 + v, -1 - v]) @ x / 4, np.array([u - 1, -1 - u, 1 + u, 1 - u]) @ x / 4)
            weight[list(side)] += N * np.linalg.norm(np.cross(*along))
    share = weight[members] if weight[members].all() else np.ones(len(members))
    return share / share.sum()


def most_loaded(result, body):
    with h5py.File(result) as file:
        forces = file["bodies/pinion/contact_forces"]
        last = slice(*forces["offset"][-2:])
        node = forces["node"][last][np.linalg.norm(forces["force"][last], axis=1).argmax()]
    with h5py.File(body) as file:
        return file["surface/nodes"][node]


def look(program, drive):
    def run(verb, *words):
        done = subprocess.run([program, verb, drive, "-size", "tiny", "-element_order", "1", "-modes", "10", *map(str, words)], capture_output=True, text=True,
                              check=False)
        assert done.returncode == 0, done.stderr

    run("reduce")
    run("simulate")
    loaded = most_loaded("spur_c14_result.h5", "pinion.h5")
    markers = {"loaded": loaded + 1, "other": 7, "root": "root"}  # single nodes by their numbers, from 1
    sensors = [word for name, marker in markers.items() for word in (f"-sensors_{name}", f"pinion.{marker}")]
    pull = ["-loads", "pull", "-pull_marker", "pinion.7", "-pull_force", "100,-200,300"]
    for basis in ("modal_residual", "modal"):
        run("reduce", "-basis", basis, "-pinion_markers", ",".join(map(str, markers.values())))
        for analysis in (["static"], ["sweep", "-sweep_positions", 3]):
            run("simulate", "-analysis", *analysis, *sensors, *pull)
            with h5py.File("spur_c14_result.h5") as file:
                time = file["time"][-1]
                position = {name: file[f"sensors/{name}/position"][-1] for name in markers}
                turn, q = (file[f"bodies/pinion/{name}"][-1] for name in ("rotation", "q"))
            run("recover", "-field_times", repr(float(time)))
            X, u = field("spur_c14_result_pinion.vtu")
            with h5py.File("pinion.h5") as file:
                members = {name: file[f"mesh/node_sets/{marker}"][:] for name, marker in markers.items()}
                rest, cells = file["mesh/X"][:], file["mesh/cell_nodes"][:].reshape(-1, 8)
                n_modes = q.size - file["modes"].attrs["attachments"]
                by_modes = file[f"markers/{loaded + 1}/Phi"][:].reshape(6, -1)[:3, :n_modes] @ q[:n_modes]
            size = np.linalg.norm(u[loaded])
            what = f"{basis}, {analysis[0]}"
            for name, nodes in members.items():
                off = np.linalg.norm(position[name] - weights(rest, cells, nodes) @ (X + u)[nodes]) / size
                assert off < ROUNDOFF, f"{what}: sensor {name} is {off} of the displacement beside its nodes"
            left_out = np.linalg.norm(turn @ by_modes - u[loaded]) / size
            print(f"{what}: {1e6 * size:.4f} um at a loaded node, of which the modes leave out {left_out:.3f}")
            if analysis[0] == "static":
                assert (left_out > LEFT_OUT) == (basis == "modal_residual"), left_out


def main():
    program, drives = map(os.path.abspath, sys.argv[1:])
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        look(program, os.path.join(drives, "spur_c14.yaml"))
        os.chdir("/")
    print("sensors move as nodes do")


if __name__ == "__main__":
    main()
