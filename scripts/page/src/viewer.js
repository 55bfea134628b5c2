// Bodies in three dimensions: draws when something has changed, and picks nodes.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { coarse } from "./body.js";
import { ABOVE, HEAT, TWO_SIDES, ramp } from "./colours.js";

const N_COLOURS = 256, TURN = Math.PI / 24, CLICK = 5; // colours; radians a key; pixels a pointer may move in a click
const SAMPLE = 3, FRAME = 1.06; // every n-th node tells a body's extent; room around it
const SLOW = 30; // ms a frame
const DETAIL = 2, LEAST_DETAIL = 0.4; // pixels of the picture for one of the page, at rest and in motion on slow machines
const ROUGH = 6000; // triangles of a body in motion on machines that are slow even then
const REST = 350, MOTION = 120; // ms: a picture rests after so long; one that is wanted sooner after the last belongs to a motion

const VERTEX = `
  attribute float value;
  uniform float low, width;
  varying float x;
  varying float shade;
  void main() {
    x = (value * 65535.0 - low) / width;
    vec3 n = normalize(normalMatrix * normal);
    shade = 0.74 + 0.26 * abs(n.z) + 0.06 * n.y;
    gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  }`;
const FRAGMENT = `
  precision mediump float;
  uniform sampler2D colours;
  uniform vec3 above;
  uniform float plain, twoSides;
  varying float x;
  varying float shade;
  void main() {
    vec3 c = texture2D(colours, vec2(clamp(x, 0.002, 0.998), 0.5)).rgb;
    if (x > 1.0001 && twoSides < 0.5) c = above;
    if (plain > 0.5) c = vec3(0.86, 0.88, 0.90);
    gl_FragColor = vec4(c * min(shade, 1.0), 1.0);
  }`;

function texture(scale) {
  const map = new THREE.DataTexture(ramp(scale, N_COLOURS), N_COLOURS, 1);
  map.minFilter = map.magFilter = THREE.LinearFilter;
  map.needsUpdate = true;
  return map;
}

class Shape {
  constructor(body, above) {
    this.body = body;
    const n = body.nodeOf.length;
    const attribute = (array, size, normalized) => new THREE.BufferAttribute(array, size, normalized);
    this.geometry = new THREE.BufferGeometry();
    this.position = attribute(new Float32Array(3 * n), 3).setUsage(THREE.DynamicDrawUsage);
    this.value = attribute(new Uint16Array(n), 1, true).setUsage(THREE.DynamicDrawUsage);
    const normals = new THREE.InterleavedBuffer(body.normals, 4);
    this.geometry.setAttribute("position", this.position);
    this.geometry.setAttribute("value", this.value);
    this.geometry.setAttribute("normal", new THREE.InterleavedBufferAttribute(normals, 3, 0, true));
    this.fine = attribute(body.index, 1);
    this.geometry.setIndex(this.fine);
    const uniforms = { low: { value: 0 }, width: { value: 1 }, plain: { value: 0 }, twoSides: { value: 0 } };
    this.material = new THREE.ShaderMaterial({
      uniforms: { ...uniforms, colours: { value: null }, above: { value: above } },
      vertexShader: VERTEX, fragmentShader: FRAGMENT, side: THREE.FrontSide,
      polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1,
    });
    this.mesh = new THREE.Mesh(this.geometry, this.material);
    this.lines = new THREE.BufferGeometry();
    this.lines.setAttribute("position", attribute(new Float32Array(3 * body.nodes), 3).setUsage(THREE.DynamicDrawUsage));
    this.lines.setIndex(attribute(body.edges, 1));
    this.group = new THREE.Group();
    this.creases = new THREE.LineSegments(this.lines, new THREE.LineBasicMaterial({ color: 0x555555 }));
    this.group.add(this.mesh, this.creases);
    this.group.matrixAutoUpdate = false;
    for (const part of this.group.children) part.frustumCulled = false;
    const spread = new THREE.Box3().setFromArray(body.X);
    this.sphere = spread.getBoundingSphere(new THREE.Sphere());
    this.geometry.boundingSphere = new THREE.Sphere(this.sphere.center.clone(), 1.5 * this.sphere.radius);
  }

  /** Draws fewer triangles, or all. */
  roughen(rough) {
    if (rough && !this.rough) this.rough = new THREE.BufferAttribute(coarse(this.body, ROUGH), 1);
    this.geometry.setIndex(rough ? this.rough : this.fine);
  }

  /** Moves the surface to its place and shape at a time; shift: m, world frame. */
  move(time, scale, shift) {
    const { X, nodes, nodeOf, packed } = this.body, u = this.body.displacement(time);
    const at = this.lines.attributes.position.array, vertex = this.position.array;
    for (let i = 0; i < 3 * nodes; i++) at[i] = X[i] + scale * u[i];
    for (let v = 0, j = 0; v < nodeOf.length; v++) {
      const i = 3 * nodeOf[v];
      vertex[j++] = at[i];
      vertex[j++] = at[i + 1];
      vertex[j++] = at[i + 2];
    }
    this.position.needsUpdate = this.lines.attributes.position.needsUpdate = true;
    const R = packed.rotation[time], p = packed.position[time];
    this.group.matrix.set(R[0], R[1], R[2], p[0] + shift.x, R[3], R[4], R[5], p[1] + shift.y,
                          R[6], R[7], R[8], p[2] + shift.z, 0, 0, 0, 1);
    this.group.matrixWorldNeedsUpdate = true;
    this.group.updateMatrixWorld(true);
  }

  /** Stored integers of a field at its nodes; null: the body has no such field. */
  colour(values, low, width, map, twoSides) {
    const { nodeOf } = this.body, to = this.value.array, u = this.material.uniforms;
    if (values) for (let v = 0; v < nodeOf.length; v++) to[v] = values[nodeOf[v]];
    this.value.needsUpdate = true;
    u.low.value = low;
    u.width.value = width;
    u.colours.value = map;
    u.plain.value = values ? 0 : 1;
    u.twoSides.value = twoSides ? 1 : 0;
  }

  center() {
    return this.sphere.center.clone().applyMatrix4(this.group.matrixWorld);
  }

  place(node) {
    return new THREE.Vector3().fromArray(this.lines.attributes.position.array, 3 * node).applyMatrix4(this.group.matrixWorld);
  }

  normal(node) {
    const n = new THREE.Vector3().fromArray(this.body.normals, 4 * this.body.nodeOf.indexOf(node));
    return n.transformDirection(this.group.matrixWorld);
  }
}

export class Viewer {
  /** onPick(body number, node). */
  constructor(canvas, bodies, onPick) {
    this.canvas = canvas;
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: false, powerPreference: "high-performance" });
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.setClearColor(0xffffff, 1);
    THREE.ColorManagement.enabled = false;
    const above = new THREE.Color(ABOVE);
    this.scale = { heat: texture(HEAT), sides: texture(TWO_SIDES) };
    this.shapes = bodies.map((body) => new Shape(body, above));
    this.scene = new THREE.Scene();
    this.scene.add(...this.shapes.map((shape) => shape.group));
    this.camera = new THREE.PerspectiveCamera(28, 1, 0.001, 10);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableZoom = false;
    this.controls.addEventListener("change", () => this.draw());
    this.mark = new THREE.Points(
      new THREE.BufferGeometry().setAttribute("position", new THREE.BufferAttribute(new Float32Array(3), 3)),
      new THREE.PointsMaterial({ color: 0x00e5ff, size: 11, sizeAttenuation: false, depthTest: false }));
    this.mark.visible = false;
    this.mark.frustumCulled = false;
    this.mark.renderOrder = 1;
    this.scene.add(this.mark);
    this.apart = 0;
    this.picked = null;
    this.waiting = false;
    this.detail = this.swift = DETAIL; // swift: that of the last motion
    this.rough = false; // fewer triangles are needed in motion
    this.last = this.wanted = 0; // times of the last frame, and of the call for the next one
    this.listen(onPick);
    new ResizeObserver(() => this.fit()).observe(canvas.parentElement);
    this.fit();
  }

  listen(onPick) {
    const { canvas } = this;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => {
      down = [event.clientX, event.clientY];
      canvas.focus({ preventScroll: true });
    });
    canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > CLICK) return;
      const hit = this.nodeAt(event.clientX, event.clientY);
      if (hit) onPick(hit.body, hit.node);
    });
    canvas.addEventListener("focus", () => (this.controls.enableZoom = true));
    canvas.addEventListener("blur", () => (this.controls.enableZoom = false));
    canvas.addEventListener("keydown", (event) => {
      const turn = { ArrowLeft: [TURN, 0], ArrowRight: [-TURN, 0], ArrowUp: [0, TURN], ArrowDown: [0, -TURN] }[event.key];
      if (turn) this.turn(...turn);
      else if (event.key === "+" || event.key === "=") this.zoom(0.85);
      else if (event.key === "-") this.zoom(1 / 0.85);
      else return;
      event.preventDefault();
    });
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => this.draw());
  }

  turn(around, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const place = new THREE.Spherical().setFromVector3(this.toY(offset));
    place.theta += around;
    place.phi = Math.min(Math.max(place.phi - up, 0.05), Math.PI - 0.05);
    this.camera.position.copy(this.controls.target).add(this.fromY(new THREE.Vector3().setFromSpherical(place)));
    this.controls.update();
    this.draw();
  }

  toY(v) {
    return v.applyQuaternion(new THREE.Quaternion().setFromUnitVectors(this.camera.up, new THREE.Vector3(0, 1, 0)));
  }

  fromY(v) {
    return v.applyQuaternion(new THREE.Quaternion().setFromUnitVectors(new THREE.Vector3(0, 1, 0), this.camera.up));
  }

  zoom(factor) {
    this.camera.position.sub(this.controls.target).multiplyScalar(factor).add(this.controls.target);
    this.controls.update();
    this.draw();
  }

  fit() {
    const { clientWidth: w, clientHeight: h } = this.canvas.parentElement;
    if (w === 0 || h === 0) return;
    this.renderer.setPixelRatio(this.detail);
    this.renderer.setSize(w, h, false);
    this.camera.aspect = w / h;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /** Sets places, shapes and colours; state: see main.js. fields: one for each body, or null. */
  show(state, fields, end, twoSides) {
    this.shapes.forEach((shape, i) => {
      shape.move(state.step, state.scale, this.direction(i).multiplyScalar(state.apart * this.radius()));
      const field = fields[i];
      const low = field ? ((twoSides ? -end : 0) - field.low) / field.step : 0;
      const width = field ? ((twoSides ? 2 : 1) * end) / field.step : 1;
      shape.colour(field && field.steps[state.step], low, width, twoSides ? this.scale.sides : this.scale.heat, twoSides);
      shape.group.visible = state.shown === "all" || state.shown === shape.body.name;
    });
    this.moveMark();
    this.draw();
  }

  radius() {
    return Math.max(...this.shapes.map((shape) => shape.sphere.radius));
  }

  /** Away from the others: where a body's middle lies from the middle of all, undisturbed by shifts. */
  direction(i) {
    const rest = this.shapes.map((shape) => {
      const R = shape.body.packed.rotation[0], p = shape.body.packed.position[0], c = shape.sphere.center;
      return new THREE.Vector3(R[0] * c.x + R[1] * c.y + R[2] * c.z + p[0], R[3] * c.x + R[4] * c.y + R[5] * c.z + p[1],
                               R[6] * c.x + R[7] * c.y + R[8] * c.z + p[2]);
    });
    const middle = rest.reduce((sum, c) => sum.add(c), new THREE.Vector3()).divideScalar(rest.length);
    return rest[i].sub(middle).normalize();
  }

  visible() {
    return this.shapes.filter((shape) => shape.group.visible);
  }

  /** All visible bodies, seen from a direction, as large as they fit. */
  whole(direction, up) {
    const back = new THREE.Vector3(...direction).normalize(), right = new THREE.Vector3(...up).cross(back).normalize();
    const axes = [right, new THREE.Vector3().crossVectors(back, right), back], low = [1e9, 1e9, 1e9], high = [-1e9, -1e9, -1e9];
    const each = (act) => this.visible().forEach((shape) => {
      for (let i = 0; i < shape.body.nodes; i += SAMPLE) act(axes.map((axis) => axis.dot(shape.place(i))));
    });
    each((x) => x.forEach((value, k) => {
      low[k] = Math.min(low[k], value);
      high[k] = Math.max(high[k], value);
    }));
    const middle = low.map((value, k) => (value + high[k]) / 2), t = Math.tan((this.camera.fov * Math.PI) / 360);
    let distance = 0;
    each((x) => {
      const across = Math.max(Math.abs(x[0] - middle[0]) / this.camera.aspect, Math.abs(x[1] - middle[1]));
      distance = Math.max(distance, (FRAME * across) / t + x[2] - middle[2]);
    });
    const target = axes.reduce((sum, axis, k) => sum.addScaledVector(axis, middle[k]), new THREE.Vector3());
    this.look(target, direction, up, distance);
  }

  look(target, direction, up, distance) {
    const d = new THREE.Vector3(...direction).normalize();
    this.camera.up.set(...up);
    this.camera.position.copy(target).addScaledVector(d, distance);
    this.camera.near = distance / 200;
    this.camera.far = 20 * Math.max(distance, 8 * this.radius());
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(target);
    // OrbitControls takes the axis of its turns when it is made.
    this.controls.dispose();
    const { enableZoom } = this.controls;
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableZoom = enableZoom;
    this.controls.target.copy(target);
    this.controls.addEventListener("change", () => this.draw());
    this.controls.update();
    this.draw();
  }

  /** A node from outside of its body, near. */
  near(i, node, up) {
    const shape = this.shapes[i], n = shape.normal(node);
    const out = shape.place(node).sub(shape.center()).normalize();
    const direction = n.add(out.multiplyScalar(0.6)).normalize();
    if (Math.abs(direction.dot(new THREE.Vector3(...up))) > 0.97) direction.x += 0.3;
    this.look(shape.place(node), direction.toArray(), up, (0.55 * shape.sphere.radius) / Math.tan((this.camera.fov * Math.PI) / 360) / 2);
  }

  pick(i, node) {
    this.picked = { i, node };
    this.moveMark();
    this.draw();
  }

  moveMark() {
    const { picked } = this;
    this.mark.visible = Boolean(picked) && this.shapes[picked.i].group.visible;
    if (!this.mark.visible) return;
    this.shapes[picked.i].place(picked.node).toArray(this.mark.geometry.attributes.position.array);
    this.mark.geometry.attributes.position.needsUpdate = true;
  }

  /** The node drawn nearest to a place on the page, on what is seen there. */
  nodeAt(x, y) {
    const box = this.canvas.getBoundingClientRect(), ray = new THREE.Raycaster();
    for (const shape of this.shapes) shape.roughen(false);
    const at = new THREE.Vector2(((x - box.left) / box.width) * 2 - 1, 1 - ((y - box.top) / box.height) * 2);
    ray.setFromCamera(at, this.camera);
    const hits = ray.intersectObjects(this.visible().map((shape) => shape.mesh), false);
    if (hits.length === 0) return null;
    const body = this.shapes.findIndex((shape) => shape.mesh === hits[0].object), { face, point } = hits[0];
    const shape = this.shapes[body];
    const nodes = [face.a, face.b, face.c].map((vertex) => shape.body.nodeOf[vertex]);
    const away = nodes.map((node) => shape.place(node).distanceTo(point));
    return { body, node: nodes[away.indexOf(Math.min(...away))] };
  }

  draw() {
    if (this.waiting) return;
    this.waiting = true;
    this.wanted = performance.now();
    requestAnimationFrame(() => {
      this.waiting = false;
      this.adapt(performance.now());
      this.drawNow();
    });
  }

  drawNow() {
    this.renderer.render(this.scene, this.camera);
  }

  /** Fewer pixels while frames follow each other too slowly, all of them again when the picture rests. */
  adapt(now) {
    const moving = this.wanted - this.last < MOTION, lag = now - this.wanted;
    this.last = now;
    if (moving && this.detail > this.swift) {
      this.resize(this.swift);
    } else if (moving && lag > SLOW && this.detail > LEAST_DETAIL) {
      this.resize((this.swift = Math.max(LEAST_DETAIL, this.detail * Math.max(0.5, Math.min(0.85, Math.sqrt(SLOW / lag))))));
    } else if (moving && lag > SLOW && !this.rough) {
      this.rough = true;
      this.resize(LEAST_DETAIL);
    }
    this.restAfter(Math.max(REST, moving ? 2 * lag : 0));
  }

  restAfter(wait) {
    clearTimeout(this.rest);
    if (this.detail === DETAIL) return;
    this.rest = setTimeout(() => {
      if (this.waiting) return this.restAfter(wait);
      this.resize(DETAIL);
      this.drawNow();
    }, wait);
  }

  /** pixels of the picture for one of the page. Creases, and triangles on the slowest machines, are left out of the coarsest ones. */
  resize(detail) {
    this.detail = detail;
    this.renderer.setPixelRatio(detail);
    for (const shape of this.shapes) {
      shape.creases.visible = detail > LEAST_DETAIL;
      shape.roughen(detail <= LEAST_DETAIL && this.rough);
    }
  }
}
