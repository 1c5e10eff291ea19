// The photons of a triangle that is clicked on the live page, over the picture: what an estimate there uses.

const shaderPhotons = {
  vertex: `#version 300 es
layout(location = 0) in vec3 position;
uniform mat4 uCamera;
uniform vec3 uEye;
uniform float uNearer, uSize;   // part of the way to the eye, in front of what it lies on
void main() {
  gl_Position = uCamera * vec4(mix(position, uEye, uNearer), 1.0);
  gl_PointSize = uSize;
}`,
  fragment: `#version 300 es
precision highp float;
uniform vec4 uColour;
out vec4 fragment;
void main() { fragment = vec4(uColour.rgb * uColour.a, uColour.a); }`,
};

/// In the order in which the server sends them (LiveRoom::photon_bytes): triangles, then points.
const photonParts = [
  {name: 'triangle', colour: [230, 60, 40], says: (n, side) => `Triangle ${n}, side ${side}`},
  {name: 'group', colour: [60, 120, 255], says: (n) => `${n} triangles near it`},
  {name: 'patch', colour: [60, 190, 90], says: (n) => `${n} more that share its map`},
  {name: 'own', points: true, colour: [255, 230, 0], says: (n) => `${n} photons on it`},
  {name: 'reached', points: true, colour: [0, 255, 255], says: (n) => `${n} photons within the radius`},
];

class PhotonMap {
  constructor(live) {
    this.live = live;
    this.parts = null;  // of the clicked triangle
    this.on = false;
    this.toggle = element('button', {type: 'button', textContent: 'Photons of a triangle',
                                     title: 'A click shows the photons that an estimate there uses'});
    this.toggle.setAttribute('aria-pressed', false);
    this.toggle.addEventListener('click', () => this.turn(!this.on));
    this.legend = element('ul', {className: 'legend', hidden: true});
    find('#display').append(this.toggle, this.legend);
  }

  turn(on) {
    const {renderer, page} = this.live;
    this.on = on;
    if (on) page.plan.close();
    this.toggle.setAttribute('aria-pressed', on);
    this.legend.hidden = !on;
    this.legend.replaceChildren(element('li', {textContent: 'Click a surface.'}));
    this.draws ??= (camera) => this.draw(camera);
    if (on) renderer.overlays.add(this.draws);
    else renderer.overlays.delete(this.draws);
    this.parts = null;
    page.wake();
  }

  async click(x, y) {
    if (!this.on) return false;
    const {live} = this, {page, renderer: {gl}} = live;
    const loaded = await live.load('photons', {eye: page.walker.eye, direction: page.directionTo(x, y)});
    if (!loaded) return true;
    this.program ??= live.renderer.program(shaderPhotons);
    const {counts, found, triangle, side} = loaded.header;
    const numbers = new Float32Array(loaded.bytes.slice().buffer);
    this.parts?.forEach(({buffer}) => gl.deleteBuffer(buffer));
    let at = 0;
    this.parts = photonParts.map((part, i) => {
      const size = counts[i] * (part.points ? 3 : 9), buffer = gl.createBuffer(), vertices = gl.createVertexArray();
      gl.bindVertexArray(vertices);
      gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
      gl.bufferData(gl.ARRAY_BUFFER, numbers.subarray(at, at += size), gl.STATIC_DRAW);
      gl.enableVertexAttribArray(0);
      gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
      gl.bindVertexArray(null);
      return {...part, buffer, vertices, count: size / 3};
    });
    this.legend.replaceChildren(...photonParts.map(({colour, says}, i) => legendRow(
        colour, i === 0 ? says(triangle, side) : says(found[i].toLocaleString('en')))));
    page.wake();
    return true;
  }

  /// Over the picture, which has no depth any more.
  draw({eye, right, up, forward, projection}) {
    if (!this.parts) return;
    const {renderer, renderer: {gl, vertices, indices}} = this.live, {program, uniforms} = this.program;
    gl.useProgram(program);
    gl.uniformMatrix4fv(uniforms.uCamera, false, product(projection, viewMatrix(eye, right, up, scaled(forward, -1))));
    gl.uniform3f(uniforms.uEye, ...eye);
    gl.uniform1f(uniforms.uSize, Math.min(window.devicePixelRatio || 1, 2));
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    gl.clear(gl.DEPTH_BUFFER_BIT);
    gl.colorMask(false, false, false, false);
    gl.uniform1f(uniforms.uNearer, 0);
    gl.bindVertexArray(vertices);
    gl.drawElements(gl.TRIANGLES, indices.length, gl.UNSIGNED_INT, 0);
    gl.colorMask(true, true, true, true);
    gl.depthMask(false);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    for (const {points, colour, count, vertices: own} of this.parts) {
      gl.uniform1f(uniforms.uNearer, points ? 0.01 : 0.002);
      gl.uniform4f(uniforms.uColour, ...colour.map((part) => part / 255), points ? 1 : 0.4);
      if (points) gl.disable(gl.CULL_FACE);
      else gl.enable(gl.CULL_FACE);
      gl.bindVertexArray(own);
      gl.drawArrays(points ? gl.POINTS : gl.TRIANGLES, 0, count);
      ++renderer.drawCalls;
    }
    gl.disable(gl.BLEND);
    gl.disable(gl.DEPTH_TEST);
    gl.depthMask(true);
    gl.bindVertexArray(null);
  }
}

/// A line of a legend.
const legendRow = (colour, text) => {
  const dot = element('span', {className: 'dot'});
  dot.style.setProperty('--light', `rgb(${colour.join(' ')})`);
  return element('li', {}, dot, text);
};
