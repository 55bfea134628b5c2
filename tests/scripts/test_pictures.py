"""Pictures of a small field and a small tree, drawn off screen."""
import os
import subprocess
import sys
import tempfile
import unittest
import unittest.mock

import h5py
import numpy as np
import vtk
from vtk.util.numpy_support import numpy_to_vtk, vtk_to_numpy

SCRIPTS = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts")
sys.path.insert(0, SCRIPTS)
import bodies  # noqa: E402  (found through the line above)
import pictures  # noqa: E402
import scene  # noqa: E402
import views  # noqa: E402


def add_array(attributes, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values), deep=True)
    array.SetName(name)
    attributes.AddArray(array)


def write_field(path, with_stress=True, stress=np.arange(8) * 1e7):
    """A unit cube of one hexahedron; stress in Pa at its nodes."""
    grid = vtk.vtkUnstructuredGrid()
    points = vtk.vtkPoints()
    for x, y, z in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)):
        points.InsertNextPoint(x, y, z)
    grid.SetPoints(points)
    grid.InsertNextCell(vtk.VTK_HEXAHEDRON, 8, range(8))
    add_array(grid.GetPointData(), "displacement [m]", np.full((8, 3), 1e-6))
    if with_stress:
        add_array(grid.GetPointData(), "von_mises", stress)
    writer = vtk.vtkXMLUnstructuredGridWriter()
    writer.SetFileName(path)
    writer.SetInputData(grid)
    writer.Write()


def write_body(path):
    """A unit cube of one hexahedron, held at its bottom."""
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear body"
        file["mesh/X"] = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)], dtype=float)
        file["mesh/cell_type"], file["mesh/cell_offset"], file["mesh/cell_nodes"] = [0], [0, 8], np.arange(8)
        file["reduced/free_dof"] = np.arange(12, 24)


def write_start(path):
    """The cube, which turns about z under a torque."""
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear result"
        body = file.create_group("bodies/cube")
        body.attrs["joint"], body["rotation"], body["position"] = "revolute", np.eye(3)[None], np.zeros((1, 3))
        body["rigid_velocity"], body["joint_force"] = [[1.0]], [[-2.0]]


def write_boxes(path):
    """One box of level 1."""
    cube = vtk.vtkCubeSource()
    cube.Update()
    add_array(cube.GetOutput().GetCellData(), "level", np.ones(6, dtype=np.int32))
    writer = vtk.vtkXMLPolyDataWriter()
    writer.SetFileName(path)
    writer.SetInputData(cube.GetOutput())
    writer.Write()


class Files(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)

    def run_pictures(self, *arguments):
        return subprocess.run([os.path.join(SCRIPTS, "pictures.py"), *arguments], capture_output=True, encoding="utf-8",
                              cwd=self.folder.name)

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def test_stress_and_boxes_are_drawn(self):
        write_field(self.path("cube.vtu"))
        write_boxes(self.path("cube.vtp"))
        boxes = ("boxes", "--surfaces", "cube.vtu", "--boxes", "cube.vtp", "--levels", "1", "leaf", "--out", "b.png")
        for arguments in (("stress", "cube.vtu", "--out", "s.png"), boxes):
            run = self.run_pictures(*arguments)
            self.assertEqual(run.returncode, 0, run.stderr)
            self.assertGreater(os.path.getsize(self.path(arguments[-1])), 1000)

    def test_bodies_are_drawn_from_their_files(self):
        write_body(self.path("cube.h5"))
        write_start(self.path("result.h5"))
        for name, colour, *arguments in (("parts", bodies.HELD, "--view", "0.3", "0.5", "-0.8"), ("setup", bodies.SPEED, "result.h5"),
                                         ("spots", bodies.SPOT, "--node", "cube=6")):
            run = self.run_pictures(name, *arguments, "--body-file", "cube=cube.h5", "--out", name + ".png")
            self.assertEqual(run.returncode, 0, run.stderr)
            pixels = self.pixels(name + ".png")
            wanted = np.array([int(colour[i:i + 2], 16) for i in (1, 3, 5)])
            shade = (pixels @ wanted) / np.maximum(np.linalg.norm(pixels, axis=1) * np.linalg.norm(wanted), 1)  # of any brightness
            self.assertTrue((shade > 0.995).any(), name)

    def pixels(self, name):
        """n x 3 colours of a picture, 0 .. 255."""
        reader = vtk.vtkPNGReader()
        reader.SetFileName(self.path(name))
        reader.Update()
        return vtk_to_numpy(reader.GetOutput().GetPointData().GetScalars())[:, :3].astype(int)

    def test_colours_are_those_of_the_bar(self):
        write_field(self.path("cube.vtu"), stress=np.full(8, 7e7))  # MPa: the bar ends at 70, in its darkest colour
        self.assertEqual(self.run_pictures("stress", "cube.vtu", "--out", "s.png").returncode, 0)
        darkest = [int(scene.HEAT[-1][i:i + 2], 16) for i in (1, 3, 5)]
        body = (np.abs(self.pixels("s.png") - darkest).max(axis=1) <= 2).mean()
        self.assertGreater(body, 0.2)  # of the picture: the cube, in no other shade

    def test_what_is_above_the_bar_is_said(self):
        blue = [int(scene.ABOVE[i:i + 2], 16) for i in (1, 3, 5)]
        shares = []
        for stands_out in (3, 1.9):  # half of the nodes are above 3.5
            with unittest.mock.patch.multiple(pictures, SHOWN_QUANTILE=0.5, STANDS_OUT=stands_out):
                end = pictures.colour_range(np.arange(8.0))
            shares.append((end, pictures.stress_label(np.arange(8.0), end)))
        self.assertEqual(shares[0], (7.0, "von Mises stress in MPa, largest 7"))
        self.assertIn("above 3.5, to 7 (4 of 8 nodes)", shares[1][1])
        write_field(self.path("cube.vtu"), stress=1e6 * np.array([1, 1, 1, 1, 1, 1, 1, 1]))
        write_field(self.path("hot.vtu"), stress=1e6 * np.array([1, 1, 1, 1, 1, 1, 1, 9]))
        for name, is_above in (("cube.vtu", False), ("hot.vtu", True)):
            self.assertEqual(self.run_pictures("stress", name, "--like", "cube.vtu", "--out", "s.png").returncode, 0)
            self.assertEqual((np.abs(self.pixels("s.png") - blue).max(axis=1) <= 2).any(), is_above)

    def test_colours_end_where_they_are_told_to(self):
        blue = [int(scene.ABOVE[i:i + 2], 16) for i in (1, 3, 5)]
        write_field(self.path("cube.vtu"))  # 0 to 70 MPa
        for end, is_above in (("50", True), ("90", False)):
            self.assertEqual(self.run_pictures("stress", "cube.vtu", "--end", end, "--out", "s.png").returncode, 0)
            self.assertEqual((np.abs(self.pixels("s.png") - blue).max(axis=1) <= 2).any(), is_above)

    def test_a_field_without_stress_is_refused(self):
        write_field(self.path("cube.vtu"), with_stress=False)
        run = self.run_pictures("stress", "cube.vtu", "--out", "s.png")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("von_mises", run.stderr)
        self.assertFalse(os.path.exists(self.path("s.png")))

    def test_a_level_that_is_not_there_is_refused(self):
        write_boxes(self.path("cube.vtp"))
        with self.assertRaisesRegex(SystemExit, "no boxes of level 3, only of 1"):
            pictures.boxes_of_level(pictures.read(self.path("cube.vtp")), "3", "cube.vtp")


class Choices(unittest.TestCase):
    def test_the_scale_is_a_round_number(self):
        displacement = np.array([[3e-6, 0, 0], [0, 1e-6, 0]])
        self.assertAlmostEqual(pictures.warp_scale(displacement, size=0.1), 1000)

    def test_a_body_that_does_not_move_is_not_enlarged(self):
        self.assertEqual(pictures.warp_scale(np.zeros((2, 3)), size=0.1), 1)

    def test_the_axis_of_a_rod_and_of_a_disc_is_found(self):
        angle = np.linspace(0, 2 * np.pi, 40, endpoint=False)
        circle = np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=1)
        for height in (0.2, 9.0):  # disc, rod
            points = np.vstack([circle, circle + [0, 0, height]])
            np.testing.assert_allclose(np.abs(views.axis_of(points)), [0, 0, 1], atol=1e-12)


if __name__ == "__main__":
    unittest.main()
