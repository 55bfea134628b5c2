"""The misuses of tables and files of options by their letters, line ends and headings, whatever the verb; signals."""
import h5py
import numpy as np

from misuse_case import again, Case, encoded, KILL_AT_SECOND_STATE, told_to_quit, written
from misuse_files import bar

BY_TABLE = "{hinged} -a_torque table,torque.csv"


def torque(text, encoding="utf-8"):
    return encoded("torque.csv", text, encoding)


def as_in_square_brackets(bench):
    """The same table with [ms] and [kN m] moves the body as far."""
    bench.good("{hinged} -a_torque table,ramp_in_ms.csv -output square.h5")
    with h5py.File(bench.path("kept_run.h5")) as a, h5py.File(bench.path("square.h5")) as b:
        alike = np.allclose(a["energy/work"][:], b["energy/work"][:], rtol=1e-9, atol=0) and b["energy/work"][-1] != 0
    return "" if alike else "the units in round brackets are not read"


TABLES = [
    Case("torque with a byte order mark", r"", BY_TABLE, kind="good", leaves=r"kept_run\.h5", before=torque("\ufefftime,torque\n0,0\n1,1\n")),
    Case("torque with DOS line ends", r"", BY_TABLE, kind="good", leaves=r"kept_run\.h5", before=torque("time,torque\r\n0,0\r\n1,1\r\n")),
    Case("torque with old Macintosh line ends", r"torque.csv", BY_TABLE, before=torque("time,torque\r0,0\r1,1\r")),
    Case("torque with a time twice", r"torque.csv: table row 3: time 1 s", BY_TABLE, before=torque("0,0\n1,1\n1,1\n")),
    Case("torque beyond doubles", r"torque.csv, line 2: '1e999'", BY_TABLE, before=torque("0,0\n1,1e999\n")),
    Case("torque with a column of text", r"torque.csv, line 2", BY_TABLE, before=torque("time,torque,remark\n0,0,start\n1,1,end\n")),
    Case("torque with units in round brackets", r"", BY_TABLE, kind="good", leaves=r"kept_run\.h5|square\.h5",
         before=torque("time (ms),torque (kN m)\n0,0\n1,0.001\n"), after=as_in_square_brackets),
    Case("master curve with a byte order mark", r"", "{reduce} -material_master_curve marked.csv -basis modal", kind="good", leaves=r"kept\.h5",
         before=encoded("marked.csv", "\ufefftime [s],modulus [GPa]\n0.01,200\n1,180\n100,150\n", "utf-8")),
    Case("times of output with a byte order mark", r"", "{single} -output_times marked.txt", kind="good", leaves=r"kept_run\.h5",
         before=encoded("marked.txt", "\ufeff1e-7\n5e-7\n", "utf-8")),
    Case("options with a byte order mark", r"", "{reduce} -options_file marked.txt", kind="good", leaves=r"kept\.h5",
         before=encoded("marked.txt", "\ufeff-material_rho 7850\n", "utf-8")),
    Case("mesh with a byte order mark", r"", "{reduce} -mesh marked.inp", kind="good", leaves=r"kept\.h5", before=encoded("marked.inp", "\ufeff" + bar(), "utf-8")),
    Case("mesh with DOS line ends", r"", "{reduce} -mesh dos.inp", kind="good", leaves=r"kept\.h5", before=encoded("dos.inp", bar().replace("\n", "\r\n"), "utf-8")),
    Case("mesh in UTF-16", r"wide.inp, line 1", "{reduce} -mesh wide.inp", before=encoded("wide.inp", bar(), "utf-16")),
    Case("set of cells with a slash", r"slashed.inp: a set has the name 'ALL/STEEL'.*rename it", "{reduce} -mesh slashed.inp",
         before=written("slashed.inp", bar().replace("ELSET=ALL", "ELSET=ALL/STEEL"))),
    Case("run after one that was told to quit", r"", "{single} -checkpoint_every 0", kind="good", leaves=r"kept_run\.h5.*",
         before=told_to_quit("{single} -checkpoint_every 0", {**KILL_AT_SECOND_STATE, "": "stop"}), after=again("{single} -checkpoint_every 0", "kept_run.h5")),
]
