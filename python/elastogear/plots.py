"""Pictures by matplotlib, one line each. Every function returns the axes that it has drawn in.

The time of a sweep is the roll angle in pitches, that of an equilibrium the load factor; the axis says so.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._elastogear import Mesh
    from .results import Result, Stress, StressSet

_MS, _MPA, _MM = 1e3, 1e-6, 1e3


def _axes(axes: Any, **options: Any) -> Any:
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt
    return plt.subplots(layout="constrained", **options)[1]


def _time(axes: Any, of: Union["Result", "Stress"]) -> NDArray[Any]:
    name, unit = of.time_axis
    in_time = unit == "s"
    axes.set_xlabel(f"{name} in ms" if in_time else name if unit == "1" else f"{name} in {unit}")
    axes.grid(alpha=0.3)
    return _MS * of.time if in_time else of.time


def contact_force(result: "Result", pair: Optional[str] = None, axes: Any = None) -> Any:
    """Contact force of a pair (default: the first one) over the time, N."""
    pair = pair or result.pairs[0]
    axes = _axes(axes)
    force = np.linalg.norm(result.pair(pair).force, axis=1)
    axes.plot(_time(axes, result), force, label=pair)
    axes.set_ylabel("contact force in N")
    axes.legend()
    return axes


def speed(result: "Result", axes: Any = None) -> Any:
    """Speeds of all joint coordinates over the time, rad/s or m/s."""
    axes = _axes(axes)
    for body in result.bodies:
        rates = result.body(body).s_dot
        for i in range(rates.shape[1]):
            axes.plot(_time(axes, result), rates[:, i], label=body if rates.shape[1] == 1 else f"{body} {i}")
    axes.set_ylabel("speed in rad/s or m/s")
    axes.legend()
    return axes


def energies(result: "Result", axes: Any = None) -> Any:
    """Energies over the time, J."""
    axes = _axes(axes)
    for name, energy in result.energies.items():
        if np.any(energy != 0):
            axes.plot(_time(axes, result), energy, label=name)
    axes.set_ylabel("energy in J")
    axes.legend()
    return axes


def peak_stress(stress: "Stress", axes: Any = None) -> Any:
    """Largest von Mises stress of each set over the time, MPa, with its estimated error by all causes
    where one is known."""
    axes = _axes(axes)
    for each in stress.sets:
        time, peak = _time(axes, stress), _MPA * each.von_mises.max(axis=1)
        axes.plot(time, peak, label=f"{each.body} {each.set}")
        error = each.total_peak_error
        if error is not None:
            axes.fill_between(time, peak - _MPA * error, peak + _MPA * error, alpha=0.3)
    axes.set_ylabel("von Mises stress in MPa")
    axes.legend()
    return axes


def stress_map(each: "StressSet", time: int = -1, axes: Any = None) -> Any:
    """Von Mises stress at the nodes of a set at one time (its index), MPa, in space."""
    axes = _axes(axes, subplot_kw={"projection": "3d"})
    points = axes.scatter(*(_MM * each.X.T), c=_MPA * each.von_mises[time], s=8)
    axes.figure.colorbar(points, ax=axes, label="von Mises stress in MPa")
    axes.set_aspect("equal")
    axes.set(xlabel="x in mm", ylabel="y in mm", zlabel="z in mm")
    return axes


def mesh(mesh: "Mesh", face_set: str = "flanks", axes: Any = None) -> Any:
    """The faces of a set."""
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection
    axes = _axes(axes, subplot_kw={"projection": "3d"})
    points = _MM * mesh.points
    faces = mesh.face_sets[face_set]
    axes.add_collection3d(Poly3DCollection(points[faces], facecolor="lightsteelblue", edgecolor="k", linewidth=0.2))
    corners = points[np.unique(faces)]
    axes.auto_scale_xyz(*corners.T)
    axes.set_aspect("equal")
    axes.set(xlabel="x in mm", ylabel="y in mm", zlabel="z in mm")
    return axes
