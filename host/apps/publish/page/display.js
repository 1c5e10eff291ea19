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
uniform sampler2D uPicture, uRest, uLuminance, uPalette;
uniform float uShown;         // of uRest, in place of uPicture
uniform vec3 uToWhite;        // from light to multiples of white
uniform int uContours;        // of false colours, as host/lighting/report/false_colour.hpp has them; -1: none
uniform float uLux;           // of a luminance of 1, over the top of their scale
uniform int uLineWidth;       // pixels
out vec4 fragment;
const int filled = 0, stepped = 1, lines = 2, bands = 3;
const float steps = ${real(room.legendSteps)};
const float brightest = 1e9;

float largest(vec3 c) { return max(c.r, max(c.g, c.b)); }

vec3 lightAt(ivec2 place) {
  vec3 light = texelFetch(uPicture, place, 0).rgb, rest = texelFetch(uRest, place, 0).rgb;
  if (uShown > 0.0) light = uShown < 1.0 ? mix(light, rest, uShown) : rest;
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

// The share of the scale; below 0 where no illuminance is known.
float shareAt(ivec2 place) {
  vec2 luminance = texelFetch(uLuminance, place, 0).rg;
  return luminance.g > 0.5 ? luminance.r / luminance.g * uLux : -1.0;
}

float levelsBelow(float share) { return clamp(floor(share * steps + 0.5), 0.0, steps); }

bool isOnLine(ivec2 place, float share) {
  for (int axis = 0; axis < 2; ++axis) {
    ivec2 next = place + (axis == 0 ? ivec2(uLineWidth, 0) : ivec2(0, -uLineWidth));
    if (next.x >= textureSize(uLuminance, 0).x || next.y < 0) continue;
    float other = shareAt(next);
    if (other >= 0.0 && levelsBelow(other) != levelsBelow(share)) return true;
  }
  return false;
}

bool isInBand(float share) { return share < 1.0 && abs(fract(share * steps) - 0.5) < 0.1; }

void main() {
  ivec2 place = ivec2(gl_FragCoord.xy);
  bool covered = uContours == filled || uContours == stepped;
  vec3 colour = covered ? vec3(0.05) : encoded(shown(place));
  float share = uContours < 0 ? -1.0 : shareAt(place);
  if (share >= 0.0 && (covered || (uContours == lines ? isOnLine(place, share) : isInBand(share)))) {
    share = clamp(share, 0.0, 1.0);
    if (uContours == stepped) share = (min(floor(share * steps), steps - 1.0) + 0.5) / steps;
    colour = textureLod(uPalette, vec2((share * 255.0 + 0.5) / 256.0, 0.5), 0.0).rgb;
  }
  fragment = vec4(colour, 1.0);
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
    this.pixels = gl.createFramebuffer();   // ... and what becomes of it: the picture ...
    this.luminance = gl.createFramebuffer();  // ... and the illuminance
    this.buffers = [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT].map((place) => {
      const buffer = gl.createRenderbuffer();
      gl.bindFramebuffer(gl.FRAMEBUFFER, this.samples);
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
      return buffer;
    });
    this.textures = [this.pixels, this.luminance].map((target) => {
      const texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      gl.bindFramebuffer(gl.FRAMEBUFFER, target);
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
      return texture;
    });
    // Half floats need not have samples.
    const counts = gl.getInternalformatParameter(gl.RENDERBUFFER, gl.RGBA16F, gl.SAMPLES) ?? [];
    this.count = Math.max(0, ...[...counts].filter((count) => count <= 4));
  }

  fit(width, height, smooth) {
    if (this.width === width && this.height === height && this.smooth === smooth) return;
    const gl = this.gl;
    Object.assign(this, {width, height, smooth});
    [gl.RGBA16F, gl.DEPTH_COMPONENT24].forEach((format, i) => {
      gl.bindRenderbuffer(gl.RENDERBUFFER, this.buffers[i]);
      gl.renderbufferStorageMultisample(gl.RENDERBUFFER, smooth ? this.count : 0, format, width, height);
    });
    for (const texture of this.textures) {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA16F, width, height, 0, gl.RGBA, gl.HALF_FLOAT, null);
    }
  }

  /// What is drawn from here on is a frame of this size, until `keep`.
  ///   smooth   whether its edges are
  begin(width, height, smooth) {
    const gl = this.gl;
    this.fit(width, height, smooth);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.samples);
    gl.viewport(0, 0, width, height);
  }

  ///   target   `pixels` or `luminance`
  keep(target) {
    const gl = this.gl, {width, height} = this;
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, this.samples);
    gl.bindFramebuffer(gl.DRAW_FRAMEBUFFER, target);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    // Without that, Chromium's software renderer keeps what is drawn next in place of this.
    gl.invalidateFramebuffer(gl.READ_FRAMEBUFFER, [gl.COLOR_ATTACHMENT0, gl.DEPTH_ATTACHMENT]);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  ///   exposure   of light in units of white
  ///   rest       a picture that is shown in part, or null
  ///   colours    false colours: {contours, lux, palette}, or null
  show(exposure, rest, colours) {
    const gl = this.gl, {width, height, program: {program, uniforms}, textures: [light, luminance]} = this;
    gl.viewport(0, 0, width, height);
    gl.useProgram(program);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.disable(gl.BLEND);
    gl.bindVertexArray(this.vertices);
    Object.entries({
      uPicture: rest?.before?.texture ?? light, uRest: rest?.light.texture ?? light, uLuminance: luminance,
      uPalette: colours?.palette ?? light,
    }).forEach(([name, texture], unit) => {
      gl.activeTexture(gl.TEXTURE0 + unit);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(uniforms[name], unit);
    });
    gl.uniform1f(uniforms.uShown, rest?.shown ?? 0);
    gl.uniform1i(uniforms.uContours, colours?.contours ?? -1);
    gl.uniform1f(uniforms.uLux, colours?.lux ?? 0);
    gl.uniform1i(uniforms.uLineWidth, Math.max(1, Math.round(width / this.gl.canvas.clientWidth)));
    gl.uniform3f(uniforms.uToWhite, ...room.display.white.map((part) => exposure / part));
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.bindVertexArray(null);
  }
}
