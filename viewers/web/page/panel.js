// The panel: one control for each attribute that the schema has, made from what the server says of it.

const UNITS = { micrometer: "µm", nanometer: "nm", degree: "°", "1/millimeter^2": "1/mm²" };
const TITLES = { layer: "Layer", profile: "Profile", curves: "Curves", wave: "Wave optics", measured: "Measured base", settings: "Render settings", surface: "Surface", light: "Light", camera: "Camera" };

const ECHO = 3000; // milliseconds that a value which was turned here waits for the server to have it

const short = (number) => Number(number.toPrecision(5)).toString();
const make = (tag, fields = {}, ...children) => {
  const element = Object.assign(document.createElement(tag), fields);
  element.append(...children);
  return element;
};

// A long slider is fine near zero: lengths in micrometres span decades.
const power = (control) => (control.low >= 0 && control.high - control.low > 50 && control.units !== "degree" ? 3 : 1);
const toSlider = (control, value) => {
  const share = (value - control.low) / (control.high - control.low || 1);
  return Math.sign(share) * Math.abs(share) ** (1 / power(control));
};
const fromSlider = (control, share) => {
  const value = control.low + (control.high - control.low) * share ** power(control);
  return control.kind === "whole" ? Math.round(value) : Number(value.toPrecision(6));
};

function range(control) {
  const low = control.least === null ? "(-∞" : (control.open_least ? "(" : "[") + short(control.least);
  const high = control.most === null ? "∞)" : short(control.most) + (control.open_most ? ")" : "]");
  return `${low}, ${high}`;
}

export function about(control) {
  const lines = [control.documentation || "(no documentation)"];
  if (["number", "whole"].includes(control.kind)) lines.push(`range ${range(control)}${unit(control) && ` ${unit(control)}`}`);
  if (control.default !== null) lines.push(`default ${JSON.stringify(control.default)}`);
  lines.push(control.id);
  return lines.join("\n");
}

const unit = (control) => UNITS[control.units] ?? control.units ?? "";

// One control; `change(id, value)` is called as it is turned, `show(value)` on the result puts another value in.
export function controlElement(control, change) {
  const told = (value) => change(control.id, value);
  const element = make("div", { className: "control" });
  element.dataset.id = control.id;
  const label = make("span", { className: "label", title: about(control) }, control.label);
  if (unit(control)) label.append(make("span", { className: "unit" }, ` ${unit(control)}`));
  label.addEventListener("click", () => {
    const shown = element.querySelector(".about");
    if (shown) shown.remove();
    else element.append(make("p", { className: "about" }, about(control)));
  });
  element.append(label);
  element.show = PARTS[control.kind](control, element, told);
  element.show(control.value);
  return element;
}

function numberParts(control, element, told) {
  const slider = make("input", { type: "range", min: 0, max: 1, step: control.kind === "whole" ? "any" : 0.001 });
  const box = make("input", { type: "number", step: "any" });
  slider.setAttribute("aria-label", control.label);
  box.setAttribute("aria-label", control.label);
  slider.addEventListener("input", () => {
    let value = fromSlider(control, Number(slider.value));
    if (control.open_least && value <= control.least) value = fromSlider(control, 0.001);
    if (control.open_most && value >= control.most) value = fromSlider(control, 0.999);
    box.value = short(value);
    told(value);
  });
  box.addEventListener("change", () => {
    const value = Number(box.value);
    if (box.value === "" || !Number.isFinite(value)) return;
    slider.value = toSlider(control, value);
    told(control.kind === "whole" ? Math.round(value) : value);
  });
  element.append(slider, box);
  return (value) => { // null: nothing is authored, and the schema has no default
    if (document.activeElement !== slider) slider.value = value === null ? 0 : toSlider(control, value);
    if (document.activeElement !== box) box.value = value === null ? "" : short(value);
  };
}

function switchParts(control, element, told) {
  const box = make("input", { type: "checkbox" });
  box.setAttribute("aria-label", control.label);
  box.addEventListener("change", () => told(box.checked));
  element.append(box);
  return (value) => { box.checked = value; };
}

function choiceParts(control, element, told) {
  const list = make("select", {}, ...control.choices.map((name) => make("option", { value: name }, name)));
  list.setAttribute("aria-label", control.label);
  list.addEventListener("change", () => told(list.value));
  element.append(make("span", { className: "wide" }, list));
  return (value) => { list.value = value; };
}

function vectorParts(control, element, told) {
  const boxes = control.value.map(() => make("input", { type: "number", step: "any" }));
  boxes.forEach((box, i) => {
    box.setAttribute("aria-label", `${control.label} ${"xyz"[i]}`);
    box.addEventListener("change", () => told(boxes.map((one) => Number(one.value))));
  });
  element.append(make("span", { className: "wide" }, ...boxes));
  return (value) => value.forEach((part, i) => { if (document.activeElement !== boxes[i]) boxes[i].value = short(part); });
}

function colorParts(control, element, told) {
  // linear to sRGB and back: a colour input shows what a screen shows
  const shown = (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
  const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);
  const picker = make("input", { type: "color" });
  picker.setAttribute("aria-label", control.label);
  const puts = vectorParts(control, element, told);
  if (control.high <= 1) {
    element.querySelector(".wide").prepend(picker);
    picker.addEventListener("input", () => {
      const value = [1, 3, 5].map((i) => Number(linear(parseInt(picker.value.slice(i, i + 2), 16) / 255).toPrecision(5)));
      puts(value);
      told(value);
    });
  }
  return (value) => {
    puts(value);
    const hex = value.map((c) => Math.round(255 * shown(Math.min(Math.max(c, 0), 1))).toString(16).padStart(2, "0"));
    if (document.activeElement !== picker) picker.value = `#${hex.join("")}`;
  };
}

function nameParts(control, element, told) {
  const box = make("input", { type: "text", maxLength: 200 });
  box.setAttribute("aria-label", control.label);
  box.addEventListener("change", () => told(box.value));
  element.append(make("span", { className: "wide" }, box));
  return (value) => { if (document.activeElement !== box) box.value = value ?? ""; };
}

function fixedParts(control, element) {
  const text = make("span", { className: "wide unit" });
  element.append(text);
  return (value) => { text.textContent = value || "(cannot be turned here)"; };
}

const PARTS = {
  number: numberParts, whole: numberParts, switch: switchParts, choice: choiceParts, pair: vectorParts, triple: vectorParts,
  color: colorParts, name: nameParts, fixed: fixedParts,
};

// The whole panel: a fold for each owner, layers of a material with their switch and arrows.
export class Panel {
  constructor(root, controls, change) {
    this.root = root;
    this.change = change;
    this.controls = new Map(controls.map((control) => [control.id, control]));
    this.elements = new Map();
    this.first = new Map(controls.map((control) => [control.id, JSON.stringify(control.value)]));
    this.folds = new Map();
    this.sent = new Map();
    const owners = new Map();
    for (const control of controls) {
      const key = `${control.section} ${control.owner}`;
      if (!owners.has(key)) owners.set(key, []);
      owners.get(key).push(control);
    }
    for (const [key, own] of owners) this.fold(key, own);
    this.order();
  }

  fold(key, own) {
    const { section, owner } = own[0];
    const fold = make("details", { open: this.folds.size === 0 });
    fold.dataset.owner = owner;
    const head = make("summary", {}, make("span", { className: "unit" }, TITLES[section]), make("span", { className: "name", title: owner }, owner.split("/").pop()));
    fold.append(head);
    if (section === "layer") this.layerHead(head, own);
    const fill = () => {
      if (!fold.open || fold.filled) return;
      fold.filled = true;
      for (const control of own) {
        const element = controlElement(control, (id, value) => this.turned(id, value));
        this.elements.set(control.id, element);
        fold.append(element);
        this.mark(control.id);
      }
    };
    fold.addEventListener("toggle", fill);
    this.root.append(fold);
    this.folds.set(key, { fold, own, section, owner });
    fill();
  }

  layerHead(head, own) {
    const named = (name) => own.find((control) => control.id.endsWith(`:${name}`));
    const enabled = named("enabled");
    const box = make("input", { type: "checkbox", checked: enabled.value, title: "rendered or not" });
    box.dataset.enabled = enabled.id;
    box.addEventListener("click", (event) => event.stopPropagation());
    box.addEventListener("change", () => this.turned(enabled.id, box.checked));
    head.prepend(box);
    for (const [sign, step, title] of [["↑", -1, "cut earlier"], ["↓", 1, "cut later, through those above"]]) {
      const arrow = make("button", { title }, sign);
      arrow.dataset.step = step;
      arrow.addEventListener("click", (event) => { event.preventDefault(); this.shift(own[0].owner, step); });
      head.append(arrow);
    }
  }

  layers(material) {
    const rows = [...this.folds.values()].filter((f) => f.section === "layer" && f.owner.split(" ")[0] === material);
    const order = (row) => this.controls.get(row.own.find((c) => c.id.endsWith(":order")).id).value;
    return rows.sort((a, b) => order(a) - order(b) || (a.owner < b.owner ? -1 : 1));
  }

  // Moves a layer among those of its material: all of them are numbered anew.
  shift(owner, step) {
    const rows = this.layers(owner.split(" ")[0]);
    const from = rows.findIndex((row) => row.owner === owner);
    const to = from + step;
    if (to < 0 || to >= rows.length) return;
    [rows[from], rows[to]] = [rows[to], rows[from]];
    rows.forEach((row, i) => this.turned(row.own.find((c) => c.id.endsWith(":order")).id, i));
    this.order();
  }

  // Shows the layers of each material in the order in which they cut.
  order() {
    const materials = new Set([...this.folds.values()].filter((f) => f.section === "layer").map((f) => f.owner.split(" ")[0]));
    for (const material of materials) {
      const rows = this.layers(material);
      const places = [...this.root.children].filter((child) => rows.some((row) => row.fold === child));
      rows.forEach((row, i) => {
        const place = places[i];
        if (place !== row.fold) { this.root.insertBefore(row.fold, place); places.splice(places.indexOf(row.fold), 1); places.splice(i, 0, row.fold); }
      });
    }
  }

  turned(id, value) {
    this.controls.get(id).value = value;
    this.sent.set(id, { value: JSON.stringify(value), until: Date.now() + ECHO });
    this.show(id, value);
    this.change(id, value);
  }

  show(id, value) {
    this.elements.get(id)?.show(value);
    const box = this.root.querySelector(`input[data-enabled="${CSS.escape(id)}"]`);
    if (box) box.checked = value;
    this.mark(id);
  }

  mark(id) {
    this.elements.get(id)?.classList.toggle("edited", JSON.stringify(this.controls.get(id).value) !== this.first.get(id));
  }

  // Values as the server has them. One that was turned here is left alone until the server has it, or does not take it.
  update(values) {
    for (const [id, value] of Object.entries(values)) {
      const control = this.controls.get(id), sent = this.sent.get(id);
      if (!control) continue;
      if (sent && sent.value !== JSON.stringify(value) && Date.now() < sent.until) continue;
      this.sent.delete(id);
      control.value = value;
      this.show(id, value);
    }
    this.order();
  }

  // What was turned here was refused: the server's values count again.
  refused() { this.sent.clear(); }
}
