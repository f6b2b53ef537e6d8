// The page: a picture that refines, and what is asked of the server as it is dragged. trame keeps what is shown.

import { ask, moving, sender, then } from "/asking.js";
import { Panel } from "/panel.js";
import { Pixel } from "/pixel.js";

const STILL = 250; // milliseconds without a step after which a drag rests

const Look = {
  name: "Look",
  components: { Panel, Pixel },
  inject: ["trame"],
  props: ["look", "before", "values", "controls", "about"],
  data: () => ({ mode: "camera", split: 0, solid: true, dragging: false, moving: false, drawn: "", picture: 0, mark: null, pixel: null, said: "", wrong: "", refused: 0 }),
  template: `
<div id="look" :data-ready="about ? 'yes' : null">
  <main>
    <nav>
      <strong id="stage" :title="about.stage">{{ about.stage.split("/").pop() }}</strong>
      <label>drag <select id="mode" v-model="mode" title="what dragging on the picture does">
        <option value="camera">the camera</option>
        <option v-for="light of lights" :key="light" :value="light">light {{ light.split("/").pop() }}</option>
        <option value="pick">nothing: a click asks about the pixel</option>
      </select></label>
      <label title="the kept picture to the left of the line, the present one to the right">before
        <input id="split" type="range" min="0" max="1" step="0.001" v-model.number="split"> after</label>
      <label v-if="about.preview" title="while the camera or a light is dragged, meshes with the directions of their scratches">
        <input id="solid" type="checkbox" v-model="solid"> 3D</label>
      <button id="keep" title="compare with the picture as it is now" @click="act('keep')">keep as before</button>
      <button id="reset" title="drop every edit" @click="act('reset')">reset</button>
      <button id="save" :title="'write the edits to ' + about.target" @click="act('save', 'saved')">save</button>
      <button id="link" title="a link for another browser, good once" @click="act('link', 'link')">link</button>
    </nav>
    <div id="picture" ref="picture" :class="{ pick: mode === 'pick' }" :style="{ aspectRatio: look.size[0] + ' / ' + look.size[1] }"
      @pointerdown="down" @pointermove="move" @pointerup="up" @pointercancel="up" @wheel.prevent="wheel">
      <img v-if="look.picture" id="after" alt="the stage as it is now" draggable="false" :src="'/picture?v=' + look.picture" :data-picture="picture" @load="loaded">
      <img v-if="drawn" id="preview" alt="the stage in 3D" draggable="false" :src="drawn" :hidden="picture && !(dragging && (moving || !look.samples))">
      <template v-if="split > 0 && before">
        <img id="before" alt="the stage as it was" draggable="false" :src="'/before?v=' + before" :style="{ clipPath: 'inset(0 ' + 100 * (1 - split) + '% 0 0)' }">
        <div id="line" :style="{ left: 100 * split + '%' }"></div>
      </template>
      <div v-if="mark" id="mark" :style="{ left: 100 * mark[0] + '%', top: 100 * mark[1] + '%' }"></div>
    </div>
    <footer>
      <progress id="progress" max="1" :value="look.spp ? look.samples / look.spp : 0"></progress>
      <span id="samples">{{ look.samples ? look.samples + " of " + look.spp + " samples" : "preview" }}</span>
      <span id="redone" title="what the last change did again">{{ said || (look.redone && "redone: " + look.redone) }}</span>
      <span id="message" role="alert">{{ wrong || look.message }}</span>
    </footer>
    <Pixel v-if="pixel" :pixel="pixel" />
  </main>
  <Panel :controls="controls" :values="values" :refused="refused" @turn="turn" />
</div>`,
  computed: {
    lights() { return [...new Set(this.controls.filter((c) => c.section === "light").map((c) => c.owner))]; },
  },
  watch: {
    look(now, old) {
      if (now.edits !== old.edits) {
        this.said = this.wrong = "";
        if (now.message) this.refused += 1;
        if (this.dragging) this.draw();
      }
      if (now.samples && !this.last) this.dragging = false;
    },
  },
  created() {
    const failed = (error) => { this.wrong = error.message; };
    this.edit = sender((values) => ask(this.trame, "edit", { values }), (a, b) => ({ ...a, ...b }), (error) => {
      failed(error);
      this.refused += 1;
    });
    this.last = null; // where the mouse was, while its button is down
    this.movers = new Map();
    this.mover = (prim) => {
      if (!this.movers.has(prim)) this.movers.set(prim, sender((body) => ask(this.trame, "move", body), then, failed));
      return this.movers.get(prim);
    };
  },
  mounted() { this.draw(); }, // there before the first picture is, and a drag need not wait for its window
  methods: {
    turn(id, value) { this.edit({ [id]: value }); },
    loaded(event) {
      this.picture = Number(new URL(event.target.src).searchParams.get("v"));
      if (!this.last) this.dragging = false;
    },
    // While the camera or a light is dragged the 3D view lies over the picture, then until that has a sample everywhere.
    async draw() {
      if (this.drawing || !this.solid || !this.about.preview) return;
      this.drawing = true;
      const edits = this.look.edits, image = new Image();
      image.src = `/preview?edits=${edits}&${Date.now()}`;
      try {
        await image.decode();
        this.drawn = image.src;
      } catch { this.solid = false; }
      this.drawing = false;
      if (this.dragging && this.look.edits !== edits) this.draw();
    },
    share(event) {
      const box = this.$refs.picture.getBoundingClientRect();
      return [(event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height];
    },
    down(event) {
      this.last = this.share(event);
      this.moved = 0;
      this.$refs.picture.setPointerCapture(event.pointerId);
    },
    move(event) {
      if (!this.last) return;
      const at = this.share(event), dx = at[0] - this.last[0], dy = at[1] - this.last[1];
      const box = this.$refs.picture.getBoundingClientRect();
      this.moved += Math.abs(dx) * box.width + Math.abs(dy) * box.height;
      this.last = at;
      if (this.mode === "pick" || (!dx && !dy)) return;
      const camera = this.mode === "camera", prim = camera ? "" : this.mode;
      this.dragging = this.moving = true;
      clearTimeout(this.still);
      this.still = setTimeout(() => { this.moving = false; }, STILL);
      this.mover(prim)(moving(event.shiftKey && camera ? { prim, across: dx, along: dy } : { prim, right: Math.PI * dx, up: Math.PI * (camera ? dy : -dy) }));
    },
    up(event) {
      if (this.last && this.moved < 4 && event.type === "pointerup") this.pick(this.share(event));
      this.last = null;
      this.moving = false;
    },
    wheel(event) {
      const prim = this.mode === "camera" ? "" : this.mode;
      if (this.mode !== "pick") this.mover(prim)(moving({ prim, nearer: Math.exp(-0.001 * event.deltaY) }));
    },
    async pick([x, y]) {
      if (!(x >= 0 && x < 1 && y >= 0 && y < 1)) return;
      this.mark = [x, y];
      try {
        this.pixel = await ask(this.trame, "pick", { x, y });
      } catch (error) { this.wrong = error.message; }
    },
    async act(name, told = "") {
      try {
        const answer = await ask(this.trame, name, {});
        if (told) this.said = `${told === "saved" ? "saved " : ""}${answer[told]}`;
      } catch (error) { this.wrong = error.message; }
    },
  },
};

// In the place of all that, while the server does not answer.
const Gone = {
  name: "Gone",
  inject: ["trame"],
  template: `<p id="gone" role="alert">The viewer does not answer; it is asked again every second.</p>`,
  mounted() {
    this.timer = setInterval(async () => {
      try { await this.trame.connect(); } catch { /* it is still away */ }
    }, 1000);
  },
  beforeUnmount() { clearInterval(this.timer); },
};

window.scratchwarp = { install: (app) => app.component("ScratchLook", Look).component("ScratchGone", Gone) };
