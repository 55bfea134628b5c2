"""Random drives of size tiny, and what must hold of them."""

import copy

import h5py
import numpy as np

from lab import Broken, Unfit, alike, between, choice, near

SAME = 3e-4  # share, of equilibria of different rounding: where flanks touch, by which their local approach goes, is found in iterations
EXACT = 1e-4  # share, where both runs round alike but for literals of the input and roots, which the search of the local approach amplifies
LENGTHS = ("tip_relief", "lead_crowning", "profile_crowning", "end_relief", "axial_offset", "radial_offset", "tangential_offset",
           "face_width", "bore", "run_out", "module", "centre_distance")


def gear(random, teeth):
    return {"teeth": int(teeth), "profile_shift": float(round(random.uniform(0.0, 0.3), 2))}


def cylindrical(random, orders=(1, 1, 2)):
    """A spur, helical or internal pair; numbers are in SI units, angles in degrees."""
    module = between(random, 1e-3, 6e-3, 2)
    kind = choice(random, "spur", "spur", "helical", "helical", "internal")
    pinion, wheel = gear(random, random.integers(16, 21)), gear(random, random.integers(20, 28))
    if kind == "internal":
        wheel = {"teeth": int(random.integers(44, 60)), "internal": True, "profile_shift": pinion["profile_shift"]}
    width = float(round(module * random.uniform(3, 9), 4))
    keys = {"drive": "cylindrical", "module": module, "face_width": width, "pinion": pinion, "wheel": wheel,
            "modes": int(random.integers(2, 8)), "torque": float(f"{random.uniform(0.3, 2) * 3e8 * module**2 * width:.3g}")}
    if kind == "helical":
        keys["helix_angle"] = float(round(random.uniform(8, 25) * choice(random, -1, 1), 1))
    keys["element_order"] = int(choice(random, *orders))
    keys["side"] = choice(random, "drive", "coast")
    return keys


def micro_geometry(random, keys):
    """Adds random modifications that are symmetric: of both flanks, and of both ends of a face."""
    for name in ("pinion", "wheel"):
        for key in ("tip_relief", "lead_crowning", "profile_crowning", "end_relief"):
            if random.random() < 0.2:
                keys[name][key] = float(f"{random.uniform(2e-3, 8e-3) * keys['module']:.3g}")


def misalignment(random, keys):
    """Adds random offsets, leaning axes and bearings."""
    for key, size in (("axial_offset", 0.05 * keys["face_width"]), ("tangential_offset", 0.01 * keys["module"]),
                      ("radial_offset", 0.01 * keys["module"]), ("skew", 0.02), ("inclination", 0.02)):
        if random.random() < 0.25:
            keys["wheel"][key] = float(f"{random.uniform(-1, 1) * size:.3g}")
    if random.random() < 0.3:
        keys["pinion"]["bearing_radial"] = float(f"{random.uniform(1, 10) * 1e11 * keys['module']:.3g}")
    if random.random() < 0.3:
        keys["wheel"]["face_width"] = float(f"{keys['face_width'] * random.uniform(0.8, 1.2):.4g}")


def drive(random, orders=(1, 1, 2), friction=False):
    keys = cylindrical(random, orders)
    micro_geometry(random, keys)
    misalignment(random, keys)
    if friction and random.random() < 0.4:
        keys["contact"] = {"friction": float(round(random.uniform(0.02, 0.1), 3))}
        keys.update(analysis="sweep", sweep_positions=2)
    return keys


def worm(random):
    """A worm drive: points of contact with a helical wheel, which costs least, or lines with one that is hobbed."""
    form = choice(random, "helical", "throated", "cylindrical")
    flank = "ZI" if form == "helical" else choice(random, "ZA", "ZN", "ZI", "ZK")
    return {"drive": "worm", "module": between(random, 1e-3, 4e-3, 2), "diameter_quotient": float(round(random.uniform(8, 11), 1)),
            "pressure_angle": 20.0, "element_order": 1, "worm": {"starts": int(random.integers(1, 4)), "flank": flank},
            "wheel": {"teeth": int(random.integers(28, 42)), "form": form},
            "modes": int(random.integers(2, 5)), "hand": choice(random, "right", "left"), "torque": 1.0,
            "side": choice(random, "drive", "coast")}


class Chain:
    """reduce, simulate and evaluate of one drive file with files of its own, and its figures."""

    def __init__(self, lab, name, keys, first=False, ranks=1, verbs=("reduce", "simulate", "evaluate"), strict=True):
        self.lab, self.name, self.ranks = lab, name, ranks
        self.gears = ("worm", "wheel") if keys["drive"] == "worm" else ("pinion", "wheel")
        self.pair = ":".join(self.gears)
        self.write(keys)
        for verb in dict.fromkeys(verbs):
            done = self.verb(verb)
            refuses = done.returncode == 1 and (not strict or first and verb == "reduce" or "no equilibrium found" in done.stderr)
            if refuses:  # a design that cannot be; single angles at which contact forces do not settle, a limit that docs/drives.md names
                raise Unfit(f"{verb}: {done.stderr.strip()[-200:]}")
            if done.returncode != 0:
                raise Broken(f"{verb} ends with exit code {done.returncode}: {done.stderr.strip()[-400:]}")
        if "evaluate" in verbs:
            self.read()

    def write(self, keys):
        keys = copy.deepcopy(keys)
        for body in self.gears:
            keys[body]["file"] = f"{self.name}_{body}.h5"
        self.lab.write(f"{self.name}.yaml", {"analysis": "static", "static_steps": 1, **keys})

    def verb(self, verb):
        files = {"reduce": (), "simulate": ("-output", f"{self.name}.h5"),
                 "evaluate": ("-result", f"{self.name}.h5", "-output", f"{self.name}_evaluation.h5")}[verb]
        return self.lab.call(verb, f"{self.name}.yaml", *files, ranks=self.ranks if verb == "reduce" else 1)

    def read(self):
        self.figures = self.lab.summary(f"{self.name}_evaluation.json")

    def value(self, path):
        return self.lab.read(f"{self.name}_evaluation.h5", f"cases/{self.name}/{self.pair}/{path}")

    def stresses(self):
        """Largest stress of each gear, Pa; 0 of rigid ones."""
        return np.array([self.figures.get(f"root/{body}/largest_von_mises", 0) for body in self.pair.split(":")])

    def transmission_error(self):
        return self.value("transmission_error/loaded")


def same_chains(one, other, length=1.0, force=1.0, share=SAME):
    """Lengths of the other are `length` times those of the one, forces `force` times."""
    stress = force / length**2
    alike("transmission error", other.transmission_error(), length * one.transmission_error(), share)
    alike("normal force", other.value("force/value"), force * one.value("force/value"), share)
    alike("root stress", other.stresses(), stress * one.stresses(), share)
    if "line_load/KHbeta" in one.figures:  # on parallel axes
        near("KHbeta", other.figures["line_load/KHbeta"], one.figures["line_load/KHbeta"], share)
    if "pressure/hertz_peak" in one.figures:
        alike("Hertz pressure", other.figures["pressure/hertz_peak"], stress * one.figures["pressure/hertz_peak"], share)


def mirrored(keys):
    """Seen in a mirror through the line of centres and the first axis: turns are opposite, and what leans or stands aside does so to
    the other side; hands swap."""
    keys = copy.deepcopy(keys)
    keys["side"] = {"drive": "coast", "coast": "drive"}[keys["side"]]
    keys["roll"] = -keys["roll"]
    if keys["drive"] == "worm":
        keys["hand"] = {"right": "left", "left": "right"}[keys["hand"]]
    elif "helix_angle" in keys:
        keys["helix_angle"] = -keys["helix_angle"]
    for key in ("tangential_offset", "skew"):
        if key in keys["wheel"]:
            keys["wheel"][key] = -keys["wheel"][key]
    return keys


def a_mirrored_drive_is_the_same(lab):
    """Mechanics has no hand: the mirrored drive has the same figures. Meshes of teeth are symmetric, so that only rounding differs."""
    keys = worm(lab.random) if lab.random.random() < 0.15 else drive(lab.random)
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    same_chains(Chain(lab, "one", keys, first=True), Chain(lab, "other", mirrored(keys)))


def other_units(keys):
    """The same numbers in mm, um, N mm, N/um."""
    units = {"torque": ("N mm", 1e3), "bearing_radial": ("N/um", 1e-6), **{key: ("mm", 1e3) for key in LENGTHS}}
    keys = copy.deepcopy(keys)
    for own in (keys, keys["pinion"], keys["wheel"]):
        for key, (unit, factor) in units.items():
            if key in own:
                own[key] = f"{own[key] * factor!r} {unit}"
    keys["material"] = {"E": "210 GPa", "nu": 0.3, "rho": 7850}
    return keys


def units_of_a_drive_change_nothing(lab):
    """The unit in which a number is written is no part of the drive; only the rounding of the conversion differs."""
    keys = drive(lab.random, friction=True)
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    keys["material"] = {"E": 210e9, "nu": 0.3, "rho": 7850.0}
    same_chains(Chain(lab, "one", keys, first=True), Chain(lab, "other", other_units(keys)))


def scaled(keys, by):
    keys = copy.deepcopy(keys)
    keys["torque"] *= by**3
    for own in (keys, keys["pinion"], keys["wheel"]):
        for key in LENGTHS:
            if key in own:
                own[key] *= by
        if "bearing_radial" in own:
            own["bearing_radial"] *= by
    return keys


def a_scaled_drive_is_the_same(lab):
    """A drive with all lengths s times as long, under torques s^3 times as large, has the same stresses; displacements are s times as
    large, forces s^2 times. Bearings are s times as stiff. No tolerance of the program may be a length. Powers of two scale numbers
    without rounding."""
    keys = drive(lab.random)
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    by = choice(lab.random, 0.25, 0.5, 2.0, 4.0)
    same_chains(Chain(lab, "one", keys, first=True), Chain(lab, "other", scaled(keys, by)), length=by, force=by**2, share=EXACT)


def a_stiffer_drive_is_the_same(lab):
    """Modulus, stiffness of bearings and torque c times as large: the same displacements, forces and stresses c times as large. Powers of two scale
    numbers without rounding."""
    keys = drive(lab.random)
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    by = choice(lab.random, 2.0**-6, 0.25, 2.0, 8.0)
    keys["material"] = {"E": 210e9, "nu": 0.3, "rho": 7850.0}
    other = copy.deepcopy(keys)
    other["torque"] *= by
    other["material"]["E"] *= by
    if "bearing_radial" in other["pinion"]:
        other["pinion"]["bearing_radial"] *= by
    same_chains(Chain(lab, "one", keys, first=True), Chain(lab, "other", other), force=by, share=EXACT)


def pressures(chain):
    """Pa, of the contacts of all positions, but for those that roundoff makes where nothing is loaded."""
    force, pressure = (chain.lab.read(f"{chain.name}.h5", f"contact/{chain.pair}/points/{name}") for name in ("force", "pressure"))
    size = np.linalg.norm(force, axis=1)
    return pressure[size > 1e-9 * size.max()]


def a_rigid_gear_is_the_limit_of_a_stiff_one(lab):
    """A gear without elastic coordinates does what one of a material a thousand million times as stiff as steel does, in contact and to
    the stresses of its mate, and has no stresses itself."""
    keys = worm(lab.random) if lab.random.random() < 0.3 else drive(lab.random, friction=True)
    if "sweep_positions" not in keys:
        keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    gears = ("worm" if keys["drive"] == "worm" else "pinion", "wheel")
    body = choice(lab.random, *gears)
    stiff, rigid = copy.deepcopy(keys), copy.deepcopy(keys)
    stiff[body]["material"] = {"E": 2e20, "nu": 0.3, "rho": 7850.0}
    rigid[body]["rigid"] = choice(lab.random, True, "yes", 1)
    if lab.random.random() < 0.3:
        rigid["modes"] = stiff["modes"] = 0
    one, other = Chain(lab, "one", stiff, first=True), Chain(lab, "other", rigid)
    alike("transmission error", other.transmission_error(), one.transmission_error(), SAME)
    alike("normal force", other.value("force/value"), one.value("force/value"), SAME)
    alike("line load", other.value("line_load/value"), one.value("line_load/value"), SAME)
    alike("pressure at the stations", *(pressures(chain) for chain in (other, one)), SAME)
    elastic = 1 - gears.index(body)
    alike("root stress of the elastic gear", other.stresses()[elastic], one.stresses()[elastic], SAME)
    lab.run("recover", "other.yaml", "-result", "other.h5", "-output", "stress.h5")
    with h5py.File(lab.path("stress.h5")) as file:
        if body in file or f"root/{body}/largest_tension" in other.figures:
            raise Broken(f"{body} is rigid and has stresses")


def a_drive_does_not_depend_on_load_steps(lab):
    """Without friction an equilibrium has no history: loads in one step or in several lead to the same."""
    keys = drive(lab.random)
    keys["roll"] = float(round(lab.random.uniform(-0.5, 0.5), 3))
    one = Chain(lab, "one", keys, first=True)
    same_chains(one, Chain(lab, "several", {**keys, "static_steps": int(lab.random.integers(2, 6))}))
