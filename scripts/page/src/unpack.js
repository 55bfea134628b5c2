// Reads the blocks that scripts/page/pack.py writes.

function bytesOf(text) {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; i++) bytes[i] = raw.charCodeAt(i);
  return bytes;
}

/** Uint8Array of a deflated, base64 text. */
export async function inflate(text) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** The n unsigned integers of a block. */
export async function unpack(text, n) {
  const bytes = await inflate(text);
  const values = new Uint32Array(n);
  for (let plane = 0; plane * n < bytes.length; plane++) {
    const shift = 8 * plane, start = plane * n;
    for (let i = 0; i < n; i++) values[i] |= bytes[start + i] << shift;
  }
  return values;
}

const signed = (z) => (z >>> 1) ^ -(z & 1);

/** Sums of signed differences, in runs of n numbers. */
export async function unpackSums(text, n, runs = 1) {
  const packed = await unpack(text, n * runs);
  const values = new Int32Array(n * runs);
  for (let run = 0; run < runs; run++) {
    let sum = 0;
    for (let i = run * n; i < (run + 1) * n; i++) values[i] = sum += signed(packed[i]);
  }
  return values;
}

/** Field of n nodes at all times: one Uint16Array for each time. */
export async function unpackField(text, n, times) {
  const packed = await unpack(text, n * times);
  const steps = [];
  let before = null;
  for (let t = 0; t < times; t++) {
    const now = new Uint16Array(n);
    let sum = 0;
    for (let i = 0; i < n; i++) {
      const change = signed(packed[t * n + i]);
      now[i] = t === 0 ? (sum += change) : before[i] + change;
    }
    steps.push((before = now));
  }
  return steps;
}

/** Triangles: numbers below the next new one. */
export async function unpackIndex(text, n) {
  const packed = await unpack(text, n);
  let following = 0;
  for (let i = 0; i < n; i++) {
    packed[i] = following - packed[i];
    if (packed[i] === following) following++;
  }
  return packed;
}
