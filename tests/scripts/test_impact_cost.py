"""The table of CPU times, and the bodies that are cut for it."""
import os
import subprocess
import sys
import tempfile
import unittest

import h5py
import numpy as np

REPOSITORY = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(REPOSITORY, "scripts"))
from cut import cut

N_MODES = 4


def write_body(path):
    with h5py.File(path, "w") as file:
        file.attrs["format"] = "elastogear body"
        file["modes/frequency"] = np.arange(1.0, N_MODES + 1)
        file["modes/Phi"] = np.zeros((N_MODES, 3, 3))
        file["reduced/K"] = np.diag(np.arange(1.0, N_MODES + 1))
        file["reduced"].attrs["alpha"] = 0.5
        file["surface/Phi"] = np.arange(6.0 * N_MODES).reshape(2, 3, N_MODES)
        file["surface/X"] = np.arange(6.0).reshape(2, 3)
        file["surface/X"].attrs["unit"] = "m"
        file["surface"].create_dataset("group_name", data=["left"], dtype=h5py.string_dtype())
        file["rigid/mass"] = 2.5


class Cost(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.body = os.path.join(self.folder.name, "body.h5")
        write_body(self.body)

    def run_script(self, *arguments):
        return subprocess.run([sys.executable, os.path.join(REPOSITORY, "studies", "impact_cost.py"), self.body, self.body,
                               *arguments], capture_output=True, encoding="utf-8", cwd=self.folder.name)

    def test_a_cut_body_has_the_first_modes_and_all_else(self):
        target = os.path.join(self.folder.name, "cut.h5")
        cut(self.body, target, 2)
        with h5py.File(target) as part, h5py.File(self.body) as whole:
            self.assertEqual(part.attrs["format"], "elastogear body")
            self.assertEqual(part["reduced"].attrs["alpha"], 0.5)
            self.assertEqual(part["surface/X"].attrs["unit"], "m")
            self.assertEqual(part["rigid/mass"][()], 2.5)
            self.assertEqual(part["surface/group_name"].asstr()[0], "left")
            np.testing.assert_array_equal(part["modes/frequency"], [1, 2])
            np.testing.assert_array_equal(part["reduced/K"], [[1, 0], [0, 2]])
            np.testing.assert_array_equal(part["surface/Phi"], whole["surface/Phi"][:, :, :2])
            np.testing.assert_array_equal(part["surface/X"], whole["surface/X"])
            self.assertNotIn("Phi", part["modes"])

    def test_every_number_of_modes_has_its_row(self):
        run = self.run_script("--modes", "2", "4", "--elastogear", "true")
        self.assertEqual(run.returncode, 0, run.stderr)
        self.assertEqual([line.split()[0] for line in run.stdout.splitlines()[1:3]], ["2", "4"])
        self.assertIn("growth from 2 to 4 modes", run.stdout)

    def test_more_modes_than_there_are_is_an_error(self):
        run = self.run_script("--modes", "5", "--elastogear", "true")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("4 modes, not 5", run.stderr)

    def test_a_run_that_fails_is_shown(self):
        run = self.run_script("--modes", "2", "--elastogear", "false")
        self.assertNotEqual(run.returncode, 0)
        self.assertIn("simulate", run.stderr)


if __name__ == "__main__":
    unittest.main()
