#!/usr/bin/python3
"""What hexahedra make of pressures on their sides: docs/validation/contact.md, section Local contact compliance of flanks.

A block of 18 x 18 x 9 sides of the length h = 1, held at its base, by a quarter of it; E = 1, nu = 0.3. Printed are mean
displacements by loads under themselves, as means of 1/r in 1/h, less what base and faces of the block add. That is
taken so that nine pressures of corners on cells of 20 nodes, as deep as long, have the exact mean, and told beside
what even pressures on boxes of four and six sides give for it.
"""

import itertools

import numpy as np
import scipy.sparse
import scipy.sparse.linalg

NU = 0.3
HALF_SPACE = (1 - NU**2) / np.pi
WITHIN_SQUARE = 2.97320  # mean of 1/r between two points of a square, times its side
SIDES = 9
POINTS = np.polynomial.legendre.leggauss(3)
CORNERS = np.array(list(itertools.product((-1, 1), repeat=3)))
MIDDLES = np.array([np.insert(s, d, 0) for d in range(3) for s in itertools.product((-1, 1), repeat=2)])


def shape(x, order):
    corner = np.prod(1 + CORNERS * x, axis=1) / 8
    if order == 1:
        return corner
    middle = [(1 - x[np.argmin(abs(m))] ** 2) * np.prod((1 + m * x)[m != 0]) / 4 for m in MIDDLES]
    return np.concatenate([corner * ((CORNERS * x).sum(axis=1) - 2), middle])


def strains(gradients):
    B = np.zeros((6, 3 * len(gradients)))
    for row, (i, j) in enumerate([(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (0, 2)]):
        B[row, j::3] += gradients[:, i]
        if i != j:
            B[row, i::3] += gradients[:, j]
    return B


def stiffness(depth, order):
    """Of a cell of 1 x 1 x depth: with the incompatible modes of order 1 condensed."""
    mu, lame = 1 / (2 + 2 * NU), NU / ((1 + NU) * (1 - 2 * NU))
    C = np.diag([2 * mu] * 3 + [mu] * 3)
    C[:3, :3] += lame
    scale, step, n = np.array([2, 2, 2 / depth]), 1e-6, 8 if order == 1 else 20
    K, K_ia, K_ii = np.zeros((3 * n, 3 * n)), np.zeros((9, 3 * n)), np.zeros((9, 9))
    for place in itertools.product(zip(*POINTS), repeat=3):
        x, weight = np.array([p for p, _ in place]), np.prod([w for _, w in place]) * depth / 8
        gradients = [(shape(x + step * e, order) - shape(x - step * e, order)) / (2 * step) for e in np.eye(3)]
        B, B_i = strains(np.stack(gradients, axis=1) * scale), strains(np.diag(-2 * x) * scale)
        K += B.T @ C @ B * weight
        K_ia += B_i.T @ C @ B * weight
        K_ii += B_i.T @ C @ B_i * weight
    return K - K_ia.T @ np.linalg.solve(K_ii, K_ia) if order == 1 else K


class Block:
    def __init__(self, depth, order):
        self.order = order
        layers = round(SIDES / depth)
        n, n_z = order * SIDES + 1, order * layers + 1
        self.number = lambda i, j, k: (i * n + j) * n_z + k
        cells = np.meshgrid(range(SIDES), range(SIDES), range(layers), indexing="ij")
        i, j, k = (order * c.ravel() for c in cells)
        nodes = np.stack([self.number(i + a, j + b, k + c) for a, b, c in self.places()], axis=1)
        dofs = (3 * nodes[:, :, None] + np.arange(3)).reshape(len(nodes), -1)
        m = dofs.shape[1]
        rows, columns = np.repeat(dofs, m, axis=1).ravel(), np.tile(dofs, (1, m)).ravel()
        K = scipy.sparse.csc_matrix((np.tile(stiffness(depth, order).ravel(), len(nodes)), (rows, columns)))
        used = np.unique(nodes)
        i, j, above = used // (n * n_z), used // n_z % n, used % n_z < n_z - 1
        free = np.sort(np.concatenate([3 * used[above & (i > 0)], 3 * used[above & (j > 0)] + 1, 3 * used[above] + 2]))
        self.dof = np.full(K.shape[0], -1)
        self.dof[free] = np.arange(len(free))
        self.factor = scipy.sparse.linalg.splu(
            K[free][:, free].tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0, options={"SymmetricMode": True}
        )

    def places(self):
        """Of a cell's nodes, in halves or wholes of its length."""
        return (CORNERS + 1) // 2 if self.order == 1 else np.concatenate([CORNERS, MIDDLES]) + 1

    def mean(self, forces):
        """By forces on the top, {(i, j): N}, whose resultant is 1 N and that are the same in all quarters."""
        f = np.zeros(self.factor.shape[0])
        for (i, j), force in forces.items():
            if i >= 0 and j >= 0:
                f[self.dof[3 * self.number(i, j, 0) + 2]] += force * (0.5 if i == 0 else 1) * (0.5 if j == 0 else 1)
        assert abs(f.sum() - 0.25) < 1e-9
        return 4 * f @ self.factor.solve(f) / HALF_SPACE

    def consistent(self, pressure, reach):
        """Nodal forces of a pressure over the sides of -reach..reach in both directions."""
        forces = {}
        for a, b in itertools.product(range(-reach, reach), repeat=2):
            for (u, weight_u), (v, weight_v) in itertools.product(zip(*POINTS), repeat=2):
                p = pressure(a + (u + 1) / 2, b + (v + 1) / 2) * weight_u * weight_v / 4
                for (i, j, k), N in zip(self.places(), shape(np.array([u, v, -1]), self.order)):
                    if k == 0:
                        node = (self.order * a + i, self.order * b + j)
                        forces[node] = forces.get(node, 0) + N * p
        return forces


def nine_corners(x, y):
    """Pressures of nine corners together: even over four sides, down to zero over the next."""
    return np.prod([np.clip(2 - abs(t), 0, 1) / 3 for t in (x, y)])


def even_forces(order):
    around = [p for p in itertools.product(range(-order, order + 1), repeat=2) if order == 1 or p[0] % 2 * (p[1] % 2) == 0]
    return {p: 1 / len(around) for p in around}


def exact(parts=24):
    """Mean of 1/r of nine_corners, by parts of sides with their second moments."""
    x = (np.arange(4 * parts) + 0.5) / parts - 2
    p = np.clip(2 - abs(x), 0, 1)
    p /= p.sum()
    d = np.arange(4 * parts)
    overlap = np.correlate(p, p, "full")[4 * parts - 1 :]  # of the pressures of two places d apart
    r = np.hypot(*np.meshgrid(d, d)) / parts
    r[0, 0] = 1
    inverse = 1 / r * (1 + 1 / (12 * (parts * r) ** 2))
    inverse[0, 0] = WITHIN_SQUARE * parts
    times = np.where(d == 0, 1, 2) * overlap
    return times @ inverse @ times


def main():
    wanted, reference = exact(), Block(1, 2)
    added = reference.mean(reference.consistent(nine_corners, 2)) - wanted
    boxes = [
        reference.mean(reference.consistent(lambda x, y, c=c: 1 / (2 * c) ** 2, c)) - WITHIN_SQUARE / (2 * c) for c in (2, 3)
    ]
    print(f"exact {wanted:.4f}; block {added:.4f}, by boxes {boxes[0]:.4f}, {boxes[1]:.4f}")
    for order, depth in itertools.product((2, 1), (0.5, 1, 1.8)):
        block = Block(depth, order)
        corners, even = block.mean(block.consistent(nine_corners, 2)), block.mean(even_forces(order))
        print(f"order {order}, cells {depth} deep: corners {corners - added:.4f}, even forces {even - added:.4f}", flush=True)


if __name__ == "__main__":
    main()
