// The display transform: what the screen shows of the light of a frame.

/// A number as GLSL has it.
const real = (number) => (Number.isInteger(number) ? `${number}.0` : `${number}`);

/// From light to the screen, pixel by pixel: `tone_map` of host/pictures/image/display.cpp with the
/// numbers that it has (room.display).
const shaderDisplay = {
  vertex: shaderMix.vertex,
  fragment: `#version 300 es
precision highp float;
precision highp int;
uniform sampler2D uPicture, uRest;
uniform float uShown;         // of uRest, in place of uPicture
uniform vec3 uToWhite;        // from light to multiples of white
uniform bool uIsLight;        // false colours are shown as they are
out vec4 fragment;
const float brightest = 1e9;

float largest(vec3 c) { return max(c.r, max(c.g, c.b)); }

vec3 lightAt(ivec2 place) {
  vec3 light = texelFetch(uPicture, place, 0).rgb;
  if (uShown > 0.0) light = mix(light, texelFetch(uRest, place, 0).rgb, uShown);
  return min(max(light, 0.0) * uToWhite, brightest);
}

// Khronos PBR Neutral; names are those of its specification.
vec3 neutral(vec3 c) {
  const float f90 = ${real(room.display.f90)}, ks = ${real(room.display.ks)}, kd = ${real(room.display.kd)};
  float x = min(c.r, min(c.g, c.b));
  c -= x <= 2.0 * f90 ? x - x * x / (4.0 * f90) : f90;
  float p = largest(c);
  if (p <= ks) return c;
  float pn = 1.0 - (1.0 - ks) * (1.0 - ks) / (p + 1.0 - 2.0 * ks);
  float g = 1.0 / (kd * (p - pn) + 1.0);
  return mix(vec3(pn), c * (pn / p), g);
}

vec3 standard(vec3 c) { return c / max(1.0, largest(c)); }

vec3 displayed(vec3 c) { return clamp(${room.display.view}(c), 0.0, 1.0); }

// The two sides of a lamp's border are mixed as they are displayed.
vec3 shown(ivec2 place) {
  vec3 own = lightAt(place), dark = own, bright = own;
  float here = largest(own);
  if (here <= 1.0) return displayed(own);
  ivec2 last = textureSize(uPicture, 0) - 1;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      vec3 other = lightAt(clamp(place + ivec2(i, j), ivec2(0), last));
      if (largest(other) < largest(dark)) dark = other;
      if (largest(other) > largest(bright)) bright = other;
    }
  }
  float least = largest(dark), most = largest(bright);
  if (most <= ${real(room.display.leastOfLight)} || least >= 1.0) return displayed(own);
  return mix(displayed(dark), displayed(bright), (here - least) / (most - least));
}

vec3 encoded(vec3 c) {
  return mix(12.92 * c, 1.055 * pow(max(c, 0.0), vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c));
}

void main() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  fragment = vec4(uIsLight ? encoded(shown(place)) : texelFetch(uPicture, place, 0).rgb, 1.0);
}`,
};

/// Holds the light of a frame while it is drawn, and shows it.
class Screen {
  ///   program   of shaderDisplay
  constructor(gl, program) {
    this.gl = gl;
    this.program = program;
    this.vertices = gl.createVertexArray();
    this.width = this.height = 0;
    this.samples = gl.createFramebuffer();  // what is drawn into ...
    this.pixels = gl.createFramebuffer();   // ... and what becomes of it
    this.buffers = [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT].map((place) => {
      const buffer = gl.createRenderbuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.samples);
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
      return buffer;
    });
    this.light = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, this.light);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.pixels);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.light, 0);
    // Half floats need not have samples.
    const counts = gl.getInternalformatParameter(gl.RENDERBUFFER, gl.RGBA16F, gl.SAMPLES) ?? [];
    this.count = Math.max(0, ...[...counts].filter((count) => count <= 4));
  }

  fit(width, height) {
    if (this.width === width && this.height === height) return;
    const gl = this.gl;
    Object.assign(this, {width, height});
    [gl.RGBA16F, gl.DEPTH_COMPONENT24].forEach((format, i) => {
      gl.bindRenderbuffer(gl.RENDERBUFFER, this.buffers[i]);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, this.count, format, width, height);
    });
    gl.bindTexture(gl.TEXTURE_2D, this.light);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, width, height, 0, gl.RGBA, gl.HALF_FLOAT, null);
  }

  /// What is drawn from here on is a frame of this size.
  begin(width, height) {
    const gl = this.gl;
    this.fit(width, height);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.samples);
    gl.viewport(0, 0, width, height);
  }

  ///   exposure   of light in units of white; null where the frame is to be shown as it is
  ///   rest       a picture that is shown in part, or null
  show(exposure, rest) {
    const gl = this.gl, {width, height, program: {program, uniforms}} = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.samples);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, this.pixels);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, width, height);
    gl.useProgram(program);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(this.vertices);
    [rest?.before?.texture ?? this.light, rest?.light.texture ?? this.light].forEach((texture, unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
    });
    gl.uniform1i(uniforms.uPicture, 0);
    gl.uniform1i(uniforms.uRest, 1);
    gl.uniform1f(uniforms.uShown, rest?.shown ?? 0);
    gl.uniform1i(uniforms.uIsLight, exposure === null ? 0 : 1);
    gl.uniform3f(uniforms.uToWhite, ...room.display.white.map((part) => (exposure ?? 1) / part));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.bindVertexArray(null);
  }
}
