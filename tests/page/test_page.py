"""The page of a drive, used in headless Chromium without a network: test_page.py PATH/TO/elastogear [FOLDER to keep]"""
import html
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import types
import unittest
import unittest.mock

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

HERE = os.path.dirname(os.path.abspath(__file__))
SCRIPTS = os.path.join(HERE, "..", "..", "scripts")
sys.path.insert(0, SCRIPTS)
from page import bundle, evaluation, fields, pack, texts  # noqa: E402  (found through the line above)

SKIPPED = 77
DRIVE = """drive: cylindrical
element_order: 1
module: 3 mm
face_width: 9 mm
pinion: {teeth: 17, profile_shift: 0.3}
wheel: {teeth: 23}
torque: 60 N m
modes: 4
static_steps: 3
"""
FACTOR = {"von_mises": 1e-6, "rankine": 1e-6, "contact_traction": 1e-6, "error_of_von_mises": 1e-6, "error_of_von_mises_by_mesh": 1e-6, "error_of_von_mises_by_steps": 1e-6, "displacement": 1e6}


def run(command, folder):
    done = subprocess.run(command, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)} failed:\n{done.stdout}{done.stderr}")
    return done.stdout


def number(text):
    return float(re.search(r"[-\d.]+", text).group())


class Names(unittest.TestCase):
    def test_a_card_of_a_body_with_quotes_names_it(self):
        body = 'wheel "A" <b>'
        peak = types.SimpleNamespace(row=0, step=0, value=2e8, error=1e6, whole_error=None, what="largest", rest=None)
        case = types.SimpleNamespace(peaks=[(body, "root", {"nodes": [7]}, peak)], time=np.array([0.5]), pressures=[], result={"contact": {}})
        with unittest.mock.patch.object(texts, "light_of", return_value=texts.light("good")):
            card = "".join(texts.cards(case))
        self.assertEqual(json.loads(html.unescape(re.search('data-visit="([^"]*)"', card)[1])), {"body": body, "node": 7, "time": 0.5})
        self.assertNotIn("<b>", card)


class Packing(unittest.TestCase):
    """Numbers survive packing to the half of a step."""

    def setUp(self):
        self.random = np.random.default_rng(5)

    def test_indices_and_blocks_are_exact(self):
        triangles = np.array([[0, 1, 2], [2, 1, 3], [0, 2, 4]])
        self.assertEqual(self.unpacked(pack.index_block(triangles), 9).tolist(), [0, 0, 0, 1, 2, 0, 4, 2, 0])
        values = self.random.integers(-70000, 70000, 50)
        z = self.unpacked(pack.block(pack.zigzag(values), 3), 50)
        self.assertEqual(np.where(z % 2, -(z + 1) // 2, z // 2).tolist(), values.tolist())

    def test_displacements_are_within_their_tolerance(self):
        shapes = self.random.standard_normal((12, 90)) * 0.5 ** np.arange(12)[:, None]
        u = self.random.standard_normal((7, 12)) @ shapes
        for tolerance in (1e-1, 1e-3):
            found, weights = pack.low_rank(u, tolerance)
            self.assertLessEqual(np.abs(weights @ found - u).max(), tolerance)
            self.assertLessEqual(np.abs(weights).max(), 1)
        self.assertEqual(len(pack.low_rank(np.outer([1, 2, 3], u[0]), 1e-9)[0]), 1)

    def test_a_box_has_twelve_creases(self):
        box = vtk.vtkUnstructuredGrid()
        points = vtk.vtkPoints()
        for corner in ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)):
            points.InsertNextPoint(corner)
        box.SetPoints(points)
        box.InsertNextCell(vtk.VTK_HEXAHEDRON, 8, list(range(8)))
        nodes, triangles = fields.skin(box)
        X = vtk_to_numpy(box.GetPoints().GetData())[nodes]
        self.assertEqual(len(triangles), 12)
        edges = pack.creases(X, triangles)
        self.assertEqual(len(edges), 12)
        self.assertTrue(np.allclose(np.linalg.norm(X[edges[:, 0]] - X[edges[:, 1]], axis=1), 1))

    @staticmethod
    def unpacked(text, n):
        planes = np.frombuffer(__import__("zlib").decompress(__import__("base64").b64decode(text)), np.uint8).reshape(-1, n)
        return sum(plane.astype(np.int64) << 8 * i for i, plane in enumerate(planes))


class Inputs(unittest.TestCase):
    """A value is listed as it was given, and that of the run beside it where it is another one."""

    def test_values_of_the_run(self):
        def shown(value, used):
            return texts.in_force(types.SimpleNamespace(options={"key": used}), "key", value)

        for value, used in (("3 mm", "0.0030000000000000001"), ("60 N m", "60"), ("15 deg", "15"), ("90 deg", "1.5707963267948966"), ("auto", "auto"), ("1.2.3", "1.2.3")):
            self.assertEqual(shown(value, used), value)
        self.assertEqual(shown("3 mm", "0.004"), "0.004 in this run, 3 mm in the file")
        self.assertEqual(shown("small", "tiny"), "tiny in this run, small in the file")

    def test_figures_have_readable_units(self):
        self.assertEqual([evaluation.in_words(*figure) for figure in ((1.2298e8, "Pa"), (0.99995, "1"), (0, "m"), (41, "1"), (-2.1e-5, "m"))],
                         ["122.98 MPa", "0.99995", "0 m", "41", "-21 µm"])


class Page(unittest.TestCase):
    """What the browser saw, and the files of the run."""

    @classmethod
    def setUpClass(cls):
        with open(os.path.join(WORK, "drive.yaml"), "w", encoding="utf-8") as file:
            file.write(DRIVE)
        for words in (["reduce"], ["simulate"], ["recover", "-field_times", "all"], ["mesh"]):
            run([PROGRAM, words[0], "drive.yaml", *words[1:]], WORK)
        run([sys.executable, "-B", os.path.join(SCRIPTS, "report.py"), "drive.yaml", "--stress", "drive_stress.h5", "--fields", "drive_result.pvd"], WORK)
        page = os.path.join(WORK, "drive_report.html")
        cls.seen = json.loads(run(["node", os.path.join(HERE, "page.mjs"), page, CHROMIUM, WORK], bundle.ready()).splitlines()[-1])
        print(f"first picture after {cls.seen['firstPicture']:.0f} ms, {cls.seen['turn']:.0f} frames/s while turning, {os.path.getsize(page) / 1e6:.2f} MB")

    def test_loads_without_network_and_errors(self):
        self.assertEqual(self.seen["errors"], [])
        self.assertEqual(self.seen["requests"], [])
        self.assertEqual(self.seen["title"], "Gear drive 17 : 23")

    def test_slider_keys_and_choice_change_the_picture(self):
        for what in ("changedByTime", "changedByKey", "changedByQuantity"):
            self.assertGreater(self.seen[what], 500, what)
        self.assertEqual(self.seen["stepByKey"], 1)
        self.assertGreaterEqual(self.seen["charts"], 2)

    def test_picking_gives_the_values_of_the_files(self):
        self.assertEqual([pick["title"].split(",")[0] for pick in self.seen["picks"]], ["pinion", "wheel"])
        for pick in self.seen["picks"] + [self.seen["visited"]]:
            body, node = re.match(r"(\w+), node (\d+)", pick["title"]).groups()
            path = next(path for time, path in fields.series(os.path.join(WORK, "drive_result.pvd"))[body] if abs(time - pick["time"]) < 1e-9)
            grid = fields.read_grid(path)
            for key, text in pick["values"].items():
                name = next(grid.GetPointData().GetArrayName(i) for i in range(grid.GetPointData().GetNumberOfArrays())
                            if grid.GetPointData().GetArrayName(i).split(" [")[0] == key)
                value = np.linalg.norm(vtk_to_numpy(grid.GetPointData().GetArray(name))[int(node)]) if key in ("displacement", "contact_traction") \
                    else vtk_to_numpy(grid.GetPointData().GetArray(name))[int(node)]
                step = number(pick["steps"][key])
                self.assertLessEqual(abs(number(text) - FACTOR[key] * value), 1.6 * step, f"{pick['title']}: {key} {text}, in the file {FACTOR[key] * value}")
                self.assertLess(step, 0.01 * max(1.0, FACTOR[key] * np.abs(vtk_to_numpy(grid.GetPointData().GetArray(name))).max()))

    def test_a_card_shows_its_node(self):
        visited = self.seen["visited"]
        self.assertEqual(visited["title"], f"{visited['body']}, node {visited['node']}")
        self.assertAlmostEqual(visited["time"], 1)

    def test_the_first_numbers_are_tension_at_the_roots_and_hertz_s_pressure(self):
        with open(os.path.join(WORK, "drive_report.html"), encoding="utf-8") as file:
            cards = re.findall(r'<li class="card">(.*?)</li>', file.read(), re.S)
        for card in cards[:2]:
            self.assertRegex(card, r"root</h3><p class=\"figure\">[\d.]+ ± [\d.]+ .*largest tension at the roots.*root, diameter [\d.]+ mm, z -?[\d.]+ mm")
        self.assertIn("largest flank pressure by H. Hertz", cards[2])

    def test_phones_do_not_scroll_sideways(self):
        for width, taken in self.seen["widths"].items():
            self.assertLessEqual(taken, int(width))

    def test_inputs_are_as_given(self):
        self.assertEqual(self.seen["module"], "3 mm")
        self.assertEqual(self.seen["asked"], "What stresses do the teeth of this gear drive have at rest under 60\u00a0N\u00a0m on the pinion?")

    def test_it_is_accessible(self):
        self.assertEqual(self.seen["violations"], [])

    def test_tables_sort_by_number(self):
        values = [float(text) for text in self.seen["sorted"]]
        self.assertEqual(values, sorted(values))

    def test_it_prints_with_its_picture(self):
        self.assertGreater(self.seen["pdf"], 20000)
        self.assertGreater(self.seen["printed"], 5000)


PROGRAM = os.path.abspath(sys.argv[1])
CHROMIUM = shutil.which("chromium") or shutil.which("google-chrome")
if __name__ == "__main__":
    for name, found in (("Chromium", CHROMIUM), ("npm", shutil.which("npm") and shutil.which("node"))):
        if not found:
            print(f"skipped: {name} is not installed; scripts/setup installs it")
            sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as temporary:
        WORK = os.path.abspath(sys.argv[2]) if len(sys.argv) > 2 else temporary
        os.makedirs(WORK, exist_ok=True)
        unittest.main(argv=sys.argv[:1], verbosity=1)
