"""The misuses of the verbs compare and info."""
import numpy as np

from misuse_case import Case, copied, edited, foldered, foreign, linked, opened_to_write, piped, removed, socketed, written
from misuse_files import attribute

BESIDE = "{elastogear} compare stress.h5"
INFO = "{elastogear} info"

COMPARE = [
    Case("compare of three files", r"compares two files, not 3", BESIDE + " stress_full.h5 run.h5"),
    Case("compare of nothing", r"compares two files, not 0", "{elastogear} compare"),
    Case("compare of evaluations", r"holds an elastogear evaluation; result and stress files can be compared", "{elastogear} compare gears_evaluation.h5 gears_evaluation.h5"),
    Case("compare of a result and its evaluation", r"both must be result files, or both stress files", "{elastogear} compare gears_result.h5 gears_evaluation.h5"),
    Case("compare of meshes", r"pinion.msh: is no HDF5 file of this program", "{elastogear} compare pinion.msh wheel.msh"),
    Case("compare with a folder", r"gear_cases(?!: there is no such file)", BESIDE + " gear_cases"),
    Case("compare with a pipe", r"pipe.h5", BESIDE + " pipe.h5", before=piped("pipe.h5")),
    Case("compare with an endless device", r"zero.h5", BESIDE + " zero.h5", before=linked("/dev/zero", "zero.h5")),
    Case("compare with a file of another program", r"foreign.h5: /: has no attribute format", BESIDE + " foreign.h5", before=foreign("foreign.h5")),
    Case("compare of other bodies", r"have no stresses at the same set of the same body", BESIDE + " gears_stress.h5"),
    Case("compare of results of other bodies", r"have no pair of bodies and no moving body of the same name", "{elastogear} compare gears_result.h5 run.h5"),
    Case("compare by names", r"'name': must be one of number, position", "{compare} -match name"),
    Case("compare within a negative distance", r"match_tolerance = -1e-06 m: must be positive", "{compare} -match position -match_tolerance -1e-6"),
    Case("compare at a moment that is none", r"at = 'now': must be a finite number", "{compare} -at now"),
    Case("compare at a time outside of the reference", r"reference_at = 7 s: is outside of the file, 0 .. 1e-06 s", "{compare} -at last -reference_at 7"),
    Case("compare of a span that ends before it begins", r"no time between 5e-07 and 1e-07 s", "{compare} -from 5e-7 -to 1e-7"),
    Case("compare of a span in mm", r"'mm' is no unit of it, write ns", "{compare} -from 5\\ mm"),
    Case("compare at a node that is not there", r"node_a.*99999", "{compare} -node_a 99999"),
    Case("compare at half a node", r"node_a.*4.5", "{compare} -node_a 4.5"),
    Case("compare at a node of an unknown body", r"unknown option -node_c", "{compare} -node_c 4"),
    Case("compare to a table that is a folder", r"'new_1.csv' is no name for a file: a folder has it", BESIDE + " stress_full.h5 -output new", before=foldered("new_1.csv")),
    Case("compare to a table that is a pipe", r"'new_1.csv' is no name for a file", BESIDE + " stress_full.h5 -output new", before=piped("new_1.csv")),
    Case("compare over its file", r"would overwrite x_1.csv; this run reads it", "{elastogear} compare x_1.csv stress.h5 -output x", before=copied("stress.h5", "x_1.csv")),
    Case("compare with an option of life", r"-sn_slope belongs to life; compare does not read it", "{compare} -sn_slope 5"),
    Case("compare of foreign nodes", r"there is no node 1000004", "{compare}", before=edited("stress.h5", "a/MIDDLE/nodes", lambda nodes: nodes + 10**6)),
    Case("compare of stresses that are not finite", r"/a/MIDDLE/stress: holds a number that is not finite", "{compare}",
         before=edited("stress.h5", "a/MIDDLE/stress", lambda stress: stress * np.nan)),
    Case("info on a pipe", r"pipe.h5(?!: there is no such file)", INFO + " pipe.h5", before=piped("pipe.h5")),
    Case("info on a socket", r"socket.h5", INFO + " socket.h5", before=socketed("socket.h5")),
    Case("info on an endless device", r"zero.inp", INFO + " zero.inp", before=linked("/dev/zero", "zero.inp")),
    Case("info on a link to itself", r"loop.h5", INFO + " loop.h5", before=linked("loop.h5", "loop.h5")),
    Case("info on a file of another program", r"foreign.h5: /: has no attribute format", INFO + " foreign.h5", before=foreign("foreign.h5")),
    Case("info on bulk data of Nastran", r"deck.bdf: unknown format; .*bulk data of Nastran becomes one.*gmsh deck.bdf -save -o deck.inp",
         INFO + " deck.bdf", before=written("deck.bdf", "GRID,1,,0.,0.,0.\n")),
    Case("info on a drive file", r"gears.yaml: unknown format; known are .msh, .inp", INFO + " gears.yaml"),
    Case("info on a text with the name of a result", r"text.h5: unknown format", INFO + " text.h5", before=written("text.h5", "a result\n")),
    Case("info on a mesh with the name of a result", r"renamed.h5: unknown format", INFO + " renamed.h5", before=copied("wheel.msh", "renamed.h5")),
    Case("info on two files of which one is missing", r"nosuch.h5: there is no such file", INFO + " run.h5 nosuch.h5"),
    Case("info on a file named like an option", r"unknown option -run.h5", INFO + " -run.h5"),
    Case("info with an option of compare", r"-match belongs to compare; info does not read it", INFO + " run.h5 -match position"),
    Case("info on a result without its times", r"run.h5: there is no /time", INFO + " run.h5", before=removed("run.h5", "time")),
    Case("info on a file that another program writes", r"run.h5: another program has it open to write", INFO + " run.h5", before=opened_to_write("run.h5")),
    Case("info on a format of the future", r"run.h5: unknown format 'elastogear sound', known are", INFO + " run.h5",
         before=lambda bench: attribute(bench, "run.h5", "format", np.bytes_("elastogear sound"))),
]
