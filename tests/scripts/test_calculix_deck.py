"""The deck for CalculiX and the readers of its results, on texts whose values are known."""
import os
import sys
import tempfile
import types
import unittest

import h5py
import numpy as np

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..", "studies"))
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

 statistics for slave set THREAD_1_LEFT, master set TOOTH_01_RIGHT and time  0.1000000E+01

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

    3.000000E+00  4.000000E+00  0.000000E+00  1.000000E+00  2.000000E+00  3.000000E+00

   area,  normal force (+ = tension) and shear force (size)

    1.677029E-06 -5.000000E+00  2.000000E-02
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

    def test_the_last_reaction_the_turn_and_the_force_of_each_pair_are_read(self):
        force, turn, pairs = self.read(calculix.read_prints, DAT)
        self.assertAlmostEqual(np.linalg.norm(force), 500)
        self.assertAlmostEqual(turn, -1.25e-4)
        self.assertEqual(list(pairs), [("thread_1_left", "tooth_01_right")])
        self.assertAlmostEqual(np.linalg.norm(pairs["thread_1_left", "tooth_01_right"]), 5)

    def test_faces_are_found_as_sides_of_their_elements(self):
        cells = np.array([[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]])
        sides = calculix.element_sides(cells, np.array([[9, 8, 11, 10], [0, 1, 5, 4]]))
        self.assertEqual(sides, [(1, 1), (0, 2)])

    def deck(self, axis, contact):
        def part(offset, axis, area):
            return types.SimpleNamespace(X=np.eye(8, 3), cells=np.arange(8).reshape(1, 8), held=np.array([0, 1]), offset=offset,
                                         material=[210e9, 0.3], faces={area: [(0, 1)]}, stiffness=1e14, element="C3D8",
                                         axis=np.array(axis, float), centres=lambda area: np.zeros((1, 3)))
        options = types.SimpleNamespace(stiffness=0, increment=0.25, torque=4, contact=contact)
        loads = ({2: np.array([0, 7.0, 0])}, {3: np.array([0, -7.0, 0])})
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "job.inp")
            calculix.write_deck(path, (part(0, axis, "thread"), part(8, [0, 0, 1], "tooth")), loads, [("thread", "tooth")], options)
            with open(path, encoding="ascii") as file:
                return file.read()

    def test_the_deck_turns_the_worm_about_its_own_axis(self):
        deck = self.deck([-1, 0, 0], "faces")
        self.assertIn("18, 1, -4\n", deck)
        self.assertIn("LINEAR\n5e+13\n", deck)
        self.assertLess(deck.index("*BOUNDARY\n18, 1, 1\n"), deck.index("*BOUNDARY, OP=NEW\n"))
        self.assertLess(deck.index("REMOVE\nthread_tooth, tooth\n"), deck.index("ADD\nthread_tooth, tooth\n"))
        self.assertIn("TYPE=SURFACE TO SURFACE\nthread_tooth, tooth\n", deck)
        self.assertIn("2, S2\n", deck)
        with self.assertRaises(SystemExit):
            self.deck([0, 1, 0], "faces")

    def test_each_face_of_the_worm_goes_to_the_nearest_tooth(self):
        places = {"left": [[0, 0, 0], [1, 0, 0], [5, 0, 0]], "tooth_1": [[0.1, 0, 0]], "tooth_2": [[9, 0, 0], [4, 0, 0]]}
        part = types.SimpleNamespace(faces={"left": ["a", "b", "c"]}, centres=lambda area: np.array(places[area], float))
        self.assertEqual(calculix.mates(part, part, [("left", "tooth_1"), ("left", "tooth_2")]),
                         {("left", "tooth_1"): ["a", "b"], ("left", "tooth_2"): ["c"]})

    def test_nodes_that_touch_have_a_law_with_a_rounded_corner(self):
        deck = self.deck([1, 0, 0], "nodes")
        self.assertIn("LINEAR\n5e+13, 4e+06\n", deck)
        self.assertIn("TYPE=NODE TO SURFACE\nthread_tooth, tooth\n", deck)
        self.assertNotIn("CONTACT PRINT", deck)

    def test_forces_act_on_the_nodes_of_both_bodies_which_are_held(self):
        deck = self.deck([1, 0, 0], "forces")
        self.assertIn("3, 2, 7\n", deck)
        self.assertIn("12, 2, -7\n", deck)
        self.assertIn("HELDworm, 1, 3\n", deck)
        self.assertNotIn("CONTACT", deck)

    def test_contact_forces_are_those_of_the_result_and_sums_between_areas(self):
        worm = types.SimpleNamespace(node=np.arange(10, 14), area_of_node={0: "thread"})
        wheel = types.SimpleNamespace(node=np.arange(20, 24), face=np.array([[0, 1, 2, 3]]), area=["tooth"])
        turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "result.h5")
            with h5py.File(path, "w") as file:
                file.attrs["format"] = "elastogear result"
                for body, offset, node, force in (("worm", [0, 0, 1], [0], [[4.0, 0, 0]]),
                                                  ("wheel", [0, 1, 3], [3, 0, 1], [[9.0, 9, 9], [0, 3, 0], [0, 1, 0]])):
                    file[f"bodies/{body}/rotation"] = np.stack([np.eye(3), turn if body == "wheel" else np.eye(3)])
                    for name, values in (("offset", offset), ("node", node), ("force", force)):
                        file[f"bodies/{body}/contact_forces/{name}"] = values
                for name, values in (("offset", [0, 1, 2]), ("slave_side", [1, 0]), ("slave_node", [3, 0]), ("face", [0, 0]),
                                     ("force", [[9.0, 9, 9], [4, 0, 0]])):
                    file[f"contact/worm:wheel/points/{name}"] = values
            loads, pairs = calculix.contact_loads(path, (worm, wheel))
            with h5py.File(path, "r+") as file:
                del file["bodies/worm/contact_forces"]
            with self.assertRaisesRegex(SystemExit, "result.h5: holds no contact forces at nodes"):
                calculix.contact_loads(path, (worm, wheel))
        self.assertEqual([list(load) for load in loads], [[10], [20, 21]])
        np.testing.assert_allclose(loads[0][10], [4, 0, 0])
        np.testing.assert_allclose([loads[1][20], loads[1][21]], [[-3, 0, 0], [-1, 0, 0]])
        np.testing.assert_allclose(pairs["thread", "tooth"], [-4, 0, 0])


if __name__ == "__main__":
    unittest.main()
