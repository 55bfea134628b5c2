"""The misuses of misuse.py, over every verb: what is done wrong, the words that the program must find, the command."""
import dataclasses
import os
import shutil
import signal
from typing import Callable, Optional

import h5py
import numpy as np

from misuse_files import Failed, attribute, edit, flip, remove, write


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
    "orthotropic": "{elastogear} reduce -mesh brick.inp -material_E1 40e9 -material_E2 10e9 -material_E3 10e9 -material_nu12 0.3 "
                   "-material_nu13 0.3 -material_nu23 0.4 -material_G12 5e9 -material_G13 5e9 -material_G23 4e9 "
                   "-material_rho 1900 -restrain FIX -basis modal -modes 5 -output kept.h5",
    "times": "-ts_dt 1e-7 -ts_max_time 1e-6 -output kept_run.h5",
    "single": "{elastogear} simulate -bodies a -a_file body.h5 {times}",
    "simulate": "{elastogear} simulate -bodies a,b -a_file body.h5 -b_file other.h5 -contact_pairs a:b {times}",
    "hinged": "{simulate} -a_joint revolute",
    "mass": "{elastogear} simulate -bodies a -a_mass 1 -a_inertia 1,1,1,0,0,0 -a_joint free {times}",
    "push": "{mass} -loads push -push_marker a.frame -push_force 1,0,0",
    "bearing": "{mass} -bushings bearing -bearing_markers ground,a.frame -bearing_stiffness 1,1,1",
    "pull": "{elastogear} simulate -bodies a -a_file body.h5 -loads pull -pull_marker a.END -pull_force 100,0,0 -analysis static "
            "-static_steps 2 -output kept_run.h5",
    "recover": "{elastogear} recover -result run.h5 -stress_a MIDDLE -output kept_stress.h5",
    "compare": "{elastogear} compare stress_full.h5 stress.h5 -output kept",
    "mesh": "{elastogear} mesh -part wheel -size tiny -mesh kept.msh",
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


def unfinished(bench):
    """A killed run after its second checkpoint."""
    status, output = bench.run("{single} -checkpoint_every 0", KILL_AT_SECOND_STATE)
    if status != -signal.SIGKILL:
        raise Failed("the run was not killed: " + output[-300:])


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


def goes_on(name):
    """The halted command ends well and its output is whole."""
    def look(bench):
        bench.started.send_signal(signal.SIGCONT)
        output = bench.started.communicate()[0].decode(errors="replace")
        if bench.started.returncode != 0:
            return "the first run ends with " + output[-300:]
        return readable(name)(bench)
    return look


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


def copied(source, target):
    return lambda bench: shutil.copy(bench.path(source), bench.path(target))


KILL_AT_SECOND_STATE = {"": "kill", "CALL": "renamed", "FILE": "state.h5", "AT": "2"}
HALT = {"": "stop", "CALL": "write", "FILE": "kept"}


def full(file, space):
    return {"": "full", "CALL": "write", "FILE": file, "SPACE": str(space)}


OWN = r"kept_run\.h5.*"  # what a run that was stopped leaves: the result until then, and parts to go on from
PARTS = r"kept_run\.h5\.partial.*"
NO_SPACE = "([Nn]o space left|disk is full)"

VERBS = [
    Case("unknown verb", r"'reduse'", "{elastogear} reduse"),
    Case("info on a foreign file", r"times.txt", "{elastogear} info times.txt"),
    Case("info on nothing", r"no file given", "{elastogear} info"),
    Case("info on a missing file", r"nosuch.h5", "{elastogear} info nosuch.h5"),
    Case("info on a folder", r"folder.*(not a|no) .*file", "{elastogear} info folder"),
    Case("info on a file cut in half", r"truncated_run.h5", "{elastogear} info truncated_run.h5"),
    Case("info on a body cut in half", r"truncated_body.h5", "{elastogear} info truncated_body.h5"),
    Case("info of an empty file", r"empty.inp", "{elastogear} info empty.inp"),
    Case("compare of one file", r"two files, not 1", "{elastogear} compare stress.h5"),
    Case("compare of bodies", r"result and stress files can be compared", "{elastogear} compare body.h5 other.h5"),
    Case("compare of unlike files", r"both must be", "{elastogear} compare run.h5 stress.h5"),
    Case("compare with a file cut in half", r"truncated_stress.h5", "{elastogear} compare truncated_stress.h5 stress.h5"),
    Case("compare at a time outside", r"at = 7 s", "{compare} -at 7"),
    Case("compare to a folder that is not there", r"nosuch", "{elastogear} compare stress_full.h5 stress.h5 -output nosuch/kept"),
    Case("compare on a full disk", NO_SPACE, "{compare}", fault=full("kept", 100)),
    Case("compare of flipped stresses", r"(checksum|damaged|read)", "{compare}", before=flipped("stress.h5", "a/MIDDLE/stress")),

]

OPTIONS = [
    Case("options file that is missing", r"nosuch.txt: there is no such file", "{single} -options_file nosuch.txt"),
    Case("options file without form", r"bad_options.txt, line 2: 'modes' is no option", "{reduce} -options_file bad_options.txt"),
    Case("options file with a misspelt option", r"epss_tol .misspelt_options.txt, line 2.*eps_tol", "{reduce} -options_file misspelt_options.txt"),
    Case("options file that is malformed YAML", r"malformed.yaml, line 2", "{reduce} -options_file malformed.yaml"),
    Case("options file without a name", r"options_file is given without", "{reduce} -options_file -modes 3"),
    Case("options file that is a folder", r"folder", "{single} -options_file folder"),
    Case("options file missing in the environment", r"PETSc cannot start.*PETSC_OPTIONS",
         "env PETSC_OPTIONS='-options_file nosuch.txt' {elastogear} reduce"),
    Case("PETSc option misspelt", r"ts_dtt.*-ts_dt ", "{single} -ts_dtt 1e-7"),
    Case("solver option misspelt", r"snes_rtoll.*-snes_rtol ", "{single} -snes_rtoll 1e-9"),
    Case("eigensolver option misspelt", r"eps_tool.*-eps_tol ", "{reduce} -eps_tool 1e-9"),
    Case("option without a known prefix misspelt", r"infoo.*-info ", "{single} -infoo"),
    Case("option of a nested solver misspelt", r"elastic_pc_tpye.*-elastic_pc_type ", "{single} -elastic_pc_tpye gamg"),
    Case("option with an equals sign", r"ts_dt=1e-8: write .* two words, -ts_dt 1e-8", "{single} -ts_dt=1e-8"),
    Case("options of PETSc", r"", "{single} -ts_adapt_type none -ts_monitor -snes_rtol 1e-9 -snes_monitor -ksp_rtol 1e-6 -pc_type shell "
         "-elastic_pc_type cholesky -log_view -malloc_debug -options_left -options_view -on_error_abort -memory_view -citations "
         "-no_signal_handler", kind="good", leaves=r"kept_run\.h5"),
    Case("options of SLEPc", r"", "{reduce} -eps_tol 1e-9 -eps_ncv 30 -st_type sinvert -st_pc_type cholesky -mat_mumps_icntl_14 30 "
         "-st_mat_mumps_icntl_14 30 -eps_monitor", kind="good", leaves=r"kept\.h5"),
    Case("option with two dashes", r"modes", "{reduce} --modes 5 --modess 4"),
    Case("wrong letters in modes", r"mdoes.*nearest known option is -modes ", "{reduce} -mdoes 5"),
    Case("list with a blank", r"'B' belongs to no option", "{elastogear} reduce -restrain A, B"),
    Case("file names after options", r"'two.yaml' belongs to no option", "{single} two.yaml"),
    Case("YAML with a key twice", r"key_twice.yaml, line 6: the key gravity is given twice, first in line 5", "{elastogear} simulate key_twice.yaml"),
    Case("YAML with a section twice", r"section_twice.yaml, line 5: the key a is given twice, first in line 2", "{elastogear} simulate section_twice.yaml"),
    Case("YAML with a key twice by nesting", r"nested_twice.yaml, line 2: the key ts_dt is given twice, first in line 1", "{elastogear} simulate nested_twice.yaml"),
    Case("YAML with a misspelt key", r"gravty .misspelt.yaml, line 5.*gravity", "{elastogear} simulate misspelt.yaml"),
    Case("YAML with a tabulator", r"tab.yaml, line 6", "{elastogear} simulate tab.yaml"),
    Case("YAML cut off", r"malformed.yaml, line", "{elastogear} reduce malformed.yaml"),
    Case("YAML with a word for a number", r"gravity.*down", "{elastogear} simulate text_number.yaml"),
    Case("YAML that is empty", r"bodies is missing", "{elastogear} simulate empty.yaml"),
    Case("YAML of bytes", r"binary.yaml", "{elastogear} simulate binary.yaml"),
    Case("YAML that is a folder", r"folder", "{elastogear} simulate folder"),
    Case("a mesh in place of YAML", r"brick.inp", "{elastogear} reduce brick.inp"),
    Case("a body file in place of YAML", r"body.h5", "{elastogear} simulate body.h5"),
    Case("option without its value", r"modes.*(missing|whole number)", "{reduce} -modes"),
    Case("flag that is neither", r"completeness.*(true|false)", "{reduce} -completeness perhaps"),
    Case("number with a unit", r"ts_dt.*1e-7s", "{single} -ts_dt 1e-7s"),
    Case("number with a comma", r"ts_dt.*1,0e-7", "{single} -ts_dt 1,0e-7"),
    Case("verb of one rank on two", r"one rank", "mpirun --oversubscribe -n 2 {single}"),

]

MESH = [
    Case("undercut gear", r"undercut", "{elastogear} mesh -part wheel -pressure_angle 8 -mesh kept.msh"),
    Case("centre distance that does not exist", r"centre_distance = 0.02", "{elastogear} mesh -part worm -centre_distance 0.02 -mesh kept.msh"),
    Case("gear that is none", r"part.*worm, wheel", "{mesh} -part gear"),
    Case("gear without a part", r"part", "{elastogear} mesh -mesh kept.msh"),
    Case("size that is none", r"size.*huge", "{mesh} -size huge"),
    Case("no teeth", r"z2", "{mesh} -z2 0"),
    Case("negative module", r"module = -0.001", "{mesh} -module -0.001"),
    Case("module in mm", r"(module|root|radius|bore|centre)", "{mesh} -module 1.25"),
    Case("mesh format that is none", r"kept.stl", "{mesh} -mesh kept.stl"),
    Case("mesh in a folder that is not there", r"nosuch", "{mesh} -mesh nosuch/kept.msh"),
    Case("mesh to a folder", r"folder", "{mesh} -mesh folder"),
    Case("odd columns of a tooth", r"tooth.*even", "{mesh} -wheel_count_tooth 3"),
    Case("mesh on a full disk", NO_SPACE, "{mesh}", fault=full("kept.msh", 4096)),
    Case("mesh killed before it has its name", r"", "{mesh}", kind="killed", leaves=r"kept\.msh\.tmp.*",
         fault={"": "kill", "CALL": "rename", "FILE": "kept.msh"}),

]

REDUCE = [
    Case("malformed configuration", r"malformed.yaml", "{elastogear} reduce malformed.yaml"),
    Case("missing mesh", r"nosuch.msh", "{reduce} -mesh nosuch.msh"),
    Case("truncated .msh", r"truncated_wheel.msh", "{reduce} -mesh truncated_wheel.msh"),
    Case("unknown option", r"modess.*-modes", "{reduce} -modess 5"),
    Case("missing option", r"material_nu", "{elastogear} reduce -mesh brick.inp -output kept.h5 -material_E 1 -restrain FIX"),
    Case("missing node set", r"NOSUCH.*CORNER.*FIX", "{reduce} -restrain NOSUCH"),
    Case("missing face set", r"NOSUCH.*TOP", "{reduce} -surface NOSUCH"),
    Case("NaN option", r"material_E.*nan", "{reduce} -material_E nan"),
    Case("NaN coordinate", r"nan.inp.*nan", "{reduce} -mesh nan.inp"),
    Case("impossible material", r"nu.*0\.7", "{reduce} -material_nu 0.7"),
    Case("inverted element", r"(cell|element).*Jacobian", "{reduce} -mesh inverted.inp"),
    Case("no restraint", r"restrain", "{elastogear} reduce -mesh brick.inp {steel} -surface TOP -modes 5 -output kept.h5"),
    Case("too little restraint", r"(singular|restrain)", "{reduce} -restrain CORNER"),
    Case("too many modes", r"modes.*37.*36", "{reduce} -modes 37"),
    Case("modes no number", r"modes.*many", "{reduce} -modes many"),
    Case("restraint of an unknown node", r"no node '99'", "{reduce} -restrain_nodes 1,99"),
    Case("frame at no point", r"frame.*bore", "{reduce} -frame bore"),
    Case("mass without stiffness", r"mass.*needs -stiffness", "{reduce} -mass m.mtx"),
    Case("missing matrix", r"nosuch.mtx", "{reduce} -stiffness nosuch.mtx -mass nosuch.mtx"),
    Case("NaN in a matrix", r"k.mtx, line 2: 'nan'", "{reduce} -stiffness k.mtx -mass k.mtx"),
    Case("matrix of another mesh", r"k2.mtx: node 17", "{reduce} -stiffness k2.mtx -mass k2.mtx"),
    Case("impossible orthotropic material", r"nu.*not positive definite", "{orthotropic} -material_nu12 3"),
    Case("orthotropic material in part", r"material_E2 is missing", "{elastogear} reduce -mesh brick.inp -material_E1 1 -material_rho 1 -output kept.h5"),
    Case("material axes in one line", r"parallel", "{orthotropic} -material_axis_2 2,0,0"),
    Case("no material anywhere", r"material_E.*brick.inp.*SOLID SECTION", "{elastogear} reduce -mesh brick.inp -restrain FIX -output kept.h5"),
    Case("restraint in two directions", r"free to move along \(0 0 1\); hold more", "{elastogear} reduce -mesh partly.inp -unit mm -output kept.h5"),
    Case("unknown material in the mesh", r"brass.inp.*unknown material 'BRASS'", "{elastogear} reduce -mesh brass.inp -output kept.h5"),
    Case("negative damping ratio", r"damping ratio -0.1", "{reduce} -damping_ratio -0.1"),
    Case("damping ratio of a full basis", r"full basis", "{reduce} -damping_ratio 0.1 -basis full"),
    Case("point mass on an unknown set", r"NOSUCH", "{reduce} -point_mass_NOSUCH 1"),
    Case("point mass of nothing", r"point_mass_FIX.*positive", "{reduce} -point_mass_FIX 0"),
    Case("marker on an unknown set", r"NOSUCH", "{reduce} -markers NOSUCH"),
    Case("marker weights that are none", r"marker_weights.*equal, area", "{reduce} -marker_weights mass"),
    Case("invariants that are none", r"invariants.*linear, full", "{reduce} -invariants all"),
    Case("basis that is none", r"basis.*modal_residual, full, modal_attachment, krylov, craig_bampton", "{reduce} -basis best"),
    Case("attachment modes of no node", r"modal_attachment needs.*loaded", "{reduce} -basis modal_attachment"),
    Case("attachment modes of an unknown set", r"NOSUCH", "{reduce} -basis modal_attachment -loaded NOSUCH"),
    Case("Krylov basis of a free body", r"held body", "{reduce} -basis krylov -restrain none"),
    Case("negative shift", r"krylov shift -1 Hz", "{reduce} -basis krylov -krylov_shift -1"),
    Case("shift that is no number", r"krylov_shift.*high", "{reduce} -basis krylov -krylov_shift high"),
    Case("more interface modes than modes", r"interface_modes = 6, must be 1..5", "{reduce} -basis craig_bampton -interface_modes 6"),
    Case("no interface modes", r"interface_modes.*0", "{reduce} -basis craig_bampton -interface_modes 0"),
    Case("orthotropic body", r"", "{orthotropic} -material_orientation cylindrical -material_axis 1,0,0", kind="good", leaves=r"kept\.h5"),
    Case("deck in mm", r"", "{reduce}", kind="good", leaves=r"kept\.h5", after=same_mass),
    Case("too few modes", r"modes.*0", "{reduce} -modes 0"),
    Case("half a mode", r"modes.*5.5", "{reduce} -modes 5.5"),
    Case("mesh with a missing node", r"no_node.inp.*99", "{reduce} -mesh no_node.inp"),
    Case("mesh with a node twice", r"twice.inp.*2", "{reduce} -mesh twice.inp"),
    Case("mesh without cells", r"no_cells.inp", "{reduce} -mesh no_cells.inp"),
    Case("mesh that is empty", r"empty.inp", "{reduce} -mesh empty.inp"),
    Case("mesh that is a folder", r"folder", "{reduce} -mesh folder"),
    Case("mesh of an unknown format", r"times.txt", "{reduce} -mesh times.txt"),
    Case("mesh that ends after its head", r"brick.msh", "{reduce} -mesh brick.msh"),
    Case("folded element", r"(cell|element).*Jacobian", "{reduce} -mesh folded.inp"),
    Case("body file as mesh", r"body.h5", "{reduce} -mesh body.h5"),
    Case("reduced integration", r"C3D8R", "{reduce} -mesh reduced_integration.inp", kind="warning", leaves=r"kept\.h5"),
    Case("unit that is none", r"unit.*inch", "{reduce} -unit inch"),
    Case("nothing left to move", r"(restrain|held|free)", "{reduce} -restrain FIX,MIDDLE,END -restrain_nodes 9,10,11,12"),
    Case("negative density", r"material_rho.*-7850", "{reduce} -material_rho -7850"),
    Case("no modulus", r"material_E.*0", "{reduce} -material_E 0"),
    Case("incompressible", r"nu.*0\.5", "{reduce} -material_nu 0.5"),
    Case("steel in MPa", r"material_E", "{reduce} -material_E 210000", kind="warning", leaves=r"kept\.h5"),
    Case("steel in tonnes per cubic millimetre", r"material_rho", "{reduce} -material_rho 7.85e-9", kind="warning", leaves=r"kept\.h5"),
    Case("mesh in mm read as m", r"(unit|mm)", "{reduce} -mesh metres.inp", kind="warning", leaves=r"kept\.h5"),
    Case("stress at an unknown set", r"NOSUCH", "{reduce} -stress_nodes NOSUCH"),
    Case("output over the mesh", r"brick.inp", "{reduce} -output brick.inp"),
    Case("output over the mesh by another path", r"brick.inp", "{reduce} -output folder/../brick.inp"),
    Case("output over a matrix", r"k2.mtx", "{reduce} -stiffness k2.mtx -mass k2.mtx -output k2.mtx"),
    Case("output in a folder that is not there", r"nosuch", "{reduce} -output nosuch/kept.h5"),
    Case("output that is a folder", r"folder", "{reduce} -output folder"),
    Case("output where nothing can be written", r"/proc/kept.h5", "{reduce} -output /proc/kept.h5"),
    Case("body on a full disk", NO_SPACE, "{reduce}", fault=full("kept.h5", 4096), leaves=r"kept\.h5\.partial.*",
         after=again("{reduce}", "kept.h5")),
    Case("parts of a body on a full disk", NO_SPACE, "{reduce} -mesh long.inp -symmetry none -modes 12 -window 4", fault=full("window_", 4096),
         leaves=r"kept\.h5\.partial.*", after=again("{reduce} -mesh long.inp -symmetry none -modes 12 -window 4", "kept.h5")),
    Case("reduction killed before its file has its name", r"", "{reduce}", kind="killed", leaves=r"kept\.h5\..*",
         fault={"": "kill", "CALL": "rename", "FILE": "kept.h5$"}, after=again("{reduce}", "kept.h5")),
    Case("two reductions with one output", r"kept.h5.*(another|other|use|run)", "{reduce}", before=running("{reduce} -modes 6", HALT),
         after=goes_on("kept.h5")),
    Case("all modes of a degenerate bar", r"", "{reduce} -modes 36", kind="good", leaves=r"kept\.h5"),
    Case("modal_residual without a surface", r"", "{reduce} -basis modal_residual -surface ''", kind="good", leaves=r"kept\.h5"),
    Case("SLEPc told nonsense", r"eps_type", "{reduce} -eps_type nosuch"),

]

SIMULATE = [
    Case("missing configuration", r"nosuch.yaml", "{elastogear} simulate nosuch.yaml"),
    Case("missing body file", r"nosuch.h5", "{simulate} -a_file nosuch.h5"),
    Case("truncated body file", r"truncated_body.h5", "{simulate} -a_file truncated_body.h5"),
    Case("a mesh as body file", r"wheel.msh", "{simulate} -a_file wheel.msh"),
    Case("misspelt body key", r"a_jonit.*a_joint", "{simulate} -a_jonit fixed"),
    Case("pair of unknown body", r"'c'", "{simulate} -contact_pairs a:c"),
    Case("zero step", r"ts_dt.*0", "{simulate} -ts_dt 0"),
    Case("friction that never fades", r"regularised friction needs the speed", "{simulate} -contact_friction 0.1"),
    Case("static friction below that of sliding", r"static friction 0.1", "{simulate} -contact_friction 0.2 -contact_friction_law stick -contact_friction_static 0.1"),
    Case("a gap moved out of sight", r"offset 1 m must not exceed", "{simulate} -contact_offset 1"),
    Case("negative contact damping", r"damping -1", "{simulate} -contact_damping -1"),
    Case("negative step", r"ts_dt = -1e-07", "{simulate} -ts_dt -1e-7"),
    Case("no end", r"ts_max_time = 0 s: must be positive", "{simulate} -ts_max_time 0"),
    Case("negative time of output", r"output_dt = -1e-07 s", "{simulate} -output_dt -1e-7"),
    Case("time of output that is none", r"output_times: 'soon' is neither", "{simulate} -output_times soon"),
    Case("times of output that fall", r"5e-08 s does not come after 1e-07 s", "{simulate} -output_times 1e-7,5e-8"),
    Case("time of output after the end", r"2 s is outside the run", "{simulate} -output_times times.txt"),
    Case("two ways to give times of output", r"exclude each other", "{simulate} -output_times 1e-7 -output_dt 1e-7"),
    Case("negative tolerance", r"step tolerance -1", "{simulate} -step_tolerance -1"),
    Case("negative time between checkpoints", r"between two checkpoints -1 s", "{simulate} -checkpoint_every -1"),
    Case("way to resume that is none", r"resume.*auto, anyway, discard", "{simulate} -resume perhaps"),
    Case("unknown analysis", r"analysis.*dynamic, static, relax", "{simulate} -analysis modal"),
    Case("static without steps", r"static_steps.*at least 1", "{simulate} -analysis static -static_steps 0"),
    Case("zero axis", r"axis", "{simulate} -a_joint revolute -a_axis 0,0,0"),
    Case("axis of a joint without one", r"a_axis: a fixed joint has no axis", "{simulate} -a_axis 0,0,1"),
    Case("bodies deep inside each other", r"(deep|penetrat)", "{simulate} -b_position 0.003,0,0.004 -b_rotation 3.14159265,0,0"),
    Case("table that ends early", r"covers 0 .. 5e-07 s, the run needs 0 .. 1e-06 s", "{hinged} -a_torque table,short.csv"),
    Case("table with equal times", r"equal.csv: table row 2: time 0 s", "{hinged} -a_torque table,equal.csv"),
    Case("table that is not there", r"nosuch.csv: cannot be read", "{hinged} -a_rotation_motion table,nosuch.csv"),
    Case("static motion without end", r"needs the time", "{elastogear} simulate -bodies a -a_file body.h5 -a_joint revolute -a_rotation_motion speed,2 -analysis static -output kept_run.h5"),
    Case("static with an initial speed", r"no initial velocity", "{hinged} -a_omega0 1 -analysis static"),
    Case("speed as a vector on a hinge", r"free or spherical", "{hinged} -a_omega0 1,2,3"),
    Case("two numbers for a speed", r"a_omega0: must be one number, or three", "{hinged} -a_omega0 1,2"),
    Case("initial angle of a fixed body", r"no axis to turn about", "{simulate} -a_angle0 1"),
    Case("mass beside a body file", r"exclude each other", "{simulate} -a_mass 1"),
    Case("torque beside a prescribed motion", r"takes no load", "{hinged} -a_torque 1 -a_rotation_motion speed,2"),
    Case("force on a hinge", r"no axis to slide along", "{hinged} -a_force 1"),
    Case("torque on a free body", r"no axis to turn about", "{simulate} -a_joint free -a_torque 1"),
    Case("unknown prescribed motion", r"a_rotation_motion: must be .speed", "{hinged} -a_rotation_motion fast"),
    Case("body without mass", r"mass 0 kg must be positive", "{mass} -a_mass 0"),
    Case("inertia of no mass distribution", r"principal inertias", "{mass} -a_inertia 1,1,3,0,0,0"),
    Case("an inertia level that is none", r"-inertia", "{simulate} -inertia cubic"),
    Case("load on an unknown body", r"push.*no body 'b'", "{push} -push_marker b.frame"),
    Case("load on an unknown marker", r"push.*no marker 'tip'; it has: frame", "{push} -push_marker a.tip"),
    Case("load on no marker", r"push_marker.*BODY.MARKER", "{push} -push_marker tip"),
    Case("load without force", r"push_force or -push_torque", "{mass} -loads push -push_marker a.frame"),
    Case("load that is not finite", r"push_force.*nan", "{push} -push_force 1,nan,0"),
    Case("load's table that ends early", r"load 'push': the table covers 0 .. 5e-07 s", "{push} -push_signal table,short.csv"),
    Case("key of a load that is not listed", r"pull_force", "{push} -pull_force 1,0,0"),
    Case("load named as a body", r"'a' is taken", "{mass} -loads a -a_marker a.frame"),
    Case("bushing with one end", r"bearing_markers: must be two", "{bearing} -bearing_markers a.frame"),
    Case("bushing from ground to ground", r"bearing.*must lie between", "{bearing} -bearing_markers ground,ground"),
    Case("negative stiffness", r"bearing.*stiffness.*-1", "{bearing} -bearing_stiffness 1,1,-1"),
    Case("sensor on the ground", r"sensors_s.*BODY.MARKER", "{mass} -sensors_s ground"),
    Case("point without coordinates", r"a_points.*x,y,z", "{mass} -a_points tip,1,2"),
    Case("two points of a name", r"two markers are named 'tip'", "{mass} -a_points tip,1,2,3,tip,1,2,3"),
    Case("inertia level full without its invariants", r"body 'body' lacks .*-invariants full", "{simulate} -inertia full"),
    Case("key of a body that no file names", r"c_joint", "{elastogear} simulate two.yaml -bodies a -c_joint free -output kept_run.h5"),
    Case("state of a missing file", r"nosuch.h5", "{hinged} -initial_file nosuch.h5"),
    Case("state of another joint", r"run.h5: body 'a' has 0 joint coordinates, here it has 1", "{hinged} -initial_file run.h5"),
    Case("state of a joint without axis", r"joint without an axis", "{simulate} -a_joint free -initial_file run.h5"),
    Case("keys of a body that is left out", r"", "{elastogear} simulate two.yaml -bodies a -output kept_run.h5", kind="good", leaves=r"kept_run\.h5"),
    Case("no bodies", r"bodies is missing", "{elastogear} simulate {times}"),
    Case("no output", r"output is missing", "{elastogear} simulate -bodies a -a_file body.h5 -ts_dt 1e-7 -ts_max_time 1e-6"),
    Case("no step", r"ts_dt is missing", "{elastogear} simulate -bodies a -a_file body.h5 -ts_max_time 1e-6 -output kept_run.h5"),
    Case("body twice", r"two bodies are named 'a'", "{single} -bodies a,a"),
    Case("body against itself", r"a:a", "{simulate} -contact_pairs a:a"),
    Case("pair of one", r"two bodies, a:b", "{simulate} -contact_pairs a"),
    Case("pair twice", r"contact_pairs.*a:b", "{simulate} -contact_pairs a:b,a:b -b_position 0,0,1"),
    Case("result file as body", r"run.h5.*(result|body)", "{single} -a_file run.h5"),
    Case("body without a surface in contact", r"body 'a' has no surface faces", "{simulate} -a_file no_surface.h5"),
    Case("rigid body without a file in contact", r"surface", "{elastogear} simulate -bodies a,b -a_mass 1 -a_inertia 1,1,1,0,0,0 -a_joint free -b_file body.h5 -contact_pairs a:b {times}"),
    Case("bodies that never touch", r"(never|no contact|not touch)", "{simulate} -b_position 0,0,1", kind="warning", leaves=r"kept_run\.h5"),
    Case("end before the first step", r"(ts_max_time|ts_dt)", "{single} -ts_max_time 1e-9 -ts_dt 1e-7"),
    Case("gravity of two numbers", r"gravity.*three", "{single} -gravity 0,9.81"),
    Case("position of two numbers", r"a_position.*three", "{single} -a_position 0,1"),
    Case("rotation that is not finite", r"a_rotation.*nan", "{single} -a_rotation nan,0,0"),
    Case("unknown joint", r"a_joint.*revolute", "{single} -a_joint hinge"),
    Case("option by its former name", r"-contact_crease.* is now called -contact_feature_angle", "{simulate} -contact_crease 30"),
    Case("kDOP of 7", r"7", "{simulate} -contact_kdop 7"),
    Case("negative contact stiffness", r"stiffness.*-1", "{simulate} -contact_stiffness -1"),
    Case("negative friction", r"friction.*-0.1", "{simulate} -contact_friction -0.1 -contact_friction_speed 1"),
    Case("smoothing a slave", r"contact_smooth", "{simulate} -contact_smooth -b_position 0,0,1", kind="warning", leaves=r"kept_run\.h5"),
    Case("steps of output that are none", r"output_every.*0", "{single} -output_every 0"),
    Case("damping radius above one", r"(alpha_radius|rho)", "{single} -ts_alpha_radius 1.5"),
    Case("rest that is never", r"rest_tolerance", "{hinged} -analysis relax -rest_tolerance 0"),
    Case("table with a word", r"word.csv, line 3", "{hinged} -a_torque table,word.csv"),
    Case("table with nan", r"nan.csv, line 3", "{hinged} -a_torque table,nan.csv"),
    Case("table that falls", r"falling.csv", "{hinged} -a_torque table,falling.csv"),
    Case("table that is empty", r"empty.csv", "{hinged} -a_torque table,empty.csv"),
    Case("table of one column", r"one_column.csv", "{hinged} -a_torque table,one_column.csv"),
    Case("ramp without its time", r"a_torque.*ramp", "{hinged} -a_torque ramp,5"),
    Case("ramp of negative time", r"ramp -1 s must be positive", "{hinged} -a_torque ramp,5,-1"),
    Case("state of a time outside", r"initial_time.*7|7 s", "{single} -a_joint revolute -initial_file turning.h5 -initial_time 7"),
    Case("state of another body", r"turning.h5.*none of the bodies", "{elastogear} simulate -bodies b -b_file body.h5 -b_joint revolute {times} -initial_file turning.h5"),
    Case("state of a body that stands", r"turning.h5.*none of the bodies", "{single} -initial_file turning.h5"),
    Case("time of a state without its file", r"initial_time.*initial_file", "{single} -initial_time 0"),
    Case("output over a body file", r"body.h5", "{single} -output body.h5"),
    Case("output over a body file by a link", r"(body|link).h5", "{single} -output link.h5"),
    Case("output over the body file by another path", r"body.h5", "{single} -output ./folder/../body.h5"),
    Case("output over a table", r"times.txt", "{single} -output times.txt -output_times times.txt"),
    Case("output over the initial state", r"turning.h5", "{single} -a_joint revolute -initial_file turning.h5 -output turning.h5"),
    Case("output over the configuration", r"one.yaml", "{elastogear} simulate one.yaml -output one.yaml"),
    Case("output that is a folder of results", r"folder", "{single} -output folder"),
    Case("output in no folder", r"nosuch", "{single} -output nosuch/kept_run.h5"),
    Case("output where none can be", r"/proc/kept_run.h5", "{single} -output /proc/kept_run.h5"),
    Case("two runs with one output", r"kept_run.h5.*(another|other|use|run)", "{single} -ts_dt 2e-7", before=running("{single}", HALT),
         after=goes_on("kept_run.h5")),
    Case("two runs with one output by two paths", r"kept_run.h5.*(another|other|use|run)", "{single} -output folder/../kept_run.h5",
         before=running("{single}", HALT), after=goes_on("kept_run.h5")),
    Case("ended by a limit of steps", r"ts_max_steps", "{single} -ts_max_steps 3", leaves=OWN, after=incomplete("kept_run.h5")),
    Case("thin bar under 50 kN, linear inertia", r"(balance|inertia)", "{elastogear} simulate -bodies a -a_file thin.h5 -a_joint revolute -a_axis 0,0,1 "
         "-a_omega0 1 -inertia linear -loads p -p_marker a.END -p_force -50000,0,0 -p_frame body -p_signal ramp,1,2e-3 -ts_dt 2e-6 "
         "-ts_max_time 5e-3 -output_every 100 -output kept_run.h5", kind="right or error", leaves=OWN, after=tip_within(100),
         before=lambda bench: bench.good("{elastogear} reduce -mesh thin.inp {steel} -restrain FIX -markers END -basis modal -modes 20 "
                                         "-output thin.h5")),
    Case("strains of ten percent", r"strain", "{pull} -a_file rubber.h5 -pull_force 10,0,0", kind="warning", leaves=r"kept_run\.h5"),
    Case("strains of hundreds of percent", r"strain", "{pull} -a_file rubber.h5 -pull_force 1000,0,0", leaves=OWN),
    Case("free rotation with far too long steps", r"strain", "{single} -a_joint spherical -a_omega0 0,1e5,1e4 -ts_dt 1e-3 "
         "-ts_max_time 0.1 -a_file rubber.h5 -inertia full", leaves=OWN),
    Case("steps that stay cut", r"steps could be longer than .*take -ts_dt", "{single} -a_joint spherical -a_omega0 0,1e4,1e3 -ts_dt 1e-2 "
         "-ts_max_time 10", leaves=OWN),
    Case("state on a full disk", NO_SPACE, "{single} -checkpoint_every 0", fault=full("state.h5", 20000), leaves=OWN,
         after=again("{single} -checkpoint_every 0", "kept_run.h5")),
    Case("result on a full disk", NO_SPACE, "{single}", fault=full("kept_run.h5", 4096), leaves=PARTS, after=again("{single}", "kept_run.h5")),
    Case("parts of a result on a full disk", NO_SPACE, "{single} -checkpoint_every 0", fault=full("kept_run.h5", 100000), leaves=OWN,
         after=again("{single} -checkpoint_every 0", "kept_run.h5")),
    Case("joined result on a full disk", NO_SPACE, "{single} -checkpoint_every 0", fault=full("result.h5", 4096), leaves=PARTS,
         after=again("{single} -checkpoint_every 0", "kept_run.h5")),
    Case("sensor table on a full disk", NO_SPACE, "{single} -sensors_s a.END -sensor_csv", fault=full("kept_run_s.csv", 100), leaves=OWN),
    Case("run killed at a checkpoint", r"", "{single} -checkpoint_every 0", kind="killed", leaves=PARTS, fault=KILL_AT_SECOND_STATE,
         after=again("{single} -checkpoint_every 0", "kept_run.h5")),
    Case("run killed before its result has its name", r"", "{single}", kind="killed", leaves=PARTS,
         fault={"": "kill", "CALL": "rename", "FILE": "kept_run.h5$"}, after=again("{single}", "kept_run.h5")),
    Case("run asked to stop", r"stopped by signal 15", "{single} -checkpoint_every 0", leaves=OWN, fault={**KILL_AT_SECOND_STATE, "": "term"},
         after=again("{single} -checkpoint_every 0", "kept_run.h5")),
    Case("unfinished run with another step", r"ts_dt 2e-7 .was 1e-7", "{single} -ts_dt 2e-7 -checkpoint_every 0", before=unfinished),
    Case("unfinished run with another body", r"identity_a", "{single} -checkpoint_every 0 -a_file soft.h5", before=unfinished),
    Case("unfinished run that is garbage", r"state.h5", "{single}", before=garbled),
    Case("unfinished run with a flipped state", r"(checksum|damaged|state.h5)", "{single} -checkpoint_every 0", before=unfinished_flipped),
    Case("unfinished run with a flipped part", r"(checksum|damaged|part_)", "{single} -checkpoint_every 0", leaves=OWN,
         before=unfinished_part_flipped),
    Case("body with a flipped stiffness", r"(checksum|damaged|body.h5)", "{single}", before=flipped("body.h5", "reduced/K")),
    Case("body with a flipped mass", r"(checksum|damaged|body.h5)", "{single}", before=flipped("body.h5", "reduced/M")),
    Case("body with a flipped coupling", r"(checksum|damaged|body.h5)", "{single}", before=flipped("body.h5", "reduced/C_l")),
    Case("body with a flipped surface", r"(checksum|damaged|body.h5)", "{simulate} -b_position 0,0,1", before=flipped("body.h5", "surface/X")),
    Case("body with a flipped mode", r"(checksum|damaged|body.h5)", "{simulate} -b_position 0,0,1", before=flipped("body.h5", "surface/Phi")),
    Case("body with a flipped contact stiffness", r"(checksum|damaged|body.h5)", "{simulate} -b_position 0,0,1", before=flipped("body.h5", "surface/c_f")),
    Case("body with a flipped mass of its own", r"(checksum|damaged|body.h5)", "{single}", before=flipped("body.h5", "rigid/mass")),
    Case("body with a flipped centre", r"(checksum|damaged|body.h5)", "{single}", before=flipped("body.h5", "rigid/center")),
    Case("body with a number that is none", r"body.h5.*(finite|nan)", "{single}", before=edited("body.h5", "reduced/K", lambda K: np.nan * K)),
    Case("body without a dataset", r"body.h5.*reduced/C_r", "{single}", before=removed("body.h5", "reduced/C_r")),
    Case("body of the future", r"body.h5.*version", "{single}", before=lambda bench: attribute(bench, "body.h5", "version", 999)),
    Case("initial state of flipped numbers", r"(checksum|damaged|turning.h5)", "{single} -a_joint revolute -initial_file turning.h5 -initial_time 1e-6",
         before=flipped("turning.h5", "bodies/a/rigid")),

]

RECOVER = [
    Case("missing result file", r"nosuch.h5", "{recover} -result nosuch.h5"),
    Case("set without stress modes", r"no stress modes at the set 'FIX'.*MIDDLE", "{elastogear} recover two.yaml -result run.h5 -stress_a FIX -output kept_stress.h5"),
    Case("body file of another reduction", r"seven.h5: 7 elastic coordinates, body .a. of .* has 6", "{recover} -a_file seven.h5"),
    Case("no set", r"stress_", "{elastogear} recover -result run.h5 -output kept_stress.h5"),
    Case("no result", r"result is missing", "{elastogear} recover -stress_a MIDDLE -output kept_stress.h5"),
    Case("set of an unknown body", r"'c'|stress_c", "{recover} -stress_c MIDDLE"),
    Case("body file as result", r"body.h5.*(body|result)", "{recover} -result body.h5"),
    Case("result cut in half", r"truncated_run.h5", "{recover} -result truncated_run.h5"),
    Case("output over the result", r"run.h5", "{recover} -output run.h5"),
    Case("output over the result by another path", r"run.h5", "{recover} -output folder/../run.h5"),
    Case("stresses over the body file", r"body.h5", "{recover} -output body.h5"),
    Case("stresses over the body file by a link", r"(body|link).h5", "{recover} -output link.h5"),
    Case("body file gone", r"body.h5.*no such file", "{recover}", before=lambda bench: os.remove(bench.path("body.h5"))),
    Case("body file of another mesh", r"(another|other|not the|finger)", "{recover} -a_file other_mesh.h5"),
    Case("body file of another material", r"(another|other|not the|finger)", "{recover} -a_file soft.h5"),
    Case("body file that was made anew", r"(another|other|not the|finger)", "{recover}", before=copied("soft.h5", "body.h5")),
    Case("body file of another basis", r"coordinates", "{recover} -a_file full.h5"),
    Case("field outside of the run", r"field_times.*7", "{recover} -field_times 7"),
    Case("level that is none", r"box_levels.*top", "{recover} -box_levels top"),
    Case("boxes of 7 directions", r"7", "{recover} -box_levels 1 -box_kdop 7"),
    Case("table of some nodes", r"csv.*peak, all", "{recover} -csv some"),
    Case("mode acceleration perhaps", r"mode_acceleration", "{recover} -mode_acceleration perhaps"),
    Case("stresses of a run that was stopped", r"incomplete|not complete|did not end", "{recover} -result cut.h5", kind="warning",
         before=lambda bench: bench.run("{single} -checkpoint_every 0 -output cut.h5", {**KILL_AT_SECOND_STATE, "": "term"}),
         leaves=r"kept_stress.*"),
    Case("stresses in no folder", r"nosuch", "{recover} -output nosuch/kept_stress.h5"),
    Case("stresses on a full disk", NO_SPACE, "{recover}", fault=full("kept_stress.h5", 4096), after=again("{recover}", "kept_stress.h5")),
    Case("table of stresses on a full disk", NO_SPACE, "{recover}", fault=full("MIDDLE.csv", 100), leaves=r"kept_stress\.h5",
         after=again("{recover}", "kept_stress.h5")),
    Case("field on a full disk", NO_SPACE, "{recover} -field_times 1e-6", fault=full(".vtu", 1000), leaves=r"kept_stress.*"),
    Case("recovery killed", r"", "{recover}", kind="killed", fault={"": "kill", "CALL": "rename", "FILE": "kept_stress.h5"},
         leaves=r"kept_stress\.h5\.tmp.*"),
    Case("result with flipped coordinates", r"(checksum|damaged|run.h5)", "{recover}", before=flipped("run.h5", "bodies/a/q")),
    Case("result with a flipped time", r"(checksum|damaged|run.h5)", "{recover}", before=flipped("run.h5", "time")),
    Case("result with flipped accelerations", r"(checksum|damaged|run.h5)", "{recover} -mode_acceleration true",
         before=flipped("run.h5", "bodies/a/q_acceleration")),
    Case("body with flipped stress modes", r"(checksum|damaged|body.h5)", "{recover}", before=flipped("body.h5", "stress/Psi")),
    Case("body with a flipped mesh", r"(checksum|damaged|body.h5)", "{recover} -field_times 1e-6", before=flipped("body.h5", "mesh/X"),
         leaves=r"kept_stress.*"),
    Case("time that stands still", r"run.h5.*time", "{recover}", before=edited("run.h5", "time", lambda t: 0 * t)),
    Case("time that is not finite", r"run.h5.*time", "{recover}", before=edited("run.h5", "time", lambda t: t / 0)),
    Case("coordinates that are not finite", r"run.h5.*(finite|nan)", "{recover}", before=edited("run.h5", "bodies/a/q", lambda q: q * np.nan)),
    Case("result without a dataset", r"run.h5.*bodies/a/q", "{recover}", before=removed("run.h5", "bodies/a/q")),
    Case("result of the future", r"run.h5.*version", "{recover}", before=lambda bench: attribute(bench, "run.h5", "version", 999)),

]

CASES = VERBS + OPTIONS + MESH + REDUCE + SIMULATE + RECOVER
