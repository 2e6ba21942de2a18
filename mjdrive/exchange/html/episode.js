"use strict";
const episode = JSON.parse(document.getElementById("episode").textContent);
const last = episode.time.length - 1;
const COLOUR = { ground: "#f4f5f7", road: "#ced3d9", line: "#8c959f", car: "#0969da", ink: "#1f2328", steering: "#bc4c00" };
const SIGNALS = ["#2da44e", "#dbab09", "#cf222e"]; // green, yellow, red
const element = (id) => document.getElementById(id);
let step = 0, playing = false, before = 0, elapsed = 0;

// The town, drawn once.
const map = element("map"), [west, south, east, north] = episode.town.bounds;
const margin = 12, side = Math.max(east - west, north - south) + 2 * margin, zoom = map.width / side;
const column = (x) => map.width / 2 + (x - (west + east) / 2) * zoom;
const row = (y) => map.height / 2 - (y - (south + north) / 2) * zoom;
const ground = document.createElement("canvas");
ground.width = map.width; ground.height = map.height;
{
  const pen = ground.getContext("2d");
  pen.fillStyle = COLOUR.ground; pen.fillRect(0, 0, map.width, map.height);
  pen.fillStyle = pen.strokeStyle = COLOUR.road;
  for (const lane of episode.town.lanes) {
    pen.beginPath();
    for (const [x, y] of lane) pen.lineTo(column(x), row(y));
    pen.closePath(); pen.fill(); pen.stroke();
  }
}

function shown(light) {
  let signal = 0;
  for (const [from, what] of light.shows) if (from <= step) signal = what;
  return signal;
}

function drawMap() {
  const pen = map.getContext("2d");
  pen.drawImage(ground, 0, 0);
  pen.lineWidth = 4;
  for (const light of episode.town.lights) {
    pen.strokeStyle = SIGNALS[shown(light)];
    pen.beginPath();
    for (const [x, y] of light.line) pen.lineTo(column(x), row(y));
    pen.stroke();
  }
  pen.strokeStyle = COLOUR.car; pen.lineWidth = 3; pen.beginPath();
  for (let index = 0; index <= step; index++) pen.lineTo(column(episode.path[index][0]), row(episode.path[index][1]));
  pen.stroke();
  for (const it of episode.infractions) {
    pen.globalAlpha = it.time <= episode.time[step] + 1e-6 ? 1 : 0.3;
    pen.fillStyle = it.colour; pen.strokeStyle = "#fff"; pen.lineWidth = 2;
    pen.beginPath(); pen.arc(column(it.x), row(it.y), 8, 0, 2 * Math.PI); pen.fill(); pen.stroke();
  }
  pen.globalAlpha = 1;
  const [x, y, yaw] = episode.path[step];
  pen.save(); pen.translate(column(x), row(y)); pen.rotate(-yaw);
  pen.fillStyle = COLOUR.ink; pen.beginPath();
  pen.moveTo(16, 0); pen.lineTo(-10, 10); pen.lineTo(-10, -10); pen.closePath(); pen.fill();
  pen.restore();
}

// The bird's-eye view: one byte a pixel, road in bit 0, lane lines in bit 1, lights now in bits 6 and 7.
const view = element("view"), size = episode.view.size, small = new OffscreenCanvas(size, size);
const rgb = (hex) => [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16));
const lookUp = Array.from({ length: 256 }, (_, code) => {
  if (code >> 6) return rgb(SIGNALS[(code >> 6) - 1]);
  return rgb(code & 2 ? COLOUR.line : code & 1 ? COLOUR.road : COLOUR.ground);
});

async function unpacked(index) {
  const bytes = Uint8Array.from(atob(episode.views[index]), (letter) => letter.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

async function drawView() {
  const wanted = step, codes = await unpacked(wanted);
  if (wanted !== step) return; // somebody has gone on meanwhile
  const pen = small.getContext("2d"), image = pen.createImageData(size, size);
  codes.forEach((code, index) => { image.data.set(lookUp[code], 4 * index); image.data[4 * index + 3] = 255; });
  pen.putImageData(image, 0, 0);
  const large = view.getContext("2d"), times = view.width / size, metre = episode.view.scale * times;
  large.imageSmoothingEnabled = false;
  large.drawImage(small, 0, 0, view.width, view.height);
  const tail = episode.view.rear * times + episode.view.overhang * metre;
  const nose = tail - episode.view.length * metre, wide = episode.view.width * metre;
  large.fillStyle = COLOUR.car; large.fillRect(view.width / 2 - wide / 2, nose, wide, tail - nose);
  large.fillStyle = COLOUR.ground;
  large.fillRect(view.width / 2 - 0.4 * wide, nose + 0.3 * (tail - nose), 0.8 * wide, 4);
}

// Charts over all of the time.
function drawChart(id, low, high, lines) {
  const canvas = element(id), pen = canvas.getContext("2d"), { width, height } = canvas;
  const across = (index) => 6 + (index / Math.max(last, 1)) * (width - 12);
  const down = (value) => height - 8 - ((value - low) / (high - low)) * (height - 16);
  pen.fillStyle = "#fff"; pen.fillRect(0, 0, width, height);
  pen.strokeStyle = "#d0d7de"; pen.lineWidth = 1; pen.beginPath();
  pen.moveTo(0, down(0)); pen.lineTo(width, down(0)); pen.stroke();
  for (const it of episode.infractions) {
    const at = across((it.time - episode.time[0]) / (episode.time[last] - episode.time[0] || 1) * last);
    pen.strokeStyle = it.colour; pen.lineWidth = 2; pen.beginPath(); pen.moveTo(at, 0); pen.lineTo(at, height); pen.stroke();
  }
  for (const [colour, value] of lines) {
    pen.strokeStyle = colour; pen.lineWidth = 2; pen.beginPath();
    for (let index = 0; index <= last; index++) pen.lineTo(across(index), down(value(index)));
    pen.stroke();
  }
  pen.strokeStyle = COLOUR.ink; pen.lineWidth = 1.5; pen.beginPath();
  pen.moveTo(across(step), 0); pen.lineTo(across(step), height); pen.stroke();
}

const fastest = Math.max(10, ...episode.speed.map((speed) => 3.6 * speed)) * 1.05;
const slowest = Math.min(0, ...episode.speed.map((speed) => 3.6 * speed));

function draw() {
  drawMap(); drawView();
  drawChart("speed", slowest, fastest, [[COLOUR.car, (index) => 3.6 * episode.speed[index]]]);
  drawChart("actions", -1.05, 1.05, [[COLOUR.car, (index) => episode.actions[index][0]], [COLOUR.steering, (index) => episode.actions[index][1]]]);
  const [acceleration, steering] = episode.actions[step], now = episode.time[step];
  element("speed-text").textContent = `speed ${(3.6 * episode.speed[step]).toFixed(1)} km/h`;
  element("actions-text").textContent = `blue: acceleration ${acceleration.toFixed(2)}; orange: steering ${steering.toFixed(2)}, left is up`;
  element("clock").textContent = `${now.toFixed(1)} s`;
  element("scrubber").value = String(step);
  const told = episode.infractions.filter((it) => it.time <= now + 1e-6 && now - it.time < 2).at(-1);
  element("told").textContent = told ? `${told.words} (${told.cause})` : "";
  element("told").style.color = told ? told.colour : "";
}

function go(to) { step = Math.min(Math.max(Math.round(to), 0), last); elapsed = episode.time[step]; draw(); }
function stepAt(time) { const at = episode.time.findIndex((it) => it >= time - 1e-6); return at < 0 ? last : at; }
function play(on) {
  playing = on; before = 0;
  element("play").textContent = on ? "\u275A\u275A" : "\u25B6";
  element("play").setAttribute("aria-label", on ? "Pause" : "Play");
  if (on && step === last) go(0);
  if (on) requestAnimationFrame(tick);
}
function tick(now) {
  if (!playing) return;
  if (before) {
    elapsed += ((now - before) / 1000) * Number(element("rate").value);
    let next = step;
    while (next < last && episode.time[next + 1] <= elapsed) next++;
    if (next !== step) { step = next; draw(); }
  }
  before = now;
  if (step === last) play(false); else requestAnimationFrame(tick);
}

element("scrubber").max = String(last);
element("scrubber").addEventListener("input", (event) => go(Number(event.target.value)));
element("play").addEventListener("click", () => play(!playing));
for (const id of ["speed", "actions"])
  element(id).addEventListener("click", (event) => go((event.offsetX / event.target.clientWidth) * last));
map.addEventListener("click", (event) => {
  const scale = map.width / map.clientWidth, x = event.offsetX * scale, y = event.offsetY * scale;
  const hit = episode.infractions.find((it) => Math.hypot(column(it.x) - x, row(it.y) - y) < 14);
  if (hit) go(stepAt(hit.time));
});
for (const it of episode.infractions) {
  const item = document.createElement("li"), button = document.createElement("button");
  button.type = "button"; button.textContent = `${it.time.toFixed(1)} s: ${it.words} (${it.cause})`;
  button.style.setProperty("--colour", it.colour);
  button.addEventListener("click", () => go(stepAt(it.time)));
  item.append(button); element("infractions").append(item);
}
document.addEventListener("keydown", (event) => {
  const typing = ["SELECT", "BUTTON"].includes(event.target.tagName);
  if (event.key === " " && !typing) { event.preventDefault(); play(!playing); }
  if (event.key === "ArrowRight" && !typing) { event.preventDefault(); go(step + 1); }
  if (event.key === "ArrowLeft" && !typing) { event.preventDefault(); go(step - 1); }
});
const asked = Number(new URLSearchParams(location.hash.slice(1)).get("t"));
go(asked > 0 ? stepAt(asked) : 0);
