// The panel: a fold for each owner of controls; layers of a material with their switch and arrows.

import { Control } from "/control.js";

const TITLES = { layer: "Layer", profile: "Profile", curves: "Curves", wave: "Wave optics", measured: "Measured base", settings: "Render settings", surface: "Surface", light: "Light", camera: "Camera" };

const ECHO = 3000; // milliseconds that a value which was turned here waits for the server to have it

const ending = (own, name) => own.find((control) => control.id.endsWith(`:${name}`)).id;

export const Panel = {
  name: "Panel",
  components: { Control },
  props: ["controls", "values", "refused"],
  emits: ["turn"],
  data() {
    const first = this.controls.length ? `${this.controls[0].section} ${this.controls[0].owner}` : "";
    return { mine: { ...this.values }, open: { [first]: true } };
  },
  created() {
    this.sent = new Map(); // what was turned here, until the server has it
    this.first = new Map(this.controls.map((control) => [control.id, JSON.stringify(control.value)]));
  },
  template: `
<aside id="panel" aria-label="controls">
  <details v-for="fold of folds" :key="fold.key" :open="open[fold.key]" :data-owner="fold.owner" @toggle="open[fold.key] = $event.target.open">
    <summary>
      <input v-if="fold.enabled" type="checkbox" :checked="mine[fold.enabled]" :data-enabled="fold.enabled" title="rendered or not"
        @click.stop @change="turn(fold.enabled, $event.target.checked)">
      <span class="unit">{{ fold.title }}</span><span class="name" :title="fold.owner">{{ fold.name }}</span>
      <template v-if="fold.enabled">
        <button data-step="-1" title="cut earlier" @click.prevent="shift(fold, -1)">↑</button>
        <button data-step="1" title="cut later, through those above" @click.prevent="shift(fold, 1)">↓</button>
      </template>
    </summary>
    <template v-if="open[fold.key]">
      <Control v-for="control of fold.own" :key="control.id" :control="control" :value="mine[control.id]" :edited="edited(control.id)" @turn="turn" />
    </template>
  </details>
</aside>`,
  computed: {
    owners() {
      const owners = new Map();
      for (const control of this.controls) {
        const key = `${control.section} ${control.owner}`;
        if (!owners.has(key)) owners.set(key, []);
        owners.get(key).push(control);
      }
      return [...owners].map(([key, own]) => {
        const { section, owner } = own[0], layer = section === "layer";
        const fold = { key, own, section, owner, title: TITLES[section], name: owner.split("/").pop(), material: owner.split(" ")[0] };
        return layer ? { ...fold, enabled: ending(own, "enabled"), order: ending(own, "order") } : fold;
      });
    },
    folds() { // the layers of each material in the order in which they cut
      const queues = new Map();
      for (const fold of this.owners) {
        if (fold.order && !queues.has(fold.material)) queues.set(fold.material, this.layers(fold.material));
      }
      return this.owners.map((fold) => (fold.order ? queues.get(fold.material).shift() : fold));
    },
  },
  watch: {
    // A value that was turned here is left alone until the server has it, or does not take it.
    values(values) {
      for (const [id, value] of Object.entries(values)) {
        const sent = this.sent.get(id);
        if (sent && sent.value !== JSON.stringify(value) && Date.now() < sent.until) continue;
        this.sent.delete(id);
        this.mine[id] = value;
      }
    },
    refused() {
      this.sent.clear();
      Object.assign(this.mine, this.values);
    },
  },
  methods: {
    layers(material) {
      const rows = this.owners.filter((fold) => fold.order && fold.material === material);
      return rows.sort((a, b) => this.mine[a.order] - this.mine[b.order] || (a.owner < b.owner ? -1 : 1));
    },
    // Moves a layer among those of its material: all of them are numbered anew.
    shift(fold, step) {
      const rows = this.layers(fold.material), from = rows.findIndex((row) => row.key === fold.key), to = from + step;
      if (to < 0 || to >= rows.length) return;
      [rows[from], rows[to]] = [rows[to], rows[from]];
      rows.forEach((row, i) => this.turn(row.order, i));
    },
    edited(id) { return JSON.stringify(this.mine[id]) !== this.first.get(id); },
    turn(id, value) {
      this.sent.set(id, { value: JSON.stringify(value), until: Date.now() + ECHO });
      this.mine[id] = value;
      this.$emit("turn", id, value);
    },
  },
};
