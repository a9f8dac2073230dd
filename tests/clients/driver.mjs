// A headless Chromium for the tests. Reads one JSON request a line on stdin, {url, args}: opens the page, calls its `run(args)`,
// and answers one JSON line on stdout, {value, log, failures}. The browser is started once and ends with stdin.
// Usage: node driver.mjs CHROMIUM NODE_MODULES
import path from 'node:path';
import readline from 'node:readline';
import { pathToFileURL } from 'node:url';

const [executablePath, modules] = process.argv.slice(2);
const { chromium } = await import(pathToFileURL(path.join(modules, 'playwright-core', 'index.mjs')));
const browser = await chromium.launch({
  executablePath,
  args: [
    '--no-sandbox', '--disable-quic', '--no-first-run', '--disable-background-networking', '--disable-component-update', '--disable-sync',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist', // WebGL 2 without a graphics card
    '--host-resolver-rules=MAP * ~NOTFOUND , EXCLUDE 127.0.0.1', // a page that asks for anything else fails, and says so
  ],
});
const answer = (tree) => process.stdout.write(JSON.stringify(tree) + '\n');
answer({ browser: browser.version() });

for await (const line of readline.createInterface({ input: process.stdin })) {
  const { url, args } = JSON.parse(line);
  const log = [], failures = [];
  const context = await browser.newContext({ viewport: { width: 320, height: 200 } });
  try {
    const page = await context.newPage();
    page.setDefaultTimeout(0); // the test that asked has the only clock
    page.setDefaultNavigationTimeout(0);
    page.on('pageerror', (error) => failures.push(`page: ${error.message}`));
    page.on('crash', () => failures.push('the page crashed'));
    page.on('console', (m) => (m.type() === 'error' ? failures : log).push(m.text()));
    await page.goto(url);
    answer({ value: await page.evaluate((given) => globalThis.run(given), args), log, failures });
  } catch (error) {
    answer({ value: null, log, failures: [...failures, String(error.message ?? error)] });
  } finally {
    await context.close().catch(() => {});
  }
}
await browser.close();
