"""The misuses of the verb life."""
import numpy as np

from misuse_case import (Case, edited, encoded, first, flipped, foldered, full, gone, linked, NO_SPACE, piped, removed, reworded,
                         written)
from misuse_files import attribute

FOR_DUTY = "{life} -duty_cycle duty.csv"
OF_STRESSES = "{life} -files gears_stress.h5"
OWN = r"gears_life.*"


def duty(text, encoding="utf-8"):
    return encoded("duty.csv", text, encoding)


DUTY = [
    Case("life without a duty cycle", r"option -duty_cycle is missing: torques and revolutions", "{elastogear} life drive.yaml -sn_knee_stress 1e8"),
    Case("duty cycle of a torque alone", r"duty_cycle.*(pairs|revolutions)", "{life} -duty_cycle 50"),
    Case("duty cycle of three numbers", r"duty_cycle: must be pairs of a torque and revolutions or hours", "{life} -duty_cycle 50,1e6,100"),
    Case("duty cycle of words", r"duty_cycle: 'half' must be a torque", "{life} -duty_cycle half,often"),
    Case("duty cycle of negative revolutions", r"-1000000 revolutions of the first gear must be > 0", "{life} -duty_cycle 50,-1e6"),
    Case("duty cycle without torque", r"torque 0 N m must be > 0 on the drive side", "{life} -duty_cycle 0,1e6"),
    Case("duty cycle beyond doubles", r"'1e400' must be a torque", "{life} -duty_cycle 1e400,1e6"),
    Case("duty cycle beyond the torques of the sweep", r"60 N m lies outside those whose stresses are known, 50 N m: add it", "{life} -duty_cycle 60,1e6"),
    Case("duty cycle in kN m", r"50000 N m lies outside", "{life} -duty_cycle 50\\ kN\\ m,1e6"),
    Case("duty cycle of the coast side", r"-50 N m lies outside", "{life} -duty_cycle -50,1e6"),
    Case("duty cycle of revolutions in mm", r"'mm' is no unit of it, write ns, us, ms, s, min, h", "{life} -duty_cycle 50,1e6\\ mm"),
    Case("duty cycle of hours at rest", r"'20 h' is a time, which needs the speed", "{life} -duty_cycle 50,20\\ h", before=reworded("gears.yaml", "speed: 1500 rpm\n", "")),
    Case("duty cycle in a folder", r"folder: is not a regular file", "{life} -duty_cycle folder"),
    Case("duty cycle in a pipe", r"pipe.csv: is not a regular file", "{life} -duty_cycle pipe.csv", before=piped("pipe.csv")),
    Case("duty cycle in an endless device", r"zero.csv: is not a regular file", "{life} -duty_cycle zero.csv", before=linked("/dev/zero", "zero.csv")),
    Case("duty cycle in a result", r"gears_result.h5, line 1", "{life} -duty_cycle gears_result.h5"),
    Case("duty cycle of a heading", r"duty.csv: has no blocks", FOR_DUTY, before=duty("torque [N m],revolutions\n")),
    Case("duty cycle with semicolons", r"duty.csv, line [12]:", FOR_DUTY, before=duty("torque [N m];revolutions\n50,5;1e6\n")),
    Case("duty cycle with a short line", r"duty.csv, line 2", FOR_DUTY, before=duty("50,1e6\n50\n")),
    Case("duty cycle that is not finite", r"duty.csv, line 2: 'nan' must be a finite number", FOR_DUTY, before=duty("50,1e6\n50,nan\n")),
    Case("duty cycle at no speed", r"duty.csv, line 1: .*0 revolutions must be > 0", FOR_DUTY, before=duty("50,20,0\n")),
    Case("duty cycle with exchanged columns", r"duty.csv, line 2: '50 N m' must be a number without a unit", FOR_DUTY, before=duty("revolutions,torque [N m]\n1e6,50\n")),
    Case("duty cycle with thousands apart", r"duty.csv, line 1: '1 000 000' must be a number", FOR_DUTY, before=duty("50,1 000 000\n")),
    Case("duty cycle with DOS line ends", r"", FOR_DUTY, kind="good", leaves=OWN, before=duty("torque [N m],revolutions\r\n50,1e6\r\n\r\n")),
    Case("duty cycle with old Macintosh line ends", r"duty.csv", FOR_DUTY, before=duty("torque [N m],revolutions\r50,1e6\r")),
    Case("duty cycle in Latin-1", r"", FOR_DUTY, kind="good", leaves=OWN, before=duty("höchstes Drehmoment [N m],Umdrehungen\n50,1e6\n", "latin-1")),
    Case("duty cycle in UTF-16", r"duty.csv, line 1: .*UTF-16", FOR_DUTY, before=duty("50,1e6\n", "utf-16")),
    Case("duty cycle with a byte order mark", r"", FOR_DUTY, kind="good", leaves=OWN, before=duty("\ufefftorque [N m],revolutions\n50,1e6\n")),
    Case("duty cycle with units in round brackets", r"", FOR_DUTY, kind="good", leaves=OWN, before=duty("torque (kN m),revolutions\n0.05,1e6\n")),
    Case("duty cycle with a block twice", r"", FOR_DUTY, kind="good", leaves=OWN, before=duty("50,5e5\n50,5e5\n")),
]

STRENGTH = [
    Case("knee of negative stress", r"sn_knee_stress = -50 Pa: must be positive", "{life} -sn_knee_stress -50"),
    Case("knee in mm", r"'mm' is no unit of it, write Pa", "{life} -sn_knee_stress 50\\ mm"),
    Case("knee in MPa without its unit", r"sn_knee_stress", "{life} -sn_knee_stress 50", kind="warning", leaves=OWN),
    Case("knee at no cycle", r"sn_knee_cycles = 0", "{life} -sn_knee_cycles 0"),
    Case("curve that rises", r"sn_slope = -5 -: must be positive", "{life} -sn_slope -5"),
    Case("curve of a slope beyond reason", r"slope 1000000000 must lie between 1 and 100", "{life} -sn_slope 1e9"),
    Case("curve by another rule", r"'miner': must be one of original, haibach, elementary", "{life} -sn_below miner"),
    Case("curve at a stress ratio of 1", r"stress ratio 1 must be < 1", "{life} -sn_ratio 1"),
    Case("survival in percent", r"probability of survival 99: must lie between 0 and 1", "{life} -survival 99 -sn_scatter 1.3"),
    Case("survival without scatter", r"survival 0.99 differs .*needs its scatter", "{life} -survival 0.99"),
    Case("scatter below 1", r"scatter 0.7 must be the amplitude at 10 % survival over that at 90 %", "{life} -sn_scatter 0.7"),
    Case("mean stress by another rule", r"'gerber': must be one of none, goodman, fkm", "{life} -mean_stress gerber"),
    Case("mean stress without a strength", r"needs mean_stress_sensitivity, or tensile_strength", "{life}", before=reworded("gears.yaml", ", tensile_strength: 800 MPa", "")),
    Case("strength below the mean stress", r"mean stress of node \d+ reaches the tensile strength", "{life} -mean_stress goodman -tensile_strength 50\\ MPa"),
    Case("strength below the stress, by fkm", r"tensile.strength", "{life} -tensile_strength 50\\ MPa"),
    Case("strength in MPa without its unit", r"tensile_strength", "{life} -tensile_strength 800"),
    Case("strength in MPa without its unit, of no effect", r"tensile_strength = 800 Pa .*MPa meant", "{life} -tensile_strength 800 -mean_stress none", kind="warning", leaves=OWN),
    Case("sensitivity above 1", r"M = 2: must be at least 0 and below 1", "{life} -mean_stress_sensitivity 2"),
    Case("strength of a gear that is not there", r"unknown option -ring_sn_knee_stress", "{life} -ring_sn_knee_stress 5e7"),
    Case("strength of one gear alone", r"sn_knee_stress is missing.*or of wheel alone", "{life} -pinion_sn_knee_stress 5e7",
         before=reworded("gears.yaml", "sn: {knee_stress: 50 MPa}, ", "")),
]

LIFE = DUTY + STRENGTH + [
    Case("life without a drive", r"needs a drive file", "{elastogear} life -duty_cycle 50,1e6"),
    Case("life before the sweep", r"drive_result.h5: there is no such file.*sweep the drive first", "{elastogear} life drive.yaml -duty_cycle 50,1e6"),
    Case("life of a body", r"gears_pinion.h5: holds an elastogear body; a life is computed from result files", "{life} -files gears_pinion.h5"),
    Case("life of an evaluation", r"gears_evaluation.h5: holds an elastogear evaluation", "{life} -files gears_evaluation.h5"),
    Case("life of a life", r"gears_life.h5: holds an elastogear life", "{life} -files gears_life.h5 -output new.h5"),
    Case("life of a mesh", r"pinion.msh: is no HDF5 file", "{life} -files pinion.msh"),
    Case("life of a folder", r"folder: is not a regular file", "{life} -files folder"),
    Case("life of a bar's stresses", r"stress.h5: does not say the torque of its run; give it by -file_torques", "{life} -files stress.h5"),
    Case("life of stresses that do not say their torque", r"gears_stress.h5: does not say the torque of its run; give it by -file_torques", OF_STRESSES,
         before=removed("gears_stress.h5", "provenance/run/drive")),
    Case("life of two files of one torque", r"50 N m.*(twice|two|both)", "{life} -files gears_result.h5,gears_stress.h5"),
    Case("life of one file under two torques", r"2 torques for 1 files", "{life} -files gears_result.h5 -file_torques 50,60"),
    Case("life of a file under an infinite torque", r"file_torques = 'inf': must be a finite number", "{life} -files gears_result.h5 -file_torques inf"),
    Case("life of files of unlike positions", r"case_0002.h5: has other positions or nodes", "{life} -files gears_result.h5,gear_cases/case_0002.h5"),
    Case("life of one position", r"one.h5: has 1 position; a life needs those of a sweep", "{life} -files one.h5", before=first("{gears_sweep} -sweep_positions 1 -output one.h5")),
    Case("life of stresses that are not finite", r"/pinion/root/stress: holds a number that is not finite", OF_STRESSES,
         before=edited("gears_stress.h5", "pinion/root/stress", lambda stress: stress * np.nan)),
    Case("life of flipped stresses", r"damaged: checksum of /pinion/root/stress", OF_STRESSES, before=flipped("gears_stress.h5", "pinion/root/stress")),
    Case("life of stresses at foreign nodes", r"gears_stress.h5.*node", OF_STRESSES, before=edited("gears_stress.h5", "pinion/root/nodes", lambda nodes: nodes + 10**6)),
    Case("life of stresses at nodes below 0", r"gears_stress.h5.*node", OF_STRESSES, before=edited("gears_stress.h5", "pinion/root/nodes", lambda nodes: nodes - 10**6)),
    Case("life of stresses without nodes", r"gears_stress.h5: there is no /pinion/root/nodes", OF_STRESSES, before=removed("gears_stress.h5", "pinion/root/nodes")),
    Case("life of stresses without a gear", r"gears_stress.h5: holds no stresses of wheel root: recover it", OF_STRESSES, before=removed("gears_stress.h5", "wheel")),
    Case("life of stresses at uneven angles", r"position 1 at 0.0625 pitches is not evenly spaced", OF_STRESSES, before=edited("gears_stress.h5", "time", lambda roll: roll**2)),
    Case("life of stresses at angles that fall", r"gears_stress.h5: /time does not increase", OF_STRESSES, before=edited("gears_stress.h5", "time", lambda roll: roll[::-1])),
    Case("life of stresses of the future", r"gears_stress.h5: has version 999", OF_STRESSES, before=lambda bench: attribute(bench, "gears_stress.h5", "version", 999)),
    Case("life of a set that is not there", r"no stress modes at the set 'NOSUCH'; there are: root", "{life} -stress_pinion NOSUCH"),
    Case("life of a variant that is not there", r"crowned", "{life} -variant crowned"),
    Case("life of rigid gears", r"all gears whose stresses are wanted are rigid", "{elastogear} life drive.yaml -duty_cycle 300,1e6 -sn_knee_stress 1e8 -mean_stress none",
         before=first("{elastogear} simulate drive.yaml -analysis sweep -output drive_result.h5")),
    Case("life after the torque was changed", r"torque: 50 N m there, 60 N m here", "{life}", before=reworded("gears.yaml", "torque: 50 N m", "torque: 60 N m")),
    Case("life without a body", r"gears_pinion.h5: there is no such file", "{life}", before=gone("gears_pinion.h5")),
    Case("life with bodies exchanged", r"gears_wheel.h5: is not the body 'pinion' of gears_result.h5", "{life} -pinion_file gears_wheel.h5 -wheel_file gears_pinion.h5"),
    Case("life over its result", r"would overwrite gears_result.h5; this run reads it", "{life} -output gears_result.h5"),
    Case("life over its stresses", r"would overwrite gears_stress.h5; this run reads it", OF_STRESSES + " -output gears_stress.h5"),
    Case("life over its duty cycle", r"would overwrite duty.csv; this run reads it, option -duty_cycle", FOR_DUTY + " -output duty.csv", before=duty("50,1e6\n")),
    Case("life whose table is its duty cycle", r"would overwrite new_pinion_root.csv", "{life} -duty_cycle new_pinion_root.csv -output new.h5",
         before=written("new_pinion_root.csv", "50,1e6\n")),
    Case("life to a pipe", r"'pipe.h5' is no name for a file", "{life} -output pipe.h5", before=piped("pipe.h5")),
    Case("life one of whose fields is a folder", r"'new_wheel.vtu' is no name for a file: a folder has it", "{life} -output new.h5", before=foldered("new_wheel.vtu")),
    Case("life on a full disk", NO_SPACE, "{life}", fault=full("gears_life", 4096)),
    Case("life with an option of wear", r"-coefficient belongs to wear; life does not read it", "{life} -coefficient 1e-18"),
]
