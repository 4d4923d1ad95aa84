// Renders the views with three.js in a headless Chromium.
// Arguments: folder of node modules, Chromium, settings as JSON, file for the pixels.

import { readFileSync, writeFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join, normalize } from 'node:path';

const [modules, chromium, settingsFile, output] = process.argv.slice(2);
const { chromium: browsers } = createRequire(join(modules, 'peer.js'))('playwright-core');
const settings = JSON.parse(readFileSync(settingsFile, 'utf8'));
const page_script = new URL('three_scene.js', import.meta.url);

const PAGE = `<!doctype html>
<script type="importmap">
{"imports": {"three": "/modules/three/build/three.module.js",
             "three/addons/": "/modules/three/examples/jsm/"}}
</script>
<body></body>`;

// Served from memory, so that no port is opened.
function answer(path) {
  if (path === '/') return { contentType: 'text/html', body: PAGE };
  if (path === '/map.exr') return { body: readFileSync(settings.map) };
  if (path === '/scene.js') {
    return { contentType: 'text/javascript', body: readFileSync(page_script) };
  }
  const file = normalize(path.replace('/modules/', ''));
  return { contentType: 'text/javascript', body: readFileSync(join(modules, file)) };
}

const browser = await browsers.launch({
  executablePath: chromium,
  args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});
try {
  const page = await browser.newPage();
  const faults = [];
  page.on('pageerror', (error) => faults.push(String(error)));
  await page.route('**/*', (route) => {
    const path = new URL(route.request().url()).pathname;
    try {
      return route.fulfill(answer(path));
    } catch {
      return route.fulfill({ status: 404, body: path });
    }
  });
  await page.goto('http://peer.invalid/');
  const rendered = await page.evaluate(async (given) => {
    const { renderViews } = await import('/scene.js');
    return renderViews(given);
  }, settings);
  if (faults.length) throw new Error(faults.join('\n'));
  writeFileSync(output, JSON.stringify(rendered));
} finally {
  await browser.close();
}
