"""The Python module beside the program: equal numbers and equal messages, and bad input.

    module_test.py PATH/TO/elastogear [unittest's arguments]
"""
import copy
import json
import os
import warnings

import numpy as np

import elastogear as eg
from shared import MOTION, REST, SPUR, WithDrive, command, main, set_up

setUpModule = set_up


class Runs(WithDrive):
    def test_stepped_motion_equals_that_of_the_program_to_the_bit(self):
        with open("spur.yaml", "w", encoding="utf-8") as file:
            file.write("""
                drive: cylindrical
                element_order: 1
                module: 3 mm
                face_width: 25 mm
                torque: 300 N m
                pinion: {teeth: 17, profile_shift: 0.3}
                wheel: {teeth: 43, profile_shift: 0.1}
                analysis: dynamic
                modes: 4
                basis: modal
                """)
        words = [word for key, value in MOTION.items() for word in (f"-{key}", str(value))]
        done = command("simulate", "spur.yaml", "-output", "program.h5", *words)
        self.assertEqual(done.returncode, 0, done.stderr)
        program = eg.Result("program.h5")
        pinion, pair = program.body("pinion"), program.pair("pinion:wheel")
        simulation = eg.Drive("spur.yaml").simulation(output="stepped.h5", **MOTION)
        states = [simulation.state, *simulation]
        self.assertEqual(len(states), len(program.time))
        self.assertGreater(max(state.pair("pinion:wheel").count for state in states), 0)
        for i, state in enumerate(states):
            self.assertEqual(state.time, program.time[i])
            for name in ["q", "q_dot", "q_ddot", "s", "s_dot", "s_ddot", "rotation"]:
                np.testing.assert_array_equal(getattr(state.body("pinion"), name), getattr(pinion, name)[i])
            np.testing.assert_array_equal(state.pair("pinion:wheel").force, pair.force[i])
            for name in state.pair("pinion:wheel").contacts.dtype.names:
                np.testing.assert_array_equal(state.pair("pinion:wheel").contacts[name],
                                              program.contacts("pinion:wheel")[i][name])
        stepped = eg.Result("stepped.h5")
        self.assertTrue(stepped.complete)
        np.testing.assert_array_equal(stepped.body("wheel").q, program.body("wheel").q)
        self.assertTrue(simulation.summary()["complete"])

    def test_equilibrium_and_stresses_from_a_dict(self):
        result = self.drive.simulate(**REST)
        stress = self.drive.recover()
        self.assertEqual(result.bodies, ["pinion", "wheel"])
        self.assertAlmostEqual(result.time[-1], 1)
        root = stress["pinion", "root"]
        self.assertEqual(root.stress.shape, (*root.von_mises.shape, 6))
        self.assertEqual(root.mesh_error.shape, root.von_mises.shape)
        np.testing.assert_allclose(eg.von_mises(root.stress[-1]), root.von_mises[-1])
        parts = [each for each in (root.error, root.mesh_error, root.contact_error, root.time_error) if each is not None]
        np.testing.assert_allclose(root.total_error, sum(parts))
        self.assertTrue(np.all(root.total_peak_error >= root.peak_error))
        peak = root.von_mises[-1].argmax()
        self.assertGreaterEqual(root.total_peak_error[-1], root.peak_error[-1] + root.mesh_error[-1, peak])
        self.assertIn("force (", repr(result.pair("pinion:wheel")))
        with open("dict.yaml", "w", encoding="utf-8") as file:
            json.dump(SPUR, file)
        done = command("recover", "dict.yaml", "-result", result.path, "-output", "program_stress.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        by_program = eg.Stress("program_stress.h5")["pinion", "root"]
        np.testing.assert_array_equal(root.stress, by_program.stress)
        self.assertEqual(set(result.energies), {"kinetic", "elastic", "contact", "bushing", "dissipated", "work", "balance"})
        body = eg.Body("pinion.h5")
        self.assertEqual(body.stress("root", result.body("pinion").q[-1]).shape, (len(root.node), 6))
        self.assertEqual(len(body.frequencies), 4)
        self.assertEqual([result.time_axis, stress.time_axis], 2 * [("load factor", "1")])
        with self.assertRaisesRegex(KeyError, "pinion root"):
            stress["pinion", "tip"]
        import matplotlib
        matplotlib.use("Agg")
        from elastogear import plots
        for picture in [result.plot(), stress.plot(), plots.energies(result), plots.speed(result),
                        plots.stress_map(root), plots.mesh(self.drive.meshes()["wheel"])]:
            picture.figure.canvas.draw()
            self.assertIn(picture.get_xlabel(), ["load factor", "x in mm"])
            matplotlib.pyplot.close(picture.figure)

    def test_a_result_whose_file_is_written_anew_is_no_other_result(self):
        first = self.drive.simulate(**REST)
        second = self.drive.simulate(roll=0.5, contact_law="unilateral")
        self.assertEqual(second.body("pinion").s.shape[0], len(second.time))
        with self.assertRaisesRegex(eg.Error, "written anew since this result was made; give each run an output"):
            first.body("pinion")
        with self.assertRaisesRegex(eg.Error, "written anew"):
            first.energies

    def test_facts_are_numbers_with_units(self):
        facts = self.drive.facts
        self.assertAlmostEqual(facts["pinion"]["pitch diameter"], 51e-3)
        self.assertEqual(facts["pinion"]["pitch diameter"].unit, "m")
        self.assertEqual(str(facts["pinion"]["pitch diameter"]), "0.051 m")
        self.assertEqual(facts["wheel"]["teeth"], 43)
        self.assertEqual((str(facts["wheel"]["teeth"]), facts["wheel"]["teeth"].unit), ("43", "1"))
        self.assertEqual(facts["pinion"]["pitch_diameter"], facts["pinion"]["pitch diameter"])
        with self.assertRaisesRegex(KeyError, "pitch: there is no such fact; there are: teeth, "):
            facts["pinion"]["pitch"]
        self.assertAlmostEqual(facts["pinion:wheel"]["ratio"], 43 / 17)
        self.assertEqual(copy.deepcopy(facts["pinion"]["bore"]).unit, "m")

    def test_drives_are_varied_and_compared(self):
        other = self.drive.replace(wheel={"profile_shift": 0.2}, torque="7 N m")
        self.assertEqual(other.facts["wheel"]["profile shift"], 0.2)
        wider = other.replace(wheel={"face_width": "20 mm"}, name="wider")
        self.assertEqual(wider.facts["wheel"]["profile shift"], 0.2)
        self.assertEqual(wider.facts["wheel"]["face width"], 20e-3)
        differences = self.drive.differences(other)
        self.assertEqual(differences["wheel"]["profile shift"], (0.1, 0.2))
        self.assertIn("centre distance", differences["pinion:wheel"])
        self.assertEqual(self.drive.differences(wider.replace(wheel=None)), {})
        self.assertEqual(self.drive.differences(other.replace(wheel_profile_shift=0.1)), {})
        train = eg.Drive({**SPUR, "gears": ["pinion", "wheel", "wheel_2"], "wheel_2": {"teeth": 31}})
        turned = train.replace(wheel={"profile_shift": 0.2}, wheel_2={"profile_shift": 0.15}).replace(wheel=None)
        self.assertEqual(turned.facts["wheel"]["profile shift"], 0.1)
        self.assertEqual(turned.facts["wheel_2"]["profile shift"], 0.15)
        self.assertRegex(str(self.drive), "pinion:wheel\n(.*\n)*  ratio +2.529")
        with self.assertRaisesRegex(eg.Error, "profile_shift"):
            self.drive.replace(pinion={"profile_shift": "large"})

    def test_run_makes_what_is_missing_and_returns_the_evaluation(self):
        drive = eg.Drive(SPUR, name="whole", face_width="6 mm", torque="50 N m", sweep_positions=3)
        first = drive.run(pinion_file="whole_pinion.h5", wheel_file="whole_wheel.h5")
        path = "root/pinion/largest_tension"
        self.assertGreater(first[path], 0)
        self.assertEqual(first.unit(path), "Pa")
        self.assertGreater(first.error(path), 0)
        self.assertIsNone(first.error("teeth/contact_ratio"))
        self.assertTrue(path in first and "root/pinion" not in first)
        self.assertEqual((len(first), list(first)), (len(first.paths), list(first.keys())))
        self.assertTrue(any(each.endswith(path) for each in first.find("tension")))
        for wrong, message in [("root/pinion", "below it are .*/largest_tension"), ("root/pinion/largest_tensio", "near it are .*/largest_tension")]:
            with self.assertRaisesRegex(KeyError, message):
                first[wrong]
        again = drive.run(pinion_file="whole_pinion.h5", wheel_file="whole_wheel.h5")
        self.assertEqual((again.report["reduce"], again.report["simulate"]), ("the bodies are there", "the result is there"))
        self.assertEqual(again[path], first[path])

    def test_evaluate_reads_what_was_swept_last(self):
        drive = eg.Drive(SPUR, name="varied", sweep_positions=2, pinion_file="pinion.h5", wheel_file="wheel.h5")
        drive.sweep()
        self.assertEqual(len(drive.evaluate().find("KHbeta")), 1)
        results = drive.sweep(variants={"nominal": {}, "tilted": {"wheel": {"skew": "0.02 deg"}}})
        self.assertEqual([result.inputs["variant"] for result in results], ["nominal", "tilted"])
        self.assertEqual(len(drive.evaluate().find("KHbeta")), 2)
        self.assertEqual(len(drive.evaluate(result=results[0]).find("KHbeta")), 1)

    def test_messages_are_those_of_the_program(self):
        def message(**options):
            with self.assertRaises(eg.Error) as caught:
                self.drive.simulate(**options)
            return str(caught.exception)

        with open("plain.yaml", "w", encoding="utf-8") as file:
            file.write("{drive: cylindrical, element_order: 1, module: 3 mm, face_width: 25 mm, torque: 300 N m, modes: 4, basis: modal, "
                       "pinion: {teeth: 17, profile_shift: 0.3}, wheel: {teeth: 43, profile_shift: 0.1}}")
        for option, value in [("rol", 0.1), ("static_steps", 0), ("torque", "3 mm"), ("analysis", "statistic"),
                              ("pinion_file", "nowhere.h5"), ("contact_friction", -1)]:
            program = command("simulate", "plain.yaml", f"-{option}", str(value)).stderr
            self.assertEqual(f"elastogear simulate: error: {message(**{option: value})}", program.strip().splitlines()[-1])

    def test_warnings_are_those_of_python(self):
        with warnings.catch_warnings():
            warnings.simplefilter("error", eg.Warning)
            with self.assertRaisesRegex(eg.Warning, "too coarse a surface"):
                self.drive.simulate(**REST)

    def test_options_have_tables(self):
        rows = {row[0]: row for row in eg.option_table("simulate")}
        self.assertEqual(rows["ts_dt"][1], "s")
        self.assertEqual(rows["contact_friction"][2], "0")
        with self.assertRaisesRegex(eg.Error, "the verbs are run, mesh, "):
            eg.option_table("simulat")


class States(WithDrive):
    def test_arrays_are_views_that_stay(self):
        simulation = self.drive.simulation(**MOTION)
        state = simulation.state
        q = state.body("pinion").q
        kept = q.copy()
        contacts = state.pair("pinion:wheel").contacts
        self.assertFalse(q.flags.owndata or q.flags.writeable or contacts.flags.writeable)
        self.assertTrue(np.shares_memory(q, state.body("pinion").q))
        with self.assertRaises(ValueError):
            q[0] = 1
        for _ in range(3):
            simulation.step()
        last = simulation.state.body("pinion").q
        self.assertFalse(np.shares_memory(q, last))
        simulation.close()
        del state, simulation
        np.testing.assert_array_equal(q, kept)
        self.assertTrue(np.isfinite(last).all())

    def test_names_that_are_not_there(self):
        state = self.drive.simulation(**MOTION).state
        with self.assertRaisesRegex(eg.Error, "there is no 'worm'; there are: pinion, wheel"):
            state.body("worm")
        self.assertEqual(list(state.bodies), ["pinion", "wheel"])

    def test_closed_simulation(self):
        simulation = self.drive.simulation(**MOTION)
        simulation.close()
        simulation.close()
        for use in [simulation.step, lambda: simulation.state, simulation.summary]:
            with self.assertRaisesRegex(eg.Error, "this simulation is closed"):
                use()

    def test_early_end_leaves_a_whole_file(self):
        with self.drive.simulation(output="early.h5", **MOTION) as simulation:
            for _ in range(5):
                simulation.step()
        result = eg.Result("early.h5")
        self.assertFalse(result.complete)
        self.assertEqual(len(result.time), 6)
        self.assertFalse([name for name in os.listdir() if name.startswith("early.h5.")])


class Forces(WithDrive):
    def motion(self, force, **options):
        return self.drive.simulation(forces={"pinion": force}, **{**MOTION, **options})

    def test_constant_force_is_that_of_the_option(self):
        given = self.drive.simulation(pinion={"torque": 7}, torque=0, **MOTION)
        computed = self.motion(lambda t, s, v: 7, torque=0)
        given.run(), computed.run()
        np.testing.assert_allclose(computed.state.body("pinion").s, given.state.body("pinion").s, rtol=1e-12)
        self.assertLess(abs(computed.state.energies["work"] / given.state.energies["work"] - 1), 1e-6)

    def test_controller_between_steps(self):
        class Controller:
            torque = 0.0

            def __call__(self, t, angle, speed):
                return self.torque - 0.1 * speed

            def update(self, simulation):
                self.torque += 1.0

        controller = Controller()
        result = self.drive.simulate(forces={"pinion": controller}, on_step=controller.update, output="c.h5", **MOTION)
        self.assertEqual(controller.torque, 40)
        self.assertTrue(result.complete)

    def test_load_at_a_marker(self):
        loads = {"loads": "push", "push": {"marker": "pinion.frame", "torque": [0, 0, 0]}}
        simulation = self.drive.simulation(
            forces={"push": lambda t, marker: ([0, 0, 0], [0, 0, 50 - marker.angular_velocity[2]])}, **loads, **MOTION)
        simulation.run()
        self.assertAlmostEqual(simulation.state.load("push").torque[2],
                               50 - simulation.state.body("pinion").s_dot[0], delta=1e-6)

    def test_exceptions_pass(self):
        def fails(t, s, v):
            if t > 1e-5:
                raise ZeroDivisionError("here")
            return 0
        simulation = self.motion(fails, output="failed.h5")
        with self.assertRaisesRegex(ZeroDivisionError, "here"):
            simulation.run()
        with self.assertRaisesRegex(eg.Error, "ended by an error"):
            simulation.step()
        self.assertFalse(eg.Result("failed.h5").complete)

    def test_wrong_values(self):
        for force, message in [(lambda t, s, v: "x", "must return a number, not str"),
                               (lambda t, s, v: None, "must return a number, not NoneType"),
                               (lambda t, s, v: float("nan"), "must be finite")]:
            with self.assertRaisesRegex(eg.Error, message):
                self.motion(force).run()
        with self.assertRaises(TypeError):
            self.motion(lambda t: 0).run()
        with self.assertRaisesRegex(eg.Error, "must be a function, not int"):
            self.motion(3)
        with self.assertRaisesRegex(eg.Error, "there is no such axis; the bodies are pinion, wheel"):
            self.drive.simulation(forces={"worm": lambda t, s, v: 0}, **MOTION)
        loads = {"loads": "push", "push": {"marker": "pinion.frame", "torque": [0, 0, 0]}}
        for value, message in [(([0, 0], [0, 0, 0]), "three components of force"), (5, "must return .force, torque."),
                               (([0, 0, 0], [0, float("nan"), 0]), "must be finite")]:
            with self.assertRaisesRegex(eg.Error, message):
                self.drive.simulation(forces={"push": lambda t, marker: value}, **loads, **MOTION).run()

    def test_work_within_work_is_refused(self):
        def again(t, s, v):
            simulation.step()
            return 0
        simulation = self.motion(lambda t, s, v: 0)
        simulation.step()
        other = None
        with self.assertRaisesRegex(eg.Error, "elastogear is at work"):
            other = self.motion(again)
        self.assertIsNone(other)
        simulation.step()
        self.assertGreater(simulation.state.time, 0)

    def test_simulation_freed_in_a_force(self):
        held = [self.drive.simulation(**MOTION)]

        def frees(t, s, v):
            held.clear()
            return 0
        self.motion(frees).run()
        self.assertEqual(held, [])


class BadInput(WithDrive):
    def test_meshes(self):
        points = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
        cell = {"hex8": [[0, 1, 2, 3, 4, 5, 6, 7]]}
        self.assertEqual(eg.Mesh(points, cell).quality()["min_scaled_jacobian"], 1)
        infinite = points.copy()
        infinite[3, 1] = np.nan
        for arguments, message in [((infinite, cell), "must be finite"), ((points[:, :2], cell), r"shape \(n, 3\)"),
                                   ((points.ravel(), cell), "2 dimension"), (("abc", cell), "array of numbers"),
                                   ((points, {"hex9": []}), "the types are hex8"),
                                   ((points, {"hex8": [[0, 1, 2]]}), r"shape \(n, 8\)"),
                                   ((points, {"hex8": [[0, 1, 2, 3, 4, 5, 6, 99]]}), "names a node outside"),
                                   ((points, {"hex8": [[0, 1, 2, 3, 4, 5, 6, 7.5]]}), "no number of a node"),
                                   ((points, cell, {"a": [-1]}), "-1"), ((points, cell, {}, {"f": [[0, 1, 6, 7]]}), "f")]:
            with self.assertRaisesRegex(eg.Error, message, msg=str(arguments[1:])):
                eg.Mesh(*arguments)
        with self.assertRaises(TypeError):
            eg.Mesh(None, None)

    def test_stresses(self):
        body = eg.Body("pinion.h5")
        for q, message in [([1, 2], "the body has 4"), ([1, 2, 3, np.inf], "must be finite"), ([[1] * 4], "1 dimension"),
                           (None, "array of numbers|must have 1"), (np.array([1j] * 4), "array of numbers|finite")]:
            with self.subTest(q=q), warnings.catch_warnings():
                warnings.simplefilter("error")
                with self.assertRaisesRegex((eg.Error, Exception), message):
                    body.stress("root", q)
        with self.assertRaisesRegex(eg.Error, "no set 'tip' of stress nodes; it has: root"):
            body.stress("tip", [0] * 4)

    def test_stresses_of_a_polymer_depend_on_its_history(self):
        corners = [(x, y, z) for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))]
        with open("cube.inp", "w", encoding="utf-8") as file:
            file.write("*NODE\n" + "".join(f"{i + 1}, {x}, {y}, {z}\n" for i, (x, y, z) in enumerate(corners)))
            file.write("*ELEMENT, TYPE=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*NSET, NSET=FIX\n1, 2, 3, 4\n*NSET, NSET=TOP\n5, 6, 7, 8\n")
        material = {"E": 3e9, "nu": 0.4, "rho": 1100, "prony_tau": 1, "prony": 0.3}
        done = command("reduce", "-mesh", "cube.inp", *[word for key, value in material.items() for word in (f"-material_{key}", str(value))],
                       "-restrain", "FIX", "-stress_nodes", "TOP", "-basis", "modal", "-modes", "2", "-output", "cube.h5")
        self.assertEqual(done.returncode, 0, done.stderr)
        with self.assertRaisesRegex(eg.Error, "cube.h5: is viscoelastic"):
            eg.Body("cube.h5").stress("TOP", [1, 0])

    def test_options(self):
        for source, message in [({}, "option -drive is missing"), ({"drive": float("nan")}, "must be one of"),
                                ({"drive": {1, 2}}, "numbers, texts, lists"), ({"drive": object()}, "numbers, texts"),
                                ({**SPUR, "module": np.array([np.nan])}, "finite"), ({**SPUR, "a b": 1}, "is no key"),
                                ({**SPUR, "pinion_teeth": 18}, "given twice"), ({**SPUR, "modes\n": 1}, "is no key")]:
            with self.assertRaisesRegex(eg.Error, message, msg=str(source)):
                eg.Drive(source).simulate()
        with self.assertRaisesRegex(eg.Error, "there is no such file"):
            eg.Drive("nowhere.yaml")
        for damaged in ["spur.msh", "nothing.h5"]:
            with self.assertRaises(eg.Error):
                eg.Result(damaged)
            with self.assertRaises(eg.Error):
                eg.Stress(damaged)

    def test_progress_that_raises(self):
        def stop(stage, fraction):
            raise LookupError(stage)
        with self.assertRaises(LookupError):
            self.drive.simulate(progress=stop, **REST)
        self.drive.simulate(**REST)

    def test_progress_that_raises_in_any_stage_of_a_reduction(self):
        stages = set()

        def stop_in_a_new_stage(stage, fraction):
            if stage not in stages:
                stages.add(stage)
                raise LookupError(stage)
        reduced = False
        while not reduced:
            n = len(stages)
            try:
                self.drive.reduce(pinion={"file": "raised_1.h5"}, wheel={"file": "raised_2.h5"},
                                  progress=stop_in_a_new_stage)
                reduced = True
            except LookupError:
                self.assertEqual(len(stages), n + 1)
        self.assertGreater(len(stages), 3)


if __name__ == "__main__":
    main()
