// One body of the page: its surface, unpacked, and what is drawn of it at a time.
import { unpackField, unpackIndex, unpackSums } from "./unpack.js";

const SMOOTH = Math.cos((35 * Math.PI) / 180); // faces that turn by less share a normal
const COARSEST = 8; // cells over the largest extent of a coarse body, at least

function cross(X, a, b, c, out) {
  const ux = X[3 * b] - X[3 * a], uy = X[3 * b + 1] - X[3 * a + 1], uz = X[3 * b + 2] - X[3 * a + 2];
  const vx = X[3 * c] - X[3 * a], vy = X[3 * c + 1] - X[3 * a + 1], vz = X[3 * c + 2] - X[3 * a + 2];
  out[0] = uy * vz - uz * vy;
  out[1] = uz * vx - ux * vz;
  out[2] = ux * vy - uy * vx;
}

/** Vertices for drawing: a node has one for each smooth part of the surface around it. index: triangles of vertices. */
function split(X, triangles, nodes) {
  const index = new Uint32Array(triangles.length), nodeOf = Array.from({ length: nodes }, (_, i) => i);
  const next = new Int32Array(2 * nodes + triangles.length).fill(-1), used = new Uint8Array(nodes);
  const sums = new Float32Array(3 * (nodes + triangles.length)), n = [0, 0, 0];
  for (let t = 0; t < triangles.length; t += 3) {
    cross(X, triangles[t], triangles[t + 1], triangles[t + 2], n);
    const size = Math.hypot(n[0], n[1], n[2]) || 1;
    for (let k = 0; k < 3; k++) {
      let v = triangles[t + k];
      while (used[v] || v >= nodes) {
        const s = Math.hypot(sums[3 * v], sums[3 * v + 1], sums[3 * v + 2]) || 1;
        if (sums[3 * v] * n[0] + sums[3 * v + 1] * n[1] + sums[3 * v + 2] * n[2] > SMOOTH * s * size) break;
        if (next[v] < 0) {
          next[v] = nodeOf.length;
          nodeOf.push(triangles[t + k]);
          v = next[v];
          break;
        }
        v = next[v];
      }
      if (v < nodes) used[v] = 1;
      for (let i = 0; i < 3; i++) sums[3 * v + i] += n[i];
      index[t + k] = v;
    }
  }
  const normals = new Int8Array(4 * nodeOf.length);
  for (let v = 0; v < nodeOf.length; v++) {
    const s = Math.hypot(sums[3 * v], sums[3 * v + 1], sums[3 * v + 2]) || 1;
    for (let i = 0; i < 3; i++) normals[4 * v + i] = Math.round((127 * sums[3 * v + i]) / s);
  }
  return { index, nodeOf: Uint32Array.from(nodeOf), normals };
}

async function readX({ block, low, step }, nodes) {
  const q = await unpackSums(block, nodes, 3);
  const X = new Float32Array(3 * nodes);
  for (let i = 0; i < nodes; i++)
    for (let k = 0; k < 3; k++) X[3 * i + k] = low[k] + step * q[k * nodes + i];
  return X;
}

/** Lowest coordinates of a body, and its largest extent. */
function extent(X) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < X.length; i++) {
    low[i % 3] = Math.min(low[i % 3], X[i]);
    high[i % 3] = Math.max(high[i % 3], X[i]);
  }
  return { low, size: Math.max(...high.map((x, k) => x - low[k]), 1e-30) };
}

/** At most about `most` triangles: the vertices in each cell of a grid become one of them. */
export function coarse({ X, nodeOf, index }, most) {
  const { low, size } = extent(X), place = (v, k, cells) => Math.floor(((X[3 * nodeOf[v] + k] - low[k]) / size) * cells);
  for (let cells = 128; ; cells *= 0.75) {
    const first = new Map(), stands = new Uint32Array(nodeOf.length), triangles = [];
    for (let v = 0; v < nodeOf.length; v++) {
      const cell = (place(v, 0, cells) * 1024 + place(v, 1, cells)) * 1024 + place(v, 2, cells);
      if (!first.has(cell)) first.set(cell, v);
      stands[v] = first.get(cell);
    }
    for (let t = 0; t < index.length; t += 3) {
      const [a, b, c] = [stands[index[t]], stands[index[t + 1]], stands[index[t + 2]]];
      if (a !== b && b !== c && c !== a) triangles.push(a, b, c);
    }
    if (triangles.length <= 3 * most || cells < COARSEST) return Uint32Array.from(triangles);
  }
}

export class Body {
  static async read(packed, times) {
    const body = new Body();
    Object.assign(body, { name: packed.name, nodes: packed.nodes, times, packed, fields: new Map() });
    const [X, triangles, numbers, edges] = await Promise.all([
      readX(packed.X, packed.nodes),
      unpackIndex(packed.index, 3 * packed.triangles),
      unpackSums(packed.numbers, packed.nodes),
      unpackSums(packed.creases.block, packed.creases.count, 2),
    ]);
    const n = packed.creases.count;
    body.edges = new Uint32Array(2 * n);
    for (let i = 0; i < n; i++) body.edges.set([edges[i], edges[n + i]], 2 * i);
    const { displacement } = packed;
    body.rank = displacement.weights[0].length;
    body.shapes = await unpackSums(displacement.block, packed.nodes, 3 * body.rank);
    Object.assign(body, { X, numbers, ...split(X, triangles, packed.nodes) });
    body.u = new Float32Array(3 * packed.nodes);
    return body;
  }

  /** Stored integers of a field at all times, unpacked when first asked for; null where the body has no such field. */
  async field(name) {
    const packed = this.packed.fields[name];
    if (!packed) return null;
    if (!this.fields.has(name))
      this.fields.set(name, { ...packed, steps: await unpackField(packed.block, this.nodes, this.times) });
    return this.fields.get(name);
  }

  /** Displacements (m, body frame) at a time; the array is used again. */
  displacement(time) {
    const { weights, step } = this.packed.displacement, { u, nodes, shapes } = this;
    u.fill(0);
    for (let r = 0; r < this.rank; r++) {
      const weight = weights[time][r] * step;
      if (weight === 0) continue;
      for (let k = 0; k < 3; k++) {
        const start = (3 * r + k) * nodes;
        for (let i = 0, j = k; i < nodes; i++, j += 3) u[j] += weight * shapes[start + i];
      }
    }
    return u;
  }

  /** Value of a field that has been unpacked at one node and time. */
  value(name, node, time) {
    const field = this.fields.get(name);
    return field ? field.low + field.step * field.steps[time][node] : undefined;
  }

  /** The node of a mesh number; -1: not on the surface. */
  nodeOfNumber(number) {
    return this.numbers.indexOf(number);
  }
}
