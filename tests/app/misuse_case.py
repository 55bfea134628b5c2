"""What a misuse of misuse.py is, the commands that misuses begin from, and what they do to the folder and look for in it."""
import dataclasses
import fcntl
import os
import shutil
import signal
import stat
import subprocess
from typing import Callable, Optional

import h5py
import numpy as np

from misuse_files import Failed, edit, flip, remove, write


@dataclasses.dataclass
class Case:
    """One misuse. kind: error (non-zero exit code); warning (exit code 0); right or error (a run that must not be wrong: `after`
    looks at what it wrote); killed (by a fault); good (no misuse: the neighbour that must work).
    """
    name: str
    words: str  # regular expression behind "error" or "warning"
    command: str  # {names} stand in COMMANDS
    kind: str = "error"
    leaves: str = ""  # regular expression of the paths that may be new or changed
    before: Optional[Callable] = None  # changes the folder first
    after: Optional[Callable] = None  # looks at the folder afterwards; returns what is wrong
    fault: Optional[dict] = None  # settings of tests/faults/faults.c without FAULT_; "": FAULT itself
    due: str = ""  # what it waits for; not run by default


COMMANDS = {
    "steel": "-material_E 210e9 -material_nu 0.3 -material_rho 7850",
    "reduce": "{elastogear} reduce -mesh brick.inp {steel} -restrain FIX -surface TOP -stress_nodes MIDDLE -markers END "
              "-basis modal -modes 5 -output kept.h5",
    "reduce_brick": "{elastogear} reduce -mesh brick.inp {steel} -restrain FIX -basis modal -output kept.h5",
    "orthotropic": "{elastogear} reduce -mesh brick.inp -material_E1 40e9 -material_E2 10e9 -material_E3 10e9 -material_nu12 0.3 "
                   "-material_nu13 0.3 -material_nu23 0.4 -material_G12 5e9 -material_G13 5e9 -material_G23 4e9 "
                   "-material_rho 1900 -restrain FIX -basis modal -modes 5 -output kept.h5",
    "polymer": "{reduce} -material_prony_tau 1e-3,10 -material_prony 0.3,0.2 -material_temperature_reference 293.15",
    "times": "-ts_dt 1e-7 -ts_max_time 1e-6 -output kept_run.h5",
    "single": "{elastogear} simulate -bodies a -a_file body.h5 {times}",
    "simulate": "{elastogear} simulate -bodies a,b -a_file body.h5 -b_file other.h5 -contact_pairs a:b {times}",
    "hinged": "{simulate} -a_joint revolute",
    "mass": "{elastogear} simulate -bodies a -a_mass 1 -a_inertia 1,1,1,0,0,0 -a_joint free {times}",
    "push": "{mass} -loads push -push_marker a.frame -push_force 1,0,0",
    "bearing": "{mass} -bushings bearing -bearing_markers ground,a.frame -bearing_stiffness 1,1,1",
    "sweep": "{elastogear} simulate -drive cylindrical -module 3e-3 -face_width 0.025 -pinion_teeth 17 -wheel_teeth 43 "
             "-analysis sweep -output kept_run.h5",
    "worm_sweep": "{elastogear} simulate -drive worm -module 2e-3 -wheel_teeth 41 -analysis sweep -torque 1 -output kept_run.h5",
    "pull": "{elastogear} simulate -bodies a -a_file body.h5 -loads pull -pull_marker a.END -pull_force 100,0,0 -analysis static "
            "-static_steps 2 -output kept_run.h5",
    "hard_pull": "{single} -checkpoint_every 0 -loads pull -pull_marker a.END -pull_force 1e12,0,0 -ts_dt 1e-3 -ts_max_time 0.1",
    "recover": "{elastogear} recover -result run.h5 -stress_a MIDDLE -output kept_stress.h5",
    "compare": "{elastogear} compare stress_full.h5 stress.h5 -output kept",
    "worm": "{elastogear} mesh -drive worm -wheel_teeth 40 -size tiny -element_order 1",
    "mesh": "{elastogear} mesh -part wheel -size tiny -element_order 1 -mesh kept.msh",
    "design": "{elastogear} mesh gears.yaml",
    "planets": "{elastogear} mesh planets.yaml",
    "gears_sweep": "{elastogear} simulate gears.yaml -analysis sweep",
    "evaluate": "{elastogear} evaluate gears.yaml",
    "life": "{elastogear} life gears.yaml",
    "wear": "{elastogear} wear gears.yaml",
    "run": "{elastogear} run gears.yaml -report none",
}


# ---- helpers of cases

def edited(name, dataset, change):
    return lambda bench: edit(bench, name, dataset, change)


def flipped(name, dataset):
    return lambda bench: flip(bench, name, dataset)


def removed(name, dataset):
    return lambda bench: remove(bench, name, dataset)


def garbled(bench):
    """An unfinished run whose last state is no HDF5 file."""
    os.makedirs(bench.path("kept_run.h5.partial"))
    write(bench.path("kept_run.h5.partial"), {"state.h5": "nothing"})


def killed(command, fault):
    """Another command that was killed at a call of its own."""
    def begin(bench):
        status, output = bench.run(command, fault)
        if status != -signal.SIGKILL:
            raise Failed("the run was not killed: " + output[-300:])
    return begin


def unfinished(bench):
    """A killed run after its second checkpoint."""
    killed("{single} -checkpoint_every 0", KILL_AT_SECOND_STATE)(bench)


def unfinished_flipped(bench):
    unfinished(bench)
    flip(bench, "kept_run.h5.partial/state.h5", "state")


def unfinished_part_flipped(bench):
    unfinished(bench)
    flip(bench, "kept_run.h5.partial/part_000000.h5", "bodies/a/q")


def running(command, fault):
    """Another command that is under way, halted at a call of its own, with what it has open and locked."""
    def begin(bench):
        bench.started = bench.start(command, fault)
        _, status = os.waitpid(bench.started.pid, os.WUNTRACED)
        if not os.WIFSTOPPED(status):
            raise Failed("the first run is not halted")
    return begin


def continued(bench):
    """The halted command ends well."""
    bench.started.send_signal(signal.SIGCONT)
    output = bench.started.communicate()[0].decode(errors="replace")
    return "the first run ends with " + output[-300:] if bench.started.returncode != 0 else ""


def told_to_quit(command, fault):
    """A command that was halted at a call of its own and then got SIGQUIT, as by Ctrl-\\: it ends at once."""
    def begin(bench):
        running(command, fault)(bench)
        bench.started.send_signal(signal.SIGQUIT)
        bench.started.send_signal(signal.SIGCONT)
        try:
            bench.started.communicate(timeout=20)
        except subprocess.TimeoutExpired as hangs:
            raise Failed("SIGQUIT does not end the run") from hangs
        if bench.started.returncode == 0:
            raise Failed("the run does not mind SIGQUIT")
    return begin


def goes_on(name):
    """The halted command ends well and its output is whole."""
    return lambda bench: continued(bench) or readable(name)(bench)


def linked(target, name):
    return lambda bench: os.symlink(target, bench.path(name))


def piped(name):
    return lambda bench: os.mkfifo(bench.path(name))


def opened_to_write(name):
    """As another program that has HDF5's lock, until the end of the case."""
    def lock(bench):
        bench.held = open(bench.path(name), "rb")
        fcntl.flock(bench.held, fcntl.LOCK_EX)
    return lock


def written(name, text):
    return lambda bench: write(bench.folder, {name: text})


def encoded(name, text, encoding):
    def begin(bench):
        with open(bench.path(name), "wb") as file:
            file.write(text.encode(encoding))
    return begin


def reworded(name, old, new):
    """A text file in which `new` stands for `old`."""
    def begin(bench):
        with open(bench.path(name), encoding="utf-8") as file:
            text = file.read()
        if old not in text:
            raise Failed(f"{name}: has no '{old}'")
        write(bench.folder, {name: text.replace(old, new)})
    return begin


def socketed(name):
    """A socket that nobody listens to."""
    return lambda bench: os.mknod(bench.path(name), stat.S_IFSOCK | 0o600)


def gone(name):
    return lambda bench: os.remove(bench.path(name))


def foldered(name):
    """A folder that has the name of a file."""
    def begin(bench):
        if os.path.exists(bench.path(name)):
            os.remove(bench.path(name))
        os.mkdir(bench.path(name))
    return begin


def foreign(name):
    """An HDF5 file of another program."""
    def begin(bench):
        with h5py.File(bench.path(name), "w") as file:
            file["x"] = np.arange(3.0)
    return begin


def first(command):
    """Another command has been given, and has succeeded."""
    return lambda bench: bench.good(command)


def readable(*names):
    """Info finds the files whole and complete."""
    def look(bench):
        for name in names:
            output = bench.good("{elastogear} info " + name)
            if "incomplete" in output:
                return f"{name} is incomplete"
        return ""
    return look


def again(command, *names):
    """The same command succeeds now, and no part or lock stays."""
    def look(bench):
        bench.good(command)
        left = [name for name in os.listdir(bench.folder) if ".partial" in name or ".lock" in name]
        return f"{left} stay" if left else readable(*names)(bench)
    return look


def incomplete(name):
    def look(bench):
        return "" if "incomplete" in bench.good("{elastogear} info " + name) else f"{name} is called complete"
    return look


def same_mass(bench):
    """A deck in mm, N and tonnes is the same body as the mesh in m."""
    bench.good("{reduce}")
    bench.good("{elastogear} reduce -mesh millimetres.inp -unit mm -surface TOP -basis modal -modes 5 -output mm.h5")
    with h5py.File(bench.path("kept.h5")) as a, h5py.File(bench.path("mm.h5")) as b:
        alike = (np.allclose(a["rigid/mass"][()], b["rigid/mass"][()], rtol=1e-9)
                 and np.allclose(a["modes/frequency"][:], b["modes/frequency"][:], rtol=1e-9))
    return "" if alike else "the deck in mm differs"


def tip_within(limit):
    """What a run leaves is small: no elastic coordinate ran away."""
    def look(bench):
        with h5py.File(bench.path("kept_run.h5")) as file:
            energy = file["energy"]
            stored = np.abs(energy["kinetic"][:] + energy["elastic"][:]).max()
        return "" if stored < limit else f"{stored:.3g} J are stored, more than {limit} J"
    return look


def mass_is(expected):
    """kg, of the body kept.h5; FIX's part of the mass is in it."""
    def look(bench):
        with h5py.File(bench.path("kept.h5")) as file:
            mass = file["rigid/mass"][()]
        return "" if abs(mass - expected) < 1e-6 * expected else f"the mass is {mass} kg, not {expected} kg"
    return look


def last_time(expected):
    """The run ends at this time."""
    def look(bench):
        with h5py.File(bench.path("kept_run.h5")) as file:
            end = file["time"][-1]
        return "" if abs(end - expected) < 1e-9 * expected else f"ends at {end} s, not {expected} s"
    return look


def copied(source, target):
    return lambda bench: shutil.copy(bench.path(source), bench.path(target))


KILL_AT_SECOND_STATE = {"": "kill", "CALL": "renamed", "FILE": "state.h5", "AT": "2"}
HALT = {"": "stop", "CALL": "write", "FILE": "kept"}


def full(file, space):
    return {"": "full", "CALL": "write", "FILE": file, "SPACE": str(space)}


OWN = r"kept_run\.h5.*"  # what a run that was stopped leaves: the result until then, and parts to go on from
PARTS = r"kept_run\.h5\.partial.*"
NO_SPACE = "([Nn]o space left|disk is full)"
