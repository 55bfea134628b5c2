// The page of scripts/report.py: unpacks the run, and links picture, slider, curves and tables.
import { Body } from "./body.js";
import { Chart } from "./charts.js";
import { ABOVE, HEAT, TWO_SIDES } from "./colours.js";
import { makeSortable } from "./tables.js";
import { Viewer } from "./viewer.js";
import "./page.css";

const PAPER = 320; // px, a column of charts in print
const SECONDS = 5; // that the whole run takes to play
const FRAME = 40; // ms at least between two of its times
const UP = [0, 0, 1], FROM = [0.35, 0.75, 0.55];
const $ = (id) => document.getElementById(id);
const pause = () => new Promise((done) => setTimeout(done));
const text = (value, digits = 4) => String(+Number(value).toPrecision(digits));

/** "1.23" and its unit, with as many digits as the stored steps tell apart. */
function measured(value, step, factor, unit) {
  const decimals = Math.max(0, Math.min(6, -Math.floor(Math.log10(step * factor))));
  return `${(value * factor).toFixed(decimals)} ${unit}`;
}

class Page {
  constructor(data, bodies) {
    Object.assign(this, { data, bodies, charts: [], picked: null, playing: null });
    this.state = { step: data.start, quantity: data.quantities[0].key, scale: 1, apart: 0, shown: "all" };
    this.ends = Object.fromEntries(data.quantities.map((q) => [q.key, q.end]));
    this.viewer = new Viewer($("view"), bodies, (body, node) => this.pick(body, node));
  }

  get quantity() {
    return this.data.quantities.find((q) => q.key === this.state.quantity);
  }

  async fieldsOf(quantity) {
    if (quantity.key !== "pattern") return Promise.all(this.bodies.map((body) => body.field(quantity.key)));
    return Promise.all(this.bodies.map(async (body) => {
      const field = await body.field("contact_traction");
      if (!field) return null;
      const most = field.steps.reduce((all, now) => all.map((v, i) => Math.max(v, now[i])), new Uint16Array(body.nodes));
      return { ...field, steps: Array(body.times).fill(most) };
    }));
  }

  async chooseQuantity(key) {
    this.state.quantity = key;
    this.fields = await this.fieldsOf(this.quantity);
    $("end").value = text(this.ends[key] * this.quantity.factor);
    this.showBar();
    this.show();
  }

  showBar() {
    const q = this.quantity, end = this.ends[q.key] * q.factor, bar = $("bar");
    const colours = q.twoSides ? TWO_SIDES : HEAT;
    bar.querySelector(".ramp").style.background = `linear-gradient(to right, ${colours.join(",")})`;
    bar.querySelector(".beyond").hidden = q.twoSides;
    bar.querySelector(".beyond").style.background = ABOVE;
    const low = q.twoSides ? -end : 0;
    bar.querySelector(".ticks").replaceChildren(...[0, 1, 2, 3, 4, 5].map((i) => {
      const tick = document.createElement("span");
      tick.textContent = text(low + ((end - low) * i) / 5, 3);
      return tick;
    }));
    $("bar-title").textContent = `${q.label} in ${q.unit}`;
  }

  show() {
    const { data, state } = this, q = this.quantity;
    this.viewer.show(state, this.fields, this.ends[q.key], q.twoSides);
    const now = `${text(data.times[state.step] * data.x.factor)} ${data.x.unit}`.trim();
    $("time").value = state.step;
    $("time").setAttribute("aria-valuetext", now);
    $("time-text").textContent = `${data.x.name} ${now}`;
    const most = this.largest();
    $("largest").textContent = most ? `largest now: ${most}` : "";
    for (const chart of this.charts) chart.show(data.times[state.step] * data.x.factor);
    if (this.picked) this.showPick();
  }

  largest() {
    const q = this.quantity, parts = [];
    this.fields.forEach((field, i) => {
      if (!field || (this.state.shown !== "all" && this.state.shown !== this.bodies[i].name)) return;
      const most = field.steps[this.state.step].reduce((a, b) => Math.max(a, b), 0);
      parts.push(`${this.bodies[i].name} ${measured(field.low + field.step * most, field.step, q.factor, q.unit)}`);
    });
    return parts.join(", ");
  }

  setStep(step) {
    this.state.step = Math.max(0, Math.min(this.data.times.length - 1, step));
    this.show();
  }

  stepAt(x) {
    const { times } = this.data;
    let best = 0;
    times.forEach((time, i) => {
      if (Math.abs(time - x) < Math.abs(times[best] - x)) best = i;
    });
    return best;
  }

  play(on) {
    clearInterval(this.playing);
    this.playing = on ? setInterval(() => this.setStep((this.state.step + 1) % this.data.times.length),
                                    Math.max(FRAME, (1000 * SECONDS) / this.data.times.length)) : null;
    $("play").setAttribute("aria-pressed", on);
    $("play").textContent = on ? "Pause" : "Play";
  }

  async pick(body, node) {
    this.picked = { body, node };
    this.viewer.pick(body, node);
    for (const q of this.data.quantities) if (q.key !== "pattern") await this.bodies[body].field(q.key);
    $("node-body").value = this.bodies[body].name;
    $("node-number").value = this.bodies[body].numbers[node];
    this.showPick();
    this.showHistory();
  }

  showPick() {
    const { body: i, node } = this.picked, body = this.bodies[i], { step } = this.state, rows = [];
    for (const q of this.data.quantities) {
      const field = body.fields.get(q.key);
      if (field) rows.push([q.label, measured(body.value(q.key, node, step), field.step, q.factor, q.unit), measured(field.step / 2, field.step / 20, q.factor, q.unit), q.key]);
    }
    const u = [0, 1, 2].map((k) => body.displacement(step)[3 * node + k]), { tolerance } = body.packed.displacement;
    rows.push(["Displacement", measured(Math.hypot(...u), tolerance, 1e6, "µm"), measured(tolerance, tolerance / 10, 1e6, "µm"), "displacement"]);
    $("pick-title").textContent = `${body.name}, node ${body.numbers[node]}`;
    $("pick-values").replaceChildren(...rows.map(([label, value, step, key]) => {
      const row = document.createElement("tr");
      row.dataset.key = key;
      for (const cell of [label, value, `± ${step}`]) row.append(Object.assign(document.createElement("td"), { textContent: cell }));
      return row;
    }));
    $("pick-at").textContent = [0, 1, 2].map((k) => (1e3 * body.X[3 * node + k]).toFixed(3).replace(/^-(0\.0*)$/, "$1")).join(", ");
    $("picked").hidden = false;
    $("pick-hint").hidden = true;
  }

  showHistory() {
    const { body: i, node } = this.picked, body = this.bodies[i], { data } = this;
    this.history?.destroy();
    this.charts = this.charts.filter((chart) => chart !== this.history);
    this.history = null;
    if (data.times.length < 2) return;
    const curves = data.quantities.filter((q) => body.fields.get(q.key)).map((q) => ({
      name: q.label, values: data.times.map((_, t) => body.value(q.key, node, t) * q.factor),
    }));
    this.history = new Chart($("pick-chart"), {
      x: data.times.map((t) => t * data.x.factor), xName: data.x.name, xLabel: data.x.label, yLabel: "MPa", curves,
    }, (x) => this.goTo(x));
    $("pick-chart").setAttribute("aria-label", `History of the values at node ${body.numbers[node]} of the ${body.name}`);
    this.charts.push(this.history);
    this.history.show(data.times[this.state.step] * data.x.factor);
  }

  goTo(x) {
    this.play(false);
    this.setStep(this.stepAt(x / this.data.x.factor));
  }

  /** Shows a node of a body by its number, near, at a time. */
  async visit(name, number, time, quantity = "von_mises") {
    const i = this.bodies.findIndex((body) => body.name === name), node = i < 0 ? -1 : this.bodies[i].nodeOfNumber(number);
    if (node < 0) {
      $("node-error").textContent = `the surface of the ${name} has no node ${number}`;
      return;
    }
    $("node-error").textContent = "";
    this.play(false);
    if (time !== undefined) this.state.step = this.stepAt(time);
    this.state.shown = name;
    $("shown").value = name;
    if (quantity) {
      $("quantity").value = quantity;
      await this.chooseQuantity(quantity);
    }
    await this.pick(i, node);
    this.viewer.near(i, node, UP);
  }

  whole() {
    this.viewer.whole(FROM, UP);
  }

  listen() {
    const { state, data } = this, on = (id, event, act) => $(id).addEventListener(event, act);
    on("time", "input", (event) => {
      this.play(false);
      this.setStep(+event.target.value);
    });
    on("play", "click", () => this.play(!this.playing));
    on("quantity", "change", (event) => this.chooseQuantity(event.target.value));
    on("shown", "change", (event) => {
      state.shown = event.target.value;
      this.show();
      this.whole();
    });
    on("scale", "input", (event) => {
      state.scale = data.scales[+event.target.value];
      $("scale-text").textContent = `× ${state.scale}`;
      event.target.setAttribute("aria-valuetext", `${state.scale} times`);
      this.show();
    });
    on("apart", "input", (event) => {
      state.apart = +event.target.value / 100;
      this.show();
      this.whole();
    });
    on("end", "change", (event) => {
      const value = +event.target.value / this.quantity.factor;
      if (value > 0) this.ends[state.quantity] = value;
      this.showBar();
      this.show();
    });
    on("whole", "click", () => this.whole());
    on("node-form", "submit", (event) => {
      event.preventDefault();
      this.visit($("node-body").value, +$("node-number").value, undefined, null);
    });
    for (const button of document.querySelectorAll("[data-visit]"))
      button.addEventListener("click", () => {
        const { body, node, time } = JSON.parse(button.dataset.visit);
        this.visit(body, node, time);
        $("view").scrollIntoView({ block: "center", behavior: matchMedia("(prefers-reduced-motion: reduce)").matches ? "auto" : "smooth" });
      });
    window.addEventListener("beforeprint", () => {
      this.viewer.drawNow();
      $("print").src = $("view").toDataURL("image/png");
    });
  }

  async start() {
    await this.chooseQuantity(this.state.quantity);
    this.whole();
    this.viewer.drawNow();
    $("loading").hidden = true;
    performance.mark("first picture");
  }

  addCharts(charts) {
    for (const chart of charts) {
      const { factor } = this.data.x;
      const scaled = { ...chart, x: chart.x.map((t) => t * factor), xName: this.data.x.name, xLabel: this.data.x.label };
      this.charts.push(new Chart($(chart.id), scaled, (x) => this.goTo(x)));
    }
    this.charts.forEach((chart) => chart.show(this.data.times[this.state.step] * this.data.x.factor));
  }
}

function fitToPaper(charts) {
  window.addEventListener("beforeprint", () => charts().forEach((chart) => chart.fit(PAPER)));
  window.addEventListener("afterprint", () => charts().forEach((chart) => chart.fit()));
}

function addOnlyCharts(data) {
  const charts = data.charts.map((chart) =>
    new Chart($(chart.id), { ...chart, x: chart.x.map((t) => t * data.x.factor), xName: data.x.name, xLabel: data.x.label }, () => {}));
  fitToPaper(() => charts);
}

async function main() {
  makeSortable(document);
  const data = JSON.parse($("data").textContent);
  if (!data.times) {
    addOnlyCharts(data);
    return;
  }
  try {
    const bodies = await Promise.all(data.bodies.map((body) => Body.read(body, data.times.length)));
    const page = new Page(data, bodies);
    page.listen();
    await page.start();
    await pause();
    page.addCharts(data.charts);
    fitToPaper(() => page.charts);
    window.report = page;
  } catch (error) {
    $("loading").textContent = `The picture cannot be drawn here: ${error.message}. It needs WebGL, and a browser of 2023 or later.`;
    if (document.querySelector(".chart .uplot") === null) addOnlyCharts(data);
    throw error;
  }
}

main();
