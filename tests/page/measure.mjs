// Measures a report in headless Chromium with software rendering: node measure.mjs REPORT.html CHROMIUM, in build/page.
// CPU times of all of the browser's processes, which do not depend on what else the machine does, beside wall times.
import { readFileSync, readdirSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [report, executablePath] = process.argv.slice(2);
const { chromium } = createRequire(join(process.cwd(), "package.json"))("playwright-core");
const TICK = 10; // ms of /proc's clock

/** ms of CPU time that descendants of this process have taken, living ones. */
function cpu() {
  const parents = new Map(), times = new Map();
  for (const pid of readdirSync("/proc").filter((name) => /^\d+$/.test(name))) {
    try {
      const fields = readFileSync(`/proc/${pid}/stat`, "utf8").split(") ")[1].split(" ");
      parents.set(+pid, +fields[1]);
      times.set(+pid, TICK * (+fields[11] + +fields[12]));
    } catch {} // it has ended
  }
  const ours = (pid) => pid === process.pid || (parents.has(pid) && ours(parents.get(pid)));
  return [...times].filter(([pid]) => pid !== process.pid && ours(pid)).reduce((sum, [, time]) => sum + time, 0);
}

const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
const page = await (await browser.newContext({ viewport: { width: 1280, height: 900 }, offline: true })).newPage();
page.setDefaultTimeout(300000);
let start = cpu();
await page.goto(pathToFileURL(report).href);
await page.waitForFunction(() => window.report);
const first = await page.evaluate(() => performance.getEntriesByName("first picture")[0].startTime);
console.log(`first picture after ${Math.round(first)} ms; ready with ${cpu() - start} ms of CPU time`);

const SETTLING = 12; // frames in which the picture finds how fine it can be

async function frames(what, n, act) {
  await run(SETTLING, act);
  start = cpu();
  const wall = await run(n, act);
  const [detail, triangles] = await page.evaluate(() => {
    const { viewer } = window.report;
    return [viewer.detail, viewer.visible().reduce((sum, shape) => sum + shape.geometry.index.count / 3, 0)];
  });
  console.log(`${what}: ${((cpu() - start) / n).toFixed(1)} ms of CPU time a frame, ${((1000 * n) / wall).toFixed(1)} frames/s, ${triangles} triangles, ${detail.toFixed(2)} pixels for one of the page`);
}

/** ms that n frames take, in each of which act(report) is called. */
function run(n, act) {
  return page.evaluate(`new Promise((done) => {
    const { report } = window, start = performance.now();
    let left = ${n};
    const next = () => (left-- === 0 ? done(performance.now() - start) : ((${act})(report), requestAnimationFrame(next)));
    next();
  })`);
}
await frames("turning", 30, (report) => report.viewer.turn(0.02, 0));
await frames("playing", 30, (report) => report.setStep((report.state.step + 1) % report.data.times.length));
await browser.close();
