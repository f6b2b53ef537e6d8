// The page: a picture that refines, and what is asked of the server as it is dragged.

import { Panel } from "/panel.js";

const at = (id) => document.getElementById(id);
const shown = { picture: -1, version: -1, edits: -1 };
let panel = null;

async function ask(path, body) {
  const options = body === undefined ? {} : { method: "POST", headers: { "Content-Type": "application/json" }, body: JSON.stringify(body) };
  const answer = await fetch(path, options);
  if (!answer.ok) throw new Error(await answer.text());
  return answer.json();
}

const say = (text) => { at("message").textContent = text; };

// At most one request of a kind is under way; what comes meanwhile is merged and sent after it.
function sender(path, merge) {
  let waiting = null, busy = false;
  const flush = async () => {
    busy = true;
    while (waiting !== null) {
      const body = waiting;
      waiting = null;
      try { await ask(path, body); } catch (error) { say(error.message); }
    }
    busy = false;
  };
  return (body) => {
    waiting = waiting === null ? body : merge(waiting, body);
    if (!busy) flush();
  };
}

const sendEdit = sender("/edit", (a, b) => ({ values: { ...a.values, ...b.values } }));
const movers = new Map();
function sendMove(body) {
  if (!movers.has(body.prim)) {
    movers.set(body.prim, sender("/move", (a, b) => ({
      prim: a.prim, right: a.right + b.right, up: a.up + b.up, across: a.across + b.across, along: a.along + b.along, nearer: a.nearer * b.nearer,
    })));
  }
  movers.get(body.prim)({ right: 0, up: 0, across: 0, along: 0, nearer: 1, ...body });
}

function showState(state) {
  Object.assign(shown, { version: state.version, edits: state.edits });
  at("samples").textContent = state.samples ? `${state.samples} of ${state.spp} samples` : "preview";
  at("progress").value = state.spp ? state.samples / state.spp : 0;
  at("redone").textContent = state.redone && `redone: ${state.redone}`;
  say(state.message);
  if (state.picture !== shown.picture) {
    shown.picture = state.picture;
    at("after").src = `/picture?v=${state.picture}`;
    at("after").dataset.picture = state.picture;
    if (!dragging) at("preview").hidden = true;
  }
  // the first one, hidden, opens the 3D view, so that a drag need not wait for it
  if (state.samples ? solid.edits < 0 : dragging && state.edits !== solid.edits) showSolid(state.edits);
  at("picture").style.aspectRatio = `${state.size[0]} / ${state.size[1]}`;
}

// While the camera or a light is dragged the 3D view lies over the picture, which refines below it.
let dragging = false;
const solid = { edits: -1, busy: false };
async function showSolid(edits) {
  if (solid.busy || !at("solid").checked) return;
  Object.assign(solid, { edits, busy: true });
  const image = new Image();
  image.src = `/preview?edits=${edits}&${Date.now()}`;
  try {
    await image.decode();
    at("preview").src = image.src;
    at("preview").hidden = !dragging;
  } catch { at("solid").checked = false; }
  solid.busy = false;
}

async function follow() {
  for (;;) {
    try {
      const state = await ask(`/changes?after=${shown.version}&edits=${shown.edits}`);
      showState(state);
      if (state.values) {
        if (state.message) panel.refused();
        panel.update(state.values);
      }
      if (state.before) showBefore();
    } catch (error) {
      say(`no answer: ${error.message}`);
      await new Promise((resolve) => setTimeout(resolve, 1000));
    }
  }
}

let beforeAsked = false;
function showBefore(again = false) {
  if (beforeAsked && !again) return;
  beforeAsked = true;
  at("before").src = `/before?${Date.now()}`;
}

function split() {
  const share = Number(at("split").value);
  at("before").hidden = at("line").hidden = share === 0;
  at("before").style.clipPath = `inset(0 ${100 * (1 - share)}% 0 0)`;
  at("line").style.left = `${100 * share}%`;
}

function drags() {
  const picture = at("picture");
  let last = null, moved = 0;
  picture.addEventListener("pointerdown", (event) => {
    last = [event.clientX, event.clientY];
    moved = 0;
    picture.setPointerCapture(event.pointerId);
  });
  picture.addEventListener("pointermove", (event) => {
    if (!last) return;
    const box = picture.getBoundingClientRect();
    const dx = (event.clientX - last[0]) / box.width, dy = (event.clientY - last[1]) / box.height;
    moved += Math.abs(event.clientX - last[0]) + Math.abs(event.clientY - last[1]);
    last = [event.clientX, event.clientY];
    const mode = at("mode").value;
    if (mode === "pick" || (!dx && !dy)) return;
    const shift = event.shiftKey && mode === "camera";
    const prim = mode === "camera" ? "" : mode;
    dragging = true;
    sendMove(shift ? { prim, across: dx, along: dy } : { prim, right: Math.PI * dx, up: -Math.PI * (prim ? 1 : -1) * dy });
  });
  picture.addEventListener("pointerup", (event) => {
    if (last && moved < 4) {
      const box = picture.getBoundingClientRect();
      pick((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
    }
    last = null;
    dragging = false;
  });
  picture.addEventListener("wheel", (event) => {
    event.preventDefault();
    const mode = at("mode").value;
    if (mode !== "pick") sendMove({ prim: mode === "camera" ? "" : mode, nearer: Math.exp(-0.001 * event.deltaY) });
  }, { passive: false });
  at("mode").addEventListener("change", () => picture.classList.toggle("pick", at("mode").value === "pick"));
}

async function pick(x, y) {
  if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return;
  const mark = at("mark");
  mark.hidden = false;
  mark.style.left = `${100 * x}%`;
  mark.style.top = `${100 * y}%`;
  try { showPixel(await ask("/pick", { x, y })); } catch (error) { say(error.message); }
}

const make = (tag, text = "", ...children) => {
  const element = document.createElement(tag);
  element.textContent = text;
  element.append(...children);
  return element;
};
const row = (head, ...cells) => make("tr", "", make("th", head), ...cells.map((cell) => make("td", "", cell)));
const digits = (n, count = 4) => (n === null ? "∞" : Number(n.toPrecision(count)).toString());
// parts are differences of sums: what is left of nothing is nothing
const color = (rgb) => rgb.map((c) => (Math.abs(c) < 1e-5 ? "0" : digits(c, 3))).join("  ");
const length = (um) => (um >= 1000 ? `${digits(um / 1000)} mm` : `${digits(um)} µm`);

function showPixel(pixel) {
  const facts = make("table");
  facts.append(
    row("surface", pixel.prim || "nothing"), row("material", pixel.material || "none"),
    row("radiance", `${color(pixel.radiance)}  ± ${digits(pixel.noise, 2)}`),
    row("of it base", color(pixel.base)), row("scratches", color(pixel.scratches)), row("emission", color(pixel.emission)),
  );
  if (pixel.prim) facts.append(
    row("distance", `${digits(pixel.distance)} m`),
    row("footprint", `${length(pixel.footprint[0])} by ${length(pixel.footprint[1])}`),
    row("position", pixel.position.map((p) => digits(p)).join("  ") + " m"),
  );
  const layers = make("table");
  layers.id = "layers";
  for (const layer of pixel.layers) {
    const cells = [`adds ${color(layer.radiance)}`, `viewer at θ ${digits(layer.theta, 3)}°, φ ${digits(layer.phi, 3)}°; lit from θ ${digits(-layer.theta, 3)}°`];
    layers.append(row(layer.name, ...cells, layer.lobe.length ? lobe(layer) : "Lambert"));
  }
  const effects = make("table");
  for (const [name, why] of pixel.effects) effects.append(row(name, why));
  const parts = [make("h2", `pixel ${pixel.pixel.join(", ")}`), facts];
  if (pixel.layers.length) parts.push(make("h2", "layers, with their lobes of φ on the mirror cone"), layers);
  parts.push(make("h2", "effects that made it"), effects);
  at("pixel").replaceChildren(...parts);
  at("pixel").hidden = false;
}

// rho over phi from -90 to 90 degrees, polar: the normal points up.
function lobe(layer) {
  const space = "http://www.w3.org/2000/svg";
  const svg = document.createElementNS(space, "svg");
  const most = Math.max(...layer.lobe, 1e-9);
  const points = layer.lobe.map((rho, i) => {
    const angle = layer.angles[i] * Math.PI / 180, radius = 44 * Math.sqrt(rho / most);
    return `${(60 + radius * Math.sin(angle)).toFixed(1)},${(50 - radius * Math.cos(angle)).toFixed(1)}`;
  });
  const view = layer.phi * Math.PI / 180;
  const shapes = [
    ["line", { x1: 10, y1: 50, x2: 110, y2: 50, stroke: "#8d95a1" }],
    ["line", { x1: 60, y1: 50, x2: 60 + 46 * Math.sin(view), y2: 50 - 46 * Math.cos(view), stroke: "#56b4e9" }],
    ["polygon", { points: ["60,50", ...points].join(" "), fill: "#e69f0055", stroke: "#e69f00" }],
  ];
  for (const [name, fields] of [["title", {}], ...shapes]) {
    const shape = document.createElementNS(space, name);
    for (const [key, value] of Object.entries(fields)) shape.setAttribute(key, value);
    if (name === "title") shape.textContent = "reflectance over φ_i (root scale, orange), the viewer (blue)";
    svg.append(shape);
  }
  svg.setAttribute("width", 120);
  svg.setAttribute("height", 58);
  return svg;
}

function buttons() {
  const act = (id, work) => at(id).addEventListener("click", async () => {
    try { await work(); } catch (error) { say(error.message); }
  });
  act("keep", async () => { await ask("/before", {}); showBefore(true); });
  act("reset", () => ask("/reset", {}));
  act("save", async () => { const { saved } = await ask("/save", {}); at("redone").textContent = `saved ${saved}`; });
  act("link", async () => { const { link } = await ask("/link", {}); at("redone").textContent = link; });
  at("split").addEventListener("input", split);
}

async function start() {
  const state = await ask("/state");
  at("stage").textContent = document.title = state.stage.split("/").pop();
  at("save").title = `write the edits to ${state.target}`;
  panel = new Panel(at("panel"), state.controls, (id, value) => sendEdit({ values: { [id]: value } }));
  for (const light of new Set(state.controls.filter((c) => c.section === "light").map((c) => c.owner))) {
    const option = make("option", `light ${light.split("/").pop()}`);
    option.value = light;
    at("mode").insertBefore(option, at("mode").lastElementChild);
  }
  at("solid").hidden = !state.preview;
  at("solid").checked = state.preview;
  drags();
  buttons();
  split();
  showState(state);
  document.body.dataset.ready = "yes";
  follow();
}

start().catch((error) => say(error.message));
