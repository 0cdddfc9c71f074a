// Viewer of drapes in a report page.
'use strict';

const { abs, ceil, cos, sin, floor, hypot, max, min, round, PI } = Math;
const COLOURS = { fem: '#2a9d5c', hybrid: '#2f6fb7', other: '#8a62ad', skin: '#bdb6b0' };
const TAP = 14;  // px from a line at which a tap still means it
const DEEP = 25;  // mm that cloth may lie in the skin and still count as around it
const RAYS = 72;  // directions of gaps
const FIELD = .16;  // tangent of half the camera's field of view

const root = document.querySelector('.viewer');
const find = selector => root.querySelector(selector);
const [canvas, stage, slider, tick] = ['canvas', '.stage', '[type=range]', '[type=checkbox]'].map(find);
const data = JSON.parse(document.getElementById('drapes').textContent);
const [frontX, frontY] = data.front;

const state = { line: '', cut: null };
const gl = canvas.getContext('webgl2');
const camera = {};  // yaw, pitch, zoom, target, reach, rise; see reset()
const grid = {};  // columns, rows, width, height of a pane; see layout()
let panes = [], gpu;

// ---- Unpacking

async function unpack(text) {
	const packed = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
	const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('deflate-raw'));
	return new Uint8Array(await new Response(stream).arrayBuffer());
}

// 16-bit numbers: the low bytes of all, then the high bytes.
function words(bytes, count, plane = 0) {
	const low = bytes.subarray(2 * plane * count), high = low.subarray(count);
	return Uint16Array.from({ length: count }, (_, i) => low[i] | high[i] << 8);
}

const edge = (a, b) => min(a, b) * 65536 + max(a, b);

// The triangles, and for each vertex the three (a, b, o) that predict it as a + b - o.
async function openMesh({ indices: text, vertices, triangles }) {
	const indices = words(await unpack(text), 3 * triangles);
	const plan = new Int32Array(3 * vertices), across = new Map();
	let next = 0;
	for (let t = 0; t < indices.length; t += 3) {
		const before = next;
		for (let i = t; i < t + 3; i++) {
			indices[i] = next - indices[i];
			if (indices[i] === next) plan.fill(next - 1, 3 * next, 3 * ++next);
		}
		const [p, q, r] = indices.subarray(t, t + 3);
		for (const [a, b, c] of [[p, q, r], [q, r, p], [r, p, q]]) {
			const opposite = across.get(edge(a, b));
			if (next === before + 1 && c === before && opposite >= 0) plan.set([a, b, opposite], 3 * c);
			across.set(edge(a, b), c);
		}
	}
	return { indices, plan };
}

// Coordinates in mm, from residuals to what `predict` makes of those before.
function decode(bytes, count, { origin_mm: origin, step_mm: step }, predict) {
	const places = new Float32Array(3 * count);
	for (const axis of [0, 1, 2]) {
		const steps = new Int32Array(count);
		words(bytes, count, axis).forEach((word, i) => {
			steps[i] = (word >>> 1 ^ -(word & 1)) + (i && predict(steps, i));
			places[3 * i + axis] = origin[axis] + step * steps[i];
		});
	}
	return places;
}

async function openSurface(item) {
	const mesh = data.meshes[item.mesh], { indices, plan } = await (mesh.opened ??= openMesh(mesh));
	const places = decode(await unpack(item.positions), mesh.vertices, item,
		(steps, v) => steps[plan[3 * v]] + steps[plan[3 * v + 1]] - steps[plan[3 * v + 2]]);
	// Vertices at one place become one, so that a sewn seam is no edge.
	const first = {}, same = Array.from({ length: mesh.vertices }, (_, v) => first[places.subarray(3 * v, 3 * v + 3)] ??= v);
	const surface = { places, indices: indices.map(v => same[v]), maps: {} };
	surface.normals = normals(surface);
	surface.spans = [0, 1, 2].map(axis => span(places.filter((_, i) => i % 3 === axis)));
	return surface;
}

function openLine(drape, line) {
	return line.opened ??= unpack(line.points).then(bytes => decode(bytes, line.count, drape, (steps, i) => steps[i - 1]));
}

// Normals of vertices, weighted by area.
function normals({ places: p, indices }) {
	const sums = new Float32Array(p.length);
	for (let t = 0; t < indices.length; t += 3) {
		const [a, b, c] = [0, 1, 2].map(k => 3 * indices[t + k]);
		for (const [k, i, j] of [[0, 1, 2], [1, 2, 0], [2, 0, 1]]) {
			const n = (p[b + i] - p[a + i]) * (p[c + j] - p[a + j]) - (p[b + j] - p[a + j]) * (p[c + i] - p[a + i]);
			sums[a + k] += n, sums[b + k] += n, sums[c + k] += n;
		}
	}
	return sums;
}

function span(numbers) {
	let low = Infinity, high = -Infinity;
	for (const number of numbers) low = min(low, number), high = max(high, number);
	return [low, high];
}

// ---- Sections

// Outlines of a surface in a level plane, with area and centroid; a closed one ends where it begins.
function outlines({ places: p, indices }, height) {
	const after = new Map(), ends = new Set(), found = [];
	for (let t = 0; t < indices.length; t += 3) {
		let enter, leave;
		for (let i = 0; i < 3; i++) {
			const a = indices[t + i], b = indices[t + (i + 1) % 3], above = p[3 * a + 2] > height;
			if (above === p[3 * b + 2] > height) continue;
			if (above) leave = edge(a, b); else enter = edge(a, b);
		}
		if (enter) after.set(enter, leave), ends.add(leave);
	}
	const point = key => {
		const a = 3 * floor(key / 65536), b = 3 * (key % 65536), t = (height - p[a + 2]) / (p[b + 2] - p[a + 2]);
		return [p[a] + t * (p[b] - p[a]), p[a + 1] + t * (p[b + 1] - p[a + 1])];
	};
	const trace = start => {
		const points = [point(start)];
		let key = start;
		for (let next; (next = after.get(key)); key = next) {
			after.delete(key);
			points.push(point(next));
		}
		found.push({ points, closed: key === start, ...middle(points) });
	};
	[...after.keys()].filter(key => !ends.has(key)).forEach(trace);
	for (const key of after.keys()) trace(key);
	return found;
}

function middle(points) {
	let area = 0, x = 0, y = 0;
	points.forEach(([bx, by], i) => {
		const [ax, ay] = points.at(i - 1), part = (ax * by - bx * ay) / 2;
		area += part, x += part * (ax + bx) / 3, y += part * (ay + by) / 3;
	});
	return { area: abs(area), centre: [x / area, y / area] };
}

// Distances from a point at which a ray crosses a loop.
function hits({ points }, [x, y], dx, dy) {
	const turned = points.map(([px, py]) => [dx * (py - y) - dy * (px - x), dx * (px - x) + dy * (py - y)]);
	return turned.flatMap(([b, farB], i) => {
		const [a, farA] = turned[max(0, i - 1)], far = farA + (farB - farA) * a / (a - b);
		return a < 0 !== b < 0 && far > 0 ? far : [];
	});
}

const inside = (loop, point) => loop.closed && hits(loop, point, 1, 0).length % 2 > 0;

// Radial gaps between the trunk and the cloth around it; below the crotch of a leg, or of both where one cloth goes round.
function gapsOf(skin, cloth) {
	const [greatest] = [...skin].sort((a, b) => b.area - a.area);
	if (!greatest) return { near: [] };
	const [round] = cloth.filter(loop => inside(loop, greatest.centre)).sort((a, b) => a.area - b.area);
	const trunk = skin.filter(loop => loop.area > greatest.area / 2 && (loop === greatest || round && inside(round, loop.centre)));
	const [x, y] = [0, 1].map(axis => trunk.reduce((sum, { centre }) => sum + centre[axis] / trunk.length, 0));
	const sheath = cloth.filter(loop => !loop.closed || inside(loop, [x, y]));
	const rays = [];
	for (let k = 0; k < RAYS; k++) {
		const angle = 2 * PI * k / RAYS, dx = cos(angle), dy = sin(angle), reach = loop => hits(loop, [x, y], dx, dy);
		const from = max(...trunk.flatMap(reach)), to = min(...sheath.flatMap(reach).filter(far => far > from - DEEP));
		if (from > 0 && to < Infinity) rays.push({ gap: to - from, points: [from, to].map(far => [x + far * dx, y + far * dy]) });
	}
	const mean = rays.reduce((sum, ray) => sum + ray.gap / rays.length, 0);
	return { near: [...trunk, ...sheath], mean, widest: rays.sort((a, b) => b.gap - a.gap)[0] };
}

// ---- Drawing

function startGpu() {
	const source = name => find(`[data-shader=${name}]`).textContent;
	// What comes back starts the program for a view and gives what sets its uniforms.
	const program = name => {
		const made = gl.createProgram(), slots = {};
		for (const kind of ['VERTEX', 'FRAGMENT']) {
			const shader = gl.createShader(gl[kind + '_SHADER']);
			gl.shaderSource(shader, source('start') + source(`${name}-${kind.toLowerCase()}`));
			gl.compileShader(shader);
			gl.attachShader(made, shader);
		}
		gl.linkProgram(made);
		const put = (name, ...numbers) => gl[`uniform${numbers.length}f`](slots[name] ??= gl.getUniformLocation(made, name), ...numbers);
		return ({ frame, target, lens, away }) => {
			gl.useProgram(made);
			frame.forEach((way, i) => put(`frame[${i}]`, ...way));
			put('target', ...target), put('lens', ...lens), put('away', away), put('cut', state.cut ?? 1e9);
			return put;
		};
	};
	const points = gl.createBuffer();
	gl.bindBuffer(gl.ARRAY_BUFFER, points);
	for (const end of [0, 1]) {
		gl.enableVertexAttribArray(end);
		gl.vertexAttribPointer(end, 3, gl.FLOAT, false, 0, 12 * end);
		gl.vertexAttribDivisor(end, 1);
	}
	for (const what of [gl.DEPTH_TEST, gl.SCISSOR_TEST, gl.BLEND]) gl.enable(what);
	gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
	return { startSurface: program('surface'), startLine: program('line'), points, arrays: new Map() };
}

// Binds a surface, with the bytes of a map where one is chosen.
function bindSurface(surface, values) {
	const key = values ?? surface, known = gpu.arrays.get(key), array = known ?? gl.createVertexArray();
	gl.bindVertexArray(array);
	if (known) return;
	gpu.arrays.set(key, array);
	const fill = (target, bytes) => {
		gl.bindBuffer(target, gl.createBuffer());
		gl.bufferData(target, bytes, gl.STATIC_DRAW);
	};
	const attribute = (place, bytes, size, type) => {
		fill(gl.ARRAY_BUFFER, bytes);
		gl.enableVertexAttribArray(place);
		gl.vertexAttribPointer(place, size, type, true, 0, 0);
	};
	attribute(0, surface.places, 3, gl.FLOAT);
	attribute(1, surface.normals, 3, gl.FLOAT);
	if (values) attribute(2, values, 1, gl.UNSIGNED_BYTE);
	fill(gl.ELEMENT_ARRAY_BUFFER, surface.indices);
}

// The camera's right, up and backward directions, target, distance and lens.
function view() {
	const { width, height } = grid, { yaw, pitch, zoom, target, reach, rise } = camera, level = cos(pitch), tilt = sin(pitch);
	const x = frontX * cos(yaw) - frontY * sin(yaw), y = frontX * sin(yaw) + frontY * cos(yaw);
	const frame = [[-y, x, 0], [-x * tilt, -y * tilt, level], [x * level, y * level, tilt]];
	const away = zoom * (max(rise, reach * height / width) / FIELD + reach);
	return { frame, target, away, lens: [height / width / FIELD, 1 / FIELD], scale: height / 2 / FIELD };
}

let asked;
function redraw() {
	asked ??= requestAnimationFrame(draw);
}

function draw() {
	asked = null;
	if (!gpu) return;
	const ratio = min(devicePixelRatio, 2), { columns, rows, width, height } = grid, style = getComputedStyle(stage);
	const [ink, paper] = [style.color, style.backgroundColor].map(colour => colour.match(/[\d.]+/g).slice(0, 3).map(part => part / 255));
	const pixels = lengths => lengths.map(length => round(length * ratio));
	const size = pixels([columns * width, rows * height]), seen = { ...view(), ink, paper, ratio };
	if (size.join() !== [canvas.width, canvas.height].join()) [canvas.width, canvas.height] = size;
	gl.scissor(0, 0, ...size);
	gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
	panes.forEach((pane, i) => {
		const box = pixels([i % columns * width, (rows - 1 - floor(i / columns)) * height, width, height]);
		gl.viewport(...box);
		gl.scissor(...box);
		drawSurfaces(pane, seen);
		drawLines(pane, seen, box);
	});
}

function drawSurfaces({ drape, cloth, skin, values }, seen) {
	const { ink, paper } = seen, put = gpu.startSurface(seen);
	const surface = (item, map, ramp, inner, lift) => {
		bindSurface(item, map);
		put('inner', ...inner), put('lift', lift), put('last', ramp.length - 1);
		ramp.forEach((colour, i) => put(`ramp[${i}]`, ...[1, 3, 5].map(at => parseInt(colour.slice(at, at + 2), 16) / 255)));
		gl.drawElements(gl.TRIANGLES, item.indices.length, gl.UNSIGNED_SHORT, 0);
	};
	// Flat inside, a cut body looks filled. It stands 3 mm back from cloth that lies on it.
	const flat = paper.map((part, i) => .78 * part + .22 * ink[i]);
	if (skin && tick.checked) surface(skin, null, [COLOURS.skin], [...flat, 1], -3);
	surface(cloth, values, values ? data.scales[state.map].ramp : [colourOf(drape)], [0, 0, 0, .3], 0);
}

function drawLines({ cut, line }, seen, [, , width, height]) {
	const { ink, paper, ratio } = seen, put = gpu.startLine(seen);
	gl.bindVertexArray(null);
	gl.bindBuffer(gl.ARRAY_BUFFER, gpu.points);
	const stroke = (points, colour, alpha, thick, lift) => {
		gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(points), gl.DYNAMIC_DRAW);
		put('colour', ...colour, alpha), put('pane', width, height, thick * ratio), put('lift', lift);
		gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, points.length / 3 - 1);
	};
	const level = ({ points }) => points.flatMap(([x, y]) => [x, y, state.cut]);
	gl.depthMask(false);
	if (cut && tick.checked) cut.skin.forEach(loop => stroke(level(loop), ink, .6, 1.5, 4));
	if (cut) cut.cloth.forEach(loop => stroke(level(loop), ink, 1, 2, 6));
	if (line) {
		stroke(line, ink, .3, 2, 600);
		stroke(line, paper, 1, 5.5, 12);
		stroke(line, ink, 1, 2.5, 12);
	}
	gl.depthMask(true);
}

// ---- What is shown

const colourOf = ({ simulator }) => COLOURS[simulator] ?? COLOURS.other;
const levels = () => data.levels[state.subject] ?? [];
const kinds = (drapes, name) => [...new Set(drapes.map(drape => drape[name]))];

// Offers the values of a choice, as options of a select or as buttons of a group.
function offer(name, values, texts = values, useful = values.length > 1) {
	const box = find(`[data-choice=${name}]`), key = texts.join() + values, isSelect = box.matches('select');
	box.closest('.choice').hidden = !useful;
	if (box.dataset.key !== key) {
		box.dataset.key = key;
		box.replaceChildren(...values.map((value, i) => isSelect ? new Option(texts[i], value) : Object.assign(
			document.createElement('button'), { type: 'button', textContent: texts[i], onclick: () => set(name, value) })));
		box.onchange = () => set(name, box.value);
	}
	if (isSelect) box.value = state[name];
	else values.forEach((value, i) => box.children[i].setAttribute('aria-pressed', value === state[name]));
}

function set(name, value) {
	const off = value === null;
	if (name === 'cut' && off !== (state.cut === null)) camera.pitch = off ? .05 : .45;
	state[name] = value;
	if (name === 'cut') section(); else refresh();
}

// Falls to the first value where the chosen one is not offered.
function choose(name, values, texts) {
	if (!values.includes(state[name])) [state[name]] = values;
	offer(name, values, texts);
}

function narrow(drapes, name) {
	choose(name, kinds(drapes, name));
	return drapes.filter(drape => drape[name] === state[name]);
}

let turn = 0;
async function refresh() {
	const mine = ++turn, was = panes[0]?.drape, all = narrow(narrow(data.drapes, 'garment'), 'subject');
	const ways = ['size', 'simulator'].filter(name => kinds(all, name).length > 1);
	choose('beside', ways.length ? ways : ['size'], ways.map(name => name + 's'));
	state.size ??= all.find(drape => drape.wear)?.size;
	offer(state.beside, []);
	const shown = narrow(all, state.beside === 'size' ? 'simulator' : 'size');
	choose('map', ['plain', ...new Set(shown.flatMap(drape => Object.keys(drape.maps)))]);
	const lines = kinds(shown.flatMap(drape => drape.lines), 'name');
	choose('line', ['', ...lines], ['none', ...lines]);

	const opened = await Promise.all(shown.map(openPane));
	if (mine !== turn) return;
	panes = opened;
	find('.panes').replaceChildren(...panes.map(pane => pane.element));
	slider.max = ceil((panes[0].skin ?? panes[0].cloth).spans[2][1]);
	showScale(data.scales[state.map]);
	root.hidden = !gpu;
	layout();
	if (was?.garment !== state.garment || was.subject !== state.subject) reset();
	section();
}

async function openPane(drape) {
	const line = drape.lines.find(({ name }) => name === state.line), packed = drape.maps[state.map];
	const body = data.bodies.find(({ subject }) => subject === drape.subject);
	const [cloth, skin] = await Promise.all([drape, body].map(item => item && (item.surface ??= openSurface(item))));
	const element = find('template').content.firstElementChild.cloneNode(true), part = name => element.querySelector(name);
	element.style.setProperty('--cloth', colourOf(drape));
	part('b').textContent = `${drape.size}, ${drape.simulator}`;
	if (!drape.wear) part('.wear').remove();
	part('.measure').textContent = line?.text ?? '';
	return {
		drape, cloth, skin, element, part, line: line && await openLine(drape, line),
		values: packed && await (cloth.maps[state.map] ??= unpack(packed)),
	};
}

function showScale(scale) {
	find('.scale').hidden = !scale;
	if (!scale) return;
	const { label, unit, low, high, ramp } = scale, [name, from, bar, to] = find('.scale').children;
	[name.textContent, from.textContent, to.textContent] = [label, `${low} ${unit}`, `${high} ${unit}`];
	bar.style.background = `linear-gradient(90deg, ${ramp})`;
}

function layout() {
	const whole = stage.clientWidth, columns = min(panes.length, whole < 640 ? 2 : floor(whole / 200));
	const rows = ceil(panes.length / columns), width = whole / columns, height = min(rows > 1 ? 420 : 580, max(300, 2 * width));
	Object.assign(grid, { columns, rows, width, height });
	canvas.style.height = rows * height + 'px';
	stage.style.setProperty('--columns', columns);
	redraw();
}

let speaking;
function section() {
	const height = state.cut, on = height !== null, at = on ? `${round(height)} mm` : 'off', known = levels();
	const skin = on && panes[0].skin ? outlines(panes[0].skin, height) : [];
	offer('cut', [null, ...known.map(level => level.height_mm)], ['off', ...known.map(level => level.name)], true);
	slider.value = height ?? slider.max;
	find('output').textContent = at;
	for (const pane of panes) {
		const cloth = on && outlines(pane.cloth, height), { widest, mean } = pane.cut = on && { skin, cloth, ...gapsOf(skin, cloth) };
		const gap = widest ? `mean gap ${round(mean)} mm, greatest ${round(widest.gap)} mm` : 'no cloth here';
		pane.part('.gap').textContent = on ? gap : '';
	}
	drawInsets();
	const said = panes.map(({ element }) => [...element.querySelectorAll('p')].map(line => line.textContent.trim()).filter(Boolean).join(': '));
	if (on) said.unshift(`Section ${known.find(level => level.height_mm === height)?.name ?? ''} at ${at}`);
	clearTimeout(speaking);
	speaking = setTimeout(() => { find('.spoken').textContent = on || state.line ? said.join('. ') : ''; }, 400);
	redraw();
}

// Outlines from above, the front below, all panes to one scale.
function drawInsets() {
	const flat = ([x, y]) => [frontX * y - frontY * x, frontX * x + frontY * y].map(round);
	const path = loops => loops.map(({ points }) => 'M' + points.map(flat).join('L')).join('');
	const near = panes.flatMap(({ cut }) => cut ? cut.near : []).flatMap(({ points }) => points.map(flat));
	const [[left, right], [back, front]] = [0, 1].map(axis => span(near.map(point => point[axis])));
	for (const { part, cut } of panes) {
		part('figure').hidden = !cut || !near.length;
		if (part('figure').hidden) continue;
		part('svg').setAttribute('viewBox', [left - 15, back - 15, right - left + 30, front - back + 45]);
		const paths = { skin: path(cut.skin), cloth: path(cut.cloth), reach: path(cut.widest ? [cut.widest] : []), bar: `M${left} ${front + 27}h100` };
		for (const name in paths) part('.' + name).setAttribute('d', paths[name]);
	}
}

// ---- Input

function aim(changes) {
	Object.assign(camera, changes);
	redraw();
}

function reset() {
	const spans = [0, 1, 2].map(axis => span(panes.flatMap(({ cloth }) => cloth.spans[axis])));
	const [x, y, rise] = spans.map(([low, high]) => (high - low) / 2);
	aim({ yaw: 0, pitch: .05, zoom: 1.15, target: spans.map(([low, high]) => (low + high) / 2), reach: hypot(x, y), rise });
}

const rotate = (yaw, pitch) => aim({ yaw: camera.yaw + yaw, pitch: max(-1.5, min(1.5, camera.pitch + pitch)) });
const zoom = factor => aim({ zoom: max(.08, min(4, camera.zoom * factor)) });

function pan(dx, dy) {
	const { frame: [right, up], away, scale } = view();
	aim({ target: camera.target.map((place, axis) => place + (dy * up[axis] - dx * right[axis]) * away / scale) });
}

// Moves the section plane; at the top it is off.
const slice = height => set('cut', height < slider.max ? max(0, height) : null);
const shift = by => slice((state.cut ?? camera.target[2]) + by);

const held = new Map();
let moved = 0;
canvas.onpointerdown = event => {
	if (!held.size) moved = 0;
	canvas.setPointerCapture(event.pointerId);
	held.set(event.pointerId, event);
};
canvas.onpointermove = event => {
	const before = held.get(event.pointerId);
	if (!before) return;
	const other = [...held.values()].find(pointer => pointer !== before);
	const dx = event.x - before.x, dy = event.y - before.y;
	moved += hypot(dx, dy);
	held.set(event.pointerId, event);
	if (other) {
		const apart = ({ x, y }) => hypot(x - other.x, y - other.y);
		zoom(apart(before) / max(1, apart(event)));
		pan(dx / 2, dy / 2);
	} else if (event.shiftKey) pan(dx, dy);
	else rotate(-.008 * dx, .008 * dy);
};
canvas.onpointerup = event => {
	if (held.size === 1 && moved < 5) tap(event);
};
canvas.onlostpointercapture = event => held.delete(event.pointerId);
const keep = (type, wanted) => canvas.addEventListener(type, event => { if (wanted(event)) event.preventDefault(); }, { passive: false });
keep('touchmove', event => event.touches.length > 1);
keep('wheel', event => {
	const wanted = event.ctrlKey || document.activeElement === canvas;
	if (wanted) zoom(Math.exp(event.deltaY * .0015));
	return wanted;
});
canvas.ondblclick = reset;

// Chooses the measurement whose line is tapped.
async function tap({ offsetX, offsetY }) {
	const { columns, width, height } = grid, column = floor(offsetX / width), row = floor(offsetY / height);
	const { frame, target, away, scale } = view(), drape = panes[row * columns + column]?.drape;
	const x = offsetX - (column + .5) * width, y = (row + .5) * height - offsetY;
	let best = Infinity, chosen;
	for (const line of drape?.lines ?? []) {
		const points = await openLine(drape, line);
		let from;
		for (let i = 0; i < points.length; i += 3) {
			const [right, up, near] = frame.map(way => way.reduce((sum, part, axis) => sum + part * (points[i + axis] - target[axis]), 0));
			const to = [right, up].map(length => length * scale / (away - near));
			const [ax, ay] = from ?? to, dx = to[0] - ax, dy = to[1] - ay;
			const t = max(0, min(1, ((x - ax) * dx + (y - ay) * dy) / (dx * dx + dy * dy || 1)));
			const off = hypot(ax + t * dx - x, ay + t * dy - y), rank = off - near / 20;
			if (off <= TAP && rank < best) best = rank, chosen = line.name;
			from = to;
		}
	}
	if (chosen) set('line', chosen);
}

const KEYS = {
	ArrowLeft: () => rotate(.1, 0), ArrowRight: () => rotate(-.1, 0), ArrowUp: () => rotate(0, .1), ArrowDown: () => rotate(0, -.1),
	'+': () => zoom(.9), '-': () => zoom(1 / .9),
	PageUp: () => shift(10), PageDown: () => shift(-10),
	1: () => aim({ yaw: 0 }), 2: () => aim({ yaw: PI / 2 }), 3: () => aim({ yaw: PI }), 0: reset,
	m: () => (find('[data-choice=map] [aria-pressed=true] + *') ?? find('[data-choice=map] *')).click(),
};
canvas.onkeydown = event => {
	if (!KEYS[event.key] || event.ctrlKey || event.metaKey || event.altKey) return;
	event.preventDefault();
	KEYS[event.key]();
};

// ---- Start

slider.oninput = () => {
	slice(levels().map(level => level.height_mm).find(height => abs(height - slider.value) < 8) ?? +slider.value);
};
tick.onchange = redraw;
for (const button of root.querySelectorAll('[data-key]')) button.onclick = KEYS[button.dataset.key];
canvas.addEventListener('webglcontextlost', event => { event.preventDefault(); gpu = null; });
canvas.addEventListener('webglcontextrestored', () => { gpu = startGpu(); redraw(); });
matchMedia('(prefers-color-scheme: dark)').onchange = redraw;

if (gl) {
	gpu = startGpu();
	refresh().then(() => new ResizeObserver(layout).observe(stage)).catch(() => { root.hidden = true; });
}
