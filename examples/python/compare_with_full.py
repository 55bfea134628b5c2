"""How far is a reduced body from the unreduced one? The roller of examples/hertz, pressed onto a rigid plate.

Expected: ten modes alone miss the stress under the contact; with static responses they have it within 1 %, as their
estimated error says.
"""
from pathlib import Path

import elastogear as eg

repository = Path(__file__).resolve().parents[2]
hertz, meshes = repository / "examples" / "hertz", repository / "meshes"
eg.System(hertz / "plate.yaml").reduce(mesh=meshes / "bar.inp")
roller = eg.System(hertz / "hertz.yaml")

stress = {}
for basis in ["full", "modal_residual", "modal"]:
    roller.reduce(mesh=meshes / "roller.inp", basis=basis)
    roller.simulate()
    stress[basis] = roller.recover()["roller", "AXIS"]

full = stress["full"].von_mises[-1]
error = {}
for basis, each in stress.items():
    peak, error[basis] = each.von_mises[-1].max(), abs(each.von_mises[-1] - full).max() / full.max()
    known = "" if each.peak_error is None else f", estimated {1e-6 * each.peak_error[-1]:.2f} MPa"
    print(f"{basis:15} {1e-6 * peak:7.1f} MPa, off by {100 * error[basis]:.3f} %{known}")

assert error["modal_residual"] < 0.01 < error["modal"]
