"""How far is a reduced body from the unreduced one? The roller of examples/hertz, pressed onto a plate.

    compare_with_full.py [FOLDER_OF_EXAMPLES]

Expected: ten modes alone miss the stress under the contact; with static responses they have it within 1 %, as their
estimated error says.
"""
import sys
from pathlib import Path

import elastogear as eg

repository = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parents[2]
hertz = repository / "examples" / "hertz"
eg.System(hertz / "plate.yaml").reduce(mesh=repository / "meshes" / "bar.inp")
roller = eg.System(hertz / "hertz.yaml")

stress = {}
for basis in ["full", "modal_residual", "modal"]:
    roller.reduce(mesh=repository / "meshes" / "roller.inp", basis=basis, output="roller.h5")
    roller.simulate()
    stress[basis] = roller.recover()["roller", "AXIS"]

full = stress["full"].von_mises[-1]
for basis, each in stress.items():
    peak, error = each.von_mises[-1].max(), abs(each.von_mises[-1] - full).max()
    known = "" if each.peak_error is None else f", estimated {1e-6 * each.peak_error[-1]:.2f} MPa"
    print(f"{basis:15} {1e-6 * peak:7.1f} MPa, off by {1e-6 * error:.2f} MPa{known}")

assert abs(stress["modal_residual"].von_mises[-1] - full).max() < 0.01 * full.max()
assert abs(stress["modal"].von_mises[-1] - full).max() > 0.1 * full.max()
