"""What must neither crash nor hang the Python module: interrupts, threads, forked processes, other users of MPI.

    process_test.py PATH/TO/elastogear [unittest's arguments]
"""
import os
import threading
import time

import elastogear as eg
from shared import ENDLESS, MOTION, REST, SPUR, WithDrive, main, python, set_up

setUpModule = set_up


class Interrupts(WithDrive):
    def test_run_ends_and_leaves_a_whole_file(self):
        under_way = self.interrupter()
        with self.assertRaises(KeyboardInterrupt):
            self.drive.simulate(analysis="dynamic", output="endless.h5", resume="discard",
                                progress=lambda stage, fraction: under_way.set(), **ENDLESS)
        self.assertFalse(eg.Result("endless.h5").complete)
        self.assertFalse([name for name in os.listdir() if ".tmp" in name or name.endswith(".lock")])

    def test_stepping_ends(self):
        under_way = self.interrupter()
        simulation = self.drive.simulation(**ENDLESS)
        under_way.set()
        with self.assertRaises(KeyboardInterrupt):
            simulation.run()
        with self.assertRaisesRegex(eg.Error, "ended by an error or an interrupt"):
            simulation.step()

    def test_callback_ends(self):
        under_way = self.interrupter()
        with self.assertRaises(KeyboardInterrupt):
            self.drive.simulate(forces={"pinion": lambda t, s, v: 0.0}, output="endless.h5",
                                on_step=lambda simulation: under_way.set(), **ENDLESS)

    def test_reduction_ends(self):
        under_way = self.interrupter()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                self.drive.reduce(pinion={"file": "again_1.h5"}, wheel={"file": "again_2.h5"},
                                  progress=lambda stage, fraction: under_way.set())
        self.assertFalse([name for name in os.listdir() if ".tmp" in name or name.endswith(".lock")])

    def test_other_threads_go_on(self):
        count = [0]
        simulation = self.drive.simulation(**ENDLESS)
        stop = threading.Event()

        def other():
            while not stop.is_set():
                count[0] += 1
                try:
                    eg.Body("pinion.h5")
                except eg.Error as error:
                    self.assertIn("at work", str(error))
                time.sleep(0.001)
        thread = threading.Thread(target=other)
        thread.start()
        taken = 0
        while count[0] < 20 or taken < 20:
            try:
                simulation.step()
                taken += 1
            except eg.Error as error:
                self.assertIn("at work", str(error))
        stop.set()
        thread.join()


class Processes(WithDrive):
    def test_forked_child_gets_an_exception(self):
        simulation = self.drive.simulation(**MOTION)
        read, write = os.pipe()
        child = os.fork()
        if child == 0:
            said = []
            for use in [simulation.step, lambda: self.drive.simulate(**REST), lambda: eg.Body("pinion.h5"),
                        simulation.close]:
                try:
                    use()
                    said.append("nothing")
                except eg.Error as error:
                    said.append(str(error))
            del simulation
            os.write(write, "\n".join(said).encode())
            os._exit(0)
        os.close(write)
        with os.fdopen(read) as pipe:
            said = pipe.read().splitlines()
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        self.assertEqual(len(said), 4)
        for text in said:
            self.assertIn("forked", text)
        self.assertTrue(simulation.step())

    def test_interpreter_ends_with_a_run_alive(self):
        done = python(f"import elastogear as eg, warnings\nwarnings.simplefilter('ignore')\n"
                      f"s = eg.Drive({SPUR}).simulation(**{MOTION})\ns.step()\nprint(s.state.time)")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_interpreter_ends_while_a_thread_simulates(self):
        done = python(f"""import elastogear as eg, threading, warnings
warnings.simplefilter('ignore')
under_way = threading.Event()
drive = eg.Drive({SPUR})
work = lambda: drive.simulate(analysis='dynamic', output='left.h5', resume='discard',
                              progress=lambda stage, fraction: under_way.set(), **{ENDLESS})
threading.Thread(target=work, daemon=True).start()
under_way.wait()""")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertFalse([name for name in os.listdir() if ".tmp" in name or name.endswith(".lock")])

    def test_interpreter_ends_with_a_body_alive(self):
        done = python("import elastogear as eg\nbody = eg.Body('pinion.h5')")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_forked_before_the_first_use(self):
        done = python("import os, elastogear as eg\n"
                      "if os.fork() == 0:\n    eg.describe('pinion.h5')\n"
                      "else:\n    assert os.wait()[1] == 0\n    eg.describe('pinion.h5')\n")
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def test_beside_petsc4py_and_mpi4py(self):
        for first, last in [("from mpi4py import MPI", "assert MPI.COMM_WORLD.allreduce(1) == 1"),
                            ("from petsc4py import PETSc", "v = PETSc.Vec().createSeq(3); v.set(1); assert v.sum() == 3")]:
            module = first.split()[1]
            if python(f"import {module}").returncode != 0:
                continue
            use = "import elastogear as eg\neg.describe('pinion.h5')\n"
            for script in [f"{first}\n{use}{last}", f"{use}{first}\n{last}\n{use}"]:
                done = python(script)
                self.assertEqual((done.returncode, done.stderr), (0, ""), script)


if __name__ == "__main__":
    main()
