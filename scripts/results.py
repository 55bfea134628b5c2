"""Reads what the plots and the summary need from elastogear's result, stress and body files (docs/file_format.md)."""
import sys

import h5py
import numpy as np

ROLLS = 0.9  # of the turns asked for: drives that roll keep their speed within some percent
COMPONENTS = ("xx", "yy", "zz", "xy", "yz", "xz")


def open_file(path, kind):
    """Opens an HDF5 file whose root attribute `format` is "elastogear <kind>"; exits with a message otherwise."""
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        sys.exit(f"{path}: cannot be read as HDF5: {error}")
    found = text(file.attrs.get("format", "nothing"))
    if found != f"elastogear {kind}":
        sys.exit(f"{path}: holds {found}, expected an elastogear {kind} file")
    return file


def text(value):
    return value.decode() if isinstance(value, bytes) else str(value)


def require_body_of_run(result, body, path):
    """Exits with a message when the body file does not hold what the run was made with; older files do not say."""
    with open_file(path, "body") as file:
        held = file.attrs.get("identity")
    known = result["provenance"].attrs.get("identity_" + body) if "provenance" in result else None
    if held is not None and known is not None and text(held) != text(known):
        sys.exit(f"{path}: is not the body '{body}' of {result.filename}")


def key_values(items, option):
    """["worm=a", "wheel=b"] -> {"worm": "a", "wheel": "b"}."""
    for item in items:
        if "=" not in item:
            sys.exit(f"{option} {item}: expected <body>=<value>")
    return dict(item.split("=", 1) for item in items)


def group_forces(pair, side="b"):
    """Magnitude of the contact force over time (N) for each face group of one surface: {name: n_t}."""
    group = pair[f"groups/{side}"]
    magnitude = np.linalg.norm(group["force"][:], axis=2)
    return {text(name): magnitude[:, i] for i, name in enumerate(group["name"][:])}


def total_force(pair):
    """Magnitude of a pair's resulting contact force over time, N."""
    return np.linalg.norm(pair["force"][:], axis=1)


def nodal_forces(file, body, step):
    """Contact forces on a body at one output time: its surface nodes (numbers into /surface/nodes of the body file), and the
    forces (n x 3, N, world frame)."""
    state = file[f"bodies/{body}"]
    if "contact_forces" not in state:
        sys.exit(f"{file.filename}: holds no contact forces at nodes, as results of older versions: run simulate again")
    forces, offset = state["contact_forces"], state["contact_forces/offset"][:]
    start = range(len(offset) - 1)[step]
    rows = slice(offset[start], offset[start + 1])
    return forces["node"][rows], forces["force"][rows] @ state["rotation"][step].T


def torque_on_worm(file):
    """Moment of the contact forces about the worm's axis at all times, N m; the pair's force and moment are those on the wheel."""
    pair, worm = next(iter(file["contact"].values())), file["bodies/worm"]
    axis = worm["rotation"][0] @ np.array([0.0, 0.0, 1.0])
    return (np.cross(worm["position"][:], pair["force"][:]) - pair["torque"][:]) @ axis


def standstill(file, body="worm"):
    """Why a run of rolling contact is none: a body that its initial speed would turn at least once made fewer turns than that; or nothing."""
    state, time = file[f"bodies/{body}"], file["time"][:]
    asked = abs(state["rigid_velocity"][0, 0]) * (time[-1] - time[0]) / (2 * np.pi)
    if asked < 1:
        return ""
    made = np.abs(state["rigid"][:, 0] - state["rigid"][0, 0]) / (2 * np.pi)
    if made[-1] >= ROLLS * asked:
        return ""
    return (f"the {body} does not roll: it made {made[-1]:.2f} of the {asked:.2f} turns that its initial speed asks for, at most {made.max():.2f} "
            "at one time. A mesh that is too coarse slows the free motion or stops it: use size small or a finer one")


ANGLES = {"revolute": (0,), "cylindrical": (0,), "spherical": (0, 1, 2), "free": (3, 4, 5)}  # coordinates of joints in rad


def speed_unit(body, i=0):
    """Unit of the velocity of joint coordinate i of a result file's body group."""
    return "rad/s" if i in ANGLES.get(text(body.attrs.get("joint", "revolute")), ()) else "m/s"


class NodeStress:
    """Stress history of one node of one body, Pa: tensor (n_t x 6, order COMPONENTS), von_mises, rankine, error (estimated, of
    von_mises, by the reduction; None: not estimated)."""

    def __init__(self, group, body, set_name, row):
        self.body, self.set, self.node = body, set_name, int(group["nodes"][row])
        self.tensor = group["stress"][:, row, :]
        self.von_mises = group["von_mises"][:, row]
        self.rankine = group["rankine"][:, row]
        self.error = group["error"][:, row] if "error" in group else None


TRUSTED = 0.05  # of the peak: above this estimated error a stress is not to be trusted
WELL_TRUSTED = 0.02  # of the peak: up to this one needs no second look
TRUSTED_MESH, WELL_TRUSTED_MESH = 0.1, 0.05  # the same of the mesh's error, which is a bound of it in most places


class Peak:
    """Largest von Mises stress of an evaluated node set: value (Pa), step, row of the node, and the estimated errors of the
    reduction, of the mesh, of the contact's resolution, of the steps in time (docs/theory, sections 4.3, 1.7, 4.6 and 4.7) and
    of all together (Pa; None: not estimated)."""

    what = "largest von Mises stress"

    def __init__(self, group, steps=slice(None)):
        von_mises = group["von_mises"][steps]
        step, self.row = np.unravel_index(von_mises.argmax(), von_mises.shape)
        self.value = float(von_mises[step, self.row])
        self.step = int(np.arange(group["von_mises"].shape[0])[steps][step])
        self.error = float(group["peak_error"][self.step]) if "peak_error" in group else None
        self.mesh_error = float(group["mesh_error"][self.step, self.row]) if "mesh_error" in group else None
        self.contact_error = float(group["contact_error"][self.step, self.row]) if "contact_error" in group else None
        self.time_error = float(group["time_error"][self.step, self.row]) if "time_error" in group else None
        known = self.error is not None and self.mesh_error is not None
        self.whole_error = self.error + self.mesh_error + (self.contact_error or 0) + (self.time_error or 0) if known else None

    def trust_mesh(self):
        """The estimated error of the mesh in words."""
        if self.mesh_error is None:
            return "error of the mesh not estimated"
        doubt = ": too coarse a mesh for this stress" if self.mesh_error > TRUSTED_MESH * self.value else ""
        return f"estimated error of the mesh {self.mesh_error / 1e6:.3g} MPa ({100 * self.mesh_error / max(self.value, 1e-300):.2g} %){doubt}"

    def trust_contact(self):
        """The estimated error of the contact's resolution in words."""
        if self.contact_error is None:
            return "error of the contact's resolution not estimated"
        doubt = ": the stress beside a contact" if self.contact_error > TRUSTED_MESH * self.value else ""
        share = 100 * self.contact_error / max(self.value, 1e-300)
        return f"estimated error of the contact's resolution {self.contact_error / 1e6:.3g} MPa ({share:.2g} %){doubt}"

    def trust_steps(self):
        """The estimated error of the steps in time in words."""
        if self.time_error is None:
            return "error of the steps in time not estimated"
        doubt = ": too long steps for this stress" if self.time_error > TRUSTED_MESH * self.value else ""
        return f"estimated error of the steps in time {self.time_error / 1e6:.3g} MPa ({100 * self.time_error / max(self.value, 1e-300):.2g} %){doubt}"

    def trust(self):
        """The estimated error of the reduction in words."""
        if self.error is None:
            return "error not estimated: not to be trusted"
        doubt = ": not to be trusted" if self.error > TRUSTED * self.value else ""
        return f"estimated error of the reduction {self.error / 1e6:.3g} MPa ({100 * self.error / max(self.value, 1e-300):.2g} %){doubt}"


def stress_sets(file):
    """Yields (body, set, group) for every evaluated node set of a stress file."""
    for body in file:
        if isinstance(file[body], h5py.Group):
            for name, group in file[body].items():
                if isinstance(group, h5py.Group) and "stress" in group:
                    yield body, name, group


def most_stressed_nodes(file):
    """For each body the node with the largest von Mises peak: {body: NodeStress}."""
    best = {}
    for body, name, group in stress_sets(file):
        peaks = group["von_mises"][:].max(axis=0)
        row = int(peaks.argmax())
        if body not in best or peaks[row] > best[body][0]:
            best[body] = (peaks[row], NodeStress(group, body, name, row))
    return {body: entry[1] for body, entry in best.items()}


def chosen_node(file, body, node):
    """NodeStress of mesh node number `node`; exits with a message when it was not evaluated."""
    for owner, name, group in stress_sets(file):
        rows = np.flatnonzero(group["nodes"][:] == node)
        if owner == body and rows.size:
            return NodeStress(group, body, name, int(rows[0]))
    sys.exit(f"{file.filename}: body '{body}' has no stress at node {node}")


def mode_count(body_file):
    """Number of modes of a body file, 0 for the full basis."""
    return len(body_file["modes/frequency"]) if "modes/frequency" in body_file else 0
