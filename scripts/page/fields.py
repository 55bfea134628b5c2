"""Surfaces of a run's bodies with their fields at all times, read from the collection (.pvd) that `elastogear recover` writes."""
import os
import sys
import xml.etree.ElementTree as ET

import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

FIELDS = {"von_mises": 1, "rankine": 1, "error_of_von_mises": 1, "error_of_von_mises_by_mesh": 1, "contact_traction": 3}  # components


class Surface:
    """One body: nodes (mesh numbers, n), triangles (m x 3, into nodes), X (n x 3, m, undeformed, body frame), displacement
    (n_t x n x 3, m, body frame), fields {name: n_t x n}, and its placement rotation (n_t x 3 x 3), position (n_t x 3)."""

    def __init__(self, name, nodes, triangles):
        self.name, self.nodes, self.triangles = name, nodes, triangles
        self.X, self.displacement, self.fields = None, [], {}
        self.rotation, self.position = [], []

    def add(self, data, rotation, position, path):
        """One time. data: its unstructured grid, in the world frame."""
        points = vtk_to_numpy(data.GetPoints().GetData())[self.nodes]
        arrays = {data.GetPointData().GetArrayName(i).split(" [")[0]: data.GetPointData().GetArray(i)
                  for i in range(data.GetPointData().GetNumberOfArrays())}
        if "displacement" not in arrays or "von_mises" not in arrays:
            sys.exit(f"{path}: holds no displacement or no von_mises: expected a field file of elastogear recover")
        if self.X is None:
            self.X = (points - position) @ rotation
        self.displacement.append((vtk_to_numpy(arrays["displacement"])[self.nodes] @ rotation).astype(np.float32))
        for field, components in FIELDS.items():
            if field in arrays:
                values = vtk_to_numpy(arrays[field])[self.nodes]
                values = np.linalg.norm(values, axis=1) if components == 3 else values
                self.fields.setdefault(field, []).append(values.astype(np.float32))
        self.rotation.append(rotation)
        self.position.append(position)

    def finish(self, n_times):
        self.displacement = np.array(self.displacement)
        # A field that is not in all files is in none.
        self.fields = {name: np.array(values) for name, values in self.fields.items() if len(values) == n_times}
        return self


def read_grid(path):
    if not os.path.isfile(path):
        sys.exit(f"{path}: is missing, make the fields again by elastogear recover -field_times all")
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    if reader.GetOutput().GetNumberOfPoints() == 0:
        sys.exit(f"{path}: holds no points")
    return reader.GetOutput()


def skin(data):
    """Nodes (numbers of points, in the order of their first use) and triangles of a volume mesh's outer surface."""
    # Their numbers go along as an array of our own: VTK 9.1 numbers the points of second-order cells anew in vtkOriginalPointIds.
    numbered = vtk.vtkUnstructuredGrid()
    numbered.ShallowCopy(data)
    array = numpy_to_vtk(np.arange(data.GetNumberOfPoints()), deep=True, array_type=vtk.VTK_ID_TYPE)
    array.SetName("number")
    numbered.GetPointData().AddArray(array)
    outer = vtk.vtkDataSetSurfaceFilter()
    outer.SetInputData(numbered)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(outer.GetOutputPort())
    triangles.Update()
    surface = triangles.GetOutput()
    numbers = vtk_to_numpy(surface.GetPointData().GetArray("number"))
    cells = numbers[vtk_to_numpy(surface.GetPolys().GetData()).reshape(-1, 4)[:, 1:]]
    used, first, inverse = np.unique(cells.ravel(), return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(order), dtype=np.int64)
    rank[order] = np.arange(len(order))
    return used[order].astype(np.int64), rank[inverse].reshape(-1, 3)


def series(path):
    """{body: [(time, file)]} of a .pvd file, by time."""
    try:
        entries = ET.parse(path).getroot().iter("DataSet")
        files = [(entry.get("name"), float(entry.get("timestep")), entry.get("file")) for entry in entries]
    except (OSError, ET.ParseError, TypeError, ValueError) as error:
        sys.exit(f"{path}: cannot be read as a ParaView collection: {error}")
    bodies = {}
    for name, time, file in files:
        if not name or not file:
            sys.exit(f"{path}: names no bodies, as those of older versions: run elastogear recover again")
        bodies.setdefault(name, []).append((time, os.path.join(os.path.dirname(path), file)))
    return {name: sorted(entries) for name, entries in bodies.items()}


def read_surfaces(path, result):
    """Times, and a Surface for each body of the collection `path`, whose result file gives the placements."""
    bodies, times = series(path), None
    known = result["time"][:]
    surfaces = []
    for name, entries in bodies.items():
        own = np.array([time for time, _ in entries])
        if times is not None and not np.array_equal(times, own):
            sys.exit(f"{path}: the times of '{name}' are not those of the other bodies")
        if name not in result["bodies"] or np.abs(known[:, None] - own).min(axis=0).max() > 1e-9 * max(abs(known[-1]), 1e-300):
            sys.exit(f"{path}: is not of the run {result.filename}")
        times, state, surface = own, result["bodies"][name], None
        steps = np.abs(known[:, None] - own).argmin(axis=0)
        for step, (_, file) in zip(steps, entries):
            data = read_grid(file)
            surface = surface or Surface(name, *skin(data))
            surface.add(data, state["rotation"][step], state["position"][step], file)
        surfaces.append(surface.finish(len(entries)))
    if not surfaces:
        sys.exit(f"{path}: holds no fields")
    return times, surfaces
