"""Body files that are cut to fewer modes."""
import os
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
        file["modes/Phi"] = np.arange(9.0 * N_MODES).reshape(N_MODES, 3, 3)
        file["reduced/K"] = np.diag(np.arange(1.0, N_MODES + 1))
        file["reduced"].attrs["alpha"] = 0.5
        file["surface/Phi"] = np.arange(6.0 * N_MODES).reshape(2, 3, N_MODES)
        file["surface/X"] = np.arange(6.0).reshape(2, 3)
        file["surface/X"].attrs["unit"] = "m"
        file["surface"].create_dataset("group_name", data=["left"], dtype=h5py.string_dtype())
        file["rigid/mass"] = 2.5


class Cut(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.body = os.path.join(self.folder.name, "body.h5")
        write_body(self.body)

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

    def test_values_at_all_nodes_are_kept_on_demand(self):
        target = os.path.join(self.folder.name, "cut.h5")
        cut(self.body, target, 2, fields=True)
        with h5py.File(target) as part, h5py.File(self.body) as whole:
            np.testing.assert_array_equal(part["modes/Phi"], whole["modes/Phi"][:2])


if __name__ == "__main__":
    unittest.main()
