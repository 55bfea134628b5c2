"""The deck for CalculiX and the readers of its results, on texts whose values are known."""
import os
import sys
import tempfile
import types
import unittest

import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "scripts"))
import calculix

FRD = """    1C
 -4  DISP        4    1
 -1         1 1.00000E+00 2.00000E+00 3.00000E+00
 -3
 -4  STRESS      6    1
 -5  SXX         1    4    1    1
 -1         1 1.00000E+08 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00
 -1        27 0.00000E+00 0.00000E+00 0.00000E+00 0.00000E+00-5.00000E+07 0.00000E+00
 -3
"""
DAT = """
 total force (fx,fy,fz) for set HELDWHEEL and time  0.5000000E+00

        1.000000E+00  2.000000E+00  3.000000E+00

 total force (fx,fy,fz) for set HELDWHEEL and time  0.1000000E+01

        3.000000E+02 -4.000000E+02  0.000000E+00

 displacements (vx,vy,vz) for set TURN and time  0.1000000E+01

      9 -1.250000E-04  0.000000E+00  0.000000E+00
"""


class Calculix(unittest.TestCase):
    def read(self, reader, text):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "job")
            with open(path, "w", encoding="ascii") as file:
                file.write(text)
            return reader(path)

    def test_stresses_become_von_mises_stresses_of_nodes(self):
        stress = self.read(calculix.read_stress, FRD)
        self.assertEqual(sorted(stress), [1, 27])
        self.assertAlmostEqual(stress[1], 1e8)
        self.assertAlmostEqual(stress[27] / (np.sqrt(3) * 5e7), 1)

    def test_the_last_reaction_and_turn_are_read(self):
        force, turn = self.read(calculix.read_prints, DAT)
        self.assertAlmostEqual(np.linalg.norm(force), 500)
        self.assertAlmostEqual(turn, -1.25e-4)

    def test_faces_are_found_as_sides_of_their_elements(self):
        cells = np.array([[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]])
        sides = calculix.element_sides(cells, np.array([[9, 8, 11, 10], [0, 1, 5, 4]]))
        self.assertEqual(sides, [(1, 1), (0, 2)])

    def test_the_deck_turns_the_worm_about_its_own_axis(self):
        def part(offset, axis):
            return types.SimpleNamespace(X=np.eye(8, 3), cells=np.arange(8).reshape(1, 8), held=np.array([0, 1]), offset=offset,
                                         material=[210e9, 0.3], faces=[(0, 1)], stiffness=1e14, axis=np.array(axis, float))
        options = types.SimpleNamespace(stiffness=0, increment=0.25, torque=4)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "job.inp")
            calculix.write_deck(path, part(0, [-1, 0, 0]), part(8, [0, 0, 1]), options)
            with open(path, encoding="ascii") as file:
                deck = file.read()
            self.assertIn("18, 1, -4\n", deck)
            self.assertIn("LINEAR\n5e+13\n", deck)
            self.assertIn("TYPE=SURFACE TO SURFACE\nSworm, Swheel\n", deck)
            self.assertIn("2, S2\n", deck)
            with self.assertRaises(SystemExit):
                calculix.write_deck(path, part(0, [0, 1, 0]), part(8, [0, 0, 1]), options)


if __name__ == "__main__":
    unittest.main()
