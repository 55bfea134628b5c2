"""Surfaces of the page's bodies, cut out of meshes of every cell that the program writes."""
import itertools
import os
import sys
import unittest

import numpy as np
import vtk

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
from page import fields  # noqa: E402  (found through the line above)

# Corners in a brick of two half units a side, and the pairs of corners between which nodes lie, in VTK's order.
HEXAHEDRON = ((0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0), (0, 0, 2), (2, 0, 2), (2, 2, 2), (0, 2, 2))
OF_HEXAHEDRON = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
OF_TETRAHEDRON = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
OF_WEDGE = ((0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5))
SIX_TETRAHEDRA = ((0, 1, 2, 6), (0, 2, 3, 6), (0, 3, 7, 6), (0, 7, 4, 6), (0, 4, 5, 6), (0, 5, 1, 6))
TWO_WEDGES = ((0, 2, 1, 4, 6, 5), (0, 3, 2, 4, 7, 6))
CELLS = {  # type of VTK, cells of a brick, edges with nodes
    "hex8": (vtk.VTK_HEXAHEDRON, (tuple(range(8)),), ()),
    "hex20": (vtk.VTK_QUADRATIC_HEXAHEDRON, (tuple(range(8)),), OF_HEXAHEDRON),
    "tet4": (vtk.VTK_TETRA, SIX_TETRAHEDRA, ()),
    "tet10": (vtk.VTK_QUADRATIC_TETRA, SIX_TETRAHEDRA, OF_TETRAHEDRON),
    "wedge6": (vtk.VTK_WEDGE, TWO_WEDGES, ()),
    "wedge15": (vtk.VTK_QUADRATIC_WEDGE, TWO_WEDGES, OF_WEDGE),
}
BRICKS = (3, 2, 2)


def mesh(name):
    """A box of bricks of one unit, cut into cells of one type; its nodes are numbered at random, as in files of other programs."""
    kind, cells, edges = CELLS[name]
    places, nodes_of_cells = {}, []
    for brick in itertools.product(*map(range, BRICKS)):
        corners = 2 * np.array(brick) + np.array(HEXAHEDRON)
        for cell in cells:
            at = [corners[i] for i in cell]
            at += [(at[a] + at[b]) // 2 for a, b in edges]
            nodes_of_cells.append([places.setdefault(tuple(place), len(places)) for place in at])
    number = np.random.default_rng(7).permutation(len(places))
    X = np.empty((len(places), 3))
    X[number] = 0.5 * np.array(list(places))
    grid, points = vtk.vtkUnstructuredGrid(), vtk.vtkPoints()
    for x in X:
        points.InsertNextPoint(x)
    grid.SetPoints(points)
    for nodes in nodes_of_cells:
        grid.InsertNextCell(kind, len(nodes), number[nodes].tolist())
    return grid, X


class Skin(unittest.TestCase):
    def test_surfaces_are_closed_and_have_their_area_and_volume(self):
        for name in CELLS:
            with self.subTest(name):
                grid, X = mesh(name)
                nodes, triangles = fields.skin(grid)
                self.assertEqual(len(np.unique(nodes)), len(nodes))
                a, b, c = X[nodes][triangles].transpose(1, 0, 2)
                area = np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2
                volume = np.einsum("ij,ij", a, np.cross(b, c)) / 6
                self.assertAlmostEqual(area, 2 * (3 * 2 + 3 * 2 + 2 * 2), places=9)
                self.assertAlmostEqual(volume, np.prod(BRICKS), places=9)

    def test_all_nodes_of_the_surface_take_part(self):
        for name in CELLS:
            with self.subTest(name):
                grid, X = mesh(name)
                outer = np.flatnonzero((X == 0).any(axis=1) | (X == BRICKS).any(axis=1))
                self.assertEqual(sorted(fields.skin(grid)[0]), outer.tolist())


if __name__ == "__main__":
    unittest.main()
