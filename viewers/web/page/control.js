// One control: an attribute with its unit, range, default and documentation, made from what its schema says.

const UNITS = { micrometer: "µm", nanometer: "nm", degree: "°", "1/millimeter^2": "1/mm²" };

const short = (number) => Number(number.toPrecision(5)).toString();

// A long slider is fine near zero: lengths in micrometres span decades.
const power = (control) => (control.low >= 0 && control.high - control.low > 50 && control.units !== "degree" ? 3 : 1);

// A colour input shows what a screen shows: linear to sRGB and back.
const shown = (c) => (c <= 0.0031308 ? 12.92 * c : 1.055 * c ** (1 / 2.4) - 0.055);
const linear = (c) => (c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4);

function range(control) {
  const low = control.least === null ? "(-∞" : (control.open_least ? "(" : "[") + short(control.least);
  const high = control.most === null ? "∞)" : short(control.most) + (control.open_most ? ")" : "]");
  return `${low}, ${high}`;
}

export const Control = {
  name: "Control",
  props: ["control", "value", "edited"],
  emits: ["turn"],
  data: () => ({ told: false }),
  template: `
<div class="control" :class="{ edited }" :data-id="control.id">
  <span class="label" :title="about" @click="told = !told">{{ control.label }}<span v-if="unit" class="unit">{{ unit }}</span></span>
  <template v-if="control.kind === 'number' || control.kind === 'whole'">
    <input type="range" min="0" max="1" :step="control.kind === 'whole' ? 'any' : 0.001" :aria-label="control.label" :value="share" @input="slid">
    <input type="number" step="any" :aria-label="control.label" :value="value === null ? '' : short(value)" @change="typed">
  </template>
  <input v-else-if="control.kind === 'switch'" type="checkbox" :aria-label="control.label" :checked="value" @change="turn($event.target.checked)">
  <span v-else-if="control.kind === 'choice'" class="wide">
    <select :aria-label="control.label" :value="value" @change="turn($event.target.value)">
      <option v-for="name of control.choices" :key="name" :value="name">{{ name }}</option>
    </select>
  </span>
  <span v-else-if="['pair', 'triple', 'color'].includes(control.kind)" class="wide">
    <input v-if="control.kind === 'color' && control.high <= 1" type="color" :aria-label="control.label" :value="hex" @input="picked">
    <input v-for="(part, i) of value" :key="i" type="number" step="any" :aria-label="control.label + ' ' + 'xyz'[i]" :value="short(part)" @change="put(i, $event.target)">
  </span>
  <span v-else-if="control.kind === 'name'" class="wide">
    <input type="text" maxlength="200" :aria-label="control.label" :value="value ?? ''" @change="turn($event.target.value)">
  </span>
  <span v-else class="wide unit">{{ value || "(cannot be turned here)" }}</span>
  <p v-if="told" class="about">{{ about }}</p>
</div>`,
  computed: {
    unit() { return UNITS[this.control.units] ?? this.control.units ?? ""; },
    about() {
      const { control } = this, lines = [control.documentation || "(no documentation)"];
      if (["number", "whole"].includes(control.kind)) lines.push(`range ${range(control)}${this.unit && ` ${this.unit}`}`);
      if (control.default !== null) lines.push(`default ${JSON.stringify(control.default)}`);
      return [...lines, control.id].join("\n");
    },
    share() { // of the slider; null: nothing is authored, and the schema has no default
      if (this.value === null) return 0;
      const share = (this.value - this.control.low) / (this.control.high - this.control.low || 1);
      return Math.sign(share) * Math.abs(share) ** (1 / power(this.control));
    },
    hex() {
      return `#${this.value.map((c) => Math.round(255 * shown(Math.min(Math.max(c, 0), 1))).toString(16).padStart(2, "0")).join("")}`;
    },
  },
  methods: {
    short,
    turn(value) { this.$emit("turn", this.control.id, value); },
    at(share) {
      const { control } = this, value = control.low + (control.high - control.low) * share ** power(control);
      return control.kind === "whole" ? Math.round(value) : Number(value.toPrecision(6));
    },
    slid(event) {
      const { control } = this;
      let value = this.at(Number(event.target.value));
      if (control.open_least && value <= control.least) value = this.at(0.001);
      if (control.open_most && value >= control.most) value = this.at(0.999);
      this.turn(value);
    },
    number(input) {
      const value = Number(input.value);
      return input.value === "" || !Number.isFinite(value) ? null : value;
    },
    typed(event) {
      const value = this.number(event.target);
      if (value !== null) this.turn(this.control.kind === "whole" ? Math.round(value) : value);
    },
    put(i, input) {
      const value = this.number(input);
      if (value !== null) this.turn(this.value.map((part, j) => (i === j ? value : part)));
    },
    picked(event) {
      this.turn([1, 3, 5].map((i) => Number(linear(parseInt(event.target.value.slice(i, i + 2), 16) / 255).toPrecision(5))));
    },
  },
};
