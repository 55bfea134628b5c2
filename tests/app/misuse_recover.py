"""The misuses of the verb recover."""
import os

import numpy as np

from misuse_case import again, Case, copied, edited, flipped, full, KILL_AT_SECOND_STATE, NO_SPACE, removed
from misuse_files import attribute

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
    Case("fields of most times", r"field_times.*most", "{recover} -field_times most"),
    Case("every field but the zeroth", r"field_every.*0", "{recover} -field_times all -field_every 0"),
    Case("every second of chosen fields", r"field_every.*field_times all", "{recover} -field_times 1e-6 -field_every 2"),
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
