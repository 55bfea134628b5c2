// Opens a report in headless Chromium without a network and uses it: node page.mjs REPORT.html CHROMIUM FOLDER
// Prints what it saw as JSON; test_page.py holds that against the files of the run. Run in the folder of the npm packages.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

const [report, executablePath, folder] = process.argv.slice(2);
const require = createRequire(join(process.cwd(), "package.json"));
const { chromium } = require("playwright-core");
const axe = readFileSync(require.resolve("axe-core/axe.min.js"), "utf8");

const seen = { errors: [], requests: [], picks: [], widths: {} };
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
         "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});

async function open(width, height, more = {}) {
  const context = await browser.newContext({ viewport: { width, height }, offline: true, reducedMotion: "reduce", ...more });
  const page = await context.newPage();
  page.setDefaultTimeout(120000);
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && !message.text().includes("GPU stall") && seen.errors.push(message.text()));
  page.on("pageerror", (error) => seen.errors.push(String(error)));
  page.on("request", (request) => !/^(file|data|blob):/.test(request.url()) && seen.requests.push(request.url()));
  await page.goto(pathToFileURL(report).href);
  await page.waitForFunction(() => window.report);
  return page;
}

/** Pixels of the picture, of which the page keeps the last as `seen`; returns how many are others than before. */
const changes = (page) => page.evaluate(() => {
  const { viewer } = window.report, gl = viewer.renderer.getContext();
  viewer.resize(1);
  viewer.drawNow();
  const { drawingBufferWidth: w, drawingBufferHeight: h } = gl, now = new Uint8Array(4 * w * h);
  gl.readPixels(0, 0, w, h, gl.RGBA, gl.UNSIGNED_BYTE, now);
  const before = window.seen;
  window.seen = now;
  let n = 0;
  for (let i = 0; before && i < now.length; i += 4)
    n += Math.abs(now[i] - before[i]) + Math.abs(now[i + 1] - before[i + 1]) + Math.abs(now[i + 2] - before[i + 2]) > 12;
  return n;
});

const picked = (page) => page.evaluate(() => ({
  title: document.querySelector("#pick-title").textContent, time: window.report.data.times[window.report.state.step],
  values: Object.fromEntries([...document.querySelectorAll("#pick-values tr")].map((row) => [row.dataset.key, row.cells[1].textContent])),
  steps: Object.fromEntries([...document.querySelectorAll("#pick-values tr")].map((row) => [row.dataset.key, row.cells[2].textContent])),
}));

async function clickBody(page, name) {
  const box = await page.locator("#view").boundingBox();
  const places = await page.evaluate((body) => {
    const { viewer } = window.report, { left, top } = viewer.canvas.getBoundingClientRect(), places = [];
    for (let y = 5; y < viewer.canvas.clientHeight; y += 23)
      for (let x = 5; x < viewer.canvas.clientWidth; x += 23) {
        const hit = viewer.nodeAt(left + x, top + y);
        if (hit && window.report.bodies[hit.body].name === body) places.push([x, y]);
      }
    return places;
  }, name);
  const [x, y] = places[Math.floor(places.length / 2)];
  await page.mouse.click(box.x + x, box.y + y);
  await page.waitForFunction((body) => document.querySelector("#pick-title").textContent.startsWith(body), name);
  seen.picks.push(await picked(page));
}

/** What axe-core finds that keeps people out, as text. */
const violations = (page) => page.evaluate(`${axe}; axe.run().then((found) => found.violations.filter((v) => ["serious", "critical"].includes(v.impact)).map((v) => v.id + ": " + v.nodes.map((n) => n.html.slice(0, 120)).join(" | ")))`);

const page = await open(1280, 900);
seen.firstPicture = await page.evaluate(() => performance.getEntriesByName("first picture")[0].startTime);
seen.title = await page.title();
seen.asked = await page.locator("#asked").textContent();
seen.module = await page.locator("tr", { has: page.locator("td", { hasText: /^module$/ }) }).first().locator("td").nth(1).textContent();
await page.locator("#time").focus();
await page.keyboard.press("End");
await changes(page);
await page.keyboard.press("Home");
seen.changedByTime = await changes(page);
await page.keyboard.press("ArrowRight");
seen.stepByKey = await page.evaluate(() => window.report.state.step);
await page.keyboard.press("End");
await changes(page);
await page.locator("#view").focus();
await page.keyboard.press("ArrowLeft");
seen.changedByKey = await changes(page);
await page.selectOption("#quantity", "rankine");
await page.waitForFunction(() => document.querySelector("#bar-title").textContent.startsWith("Largest principal"));
seen.changedByQuantity = await changes(page);
for (const name of await page.evaluate(() => window.report.bodies.map((body) => body.name))) await clickBody(page, name);
await page.locator(".card [data-visit]").first().click();
const visited = await page.locator(".card [data-visit]").first().getAttribute("data-visit");
await page.waitForFunction((node) => document.querySelector("#pick-title").textContent.endsWith(` ${node}`), JSON.parse(visited).node);
seen.visited = { ...JSON.parse(visited), ...(await picked(page)) };
await page.locator("#play").click();
await page.waitForFunction((step) => window.report.state.step !== step, await page.evaluate(() => window.report.state.step));
await page.locator("#play").click();
seen.charts = await page.locator(".chart .uplot").count();
await page.locator("th button").nth(2).click();
seen.sorted = await page.locator("table.sortable").first().locator("tbody tr td:nth-child(3)").allTextContents();
seen.violations = await violations(page);
seen.turn = await page.evaluate(() => new Promise((done) => {
  const { viewer } = window.report, start = performance.now();
  let frames = 0;
  const turn = () => {
    viewer.turn(0.02, 0);
    if (performance.now() - start > 1000) done((1000 * frames) / (performance.now() - start));
    else {
      frames++;
      requestAnimationFrame(turn);
    }
  };
  turn();
}));
await page.screenshot({ path: join(folder, "desktop.png"), fullPage: true });
seen.pdf = (await page.pdf({ path: join(folder, "print.pdf"), format: "A4", printBackground: true })).length;
seen.printed = await page.evaluate(() => document.querySelector("#print").src.length);
const phone = await open(390, 844, { isMobile: true, hasTouch: true });
await phone.locator(".card [data-visit]").first().click();
await phone.waitForFunction(() => !document.querySelector("#picked").hidden);
for (const width of [320, 390]) {
  await phone.setViewportSize({ width, height: 844 });
  seen.widths[width] = await phone.evaluate(() => document.documentElement.scrollWidth);
}
seen.violations.push(...(await violations(phone)));
await phone.screenshot({ path: join(folder, "phone.png"), fullPage: true });
await browser.close();
console.log(JSON.stringify(seen));
