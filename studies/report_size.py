#!/usr/bin/python3
"""Report pages of runs that are larger than the run at hand, by which size and speed of the page are measured.

    studies/report_size.py subdivide|tile N TIMES INPUT [options of scripts/report.py]

subdivide: each triangle becomes four, N times over. tile: N copies of each body in a row, each in other times of the run.
The run's times go back and forth until there are TIMES of them. Measured in a browser, from build/page, by

    node ../../tests/page/measure.mjs PAGE.html CHROMIUM
"""
import copy
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "scripts"))
import report  # noqa: E402  (found through the line above)
from page import fields  # noqa: E402

APART = 0.02  # m, from one copy of a body to the next


def changed(surface, nodes, triangles, X, of_times):
    """A surface with other nodes and triangles; of_times makes its histories of those of the former."""
    made = copy.copy(surface)
    made.nodes, made.triangles, made.X = nodes, triangles, X
    made.displacement = of_times(surface.displacement, 0)
    made.fields = {name: of_times(values, 1) for name, values in surface.fields.items()}
    return made


def tiled(surface, n):
    count, most = len(surface.nodes), int(surface.nodes.max()) + 1
    return changed(surface, np.concatenate([surface.nodes + i * most for i in range(n)]),
                   np.concatenate([surface.triangles + i * count for i in range(n)]),
                   np.concatenate([surface.X + [0, 0, i * APART] for i in range(n)]),
                   lambda values, shift: np.concatenate([np.roll(values, 3 * i * shift, axis=0) for i in range(n)], axis=1))


def subdivided(surface):
    T = surface.triangles
    edges, side = np.unique(np.sort(np.concatenate([T[:, [0, 1]], T[:, [1, 2]], T[:, [2, 0]]]), axis=1), axis=0, return_inverse=True)
    (a, b, c), (ab, bc, ca) = T.T, side.reshape(3, -1) + len(surface.X)
    parts = np.stack([np.stack(part, 1) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))], 1).reshape(-1, 3)
    used, first, number = np.unique(parts.ravel(), return_index=True, return_inverse=True)
    order = np.argsort(first)  # nodes are numbered by their first use
    rank = np.empty(len(order), int)
    rank[order] = np.arange(len(order))
    X = np.concatenate([surface.X, surface.X[edges].mean(axis=1)])[used[order]]
    return changed(surface, used[order], rank[number].reshape(-1, 3), X,
                   lambda values, _: np.concatenate([values, values[:, edges].mean(axis=2)], axis=1)[:, used[order]])


def back_and_forth(values, n):
    """n entries of a list, forwards, backwards and so on."""
    turn = [*range(len(values)), *range(len(values) - 2, 0, -1)]
    return np.asarray(values)[[turn[i % len(turn)] for i in range(n)]]


def main(how, n, n_times):
    read = fields.read_surfaces

    def larger(path, result):
        times, surfaces = read(path, result)
        for surface in surfaces:
            surface.displacement = back_and_forth(surface.displacement, n_times)
            surface.fields = {name: back_and_forth(values, n_times) for name, values in surface.fields.items()}
            surface.rotation, surface.position = back_and_forth(surface.rotation, n_times), back_and_forth(surface.position, n_times)
        for _ in range(n if how == "subdivide" else 0):
            surfaces = [subdivided(surface) for surface in surfaces]
        surfaces = [tiled(surface, n) for surface in surfaces] if how == "tile" else surfaces
        print(f"{sum(len(surface.triangles) for surface in surfaces)} triangles, {n_times} times, {len(surfaces[0].fields)} fields")
        return np.linspace(times[0], times[-1], n_times), surfaces

    fields.read_surfaces = larger
    report.main()


if __name__ == "__main__":
    if len(sys.argv) < 5 or sys.argv[1] not in ("subdivide", "tile"):
        sys.exit(__doc__)
    words = sys.argv[1:4]
    sys.argv[1:4] = []
    main(words[0], int(words[1]), int(words[2]))
