// Headless Chromium for the checks of pages: what a page must not do is written down while it runs.
import { createRequire } from 'node:module';
import path from 'node:path';

// MODULES is the folder of the installed Node packages.
const { chromium } = createRequire(path.join(process.argv[2], 'x'))('playwright-core');

/** Opens a browser, without any request of its own; pictures come from software. */
export function open() {
  return chromium.launch({
    executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium',
    args: ['--no-sandbox', '--enable-unsafe-swiftshader', '--use-gl=angle', '--use-angle=swiftshader', '--disable-quic', '--no-first-run',
      '--disable-background-networking', '--disable-component-update', '--disable-sync'],
  });
}

/** A page of a window of this size, and the list of what went wrong in it: errors, failed requests, requests to others. */
export async function watched(browser, [width, height], host, more = {}) {
  const context = await browser.newContext({ viewport: { width, height }, acceptDownloads: true, ...more });
  const page = await context.newPage();
  const wrong = [];
  page.setDefaultTimeout(240_000);
  page.on('console', (message) => ['error', 'warning'].includes(message.type()) && wrong.push(`console: ${message.text()}`));
  page.on('pageerror', (error) => wrong.push(`error: ${error.message}`));
  page.on('response', (response) => response.status() >= 400 && wrong.push(`${response.status()}: ${response.url()}`));
  page.on('request', (request) => {
    const { protocol, host: asked } = new URL(request.url());
    if (!['data:', 'blob:'].includes(protocol) && asked !== host) wrong.push(`request to ${request.url()}`);
  });
  return { page, wrong, close: () => context.close() };
}
