// Unwanted reflections above a limit, marked over the exact picture of the live page.

const shaderGlare = {
  vertex: shaderMix.vertex,
  fragment: `#version 300 es
precision highp float;
precision highp usampler2D;
uniform usampler2D uMarks;      // 0 none, else a colour
uniform vec3 uColours[8];
out vec4 fragment;
void main() {
  uint mark = texelFetch(uMarks, ivec2(gl_FragCoord.xy), 0).r;
  fragment = mark == 0u ? vec4(0.0, 0.0, 0.0, 0.5) : vec4(uColours[mark], 1.0);
}`,
};

class Glare {
  constructor(live) {
    this.live = live;
    this.marks = null;  // of the picture that is shown
    this.radio = element('input', {type: 'radio', name: 'shown', value: 'glare'});
    find('#display .choice').append(element('label', {}, this.radio, element('span', {textContent: 'Glare'})));
    this.radio.addEventListener('input', () => {
      live.page.setMode(0);
      live.page.plan.close();
      this.radio.checked = true;
      this.legend.replaceChildren(element('li', {textContent: 'Marks appear with the exact picture.'}));
    });
    this.limit = element('input', {type: 'number', min: 0, step: 'any', value: room.display.glareLimit,
                                   id: 'glare-limit'});
    this.limit.addEventListener('change', () => this.find());
    this.legend = element('ul', {className: 'legend'});
    this.section = element('div', {className: 'form', hidden: true}, element('div', {className: 'entry'},
        element('label', {textContent: 'Limit', htmlFor: this.limit.id,
                          title: 'up to 100: times the mean luminance of the picture; above: cd/m²'}), this.limit),
        this.legend);
    find('#display').append(this.section);
    live.renderer.overlays.add(() => this.draw());
  }

  get on() { return this.radio.checked; }

  /// Marks the picture by the lights and the limit as they are.
  find() {
    clearTimeout(this.timer);
    if (this.on) this.timer = setTimeout(() => this.load(), 100);
  }

  async load() {
    const {live, live: {renderer: {gl, rest}}} = this, limit = this.limit.valueAsNumber;
    if (!rest || !(limit > 0)) return;
    const loaded = await live.load('glare', {limit, mix: live.mix()});
    if (!loaded || rest !== live.renderer.rest) return;
    const {width, height, lights, colours, limit: found} = loaded.header;
    if (this.texture) gl.deleteTexture(this.texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    this.texture = live.renderer.texture(width, height, gl.R8UI, gl.RED_INTEGER, gl.UNSIGNED_BYTE, loaded.bytes,
                                         gl.NEAREST);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    this.marks = {rest, colours};
    const unit = room.lights[0].unit === 'W' ? 'W/(m² sr)' : 'cd/m²';
    const rows = lights.filter(({part}) => part > 0).map(({name, part, peak, colour}) => legendRow(
        colours[colour], `${name.replaceAll('_', ' ')}: ${shortNumber(100 * part)}%, up to ${shortNumber(peak)}`));
    this.legend.replaceChildren(element('li', {textContent:
        `${rows.length > 0 ? 'Above' : 'No reflection is above'} ${shortNumber(found)} ${unit}`}), ...rows);
    live.page.wake();
  }

  draw() {
    const {renderer, renderer: {gl}} = this.live;
    this.section.hidden = !this.on;
    if (!this.on || !this.marks || this.marks.rest !== renderer.rest || renderer.mode !== 0) return;
    this.program ??= renderer.program(shaderGlare);
    const {program, uniforms} = this.program;
    gl.useProgram(program);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
    renderer.bind(0, gl.TEXTURE_2D, this.texture, uniforms.uMarks);
    gl.uniform3fv(uniforms.uColours, [0, 0, 0, ...this.marks.colours.flat().map((part) => part / 255)].slice(0, 24));
    gl.bindVertexArray(renderer.emptyVertices);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(null);
  }
}
