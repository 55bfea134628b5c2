"""The misuses of drive files by mesh and reduce: gear data, drives of several gears, worms, own meshes."""
from misuse_case import Case, encoded, first, linked, piped, reworded, written

REDUCE = "{elastogear} reduce gears.yaml"
WORM = "{elastogear} mesh worm.yaml"
OTHER = "{elastogear} mesh other.yaml"
OWN = "{design} -pinion_mesh own.msh"
MADE = r"(pinion|wheel)\.msh|gears\.svg"


def gears(old, new):
    return reworded("gears.yaml", old, new)


def worm(old, new):
    return reworded("worm.yaml", old, new)


def other(text):
    return written("other.yaml", text)


def drive_of(*names):
    """A drive file of gears of these names."""
    sections = "".join(f"'{name}': {{teeth: {17 + 6 * i}}}\n" for i, name in enumerate(names))
    return other(f"drive: cylindrical\nelement_order: 1\nmodule: 3 mm\nface_width: 9 mm\ngears: [{', '.join(names)}]\n{sections}")


def own_mesh(options=""):
    return first("{design} -pinion_mesh_output own.msh -wheel_mesh_output own_wheel.msh -drawing own.svg" + options)


DATA = [
    Case("drive of a kind that is none", r"'bevel': must be one of cylindrical, worm", "{design}", before=gears("cylindrical", "bevel")),
    Case("drive without teeth", r"option -wheel_teeth is missing: number of teeth, as in", "{design}", before=gears("{teeth: 23, ", "{")),
    Case("drive of half a tooth", r"wheel_teeth = '23.5': must be a whole number", "{design} -wheel_teeth 23.5"),
    Case("drive of a billion teeth", r"teeth = 1000000000: must be 5 to 1000", "{design} -wheel_teeth 1000000000"),
    Case("drive of two modules", r"give one of them", "{design} -transverse_module 3\\ mm"),
    Case("face in mm without its unit", r"face_width", "{design} -face_width 9"),
    Case("bore beyond the root", r"bore = 60 mm: must be positive and at most 39.3 mm", "{design} -pinion_bore 60\\ mm"),
    Case("rim within the bore", r"rim_diameter = 10 mm: must be between the bore, 24.84 mm, and", "{design} -wheel_rim_diameter 10\\ mm"),
    Case("hub beyond the rim", r"hub_diameter 80.*must increase in this order", "{design} -wheel_hub_diameter 80\\ mm"),
    Case("web without a hub", r"web_diameter.*hub_diameter", "{design} -wheel_web_diameter 40\\ mm"),
    Case("web wider than the face", r"web_width = 20 mm: must be positive, at most hub_width", "{design} -wheel_hub_diameter 35\\ mm -wheel_web_diameter 45\\ mm -wheel_web_width 20\\ mm"),
    Case("outside of an external gear", r"only internal gears have one", "{design} -wheel_outer_diameter 100\\ mm"),
    Case("helix of a right angle", r"helix_angle = 90 deg: must be at most 45 deg", "{design} -helix_angle 90"),
    Case("pressure angle in rad as deg", r"contact ratio is .*at least 1 is needed", "{design} -pressure_angle 0.349"),
    Case("rack that is none", r"no basic rack 'E'; those of ISO 53 are A, B, C, D", "{design} -rack E"),
    Case("dedendum below the addendum", r"rack_dedendum = 0.5.*the dedendum above the addendum", "{design} -rack_dedendum 0.5"),
    Case("protuberance beyond the space", r"rack_protuberance = 2: must be 0 to 0.2 modules", "{design} -rack_protuberance 2"),
    Case("profile shift in mm", r"pinion_profile_shift = '0.9 mm': must be a finite number", "{design} -pinion_profile_shift 0.9\\ mm"),
    Case("profile shift beyond reason", r"profile_shift = 5: must be between -2 and 2 .modules.", "{design} -pinion_profile_shift 5"),
    Case("tip below the root", r"tip diameter 60 mm: must be above those of root and base", "{design} -wheel_tip_diameter 60\\ mm"),
    Case("tip in mm without its unit", r"tip diameter 76000 mm; tip_diameter of at most 78.29571536 mm would do", "{design} -wheel_tip_diameter 76"),
    Case("centre distance of no gears", r"centre_distance = 50 mm: must be above the sum of the base radii", "{design} -centre_distance 50\\ mm"),
    Case("centre distance out of touch", r"contact ratio is .*a smaller centre distance", "{design} -centre_distance 70\\ mm"),
    Case("backlash below 0", r"backlash = -0.0001 m: must be at least 0", "{design} -backlash -0.1\\ mm"),
    Case("backlash of 0.75 modules", r"", "{elastogear} simulate drive.yaml -analysis sweep -backlash 2.25\\ mm -output kept_run.h5", kind="good", leaves=r"kept_run\.h5",
         before=first("{elastogear} reduce drive.yaml -backlash 2.25\\ mm")),
    Case("backlash of a module", r"", "{elastogear} simulate drive.yaml -analysis sweep -pinion_teeth 23 -backlash 3\\ mm -output kept_run.h5", kind="good", leaves=r"kept_run\.h5",
         before=first("{elastogear} reduce drive.yaml -pinion_teeth 23 -backlash 3\\ mm")),
    Case("backlash of 1.25 modules", r"pinion: the teeth are pointed.*backlash", "{elastogear} mesh drive.yaml -backlash 3.75\\ mm"),
    Case("backlash of 1.5 modules", r"pinion: the teeth are pointed", "{elastogear} mesh drive.yaml -backlash 4.5\\ mm"),
    Case("helix in the section of a gear", r"helix_angle.*(all gears|drive)", "{design}", before=gears("pinion: {", "pinion: {helix_angle: 20 deg, ")),
    Case("module in the section of a gear", r"module.*(all gears|drive)", "{design}", before=gears("pinion: {", "pinion: {module: 5 mm, ")),
    Case("pressure angle in the section of a gear", r"pressure_angle.*(all gears|drive)", "{design}", before=gears("wheel: {", "wheel: {pressure_angle: 25 deg, ")),
    Case("side in the section of a gear", r"pinion_side .*: all gears of a drive have one side", "{design}", before=gears("pinion: {", "pinion: {side: coast, ")),
    Case("output in the section of a gear", r"pinion_output .*: is for a single body", REDUCE, before=gears("pinion: {", "pinion: {output: other.h5, ")),
    Case("size in the section of a gear", r"pinion_size .*: all gears of a drive have one size", "{design}", before=gears("pinion: {", "pinion: {size: small, ")),
    Case("order of elements in the section of a gear", r"all gears of a drive have one element_order", "{design} -wheel_element_order 2"),
]

GEARS = [
    Case("drive of a gear alone", r"gears.*two", "{elastogear} simulate other.yaml -analysis sweep -torque 50 -modes 0 -output kept_run.h5",
         before=lambda bench: (drive_of("pinion")(bench), bench.good("{elastogear} reduce other.yaml -modes 0 -pinion_file pinion.h5"))),
    Case("drive of a gear twice", r"(twice|unknown option -wheel_teeth)", "{design}", before=gears("module:", "gears: [pinion, pinion]\nmodule:")),
    Case("drive of a gear with a blank in its name", r"'big wheel' is no key: it must be one word", OTHER, before=drive_of("pinion", "big wheel")),
    Case("drive of a gear with a path for a name", r"'\.\./up' is no key: it must be one word", OTHER, before=drive_of("pinion", "../up")),
    Case("drive of a gear with the name of a section", r"gears.*'contact'", OTHER, before=drive_of("pinion", "contact")),
    Case("section of a gear that is not listed", r"unknown option -idler_teeth", "{design}", before=gears("modes: 0", "modes: 0\nidler: {teeth: 30}")),
    Case("direction of the first gear", r"pinion_direction", "{design} -pinion_direction 30"),
    Case("mate of itself", r"wheel_mate = 'wheel': must be a gear named before", "{design} -wheel_mate wheel"),
    Case("mate that comes later", r"planet_1_mate = 'ring': must be a gear named before", "{planets} -planet_1_mate ring"),
    Case("mate that is not there", r"ring_mate = 'idler': must be a gear named before", "{planets} -ring_mate sun,idler"),
    Case("planets inside each other", r"planet_1 and planet_2: are not in mesh, and overlap", "{planets} -planet_2_direction 15"),
    Case("planets out of step", r"direction", "{planets} -planet_2_direction 121"),
    Case("ring smaller than its planets", r"pair planet_1:ring: .*the teeth overlap", "{planets} -ring_teeth 30"),
    Case("ring whose planets do not fit", r"pair planet_1:ring: the contact ratio is", "{planets} -ring_teeth 75"),
    Case("ring without internal teeth", r"pair planet_2:ring: its flanks miss each other", "{planets} -ring_internal false"),
    Case("two gears with internal teeth", r"both gears are internal; one must be external", "{design} -pinion_internal true -wheel_internal true"),
    Case("ring of as many teeth as its pinion", r"an internal gear of 17 teeth has no room for 17", "{design} -wheel_internal true -wheel_teeth 17"),
    Case("ring whose outside is within its teeth", r"outer_diameter = 100 mm: must be at least 228.9 mm", "{design} -wheel_internal true -wheel_teeth 72 -wheel_outer_diameter 100\\ mm"),
    Case("cutter larger than its ring", r"cutter_teeth = 90: must be 5 to 71", "{design} -wheel_internal true -wheel_teeth 72 -wheel_cutter_teeth 90"),
    Case("cutter of an external gear", r"is external, which no cutter_teeth", "{design} -wheel_cutter_teeth 25"),
    Case("starts of no worm", r"worm_starts: has no meaning in drive: cylindrical", "{design} -worm_starts 2"),
]

WORMS = [
    Case("worm without a wheel", r"option -wheel_teeth is missing", WORM, before=worm("wheel: {teeth: 41}\n", "")),
    Case("worm of half a start", r"worm_starts = '1.5': must be a whole number", WORM + " -worm_starts 1.5"),
    Case("worm of many starts", r"worm_starts = 30: must be 1 to 6", WORM + " -worm_starts 30"),
    Case("worm with an idler", r"gears.*idler", WORM, before=worm("module:", "gears: [worm, wheel, idler]\nmodule:"), leaves=r".*\.(msh|svg)"),
    Case("worm with the helix of a cylindrical gear", r"helix_angle: has no meaning in drive: worm", WORM + " -helix_angle 10"),
    Case("worm with a mesh of one's own", r"wheel_mesh: has no meaning in drive: worm", WORM + " -wheel_mesh brick.inp"),
    Case("worm with a hob smaller than itself", r"hob_oversize = -0.005 m: must be finite and at least 0", WORM + " -worm_flank ZA -hob_oversize -5\\ mm"),
    Case("worm whose quotient and distance exclude each other", r"profile shift is -5.*it must be between -1 and 1", WORM + " -diameter_quotient 20"),
    Case("worm with a wheel of a form that is none", r"'hobbed': must be one of helical, cylindrical, throated", WORM + " -wheel_form hobbed"),
    Case("worm whose hand is that of the worm alone", r"hand.*(all gears|drive)", WORM, before=worm("starts: 2", "starts: 2, hand: left")),
]

OWN_MESHES = [
    Case("own mesh that is missing", r"nosuch.inp: there is no such file", "{design} -pinion_mesh nosuch.inp"),
    Case("own mesh that is a folder", r"folder: unknown mesh format", "{design} -pinion_mesh folder"),
    Case("own mesh that is a body", r"gears_pinion.h5: unknown mesh format '.h5'", "{design} -pinion_mesh gears_pinion.h5"),
    Case("own mesh that is a pipe", r"pipe.inp: is not a regular file", "{design} -pinion_mesh pipe.inp", before=piped("pipe.inp")),
    Case("own mesh that is an endless device", r"zero.inp: is not a regular file", "{design} -pinion_mesh zero.inp", before=linked("/dev/zero", "zero.inp")),
    Case("own mesh of a bar", r"the teeth of the mesh are 10 mm wide.*those of the data 9 mm: give the gear's face_width", "{design} -pinion_mesh brick.inp"),
    Case("own mesh in another unit", r"no face of the mesh is on a flank.*pinion: \{unit: mm\} is for a file in mm", OWN + " -pinion_unit mm", before=own_mesh()),
    Case("own mesh of another profile shift", r"node \d+ of the mesh.*inside the left flank of tooth .*or mesh it anew", OWN, before=own_mesh(" -pinion_profile_shift 0.2")),
    Case("own mesh that would be overwritten", r"pinion_mesh_output: would overwrite own.msh; this run reads it", OWN + " -pinion_mesh_output own.msh", before=own_mesh()),
    Case("own mesh held at a set that is not there", r"no node set and no face set 'NOSUCH'; its node sets: bore, root", REDUCE + " -pinion_mesh own.msh -pinion_restrain NOSUCH", before=own_mesh()),
]

FILES = [
    Case("material of a gear in part", r"option -(pinion_)?material_nu is missing", REDUCE + " -pinion_material_E 3e9"),
    Case("material by its name", r"unknown option -material .gears.yaml, line 10. = 'steel'", REDUCE, before=gears("modes: 0", "modes: 0\nmaterial: steel")),
    Case("material of a rim that is not there", r"no cell set 'crown'; it has: body, rim", REDUCE + " -pinion_material_crown_E 3e9 -pinion_material_crown_nu 0.3 -pinion_material_crown_rho 1e3"),
    Case("body of a gear to a folder", r"'folder' is no name for a file", REDUCE + " -pinion_file folder"),
    Case("body of a gear over the drive file", r"pinion_file: would overwrite gears.yaml", REDUCE + " -pinion_file gears.yaml"),
    Case("bodies of two gears in one file", r"one.h5.*(both|two|pinion.*wheel)", REDUCE + " -pinion_file one.h5 -wheel_file one.h5"),
    Case("bodies of two gears in one file by two paths", r"one.h5.*(both|two|pinion.*wheel)", REDUCE + " -pinion_file one.h5 -wheel_file folder/../one.h5"),
    Case("meshes of two gears in one file", r"one.msh.*(both|two|pinion.*wheel)", "{design} -pinion_mesh_output one.msh -wheel_mesh_output one.msh"),
    Case("mesh of a gear over the drawing", r"drawing: 'pinion.msh' is the file of option -pinion_mesh_output, too", "{design} -drawing pinion.msh"),
    Case("drawing over the drive file", r"drawing: would overwrite gears.yaml", "{design} -drawing gears.yaml"),
    Case("mesh of a gear that is a pipe", r"'pipe.msh' is no name for a file", "{design} -wheel_mesh_output pipe.msh", before=piped("pipe.msh")),
    Case("drive file with a byte order mark", r"", "{design}", kind="good", leaves=MADE, before=gears("drive:", "\ufeffdrive:")),
    Case("drive file with DOS line ends", r"", "{design}", kind="good", leaves=MADE, before=gears("\n", "\r\n")),
    Case("drive file as a list", r"other.yaml, line 1: must be keys and values", OTHER, before=other("- drive: cylindrical\n- module: 3 mm\n")),
    Case("drive file with decimal commas", r"pinion_profile_shift .gears.yaml, line 5. = '0,3': must be a finite number", "{design}", before=gears("shift: 0.3", "shift: '0,3'")),
    Case("drive file with equals signs", r"gears.yaml, line 4: is no valid YAML", "{design}", before=gears("module: 3 mm", "module = 3 mm")),
    Case("drive file with a number and a section of a gear", r"gears.yaml, line 6: the key pinion is given twice", "{design}", before=gears("pinion: {", "pinion: 17\npinion: {")),
    Case("drive file with a name that nothing has", r"other.yaml, line 2: is no valid YAML", OTHER, before=other("drive: cylindrical\nmodule: *three\n")),
    Case("drive file in Latin-1", r"other.yaml, line 1: is no valid YAML", OTHER, before=encoded("other.yaml", "# Getriebe für Prüfstand\ndrive: cylindrical\n", "latin-1")),
    Case("two drive files of unlike gears", r"unknown option -pinion_", "{elastogear} mesh gears.yaml planets.yaml"),
]

DESIGN = DATA + GEARS + WORMS + OWN_MESHES + FILES
