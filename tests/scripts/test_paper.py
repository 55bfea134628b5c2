"""scripts/paper: its page of a small folder whose deviations are known, and how it ends where a step fails."""
import os
import re
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

REPOSITORY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(REPOSITORY, "scripts"))
import steps  # noqa: E402  (found through the line above)
from page import paper  # noqa: E402

TIME = np.array([0.0, 1e-3])
CONTACT, BESIDE, AWAY = [0.0, 0.0, 0.0], [1e-3, 0.0, 0.0], [5e-3, 0.0, 0.0]  # m: a node that touches, two of the root


def write_body(path):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear body"
        file["mesh/X"], file["mesh/cell_type"] = np.array([CONTACT, BESIDE, AWAY]), [0]
        file["surface/face"], file["surface/X"] = np.zeros((1, 4), int), np.array([CONTACT])
        file["material/0/E"], file["material/0/nu"], file["modes/frequency"] = 2.1e11, 0.3, np.arange(3.0)


def write_result(path):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear result"
        file.create_group("provenance").attrs.update({"program_version": "1.2.3", "git_hash": "abc"})
        for body in ("worm", "wheel"):
            file[f"bodies/{body}/contact_forces/node"] = [0]


def write_stress(path, factor):
    """Root nodes 1, beside the contact, and 2, with less stress; in proportion to `factor`."""
    with h5py.File(path, "w") as file:
        file.attrs["format"], file["time"] = "elastogear stress", TIME
        for body in ("worm", "wheel"):
            group = file.create_group(body + "/root")
            group["nodes"], group["X"] = [1, 2], np.array([BESIDE, AWAY])
            load = TIME[:, None] * np.array([900e9, 100e9])  # Pa
            group["stress"] = factor * load[:, :, None] * np.arange(1.0, 7)
            group["von_mises"], group["rankine"] = factor * load, 2 * factor * load


def text(page):
    return re.sub(r"<[^>]*>", " ", page)


class Page(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name
        os.mkdir(os.path.join(self.folder, "turn_in"))

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, "-B", os.path.join(REPOSITORY, "scripts", "paper"), *arguments, "--output", self.folder],
                              capture_output=True, encoding="utf-8")

    def page(self):
        run = self.run_script("--page")
        self.assertEqual(run.returncode, 0, run.stderr)
        with open(self.path("paper.html"), encoding="utf-8") as file:
            return file.read()

    def test_an_empty_folder_has_a_page_that_says_so(self):
        page = self.page()
        self.assertEqual(page.count("Not computed"), len(paper.FUNCTIONS))
        self.assertNotIn("http://", page)
        self.assertNotIn("https://", page)

    def test_deviations_stand_beside_the_papers(self):
        for body in ("worm", "wheel"):
            write_body(self.path(body + "_modal_1000.h5"))
        for label, factor in (("full", 1.0), ("modal_1000", 1.1)):
            write_result(self.path("turn_in", label + ".h5"))
            write_stress(self.path("turn_in", label + "_stress.h5"), factor)
        page = text(self.page())
        self.assertRegex(page, r"worm root node 2, 1000 modes(\s+10\.00){8}\s")
        self.assertRegex(page, r"paper, worm node 9391, 1000 modes\s+9\.32\s+4\.59")
        self.assertRegex(page, r"number of nodes\s+3\s+3\s+90082\s+468587")
        self.assertIn("Version 1.2.3, revision abc", page)

    def test_a_worm_that_stops_is_reported(self):
        os.mkdir(self.path("rolling"))
        for body in ("worm", "wheel"):
            write_body(self.path(body + "_modal_1000.h5"))
        write_result(self.path("rolling", "modal_10.h5"))
        write_stress(self.path("rolling", "modal_10_stress.h5"), 1.0)
        with h5py.File(self.path("rolling", "modal_10.h5"), "r+") as file:
            file["time"], file["contact/worm:wheel/force"] = TIME, np.ones((2, 3))
            for body in ("worm", "wheel"):  # two turns asked for, a tenth of one made
                file[f"bodies/{body}/rigid_velocity"] = np.full((2, 1), 4e3 * np.pi)
                file[f"bodies/{body}/rigid"] = np.array([[0.0], [0.2 * np.pi]])
        page = text(self.page())
        self.assertIn("The worm does not roll: it made 0.10 of the 2.00 turns", page)
        self.assertIn("Not computed: the unreduced run is not there", page)

    def test_a_step_that_fails_ends_it(self):
        run = self.run_script("--elastogear", "false")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("mesh_worm: false mesh", run.stderr)
        self.assertFalse(os.path.exists(self.path("paper.html")))


class Remaining(unittest.TestCase):
    def test_time_is_shared_out_by_the_costs_of_the_steps(self):
        run = steps.Steps(costs=[10, 30])
        run.start -= 60
        run.done = 1
        self.assertEqual(run.remaining(), ", about 3 min left")
        run.done = 2
        self.assertEqual(run.remaining(), "")
        self.assertEqual(steps.Steps(3).remaining(), "")


class Parts(unittest.TestCase):
    def test_each_figure_and_table_has_a_function_and_words(self):
        parts = paper.Paper("").values["parts"]
        self.assertEqual([part["name"] for part in parts], list(paper.FUNCTIONS))
        for part in parts:
            self.assertTrue(part["paper"].endswith(".") and part["why"].endswith("."), part["name"])

    def test_rows_of_deviations_have_all_measures(self):
        for bodies in paper.Paper("").values["deviations"].values():
            for nodes in bodies.values():
                for row in nodes.values():
                    self.assertEqual(len(row), len(paper.runs.MEASURES))


if __name__ == "__main__":
    unittest.main()
