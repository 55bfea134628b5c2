"""The misuses of sweeps of drives, of their variants, bearings and modified flanks."""
from misuse_case import Case, encoded, flipped, linked, piped, reworded, written

SWEEP_ONCE = "{gears_sweep} -sweep_positions 1 -output kept_run.h5"
IN_VARIANTS = SWEEP_ONCE + " -variants v.csv"
ON_BEARINGS = SWEEP_ONCE + " -left_at -20\\ mm -right_at 20\\ mm -left_radial 1e8 -right_radial 1e8 -left_axial 1e8"
IN_CATALOGUE = SWEEP_ONCE + " -pinion_bearings left,right -left_at -20\\ mm -right_at 20\\ mm -right_radial 1e8 -left_catalogue 6206 -bearing_catalogue stock.csv"
ON_TABLE = SWEEP_ONCE + " -pinion_topography flank.csv"
CASES = r"kept_run(/.*|\.h5)?"


def variants(text, encoding="utf-8"):
    return encoded("v.csv", text, encoding)


def stock(text):
    return written("stock.csv", text)


def flank(text):
    return written("flank.csv", text)


LOADS = [
    Case("sweep over half a position", r"sweep_positions = '2.5': must be a whole number", SWEEP_ONCE + " -sweep_positions 2.5"),
    Case("sweep over more positions than memory", r"sweep_positions = 2000000000: must be at most 10000000", SWEEP_ONCE + " -sweep_positions 2000000000"),
    Case("sweep over infinite pitches", r"sweep_pitches = 'inf': must be a number of pitches", SWEEP_ONCE + " -sweep_pitches inf"),
    Case("sweep from an angle in degrees", r"roll = '5 deg': must be a finite number", SWEEP_ONCE + " -roll 5\\ deg"),
    Case("sweep under a negative torque", r"torque.*-50.*side", SWEEP_ONCE + " -torque -50"),
    Case("sweep under negative torques among others", r"torque.*-50.*side", SWEEP_ONCE + " -torques 50,-50"),
    Case("sweep under no torque among others", r"torque", SWEEP_ONCE + " -torques 50,0"),
    Case("sweep under a torque in kN", r"'kN' is no unit of it, write N mm, N m", SWEEP_ONCE + " -torque 50\\ kN"),
    Case("sweep of a pair under its own load beside the torque", r"pinion_torque", SWEEP_ONCE + " -pinion_torque 20"),
    Case("sweep with an option of wear", r"-coefficient belongs to wear; simulate does not read it", SWEEP_ONCE + " -coefficient 1e-18"),
    Case("sweep with an accuracy", r"accuracy", SWEEP_ONCE + " -accuracy 5"),
    Case("sweep with an initial state", r"initial_file: a sweep begins with the gears in touch", SWEEP_ONCE + " -initial_file turning.h5"),
    Case("sweep of one body of two", r"there is no body 'wheel'", SWEEP_ONCE + " -bodies pinion"),
    Case("sweep of a gear that floats", r"body 'pinion': a free joint has no axis to turn about", SWEEP_ONCE + " -pinion_joint free"),
    Case("sweep of gears far apart", r"nothing holds .* body 'pinion': the rotation about its axis", SWEEP_ONCE + " -pinion_position 0,0,1", leaves=r"kept_run\.h5"),
]

BODIES = [
    Case("sweep of bodies exchanged", r"body 'pinion': node \d+, in tooth_23_right, is .* off the flank", SWEEP_ONCE + " -pinion_file gears_wheel.h5 -wheel_file gears_pinion.h5"),
    Case("sweep of a bar", r"body 'pinion': no faces of sets tooth_<ii>_left", SWEEP_ONCE + " -pinion_file body.h5"),
    Case("sweep of bodies of another drive", r"drive_pinion.h5: is not the body of pinion in this drive: face_width: 0.025 m there, 0.009 m here",
         SWEEP_ONCE + " -pinion_file drive_pinion.h5 -wheel_file drive_wheel.h5"),
    Case("sweep of a mesh", r"pinion.msh: is no HDF5 file", SWEEP_ONCE + " -pinion_file pinion.msh"),
    Case("sweep after the width was changed", r"face_width: 0.009 m there, 0.01 m here", SWEEP_ONCE, before=reworded("gears.yaml", "width: 9 mm", "width: 10 mm")),
    Case("sweep after the backlash was changed", r"backlash: not given there, 0.0002 m here", SWEEP_ONCE, before=reworded("gears.yaml", "modes: 0", "modes: 0\nbacklash: 0.2 mm")),
    Case("sweep after the modes were changed", r"modes: 0 there, 2 here", SWEEP_ONCE, before=reworded("gears.yaml", "modes: 0", "modes: 2")),
    Case("sweep of flipped flanks", r"gears_pinion.h5: damaged: checksum of /surface/X", SWEEP_ONCE, before=flipped("gears_pinion.h5", "surface/X")),
    Case("motion of gears without modes", r"body 'pinion' has no modes, only static responses", "{elastogear} simulate gears.yaml -analysis dynamic -ts_max_time 1e-6 -output kept_run.h5"),
]

VARIANTS = [
    Case("variants with a byte order mark", r"", IN_VARIANTS, kind="good", leaves=CASES, before=variants("\ufeffvariant,wheel_skew\na,0.01\n")),
    Case("variants with DOS line ends", r"", IN_VARIANTS, kind="good", leaves=CASES, before=variants("variant,wheel_skew\r\na,0.01\r\n")),
    Case("variants with semicolons", r"v.csv, line 1: 'variant;wheel_skew' is no key", IN_VARIANTS, before=variants("variant;wheel_skew\na;0.01\n")),
    Case("variants of one name", r"v.csv: the variant 'a' is there twice", IN_VARIANTS, before=variants("variant,wheel_skew\na,0.01\na,0.02\n")),
    Case("variants with a key twice", r"v.csv, line 1: .*wheel_skew.*twice", IN_VARIANTS, before=variants("wheel_skew,wheel_skew\n0.01,0.02\n")),
    Case("variants with a value that is not finite", r"variant '0001': option -wheel_skew = 'nan'", IN_VARIANTS, before=variants("wheel_skew\nnan\n")),
    Case("variants with a field too many", r"v.csv, line 2: has 2 fields, the line of keys has 1", IN_VARIANTS, before=variants("wheel_skew\n0.01,5\n")),
    Case("variants of a gear that is not there", r"v.csv, line 1: 'ring_skew' is no key", IN_VARIANTS, before=variants("ring_skew\n0.01\n")),
    Case("variants in a pipe", r"pipe.csv: is not a regular file", SWEEP_ONCE + " -variants pipe.csv", before=piped("pipe.csv")),
    Case("variants in an endless device", r"zero.csv: is not a regular file", SWEEP_ONCE + " -variants zero.csv", before=linked("/dev/zero", "zero.csv")),
    Case("cases to the name of a file", r"mine: the folder of the cases cannot be made", "{gears_sweep} -torques 50,60 -output mine.h5", before=written("mine", "notes")),
]

BEARINGS = [
    Case("bearing without a catalogue", r"left_catalogue: needs bearing_catalogue, too", SWEEP_ONCE + " -pinion_bearings left -left_at 0 -left_catalogue 6206"),
    Case("bearing of a catalogue that lacks it", r"stock.csv: has no line of bearing '6206'", IN_CATALOGUE, before=stock("6205,1e8,1e8,1e3\n")),
    Case("bearing of a catalogue with a word", r"stock.csv, line 1: 'stiff' must be a finite number", IN_CATALOGUE, before=stock("6206,stiff,1e8,1e3\n")),
    Case("bearing of a catalogue with a column too few", r"stock.csv, line 1: must be a designation, radial and axial stiffness", IN_CATALOGUE, before=stock("6206,1e8,1e8\n")),
    Case("bearing of a catalogue below 0", r"bearing left: .*-100000000 N/m axial.*at least 0", IN_CATALOGUE, before=stock("6206,1e8,-1e8,1e3\n")),
    Case("bearing twice in a catalogue", r"stock.csv, line 2: .*6206.*twice", IN_CATALOGUE, before=stock("6206,1e8,1e8,1e3\n6206,1e9,1e8,1e3\n")),
    Case("bearings without anything", r"bearings of pinion: radial stiffness is missing of left, right; .*catalogue.*along its axis.*from tilting.*bearings of wheel: radial stiffness is missing of far",
         SWEEP_ONCE + " -pinion_bearings left,right -wheel_bearings far"),
    Case("bearing of a radial stiffness below 0", r"bearing left: stiffness -100000000 N/m radial.*must be positive", SWEEP_ONCE + " -pinion_bearings left -left_radial -1e8"),
    Case("variants of named bearings", r"", ON_BEARINGS + " -pinion_bearings left,right -variants soft,hard -variant_soft_left_radial 5e7 -variant_hard_right_at 25\\ mm", kind="good", leaves=CASES),
    Case("variants of a bearing that no gear has", r"'far_radial' is no key that a variant may have", ON_BEARINGS + " -pinion_bearings left,right -variants soft -variant_soft_far_radial 5e7"),
    Case("bearings that let the gear move along its axis", r"none of them holds the gear along its axis; give one an axial stiffness",
         SWEEP_ONCE + " -pinion_bearings left -left_at 0 -left_radial 1e8"),
    Case("bearing that lets the gear tilt", r"they do not keep the gear from tilting; give them different places", SWEEP_ONCE + " -pinion_bearings left -left_at 0 -left_radial 1e8 -left_axial 1e8"),
    Case("bearing twice", r"(tilting|twice)", ON_BEARINGS + " -pinion_bearings left,left"),
    Case("bearings of both gears", r"two bushings are named 'left'", ON_BEARINGS + " -pinion_bearings left,right -wheel_bearings left,right"),
    Case("bearing named as a gear", r"the name 'wheel' is taken", ON_BEARINGS + " -pinion_bearings left,wheel -wheel_at 20\\ mm -wheel_radial 1e8"),
    Case("bearing for all and apart", r"pinion_bearing_radial: the gear has pinion_bearings, too; give one of the two", ON_BEARINGS + " -pinion_bearings left,right -pinion_bearing_radial 1e8"),
    Case("bearing that no gear has", r"unknown option -left_at", SWEEP_ONCE + " -left_at 0 -left_radial 1e8"),
    Case("bearing in N", r"'N' is no unit of it, write N/m", SWEEP_ONCE + " -pinion_bearing_radial 200\\ N"),
    Case("bearing at a place in mm without its unit", r"left_at.*-20", ON_BEARINGS + " -pinion_bearings left,right -left_at -20 -right_at 20"),
]

FLANKS = [
    Case("relief in deg", r"'deg' is no unit of it, write nm", SWEEP_ONCE + " -pinion_tip_relief 1\\ deg"),
    Case("relief in um without its unit", r"tip_relief = 20000000 um: must be at most 300 um, a tenth of a module; is its unit right", SWEEP_ONCE + " -pinion_tip_relief 20"),
    Case("relief of another form", r"'round': must be one of linear, parabolic", SWEEP_ONCE + " -pinion_tip_relief 20\\ um -pinion_tip_relief_form round"),
    Case("length of a relief that is not there", r"tip_relief_length", SWEEP_ONCE + " -pinion_tip_relief_length 2\\ mm"),
    Case("length of a relief that variants give", r"", SWEEP_ONCE + " -pinion_tip_relief_length 2\\ mm -variants a,b -variant_a_pinion_tip_relief 1e-5 -variant_b_pinion_tip_relief 2e-5",
         kind="good", leaves=CASES),
    Case("relief of a bar", r"unknown option -a_tip_relief", "{single} -a_tip_relief 1e-5"),
    Case("deviation of a tooth twice", r"pitch_deviation: tooth 3 .*twice", SWEEP_ONCE + " -pinion_pitch_deviation 3,10e-6,3,20e-6"),
    Case("deviation of half a tooth", r"tooth 1.5 is not there, teeth are 1 to 17", SWEEP_ONCE + " -pinion_pitch_deviation 1.5,10e-6"),
    Case("run-out below 0", r"run_out.*-2e-05", SWEEP_ONCE + " -pinion_run_out -20\\ um"),
    Case("skew in mm", r"'mm' is no unit of it, write deg, rad", SWEEP_ONCE + " -wheel_skew 0.02\\ mm"),
    Case("offset beyond the teeth", r"radial_offset = 0.01 m: must be at most 0.00378 m to either side", SWEEP_ONCE + " -wheel_radial_offset 10\\ mm"),
    Case("offset along the axis beyond the face", r"axial_offset = 0.05 m: must be at most 0.009 m", SWEEP_ONCE + " -wheel_axial_offset 50\\ mm"),
    Case("topography of one point", r"flank.csv: a flank has 1 points .*must form a grid", ON_TABLE, before=flank("0.052,0,1e-6\n")),
    Case("topography with a point twice", r"flank.csv, line 2: this point of the flank is given twice", ON_TABLE, before=flank("0.052,0,1e-6\n0.052,0,2e-6\n")),
    Case("topography that is not finite", r"flank.csv, line 1: 'nan' must be a finite number", ON_TABLE, before=flank("0.050,-1e-3,nan\n0.054,-1e-3,1e-6\n0.050,1e-3,0\n0.054,1e-3,0\n")),
    Case("topography in mm", r"flank.csv, line 1: diameter 50 m is not on the flank", ON_TABLE, before=flank("50,-1,0.001\n54,-1,0.001\n50,1,0\n54,1,0\n")),
    Case("topography of heights in um", r"height of the topography = 1000000 um: must be at most 300 um", ON_TABLE, before=flank("0.050,-1e-3,1\n0.054,-1e-3,1\n0.050,1e-3,1\n0.054,1e-3,1\n")),
    Case("worn flank of the other gear", r"gears_wear_wheel.csv, line 2: diameter .* is not on the flank", SWEEP_ONCE + " -pinion_wear gears_wear_wheel.csv"),
    Case("worn flank in a table of something else", r"curve.csv, line 2: must be diameter, z and height", SWEEP_ONCE + " -pinion_wear curve.csv"),
    Case("worn flank in a wear file", r"gears_wear.h5, line 1: must be diameter, z and height", SWEEP_ONCE + " -pinion_wear gears_wear.h5"),
]

SWEEPS = LOADS + BODIES + VARIANTS + BEARINGS + FLANKS
