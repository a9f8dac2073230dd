// A headless Chromium for the tests. Reads one JSON request a line on stdin and answers one JSON line on stdout; the browser is
// started once and ends with stdin. Usage: node driver.mjs CHROMIUM NODE_MODULES [webgl|webgpu]
//
// {url, args}: open the page, call its `run(args)`, close it; answer {value, log, failures}.
// {open, url, width, height, reducedMotion, before, empty}: open a page under the name `open` and keep it; `before` is a script that
// runs before the page's own; modules whose address matches `empty` are empty.
// {page, steps}: do steps on a page that is open; answer {value: one result a step, log, failures, requests} since the last answer.
// {close}: close a page. A step is one of
//   {evaluate} an expression, and its value            {until} an expression that must come true; its value
//   {press: [keys]} each pressed once                  {hold: key, until} a key that is down until an expression is true
//   {type: text}                                       {drag: [[x, y], ...]} the mouse, down on the way
//   {wheel: [x, y, dy]}                                {click: [x, y]}
//   {screenshot: true} a PNG as base64                 {size: [width, height]} of the window
import path from 'node:path';
import readline from 'node:readline';
import { setTimeout as sleep } from 'node:timers/promises';
import { pathToFileURL } from 'node:url';

const [executablePath, modules, graphics = 'webgl'] = process.argv.slice(2);
const GRAPHICS = {
  webgl: ['--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'], // WebGL 2 without a graphics card
  webgpu: ['--enable-unsafe-webgpu'], // with the flags of the other there is no adapter
};
const { chromium } = await import(pathToFileURL(path.join(modules, 'playwright-core', 'index.mjs')));
const browser = await chromium.launch({
  executablePath,
  args: [
    '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
    ...GRAPHICS[graphics],
    '--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1', // a page that asks for anything else fails, and says so
  ],
});
const answer = (tree) => process.stdout.write(JSON.stringify(tree) + '\n');
answer({ browser: browser.version() });

const POLL = 50; // [ms] between two looks at a condition; it costs a page under a strict policy nothing

/** Return a new page with lists of what it says, what fails and what it asks for. */
async function newPage({ width = 320, height = 200, reducedMotion, before, empty }) {
  const log = [], failures = [], requests = [];
  const options = { viewport: { width, height }, reducedMotion: reducedMotion ? 'reduce' : 'no-preference' };
  const context = await browser.newContext(options);
  await context.grantPermissions(['clipboard-read', 'clipboard-write']);
  const page = await context.newPage();
  page.setDefaultTimeout(0); // the test that asked has the only clock
  page.setDefaultNavigationTimeout(0);
  page.on('pageerror', (error) => failures.push(`page: ${error.message}`));
  page.on('crash', () => failures.push('the page crashed'));
  page.on('console', (m) => (m.type() === 'error' ? failures : log).push(m.text()));
  page.on('request', (request) => requests.push(request.url()));
  page.on('websocket', (socket) => requests.push(socket.url()));
  page.on('download', (file) => requests.push(`download: ${file.suggestedFilename()}`));
  if (before) await page.addInitScript(before);
  const nothing = { contentType: 'text/javascript', body: 'export {};' };
  if (empty) await page.route(new RegExp(empty), (route) => route.fulfill(nothing));
  return { context, page, log, failures, requests };
}

const PATIENCE = 150e3; // [ms] less than the test's own, so that one that waits in vain does not take the browser with it

/** Return the value of an expression once it is true. */
async function until(page, expression) {
  const start = Date.now();
  while (Date.now() - start < PATIENCE) {
    const value = await page.evaluate(expression);
    if (value) return value;
    await sleep(POLL);
  }
  throw new Error(`this did not come true: ${expression}`);
}

const STEPS = {
  evaluate: (page, { evaluate }) => page.evaluate(evaluate),
  async hold(page, { hold, until: expression }) {
    await page.keyboard.down(hold);
    const value = await until(page, expression);
    await page.keyboard.up(hold);
    return value;
  },
  until: (page, step) => until(page, step.until),
  async press(page, { press }) {
    for (const key of press) await page.keyboard.press(key);
  },
  type: (page, { type }) => page.keyboard.type(type),
  async drag(page, { drag }) {
    await page.mouse.move(...drag[0]);
    await page.mouse.down();
    for (const place of drag.slice(1)) await page.mouse.move(...place);
    await page.mouse.up();
  },
  async wheel(page, { wheel: [x, y, dy] }) {
    await page.mouse.move(x, y);
    await page.mouse.wheel(0, dy);
  },
  click: (page, { click }) => page.mouse.click(...click),
  screenshot: async (page) => (await page.screenshot({ timeout: 0 })).toString('base64'),
  size: (page, { size: [width, height] }) => page.setViewportSize({ width, height }),
};

/** Do one step; its kind is its first key. */
async function done(page, step) {
  const kind = Object.keys(step)[0];
  return (await STEPS[kind](page, step)) ?? null;
}

const open = new Map();

/** Answer one request. */
async function answered(request) {
  if (request.close) {
    await open.get(request.close)?.context.close();
    open.delete(request.close);
    return { value: null, log: [], failures: [] };
  }
  const once = !request.open && !request.page;
  const tab = request.page ? open.get(request.page) : await newPage(request);
  const { context, page, log, failures, requests } = tab;
  if (request.open) open.set(request.open, tab);
  let value = null;
  try {
    if (request.url) await page.goto(request.url);
    if (once) value = await page.evaluate((given) => globalThis.run(given), request.args);
    if (request.steps) {
      value = [];
      for (const step of request.steps) value.push(await done(page, step));
    }
  } catch (error) {
    failures.push(String(error.message ?? error));
  } finally {
    if (once) await context.close().catch(() => {});
  }
  return { value, log: log.splice(0), failures: failures.splice(0), requests: requests.splice(0) };
}

for await (const line of readline.createInterface({ input: process.stdin })) {
  answer(await answered(JSON.parse(line)).catch((error) => ({ value: null, log: [], failures: [String(error.message ?? error)] })));
}
await browser.close();
