// What made a pixel: its surface, its layers with their lobes, the effects.

const digits = (n, count = 4) => (n === null ? "∞" : Number(n.toPrecision(count)).toString());
// parts are differences of sums: what is left of nothing is nothing
const color = (rgb) => rgb.map((c) => (Math.abs(c) < 1e-5 ? "0" : digits(c, 3))).join("  ");
const length = (um) => (um >= 1000 ? `${digits(um / 1000)} mm` : `${digits(um)} µm`);

export const Pixel = {
  name: "Pixel",
  props: ["pixel"],
  template: `
<section id="pixel">
  <h2>pixel {{ pixel.pixel.join(", ") }}</h2>
  <table>
    <tr v-for="[head, text] of facts" :key="head"><th>{{ head }}</th><td>{{ text }}</td></tr>
  </table>
  <template v-if="pixel.layers.length">
    <h2>layers, with their lobes of φ on the mirror cone</h2>
    <table id="layers">
      <tr v-for="layer of pixel.layers" :key="layer.name">
        <th>{{ layer.name }}</th>
        <td>adds {{ color(layer.radiance) }}<br>viewer at θ {{ digits(layer.theta, 3) }}°, φ {{ digits(layer.phi, 3) }}°; lit from θ {{ digits(-layer.theta, 3) }}°</td>
        <td>
          <svg v-if="layer.lobe.length" width="120" height="58">
            <title>reflectance over φ_i (root scale, orange), the viewer (blue)</title>
            <line x1="10" y1="50" x2="110" y2="50" stroke="#8d95a1" />
            <line x1="60" y1="50" :x2="60 + 46 * sin(layer.phi)" :y2="50 - 46 * cos(layer.phi)" stroke="#56b4e9" />
            <polygon :points="lobe(layer)" fill="#e69f0055" stroke="#e69f00" />
          </svg>
          <template v-else>Lambert</template>
        </td>
      </tr>
    </table>
  </template>
  <h2>effects that made it</h2>
  <table>
    <tr v-for="[name, why] of pixel.effects" :key="name"><th>{{ name }}</th><td>{{ why }}</td></tr>
  </table>
</section>`,
  computed: {
    facts() {
      const { pixel } = this;
      return [
        ["surface", pixel.prim || "nothing"], ["material", pixel.material || "none"],
        ["radiance", `${color(pixel.radiance)}  ± ${digits(pixel.noise, 2)}`],
        ["of it base", color(pixel.base)], ["scratches", color(pixel.scratches)], ["emission", color(pixel.emission)],
        ...(pixel.prim ? [
          ["distance", `${digits(pixel.distance)} m`],
          ["footprint", `${length(pixel.footprint[0])} by ${length(pixel.footprint[1])}`],
          ["position", `${pixel.position.map((p) => digits(p)).join("  ")} m`],
        ] : []),
      ];
    },
  },
  methods: {
    digits,
    color,
    sin: (degrees) => Math.sin(degrees * Math.PI / 180),
    cos: (degrees) => Math.cos(degrees * Math.PI / 180),
    // rho over phi from -90 to 90 degrees, polar: the normal points up
    lobe(layer) {
      const most = Math.max(...layer.lobe, 1e-9);
      const points = layer.lobe.map((rho, i) => {
        const radius = 44 * Math.sqrt(rho / most);
        return `${(60 + radius * this.sin(layer.angles[i])).toFixed(1)},${(50 - radius * this.cos(layer.angles[i])).toFixed(1)}`;
      });
      return ["60,50", ...points].join(" ");
    },
  },
};
