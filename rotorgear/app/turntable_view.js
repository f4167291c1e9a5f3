// The turntable as a part of the page: what NiceGUI calls, and what it hears.
export default {
  template: `<div style="position:relative;width:100%;height:100%">
    <canvas ref="canvas" style="width:100%;height:100%;display:block;touch-action:none" :aria-label="label"></canvas>
    <p v-if="lacking" style="position:absolute;top:40%;width:100%;text-align:center">
      This browser draws no solids (WebGL is off): all numbers are here without them.</p>
  </div>`,
  props: {label: String},
  data() { return {lacking: false}; },
  mounted() {
    this.table = window.turntable(this.$refs.canvas, {pick: (part) => this.$emit("pick", part)});
    this.lacking = !this.table;
  },
  methods: {
    show(scene) { if (this.table) { this.table.show(scene); } },
    move(motion) { if (this.table) { this.table.move(motion); } },
    paint(colours) { if (this.table) { this.table.paint(colours === "displacement" ? undefined : colours); } },
    choose(part) { if (this.table) { this.table.choose(part); } },
    run(on) { if (this.table) { this.table.run(on); } },
    partAt(x, y) { return this.table ? this.table.partAt(x, y) : ""; },
  },
};
