"""The misuses of misuse.py, over every verb: what is done wrong, the words that the program must find, the command."""
import os

from misuse_case import Case, continued, flipped, full, HALT, last_time, NO_SPACE, running
from misuse_compare import COMPARE
from misuse_design import DESIGN
from misuse_evaluate import EVALUATE
from misuse_life import LIFE
from misuse_recover import RECOVER
from misuse_reduce import REDUCE
from misuse_run import RUN
from misuse_simulate import SIMULATE
from misuse_sweep import SWEEPS
from misuse_tables import TABLES
from misuse_wear import WEAR

VERBS = [
    Case("unknown verb", r"'reduse'; the nearest one is reduce; the verbs are", "{elastogear} reduse"),
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
    Case("compare while another run writes its tables", r"kept_1.csv.*another run", "{compare}", before=running("{compare}", HALT),
         after=continued),
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
    Case("options of PETSc", r"", "{single} -ts_adapt_type none -ts_monitor -snes_rtol 1e-9 -snes_monitor -pc_type shell "
         "-log_view -malloc_debug -options_left -options_view -on_error_abort -memory_view -citations "
         "-no_signal_handler", kind="good", leaves=r"kept_run\.h5"),
    Case("options of SLEPc", r"", "{reduce} -eps_tol 1e-9 -eps_ncv 30 -st_type sinvert -st_pc_type cholesky "
         "-st_mat_mumps_icntl_14 30 -eps_monitor", kind="good", leaves=r"kept\.h5"),
    Case("another eigensolver of SLEPc", r"", "{reduce_brick} -eps_type krylovschur -eps_nev 3", kind="good",
         leaves=r"kept\.h5"),
    Case("all modes of an interval", r"", "{reduce_brick} -eps_interval 0,1e11 -eps_block_lanczos_window 4", kind="good",
         leaves=r"kept\.h5"),
    Case("two numbers of modes", r"-modes = 5 and -eps_nev = 4", "{reduce} -eps_nev 4"),
    Case("interval from above to below", r"eps_interval = '2,1': must be two numbers a < b", "{reduce_brick} -eps_interval 2,1"),
    Case("interval with a number of modes", r"eps_interval takes all modes", "{reduce} -eps_interval 0,1e9"),
    Case("modes by the loads", r"", "{reduce_brick} -basis modal_residual -surface TOP -modes auto -rise_time 1e-4", kind="good",
         leaves=r"kept\.h5"),
    Case("modes by loads that are not given", r"modes = auto: give the loads' rise_time", "{reduce_brick} -basis modal_residual -modes auto"),
    Case("modes by loads without static responses", r"modes = auto: needs basis: modal_residual", "{reduce_brick} -modes auto -rise_time 1e-4"),
    Case("rise time with a number of modes", r"rise_time: belongs to modes: auto", "{reduce_brick} -modes 3 -rise_time 1e-4"),
    Case("loads too slow for any mode", r"no eigenvalue lies between.*take one mode",
         "{reduce_brick} -basis modal_residual -modes auto -highest_frequency 1"),
    Case("interval without a mode", r"no eigenvalue lies between", "{reduce_brick} -eps_interval 0,1e-3"),
    Case("flag without a value in YAML", r"pinion_internal .flag.yaml, line 5.: is empty, write true or false", "{elastogear} mesh flag.yaml"),
    Case("speed without its unit", r"speed .speed.yaml, line 4. = 1500: write its unit, '1500 rpm'", "{elastogear} mesh speed.yaml"),
    Case("misspelt key of a drive", r"option -log_veiw .misspelt_drive.yaml, line \d+. = '1'; the nearest known option is -log_view ", "{elastogear} mesh misspelt_drive.yaml"),
    Case("worm drive of a catalogue", r"", "{worm} -axial_module 6.3\\ mm -worm_reference_diameter 63\\ mm -wheel_profile_shift 0.397 -centre_distance 160\\ mm "
         "-worm_flank ZI", kind="good", leaves=r".*\.(msh|svg)"),
    Case("worm drive of a catalogue, throated", r"", "{worm} -axial_module 6.3\\ mm -diameter_quotient 10 -centre_distance 160\\ mm -worm_flank ZK",
         kind="good", leaves=r".*\.(msh|svg)"),
    Case("worm drive whose numbers contradict each other", r"profile shift is 0.39682.*not the one given", "{worm} -axial_module 6.3\\ mm -diameter_quotient 10 "
         "-centre_distance 160\\ mm -wheel_profile_shift 0.2"),
    Case("worm drive with a shift beyond reason", r"profile shift is 2.*must be between -1 and 1", "{worm} -axial_module 6.3\\ mm -diameter_quotient 10 -centre_distance 170.1\\ mm"),
    Case("worm drive of two modules", r"-module and -axial_module: give one", "{worm} -axial_module 6.3\\ mm -module 6\\ mm"),
    Case("worm of two diameters", r"worm_reference_diameter and -diameter_quotient", "{worm} -axial_module 6.3\\ mm -diameter_quotient 10 -worm_reference_diameter 63\\ mm"),
    Case("fillet of a rack that does not fit", r"rack_fillet = 2 does not fit", "{elastogear} mesh drive.yaml -rack_fillet 2"),
    Case("misspelt key of a drive, near one of PETSc", r"-speed ", "{elastogear} mesh drive.yaml -sped 3\\ rpm"),
    Case("options file that names itself", r"itself.txt, line 1: files of options name each other", "{reduce} -options_file itself.txt"),
    Case("options file with a prefix and an alias", r"", "{elastogear} simulate -bodies a -a_file body.h5 -output kept_run.h5 -options_file prefix.txt",
         kind="good", leaves=r"kept_run\.h5", after=last_time(1e-6)),
    Case("prefix that is not there", r"prefix_pop: no -prefix_push", "{reduce} -prefix_pop"),
    Case("more keys than PETSc's database holds", r"", "{elastogear} simulate many_keys.yaml -analysis sweep", kind="good",
         leaves=r"kept_run(/.*)?"),
    Case("list of more than 255 characters", r"", "{elastogear} simulate many_torques.yaml -analysis sweep", kind="good",
         leaves=r"kept_run(/.*)?"),
    Case("list of times of more than 255 characters", r"", "{single} -output_times " + ",".join(f"{i}e-9" for i in range(1, 100)), kind="good",
         leaves=r"kept_run\.h5"),
    Case("keys of other verbs in a file for all", r"", "{elastogear} recover for_all.yaml", kind="good", leaves=r"kept_stress.*"),
    Case("keys of other verbs in a file for all, simulate", r"", "{elastogear} simulate for_all.yaml", kind="good", leaves=r"kept_run\.h5"),
    Case("stresses of a body that has the name of a key", r"(recovery|no body)", "{elastogear} recover for_all.yaml -recover_stress_recovery MIDDLE"),
    Case("torque and torques in a file", r"", "{elastogear} simulate both_torques.yaml -analysis sweep", kind="good", leaves=r"kept_run(/.*)?"),
    Case("torque of the command line before torques of a file", r"", "{elastogear} simulate both_torques.yaml -analysis sweep -torque 50", kind="good",
         leaves=r"kept_run\.h5"),
    Case("table in a unit of something else", r"duty_in_s.csv, line 2: .*'s' is no unit of it, write N mm", "{elastogear} life drive.yaml -duty_cycle duty_in_s.csv -sn_knee_stress 1e8"),
    Case("option of another verb", r"option -result belongs to recover and evaluate; life does not read it", "{elastogear} life drive.yaml -result kept.h5"),
    Case("option of the verb of a life", r"option -duty_cycle belongs to life; run does not read it", "{elastogear} run drive.yaml -duty_cycle 1,2"),
    Case("table with two separators", r"two_separators.csv, line 1: '5 1e6' must be a number without a unit", "{elastogear} life drive.yaml -duty_cycle two_separators.csv -sn_knee_stress 1e8"),
    Case("unit of what has none", r"revolutions_in_h.csv, line 2: '1e6 h' must be a number without a unit", "{elastogear} life drive.yaml -duty_cycle revolutions_in_h.csv -sn_knee_stress 1e8"),
    Case("table with a field too many", r"two_fields.csv, line 4: must be two numbers", "{hinged} -a_torque table,two_fields.csv"),
    Case("table in other units", r"", "{hinged} -a_torque table,ramp_in_ms.csv", kind="good", leaves=r"kept_run\.h5"),
    Case("table of lengths for a torque", r"ramp_in_mm.csv, line 2: .*'mm' is no unit of it", "{hinged} -a_torque table,ramp_in_mm.csv"),
    Case("table of lengths in parentheses for a torque", r"ramp_of_metres.csv, line 2: .*'mm' is no unit of it", "{hinged} -a_torque table,ramp_of_metres.csv"),
    Case("table in other units, in parentheses", r"", "{hinged} -a_torque table,ramp_in_parentheses.csv", kind="good", leaves=r"kept_run\.h5"),
    Case("table in a unit that is not known, in parentheses", r"ramp_in_lbf_ft.csv, line 1: the heading 'torque .lbf ft.' ends with 'lbf ft'.*torque .kN m.",
         "{hinged} -a_torque table,ramp_in_lbf_ft.csv"),
    Case("table of blanks with units in its heading", r"ramp_of_blanks.csv, line 1: '.ms.' is no heading.*apart by commas",
         "{hinged} -a_torque table,ramp_of_blanks.csv"),
    Case("duty cycle in a unit that is not known, in parentheses", r"duty_in_lbf_ft.csv, line 1: the heading .*'lbf ft'",
         "{elastogear} life drive.yaml -duty_cycle duty_in_lbf_ft.csv -sn_knee_stress 1e8"),
    Case("table of variants with units in parentheses", r"", "{elastogear} simulate drive.yaml -analysis sweep -variants variants_in_parentheses.csv",
         kind="good", leaves=r"kept_run(/.*)?"),
    Case("table of variants with units", r"", "{elastogear} simulate drive.yaml -analysis sweep -variants variants_in_um.csv", kind="good", leaves=r"kept_run(/.*)?"),
    Case("table of variants with a wrong unit in its heading", r"variants_in_s.csv, line 2 = '20 s': 's' is no unit",
         "{elastogear} simulate drive.yaml -analysis sweep -variants variants_in_s.csv"),
    Case("help about what moves the cursor", r"no option about '.x1b.31mred'", "{elastogear} reduce -help \x1b[31mred"),
    Case("run whose evaluation is a folder", r"'drive_evaluation.h5' is no name for a file: a folder has it", "{elastogear} run drive.yaml -report none",
         before=lambda bench: os.mkdir(bench.path("drive_evaluation.h5"))),
    Case("run whose summary is a folder", r"'drive_evaluation.json' is no name for a file: a folder has it", "{elastogear} run drive.yaml -report none",
         before=lambda bench: os.mkdir(bench.path("drive_evaluation.json"))),
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
    Case("number with the unit of something else", r"ts_dt.*1e-7 mm.*no unit of it, write ns, us, ms, s", "{single} -ts_dt 1e-7\\ mm"),
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

CASES = (VERBS + OPTIONS + MESH + REDUCE + SIMULATE + RECOVER + COMPARE + DESIGN + SWEEPS + EVALUATE + LIFE + WEAR + RUN + TABLES)
