"""Packs surfaces with fields of many times into few bytes, as scripts/page/src/unpack.js reads them.

Every array is a block: unsigned integers of up to 32 bits, apart in planes of bytes (the lowest of all numbers first), deflated,
in base64. Numbers that vary little from one to the next, or from one time to the next, are stored as differences whose sign is
the lowest bit."""
import base64
import zlib

import numpy as np

POSITION_LEVELS = 65535  # over the largest extent of a body
WARP_TOLERANCE = 1 / 400  # of the largest displacement: how far displacements may be off
CREASE = 25  # degrees, between faces whose common edge is drawn


def zigzag(values):
    """-1 -> 1, 1 -> 2, -2 -> 3: small numbers of either sign have few bits."""
    values = values.astype(np.int64)
    return np.where(values < 0, -2 * values - 1, 2 * values)


def block(values, n_planes):
    """Text of unsigned integers below 256**n_planes."""
    values = np.ascontiguousarray(values, dtype="<u4").ravel()
    planes = values.view(np.uint8).reshape(-1, 4).T[:n_planes]
    return base64.b64encode(zlib.compress(np.ascontiguousarray(planes).tobytes(), 6)).decode()


def differences(values, axis):
    """values, less those before them along the axis."""
    return np.diff(values.astype(np.int64), axis=axis, prepend=0)


def field_block(values, levels):
    """values: n_t x n. Returns the block, and low and step of the stored integers q: value = low + step q."""
    low = float(min(values.min(), 0))
    step = max(float(values.max()) - low, 1e-300) / levels
    q = np.rint((values - low) / step).astype(np.int64)
    first = differences(q[:1], 1)
    return block(zigzag(np.concatenate([first, np.diff(q, axis=0)])), 3), low, step


def index_block(triangles):
    """How far each number lies below the next new one: nodes are numbered by their first use."""
    flat = triangles.ravel().astype(np.int64)
    following = np.concatenate([[0], np.maximum.accumulate(flat + 1)[:-1]])
    return block(following - flat, 3)


def creases(X, triangles):
    """Pairs of nodes on edges at which the surface turns or ends (n x 2)."""
    a, b, c = (X[triangles[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    owner = np.tile(np.arange(len(triangles)), 3)
    order = np.lexsort((edges[:, 1], edges[:, 0]))
    edges, owner = edges[order], owner[order]
    start = np.flatnonzero(np.concatenate([[True], (np.diff(edges, axis=0) != 0).any(axis=1)]))
    count = np.diff(np.append(start, len(edges)))
    twice = start[count == 2]
    turn = (normal[owner[twice]] * normal[owner[twice + 1]]).sum(axis=1)
    sharp = twice[turn < np.cos(np.radians(CREASE))]
    return edges[np.sort(np.concatenate([sharp, start[count != 2]]))]


def low_rank(displacement, tolerance):
    """Shapes (r x 3n) and weights (n_t x r, at most 1) whose products are within the tolerance of n_t x 3n displacements."""
    u = displacement.reshape(len(displacement), -1).astype(float)
    value, vector = np.linalg.eigh(u @ u.T)
    vector = vector[:, ::-1]
    fewest, most = 0, len(u)  # the error falls with the rank
    while most - fewest > 1:
        rank = (fewest + most) // 2
        weights = vector[:, :rank]
        fewest, most = (fewest, rank) if np.abs(u - weights @ (weights.T @ u)).max() <= tolerance else (rank, most)
    weights = vector[:, :most]
    shapes = weights.T @ u
    size = np.maximum(np.abs(weights).max(axis=0), 1e-300)
    return shapes * size[:, None], weights / size


def pack_displacement(surface):
    largest = float(np.linalg.norm(surface.displacement, axis=2).max())
    tolerance = max(WARP_TOLERANCE * largest, 1e-300)
    shapes, weights = low_rank(surface.displacement, tolerance / 2)
    weights, step = np.round(weights, 6), tolerance
    u = surface.displacement.reshape(len(weights), -1)
    while np.abs(u - weights @ (step * np.rint(shapes / step))).max() > tolerance:
        step *= 0.8
    q = np.rint(shapes / step).astype(np.int64).reshape(len(shapes), -1, 3).transpose(0, 2, 1)
    return {"block": block(zigzag(differences(q, 2)), 3), "step": step, "weights": weights.tolist(),
            "largest": largest, "tolerance": tolerance}


def pack_shape(surface):
    """A body without the fields by which it is coloured."""
    low, extent = surface.X.min(axis=0), max(float(np.ptp(surface.X, axis=0).max()), 1e-300)
    step = extent / POSITION_LEVELS
    q = np.rint((surface.X - low) / step).astype(np.int64)
    packed = {"name": surface.name, "nodes": len(surface.nodes), "triangles": len(surface.triangles),
              "numbers": block(zigzag(differences(surface.nodes, 0)), 4),
              "X": {"block": block(zigzag(differences(q, 0).T), 3), "low": low.tolist(), "step": step},
              "index": index_block(surface.triangles),
              "rotation": np.round(surface.rotation, 9).reshape(-1, 9).tolist(),
              "position": np.round(surface.position, 9).tolist(), "displacement": pack_displacement(surface), "fields": {}}
    edges = creases(surface.X, surface.triangles)
    packed["creases"] = {"count": len(edges), "block": block(zigzag(differences(edges, 0).T), 3)}
    return packed


def pack_field(values, levels):
    data, low, step = field_block(values, levels)
    return {"block": data, "low": low, "step": step, "high": float(values.max())}


def size_of(packed):
    """Characters of all blocks."""
    if isinstance(packed, dict):
        return sum(size_of(value) for value in packed.values())
    return len(packed) if isinstance(packed, str) else 0


FINEST = {"von_mises": 4095, "rankine": 4095, "error_of_von_mises": 255, "error_of_von_mises_by_mesh": 255, "contact_traction": 1023}


def pack(surfaces, most):
    """All bodies, as finely as `most` characters allow; 8 bits at least."""
    levels, bodies = dict(FINEST), [pack_shape(surface) for surface in surfaces]
    while True:
        for body, surface in zip(bodies, surfaces):
            body["fields"] = {name: pack_field(values, levels[name]) for name, values in surface.fields.items()}
        if sum(map(size_of, bodies)) <= most or max(levels.values()) <= 255:
            return bodies
        levels = {name: max(255, (number + 1) // 4 - 1) for name, number in levels.items()}
