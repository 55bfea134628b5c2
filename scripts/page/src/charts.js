// Curves over time with a line at the time that is shown.
import uPlot from "uplot";
import "uplot/dist/uPlot.min.css";

const COLOURS = ["#0072B2", "#D55E00", "#009E73", "#9b4d86", "#8a6100", "#2f7fb0"]; // Okabe and Ito's, dark enough on white
const HEIGHT = 240;
const FONT = "13px system-ui, sans-serif";

const digits = (value) => (value === 0 ? "0" : Math.abs(value) >= 1e5 || Math.abs(value) < 1e-3 ? value.toExponential(2) : String(+value.toPrecision(4)));

function series(curve, i) {
  const least = 1e-9 * curve.values.reduce((most, v) => Math.max(most, Math.abs(v ?? 0)), 0); // below: rounding
  const stroke = curve.black ? "#111" : COLOURS[i % COLOURS.length];
  const common = { label: curve.name, stroke, width: curve.band ? 0 : 2, points: { show: curve.values.length < 2 }, value: (_, v) => (v == null ? "–" : digits(Math.abs(v) < least ? 0 : v)) };
  return curve.dash ? { ...common, dash: [7, 4] } : common;
}

export class Chart {
  /** chart: {title, x, xLabel, yLabel, curves: [{name, values}], bands: [[upper, lower]]}. onTime(x): a place was chosen. */
  constructor(holder, chart, onTime) {
    this.holder = holder;
    this.chart = chart;
    this.line = document.createElement("div");
    this.line.className = "now";
    const axis = (label) => ({ label, labelFont: FONT, font: FONT, stroke: "#333", grid: { stroke: "#e4e4e4", width: 1 }, labelSize: 22,
                               values: (_, ticks) => ticks.map((tick) => digits(+tick.toPrecision(10))) });
    this.plot = new uPlot({
      width: this.width(), height: HEIGHT, pxAlign: 0,
      scales: { x: { time: false }, y: { range: (_, low, high) => uPlot.rangeNum(Math.min(low, 0), Math.max(high, 0) || 1, 0.08, true) } },
      axes: [{ ...axis(chart.xLabel), size: 40 }, { ...axis(chart.yLabel), size: 62 }],
      cursor: { y: false, drag: { x: false, y: false }, points: { size: 6 } },
      legend: { live: true },
      series: [{ label: chart.xName, value: (_, v) => (v == null ? "–" : digits(v)) }, ...chart.curves.map(series)],
      hooks: { ready: [() => this.at !== undefined && this.show(this.at)] },
      bands: (chart.bands || []).map((pair) => ({ series: pair.map((i) => i + 1), fill: "#0072B233" })),
    }, [chart.x, ...chart.curves.map((curve) => curve.values)], holder);
    chart.curves.forEach((curve, i) => curve.band && (this.plot.root.querySelectorAll(".u-series")[i + 1].hidden = true));
    this.plot.over.append(this.line);
    this.plot.over.addEventListener("click", () => {
      const { left } = this.plot.cursor;
      if (left >= 0) onTime(this.plot.posToVal(left, "x"));
    });
    new ResizeObserver(() => this.fit()).observe(holder);
  }

  width() {
    return Math.max(200, this.holder.clientWidth);
  }

  /** width: of the paper's column; none: of the page's. */
  fit(width = this.width()) {
    if (this.plot.width !== width) this.plot.setSize({ width, height: HEIGHT });
    if (this.at !== undefined) this.show(this.at);
  }

  show(x) {
    this.at = x;
    const left = this.plot.valToPos(x, "x");
    this.plot.setLegend({ idx: this.nearest(x) }, false);
    this.line.style.transform = `translateX(${left.toFixed(1)}px)`;
  }

  nearest(x) {
    const { x: all } = this.chart;
    let best = 0;
    for (let i = 1; i < all.length; i++) if (Math.abs(all[i] - x) < Math.abs(all[best] - x)) best = i;
    return best;
  }

  destroy() {
    this.plot.destroy();
  }
}
