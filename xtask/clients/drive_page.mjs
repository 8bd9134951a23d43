// Drives the map page of `orogen serve`: node drive_page.mjs MODULES URL FOLDER writes screenshots into FOLDER and prints what it
// found as JSON.
import path from 'node:path';
import { open, watched } from './browser.mjs';

const [, url, folder] = process.argv.slice(2);
const found = {};
const browser = await open();
const { page, wrong, close } = await watched(browser, [1000, 640], new URL(url).host, { locale: 'en-US', colorScheme: 'light' });

/** Waits until the map has drawn everything. */
const still = () => page.waitForFunction(() => document.body.dataset.still === 'true');
/** Changes something, and takes a picture when it is drawn. */
async function shot(name, act) {
  // Without a change nothing would be drawn again: the map may be still already.
  if (act) {
    await page.evaluate(() => { document.body.dataset.still = 'false'; });
    await act();
    await page.evaluate(() => window.dispatchEvent(new Event('resize')));
  }
  await still();
  await page.screenshot({ path: path.join(folder, `${name}.png`), timeout: 240_000 });
}
const slide = (id, value) => page.locator(`#${id}`).evaluate((slider, to) => {
  slider.value = to;
  slider.dispatchEvent(new Event('input', { bubbles: true }));
}, value);
const text = (id) => page.textContent(`#${id}`);

await page.goto(url);
await page.waitForSelector('body[data-ready=true]');
await shot('start');
found.title = await page.title();

// A map from above: north is up, a sun from the north-west, then from the south-east.
await shot('flat', async () => {
  await page.goto('about:blank');
  await page.goto(`${url}#relief3d=0`);
  await page.waitForSelector('body[data-ready=true]');
});
await shot('sun', () => slide('azimuth', 135));
await shot('palette', async () => {
  await slide('azimuth', 315);
  await page.selectOption('#palette', 'grey');
});
await shot('contours', async () => {
  await page.selectOption('#palette', '');
  await page.check('#contours');
  await page.check('#summits');
});
await shot('layer', async () => {
  await page.uncheck('#contours');
  await page.uncheck('#summits');
  await page.selectOption('#layer', 'slope');
});
await page.selectOption('#layer', 'height');

// The height under the pointer is that of the server.
await page.mouse.move(650, 300);
await page.waitForTimeout(300);
await page.waitForFunction(() => / m$/.test(document.getElementById('here').textContent));
found.here = await text('here');

// Search.
await page.selectOption('#question', 'highest-summit');
await page.click('#search button[type=submit]');
await page.waitForSelector('#found li');
found.places = await page.locator('#found li').allTextContents();

// A profile of three points.
await shot('profile', async () => {
  await page.click('summary[data-text=profile]');
  await page.click('#profile-start');
  await page.mouse.click(500, 250);
  await page.mouse.click(700, 350);
  await page.mouse.dblclick(820, 260);
  await page.waitForSelector('#chart svg path.ground');
});
found.profile = await page.textContent('#chart title');
await page.keyboard.press('Escape');
await page.waitForSelector('#chart', { state: 'hidden' });

// A download.
await page.click('summary[data-text=download]');
await page.selectOption('#samples', '256');
const files = [];
for (const format of ['tif', 'glb', 'npy']) {
  await page.selectOption('#format', format);
  const [download] = await Promise.all([page.waitForEvent('download'), page.click('#download')]);
  const file = path.join(folder, download.suggestedFilename());
  await download.saveAs(file);
  files.push(file);
}
found.files = files;
const [picture] = await Promise.all([page.waitForEvent('download'), page.click('#picture')]);
await picture.saveAs(path.join(folder, 'picture.png'));

// The link shows the same.
await page.click('summary[data-text=share]');
found.link = await page.inputValue('#link');
const second = await watched(browser, [1000, 640], new URL(url).host, { locale: 'en-US', colorScheme: 'light' });
await second.page.goto(found.link);
await second.page.waitForSelector('body[data-ready=true]');
found.again = await second.page.inputValue('#link');
await second.close();

// Chinese.
await shot('chinese', async () => {
  await page.click('#language');
  await page.waitForFunction(() => document.documentElement.lang === 'zh-CN');
});
found.chinese = await page.locator('summary').allTextContents();

// Keys: the map moves and turns, and the middle is read out.
await page.locator('#map canvas').focus();
const before = found.link;
for (const key of ['ArrowRight', 'Shift+ArrowRight', '=']) {
  await page.keyboard.press(key);
  await page.waitForTimeout(600);
}
await page.waitForFunction((link) => document.getElementById('link').value !== link, before);
await page.waitForFunction(() => document.getElementById('spoken').textContent.length > 5);
found.spoken = await text('spoken');
await page.keyboard.press('/');
found.focus = await page.evaluate(() => document.activeElement.id);
await close();

// A phone in the dark: the panel opens from below.
const phone = await watched(browser, [390, 780], new URL(url).host, { hasTouch: true, isMobile: true, colorScheme: 'dark', locale: 'zh-CN' });
await phone.page.goto(url);
await phone.page.waitForSelector('body[data-ready=true]');
found.hidden = await phone.page.isHidden('#panel');
await phone.page.tap('#open');
await phone.page.waitForFunction(() => document.body.dataset.still === 'true');
await phone.page.screenshot({ path: path.join(folder, 'phone.png'), timeout: 240_000 });
found.language = await phone.page.evaluate(() => document.documentElement.lang);
found.wrong = [...wrong, ...second.wrong, ...phone.wrong];
await browser.close();
console.log(JSON.stringify(found));
