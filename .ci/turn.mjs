// Turns the drapes of a fit report in headless Chromium, over the pipe of its DevTools, without any library.
//   node turn.mjs PAGE.html GAPS.json FOLDER
// GAPS.json has rows of v_section_level: subject, size, simulator, level, mean_gap_mm, greatest_gap_mm. What the viewer says must
// be that; the page must log nothing and ask nothing of the network. Pictures for a look go to the folder.
import { spawn } from 'node:child_process';
import { readFileSync, writeFileSync, mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import { resolve, join } from 'node:path';
import { tmpdir } from 'node:os';

const [page, gaps, folder] = process.argv.slice(2);
const wanted = JSON.parse(readFileSync(gaps));
mkdirSync(folder, { recursive: true });
const profile = mkdtempSync(join(tmpdir(), 'turn-'));
const browser = spawn('chromium', ['--headless=new', '--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader', '--disable-background-networking', '--no-first-run', '--remote-debugging-pipe',
  `--user-data-dir=${profile}`, 'about:blank'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });

const waiting = new Map(), faults = [];
let count = 0, rest = '', session;
browser.stdio[4].on('data', bytes => {
  const messages = (rest + bytes).split('\0');
  rest = messages.pop();
  for (const message of messages) heard(JSON.parse(message));
});
function heard({ id, method, params, result, error }) {
  if (id) waiting.get(id)(error ? Promise.reject(new Error(JSON.stringify(error))) : result);
  else if (method === 'Network.requestWillBeSent' && !/^(file|data):/.test(params.request.url)) faults.push(`asks for ${params.request.url}`);
  else if (method === 'Log.entryAdded') faults.push(`logs ${params.entry.text}`);
  else if (method === 'Runtime.consoleAPICalled') faults.push(`writes to the console: ${params.args.map(a => a.value ?? a.description)}`);
  else if (method === 'Runtime.exceptionThrown') faults.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
}
const send = (method, params = {}) => new Promise(done => {
  waiting.set(++count, done);
  browser.stdio[3].write(JSON.stringify({ id: count, method, params, ...(session && { sessionId: session }) }) + '\0');
});
const pause = ms => new Promise(done => setTimeout(done, ms));
async function run(expression) {
  const { result, exceptionDetails } = await send('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true });
  if (exceptionDetails) throw new Error(exceptionDetails.exception.description);
  return result.value;
}
const settle = async () => { await pause(400); await run('new Promise(done => requestAnimationFrame(() => requestAnimationFrame(() => done())))'); };
const check = (what, right, found = '') => { if (!right) faults.push(`${what}: ${found}`); };

async function open(width, dark) {
  await send('Emulation.setDeviceMetricsOverride', { width, height: 1000, deviceScaleFactor: 1, mobile: width < 500 });
  await send('Emulation.setEmulatedMedia', { features: [{ name: 'prefers-color-scheme', value: dark ? 'dark' : 'light' }] });
  await send('Page.navigate', { url: 'file://' + resolve(page) });
  for (let i = 0; i < 100 && !await run(`!!document.querySelector('.viewer:not([hidden])')`); i++) await pause(100);
  await run(`document.querySelector('.viewer').scrollIntoView()`);
  await settle();
}
async function picture(name) {
  const { data } = await send('Page.captureScreenshot', { format: 'png' });
  writeFileSync(join(folder, name + '.png'), Buffer.from(data, 'base64'));
  return data;
}
async function press(choice, text) {
  const name = JSON.stringify(text);
  const found = await run(`(button => (button?.click(), !!button))([...document.querySelectorAll('[data-choice=${choice}] button')].find(b => b.textContent.toLowerCase() === ${name}))`);
  check(`a button ${text}`, found, 'there is none');
  await settle();
}
async function select(choice, value) {
  await run(`(box => { box.value = ${JSON.stringify(value)}; box.dispatchEvent(new Event('change', { bubbles: true })); })(document.querySelector('[data-choice=${choice}]'))`);
  await settle();
}
async function drag(dx, dy) {
  const { x, y } = await run(`(({ x, y, width, height }) => ({ x: x + width / 2, y: y + height / 2 }))(document.querySelector('.viewer canvas').getBoundingClientRect())`);
  const mouse = (type, x, y) => send('Input.dispatchMouseEvent', { type, x, y, button: 'left', buttons: type === 'mouseReleased' ? 0 : 1, clickCount: 1 });
  await mouse('mousePressed', x, y);
  for (let i = 1; i <= 5; i++) await mouse('mouseMoved', x + dx * i / 5, y + dy * i / 5);
  await mouse('mouseReleased', x + dx, y + dy);
  await settle();
}
const said = async () => { await pause(500); return run(`document.querySelector('.spoken').textContent`); };

// What the viewer says of the section at a level is what v_section_level has, within the step between their directions.
async function section(subject, level) {
  await select('subject', subject);
  await press('cut', level);
  const text = await said();
  for (const row of wanted.filter(row => row.subject === subject && row.level === level && row.simulator === 'fem')) {
    const [, mean] = text.match(new RegExp(`${row.size}, fem(?: wear)?: mean gap (-?\\d+) mm`)) ?? [];
    check(`mean gap of ${row.size} on ${subject} at the ${level}`, Math.abs(mean - row.mean_gap_mm) < 2, `${text} against ${row.mean_gap_mm}`);
  }
}

async function look() {
  for (const [name, width, dark] of [['wide', 1280, false], ['dark', 1280, true], ['phone', 390, false]]) {
    await open(width, dark);
    check(`${name}: shown`, !await run(`document.querySelector('.viewer').hidden`));
    check(`${name}: no wider than the window`, await run('document.documentElement.scrollWidth <= innerWidth'));
    const still = await picture(name);
    await drag(100, 30);
    check(`${name}: turned`, await picture(`${name}-turned`) !== still, 'the picture is the same');
    await press('map', 'gap');
    await picture(`${name}-gap`);
  }
  await open(1280, false);
  await section('v', 'hip');
  await picture('section');
  await section('v', 'waist');
  await press('cut', 'off');
  await select('line', 'half chest');
  check('the measurement is said', /\d+ mm flat, \d+ mm worn/.test(await said()), await said());
  await picture('measured');
  await press('beside', 'simulators');
  await picture('simulators');
}

const watchdog = setTimeout(() => { console.log('does not end'); browser.kill(); process.exit(1); }, 240000);
const { targetInfos } = await send('Target.getTargets');
({ sessionId: session } = await send('Target.attachToTarget', { targetId: targetInfos.find(t => t.type === 'page').targetId, flatten: true }));
for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await send(domain + '.enable');
await look().catch(error => faults.push(String(error)));
clearTimeout(watchdog);
const ended = new Promise(done => browser.on('exit', done));
await send('Browser.close').catch(() => {});
await ended;
rmSync(profile, { recursive: true, force: true, maxRetries: 5, retryDelay: 200 });
faults.forEach(fault => console.log(fault));
console.log(faults.length ? `${faults.length} faults` : 'turned, switched, sectioned, measured');
process.exit(faults.length ? 1 : 0);
