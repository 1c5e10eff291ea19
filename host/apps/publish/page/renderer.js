// Draws the room by WebGL 2.

/// Layers that every WebGL 2 has in an array of textures.
const mostLayers = 256;
const probeSide = 128;
/// Irradiance in multiples of white.
const evenLight = 1.8;

class Renderer {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext('webgl2', {antialias: false, alpha: false,
                                            powerPreference: 'high-performance'});
    if (!gl) throw new Error('This browser offers no WebGL 2.');
    if (!gl.getExtension('EXT_color_buffer_float') &&
        !gl.getExtension('EXT_color_buffer_half_float')) {
      throw new Error('This graphics processor cannot draw into half floats.');
    }
    this.gl = gl;
    const named = gl.getExtension('WEBGL_debug_renderer_info');
    this.isSlow = /SwiftShader|llvmpipe|software|basic render/i.test(
        gl.getParameter(named ? named.UNMASKED_RENDERER_WEBGL : gl.RENDERER));  // there is no graphics chip
    this.exposure = 1;
    this.mode = 0;  // 0 the picture, 1 its light, 2 lux
    this.falseColours = {contours: 0, top: 1000};  // filled, in steps, isolines, bands; lux
    this.unit = 1 / room.display.exposure;  // luminance of white when the page was opened
    this.drawCalls = 0;
    this.texels = this.texelsRead = 0;  // of light maps: since the last frame, and for it
    this.share = 1;           // of the pixels that are drawn, across and down
    this.isLit = !room.live;  // else an even light stands for that which is to come
    this.rest = null;         // an exact picture of where the viewer rests
    this.overlays = new Set();  // that draw over each frame, given its camera
  }

  async load(archive) {
    const gl = this.gl;
    this.roomProgram = this.program(shaderRoom);
    this.skyProgram = this.program(shaderSky);
    this.mixProgram = this.program(shaderMix);
    this.copyProgram = this.program(shaderCopy);
    this.screen = new Screen(gl, this.program(shaderDisplay));
    this.emptyVertices = gl.createVertexArray();
    this.noProbe = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_CUBE_MAP, this.noProbe);
    for (let face = 0; face < 6; ++face) {
      gl.texImage2D(gl.TEXTURE_CUBE_MAP_POSITIVE_X + face, 0, gl.RGBA8, 1, 1, 0, gl.RGBA,
                    gl.UNSIGNED_BYTE, new Uint8Array(4));
    }
    await this.loadMesh(archive);
    await this.loadTextures(archive);
    await this.loadLightMaps(archive);
    await this.loadSky(archive);
    this.setPalette(0);
    if (room.parts.some((part) => part.interaction > 0) ||
        room.materials.some((material) => material.specular.some((part) => part > 0))) {
      this.makeProbe();
    }
  }

  /// Of false colours, by its number in room.palettes.
  setPalette(i) {
    const gl = this.gl, {colours} = room.palettes[i];
    const bytes = colours.match(/../g).map((digits) => parseInt(digits, 16));
    this.colours = Array.from({length: bytes.length / 3}, (_, colour) => bytes.slice(3 * colour, 3 * colour + 3));
    gl.deleteTexture(this.palette ?? null);
    this.palette = this.texture(this.colours.length, 1, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE,
                                Uint8Array.from(this.colours.flatMap((c) => [...c, 255])), gl.LINEAR);
  }

  program({vertex, fragment}) {
    const gl = this.gl;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) {
      throw new Error(gl.getProgramInfoLog(program) ||
                      gl.getAttachedShaders(program).map((s) => gl.getShaderInfoLog(s)).join('\n'));
    }
    const uniforms = {};
    const count = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS);
    for (let i = 0; i < count; ++i) {
      const {name} = gl.getActiveUniform(program, i);
      uniforms[name.replace('[0]', '')] = gl.getUniformLocation(program, name);
    }
    return {program, uniforms};
  }

  texture(width, height, format, layout, type, texels, filter, wrap = this.gl.CLAMP_TO_EDGE) {
    const gl = this.gl;
    const texture = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.texImage2D(gl.TEXTURE_2D, 0, format, width, height, 0, layout, type, texels);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, wrap);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, wrap);
    return texture;
  }

  floatTexture(width, height, numbers) {
    const gl = this.gl;
    return this.texture(width, height, gl.RGBA32F, gl.RGBA, gl.FLOAT, numbers, gl.NEAREST);
  }

  async loadMesh(archive) {
    const gl = this.gl;
    const axes = await Promise.all(['x', 'y', 'z'].map((name) => archive.array(name)));
    const count = axes[0].length;
    this.positions = new Float32Array(3 * count);
    axes.forEach((axis, i) => axis.forEach((value, v) => { this.positions[3 * v + i] = value; }));
    this.indices = await archive.array('indices');
    this.lightUvs = await archive.array('light_uv');
    const attributes = [
      [this.positions, 3, gl.FLOAT, false],
      [new Int16Array((await archive.array('normals')).buffer), 4, gl.SHORT, true],
      [archive.has('uv') ? await archive.array('uv') : new Float32Array(2 * count), 2, gl.FLOAT,
       false],
      [this.lightUvs, 2, gl.UNSIGNED_SHORT, true],
      [await archive.array('kinds'), 2, gl.UNSIGNED_SHORT, null],
    ];
    this.vertices = gl.createVertexArray();
    gl.bindVertexArray(this.vertices);
    attributes.forEach(([array, size, type, normal], location) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, gl.createBuffer());
      gl.bufferData(gl.ARRAY_BUFFER, array, gl.STATIC_DRAW);
      gl.enableVertexAttribArray(location);
      if (normal === null) gl.vertexAttribIPointer(location, size, type, 0, 0);
      else gl.vertexAttribPointer(location, size, type, normal, 0, 0);
    });
    gl.bindBuffer(gl.ELEMENT_ARRAY_BUFFER, gl.createBuffer());
    gl.bufferData(gl.ELEMENT_ARRAY_BUFFER, this.indices, gl.STATIC_DRAW);
    gl.bindVertexArray(null);
    this.materials = this.floatTexture(3, room.materials.length, Float32Array.from(
        room.materials.flatMap((m) => [...m.diffuse, m.alpha, ...m.specular, m.roughness, m.f90,
                                       m.index, m.thin ? 1 : 0, 0])));
  }

  async loadTextures(archive) {
    const gl = this.gl;
    this.textures = [];
    for (const [i, {width, height}] of room.textures.entries()) {
      const texels = await archive.array(`texture${i}`, width);
      const texture = this.texture(width, height, gl.SRGB8_ALPHA8, gl.RGBA, gl.UNSIGNED_BYTE,
                                   texels, gl.LINEAR, gl.REPEAT);
      gl.generateMipmap(gl.TEXTURE_2D);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
      const sharp = gl.getExtension('EXT_texture_filter_anisotropic');
      if (sharp) gl.texParameteri(gl.TEXTURE_2D, sharp.TEXTURE_MAX_ANISOTROPY_EXT, 8);
      this.textures.push(texture);
    }
    this.white = this.texture(1, 1, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE,
                              new Uint8Array([255, 255, 255, 255]), gl.NEAREST);
  }

  async loadLightMaps(archive) {
    const gl = this.gl;
    const {width, height} = room.atlas;
    this.layers = [];  // texels of each light, which lux are read from
    this.maps = [];    // arrays of textures
    for (let first = 0; first < room.lights.length; first += mostLayers) {
      const count = Math.min(mostLayers, room.lights.length - first);
      const texture = gl.createTexture();
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
      gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGB9_E5, width, height, count);
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
      for (let layer = 0; layer < count; ++layer) {
        this.layers.push(room.live ? new Uint32Array(width * height)
                                   : await archive.array(`light${first + layer}`, width));
        gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
        gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, layer, width, height, 1, gl.RGB,
                         gl.UNSIGNED_INT_5_9_9_9_REV, this.layers.at(-1));
      }
      this.maps.push({texture, first, count});
    }
    this.light = this.lightTarget(width, height);
    this.fresh = room.live ? this.lightTarget(width, height) : this.light;  // that becomes it
    this.weights = gl.createTexture();
    this.emitters = gl.createTexture();
  }

  /// A texture of light, and what draws into it.
  lightTarget(width, height, filter = this.gl.LINEAR) {
    const gl = this.gl;
    const texture = this.texture(width, height, gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, null, filter);
    const target = gl.createFramebuffer();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, texture, 0);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    return {texture, target, width, height};
  }

  /// Patches of the sky have a texel each degree; a picture of surroundings is a texture.
  async loadSky(archive) {
    const gl = this.gl;
    this.patchSide = [360, 180];
    this.patchOf = null;
    if (room.patches.length > 0) {
      const [columns, rows] = this.patchSide;
      this.patchOf = new Int32Array(columns * rows).fill(-1);
      const turn = 2 * Math.PI;
      room.patches.forEach(({bounds: [from, to, low, high]}, patch) => {
        for (let row = 0; row < rows; ++row) {
          const sine = Math.cos((row + 0.5) / rows * Math.PI);
          if (sine < low || sine > high) continue;
          for (let column = 0; column < columns; ++column) {
            const azimuth = (column + 0.5) / columns * turn - Math.PI;  // from -z
            const offset = (((azimuth - from) % turn) + turn) % turn;
            if (offset <= to - from) this.patchOf[row * columns + column] = patch;
          }
        }
      });
    }
    this.patches = this.floatTexture(1, 1, new Float32Array(4));
    this.environment = this.white;
    if (room.environment) {
      const {width, height} = room.environment;
      const texels = await archive.array('environment', width);
      this.environment = this.texture(width, height, gl.RGB9_E5, gl.RGB,
                                      gl.UNSIGNED_INT_5_9_9_9_REV, texels, gl.LINEAR);
      gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.REPEAT);
    }
  }

  /// Sums layers of light.
  ///   maps      arrays of textures
  ///   weights   of each layer, linear RGB
  ///   to        as lightTarget makes it
  ///   ground    what is there without them
  sum(maps, weights, to, ground = [0, 0, 0]) {
    const gl = this.gl;
    const shining = weights.map((_, i) => i).filter((i) => weights[i].some((part) => part > 0));
    const rows = shining.flatMap((i) => [...weights[i], i % mostLayers]);
    gl.bindTexture(gl.TEXTURE_2D, this.weights);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, Math.max(1, shining.length), 1, 0, gl.RGBA,
                  gl.FLOAT, Float32Array.from(rows.length ? rows : [0, 0, 0, 0]));
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    }
    gl.bindFramebuffer(gl.FRAMEBUFFER, to.target);
    gl.viewport(0, 0, to.width, to.height);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.clearColor(...ground, 1);
    gl.clear(gl.COLOR_BUFFER_BIT);
    gl.enable(gl.BLEND);
    gl.blendFunc(gl.ONE, gl.ONE);
    const {program, uniforms} = this.mixProgram;
    gl.useProgram(program);
    gl.bindVertexArray(this.emptyVertices);
    this.bind(0, gl.TEXTURE_2D, this.weights, uniforms.uWeights);
    for (const {texture, first, count} of maps) {
      const from = shining.findIndex((i) => i >= first);
      const of = shining.filter((i) => i >= first && i < first + count).length;
      if (of === 0) continue;
      this.bind(1, gl.TEXTURE_2D_ARRAY, texture, uniforms.uMaps);
      gl.uniform1i(uniforms.uFirst, from);
      gl.uniform1i(uniforms.uCount, of);
      gl.drawArrays(gl.TRIANGLES, 0, 3);
      if (maps === this.maps) this.texels += of * this.mapTexels;
    }
    gl.disable(gl.BLEND);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
  }

  /// Mixes the light maps.
  ///   weights   of each light: what its light at power 1 is multiplied by, linear RGB
  ///   fades     whether `fade` is to bring the new light into view
  mix(weights, fades = false) {
    const gl = this.gl;
    this.lit = weights;
    if (this.isLit) {
      this.sum(this.maps, weights.map((weight, i) => scaled(weight, room.lights[i].brightest / this.unit)),
               this.fresh);
    } else {
      this.sum([], [], this.fresh, room.display.white.map((part) => evenLight * part));
    }
    if (!fades) this.fade(1);
    this.mixRest();
    const emitted = [0, 0, 0, 0];
    for (const {layer, radiance} of room.emitters) {
      const light = radiance.map((part, c) => part * weights[layer][c] / this.unit);
      emitted.push(...(this.isLit ? light : light.map((part, c) => (part > 0 ? room.display.white[c] : 0))), 0);
    }
    gl.bindTexture(gl.TEXTURE_2D, this.emitters);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, emitted.length / 4, 1, 0, gl.RGBA, gl.FLOAT,
                  Float32Array.from(emitted));
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D, filter, gl.NEAREST);
    }
    this.mixSky(weights);
    this.probeIsOld = true;
  }

  /// Brings the newest mix into view: this part of it.
  fade(part) {
    if (this.fresh === this.light) return;
    const gl = this.gl, {program, uniforms} = this.copyProgram;
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.light.target);
    gl.viewport(0, 0, this.light.width, this.light.height);
    gl.disable(gl.DEPTH_TEST);
    gl.disable(gl.CULL_FACE);
    gl.enable(gl.BLEND);
    gl.blendColor(0, 0, 0, part);
    gl.blendFunc(gl.CONSTANT_ALPHA, gl.ONE_MINUS_CONSTANT_ALPHA);
    gl.useProgram(program);
    gl.bindVertexArray(this.emptyVertices);
    this.bind(0, gl.TEXTURE_2D, this.fresh.texture, uniforms.uPicture);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    this.texels += this.mapTexels;
    gl.disable(gl.BLEND);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    if (part === 1) this.probeIsOld = true;
  }

  /// Gives each light map one colour.
  fillMaps(colours) {
    const {width, height} = room.atlas;
    colours.forEach((colour, i) => {
      this.layers[i].fill(rgb9e5(...colour));
      const {texture, first} = this.maps[Math.floor(i / mostLayers)], gl = this.gl;
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, i - first, width, height, 1, gl.RGB,
                       gl.UNSIGNED_INT_5_9_9_9_REV, this.layers[i]);
    });
  }

  /// Gives a rectangle of the light maps other texels.
  ///   texels   of each light in turn, rows of `side` texels
  setTile(x, y, side, texels) {
    const gl = this.gl, {width, height} = room.atlas;
    const columns = Math.min(side, width - x), rows = Math.min(side, height - y);
    gl.pixelStorei(gl.UNPACK_ROW_LENGTH, side);
    this.layers.forEach((layer, i) => {
      const own = texels.subarray(i * side * side, (i + 1) * side * side);
      for (let row = 0; row < rows; ++row) {
        layer.set(own.subarray(row * side, row * side + columns), (y + row) * width + x);
      }
      const {texture, first} = this.maps[Math.floor(i / mostLayers)];
      gl.bindTexture(gl.TEXTURE_2D_ARRAY, texture);
      gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, x, y, i - first, columns, rows, 1, gl.RGB,
                       gl.UNSIGNED_INT_5_9_9_9_REV, own);
    });
    gl.pixelStorei(gl.UNPACK_ROW_LENGTH, 0);
  }

  /// Fades from what is shown to a picture of the same view.
  ///   exponents   of two, by which the layers are too bright
  ///   weigh       gives the weights of the layers
  ///   halves      numbers of the layers: RGB, row 0 at the bottom
  setRest({width, height, samples, exponents}, weigh, halves) {
    const gl = this.gl, before = this.rest?.shown === 1 ? this.rest.light : null;
    this.dropRest(before);
    const layers = gl.createTexture(), count = exponents.length;
    gl.bindTexture(gl.TEXTURE_2D_ARRAY, layers);
    gl.texStorage3D(gl.TEXTURE_2D_ARRAY, 1, gl.RGB16F, width, height, count);
    for (const filter of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) {
      gl.texParameteri(gl.TEXTURE_2D_ARRAY, filter, gl.NEAREST);
    }
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 2);
    gl.texSubImage3D(gl.TEXTURE_2D_ARRAY, 0, 0, 0, 0, width, height, count, gl.RGB, gl.HALF_FLOAT,
                     halves);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 4);
    this.rest = {layers, samples, exponents, weigh, before, shown: 0,
                 light: this.lightTarget(width, height, gl.NEAREST)};
    this.mixRest();
  }

  mixRest() {
    if (!this.rest) return;
    const {layers, exponents, weigh, light} = this.rest;
    this.sum([{texture: layers, first: 0, count: exponents.length}],
             weigh().map((weight, i) => scaled(weight, 2 ** -exponents[i] / this.unit)), light);
  }

  ///   kept   a light of it that is still needed
  dropRest(kept = null) {
    if (!this.rest) return;
    const gl = this.gl, {layers, light, before} = this.rest;
    gl.deleteTexture(layers);
    for (const {texture, target} of [light, before].filter((one) => one && one !== kept)) {
      gl.deleteTexture(texture);
      gl.deleteFramebuffer(target);
    }
    this.rest = null;
  }

  mixSky(weights) {
    const gl = this.gl;
    const of = ({layer, radiance}) => radiance.map((part, c) => part * weights[layer][c] / this.unit);
    this.sunLights = room.suns.slice(0, 4).map(of);
    this.environmentLight = room.environment
        ? scaled(weights[room.environment.layer], room.environment.brightest / this.unit)
        : [0, 0, 0];
    if (!this.patchOf) return;
    const light = room.patches.map(of);
    const [columns, rows] = this.patchSide;
    const texels = new Float32Array(4 * columns * rows);
    this.patchOf.forEach((patch, i) => {
      if (patch >= 0) texels.set(light[patch], 4 * i);
    });
    gl.bindTexture(gl.TEXTURE_2D, this.patches);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA32F, columns, rows, 0, gl.RGBA, gl.FLOAT, texels);
  }

  bind(unit, target, texture, location) {
    const gl = this.gl;
    gl.activeTexture(gl.TEXTURE0 + unit);
    gl.bindTexture(target, texture);
    gl.uniform1i(location, unit);
  }

  /// Draws into the bound framebuffer.
  ///   camera   {eye, right, up, forward, projection, isPlan}
  drawView({eye, right, up, forward, projection, isPlan}, mode) {
    const gl = this.gl;
    gl.enable(gl.DEPTH_TEST);
    gl.depthMask(true);
    gl.clearColor(0, 0, 0, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const back = scaled(forward, -1);
    const room_ = this.roomProgram;
    gl.useProgram(room_.program);
    const u = room_.uniforms;
    gl.uniform1i(u.uMode, mode);
    gl.uniformMatrix4fv(u.uCamera, false, product(projection, viewMatrix(eye, right, up, back)));
    gl.uniform3f(u.uEye, ...eye);
    gl.uniform3f(u.uProbe, ...(this.probePlace ?? [0, 0, 0]));
    gl.uniform3f(u.uLow, ...room.low);
    gl.uniform3f(u.uHigh, ...room.high);
    gl.uniform1f(u.uProbeLevels, this.probe && !this.drawsProbe ? Math.log2(probeSide) + 1 : 0);
    this.bind(2, gl.TEXTURE_2D, this.materials, u.uMaterials);
    this.bind(3, gl.TEXTURE_2D, this.emitters, u.uEmitters);
    this.bind(4, gl.TEXTURE_CUBE_MAP, this.drawsProbe || !this.probe ? this.noProbe : this.probe,
              u.uSurroundings);
    gl.bindVertexArray(this.vertices);
    const drawParts = (clear, layers) => {
      this.bind(0, gl.TEXTURE_2D, this.light.texture, u.uLight);
      for (const part of room.parts) {
        if (part.clear !== clear) continue;
        gl.uniform1i(u.uInteraction, part.interaction);
        gl.uniform1i(u.uTextured, part.texture === null ? 0 : part.emits ? 2 : 1);
        this.bind(1, gl.TEXTURE_2D, part.texture === null ? this.white : this.textures[part.texture],
                  u.uTexture);
        if (part.interaction > 0) gl.disable(gl.CULL_FACE);
        else gl.enable(gl.CULL_FACE);
        if (part.cutout && mode !== 1) gl.enable(gl.SAMPLE_ALPHA_TO_COVERAGE);
        for (const layer of layers) {
          gl.uniform1i(u.uLayer, layer);
          if (layer === 1) gl.blendFunc(gl.ZERO, gl.SRC_COLOR);
          if (layer === 2) gl.blendFunc(gl.ONE, gl.ONE);
          gl.drawElements(gl.TRIANGLES, part.count, gl.UNSIGNED_INT, 4 * part.first);
          ++this.drawCalls;
        }
        gl.disable(gl.SAMPLE_ALPHA_TO_COVERAGE);
      }
    };
    drawParts(false, [0]);
    if (!isPlan) this.drawSky(right, up, forward, projection, mode);
    // Lux are those behind glass.
    if (mode !== 2 && room.parts.some((part) => part.clear)) {
      gl.useProgram(room_.program);
      gl.bindVertexArray(this.vertices);
      gl.enable(gl.BLEND);
      gl.depthMask(false);
      drawParts(true, [1, 2]);
      gl.depthMask(true);
      gl.disable(gl.BLEND);
    }
    gl.bindVertexArray(null);
  }

  drawSky(right, up, forward, projection, mode) {
    const gl = this.gl;
    const {program, uniforms: u} = this.skyProgram;
    gl.useProgram(program);
    gl.uniform1i(u.uMode, mode);
    const across = scaled(right, 1 / projection[0]), high = scaled(up, 1 / projection[5]);
    gl.uniformMatrix4fv(u.uRays, false, new Float32Array([...across, 0, ...high, 0, ...forward, 0,
                                                          0, 0, 0, 0]));
    this.bind(0, gl.TEXTURE_2D, this.patches, u.uPatches);
    this.bind(1, gl.TEXTURE_2D, this.environment, u.uEnvironment);
    gl.uniform3f(u.uEnvironmentLight, ...this.environmentLight);
    const suns = new Float32Array(16), lights = new Float32Array(12);
    for (let i = 0; i < 4; ++i) suns[4 * i + 3] = 2;
    room.suns.slice(0, 4).forEach((sun, i) => {
      suns.set([...sun.direction, sun.cosine], 4 * i);
      lights.set(this.sunLights[i], 3 * i);
    });
    gl.uniform4fv(u.uSuns, suns);
    gl.uniform3fv(u.uSunLights, lights);
    gl.bindVertexArray(this.emptyVertices);
    gl.disable(gl.CULL_FACE);
    gl.depthFunc(gl.LEQUAL);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
    gl.depthFunc(gl.LESS);
    ++this.drawCalls;
  }

  /// A cube map of the room that mirrors and gloss reflect.
  makeProbe() {
    const gl = this.gl;
    this.probe = gl.createTexture();
    gl.bindTexture(gl.TEXTURE_CUBE_MAP, this.probe);
    gl.texStorage2D(gl.TEXTURE_CUBE_MAP, Math.log2(probeSide) + 1, gl.RGBA16F, probeSide,
                    probeSide);
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MIN_FILTER, gl.LINEAR_MIPMAP_LINEAR);
    gl.texParameteri(gl.TEXTURE_CUBE_MAP, gl.TEXTURE_MAG_FILTER, gl.LINEAR);
    this.probeTarget = gl.createFramebuffer();
    this.probeDepth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, this.probeDepth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, probeSide, probeSide);
    this.probePlace = room.probe;
    this.probeIsOld = true;
  }

  updateProbe() {
    if (!this.probe || !this.probeIsOld) return;
    const gl = this.gl;
    this.probeIsOld = false;
    this.drawsProbe = true;
    const projection = perspective(Math.PI / 2, 1, 0.05, this.far);
    // Faces of a cube map are seen from inside, with rows downwards.
    const faces = [[[1, 0, 0], [0, -1, 0]], [[-1, 0, 0], [0, -1, 0]], [[0, 1, 0], [0, 0, 1]],
                   [[0, -1, 0], [0, 0, -1]], [[0, 0, 1], [0, -1, 0]], [[0, 0, -1], [0, -1, 0]]];
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.probeTarget);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER,
                               this.probeDepth);
    gl.viewport(0, 0, probeSide, probeSide);
    faces.forEach(([forward, up], face) => {
      gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0,
                              gl.TEXTURE_CUBE_MAP_POSITIVE_X + face, this.probe, 0);
      this.drawView({eye: this.probePlace, right: cross(forward, up), up, forward, projection}, 1);
    });
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.bindTexture(gl.TEXTURE_CUBE_MAP, this.probe);
    gl.generateMipmap(gl.TEXTURE_CUBE_MAP);
    this.drawsProbe = false;
    this.texels += this.mapTexels;
  }

  get mapTexels() { return this.light.width * this.light.height; }

  get far() { return 4 * Math.hypot(...subtract(room.high, room.low)) + 10; }

  ///   view   a Walker or a Plan
  cameraOf(view, aspect) {
    const {eye, forward, right, isPlan, near = 0.03, far = this.far} = view;
    return {eye, right, up: cross(right, forward), forward, isPlan,
            projection: perspective(view.angle, aspect, near, far)};
  }

  /// Pixels of the page that the canvas takes, across and down.
  get size() {
    const dense = Math.min(window.devicePixelRatio || 1, 2);
    return [this.canvas.clientWidth, this.canvas.clientHeight].map(
        (pixels) => Math.max(1, Math.round(pixels * dense)));
  }

  /// Fits the canvas to its place on the page.
  fit() {
    const share = this.rest ? 1 : this.share;
    const [width, height] = this.size.map((pixels) => Math.max(1, Math.round(share * pixels)));
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
  }

  ///   view   a Walker or a Plan, which the exact picture is not of, nor what is drawn over it
  draw(view) {
    this.drawCalls = 0;
    this.updateProbe();
    this.fit();
    const {width, height} = this.canvas, {screen, falseColours: {contours, top}} = this;
    const camera = this.cameraOf(view, width / height), showsLux = this.mode === 2;
    const rest = camera.isPlan ? null : this.rest;
    const drawInto = (target, mode) => {
      screen.begin(width, height, this.share === 1);
      this.drawView(camera, mode);
      screen.keep(target);
      this.texels += this.mapTexels;
    };
    const isSeen = !showsLux || contours >= 2;  // between lines and bands
    if (isSeen && (!rest || (rest.shown < 1 && !rest.before))) drawInto(screen.pixels, 0);
    if (showsLux) drawInto(screen.luminance, 2);
    screen.fit(width, height, this.share === 1);
    screen.show(this.exposure, rest,
                showsLux ? {contours, lux: room.lux * this.unit / top, palette: this.palette} : null);
    if (!camera.isPlan) this.overlays.forEach((draw) => draw(camera));
    ++this.drawCalls;
    [this.texelsRead, this.texels] = [this.texels, 0];
  }

  /// Lux of what is seen of matt surface, some thousand samples.
  seenLux(walker) {
    const picture = this.radiance(walker, 96, 64, 1, 2), lux = [];
    for (let i = 0; i < picture.length; i += 3) {
      if (picture[i + 1] > 0) lux.push(room.lux * this.unit * picture[i] / picture[i + 1]);
    }
    return lux;
  }

  /// Radiance of each pixel, linear RGB, row 0 at the top, from `samples` x `samples` samples each.
  radiance(walker, width, height, samples = 1, mode = 1) {
    const gl = this.gl;
    const [columns, rows] = [width * samples, height * samples];
    const colour = this.texture(columns, rows, gl.RGBA16F, gl.RGBA, gl.HALF_FLOAT, null,
                                gl.NEAREST);
    const depth = gl.createRenderbuffer();
    gl.bindRenderbuffer(gl.RENDERBUFFER, depth);
    gl.renderbufferStorage(gl.RENDERBUFFER, gl.DEPTH_COMPONENT24, columns, rows);
    const target = gl.createFramebuffer();
    this.updateProbe();
    gl.bindFramebuffer(gl.FRAMEBUFFER, target);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, colour, 0);
    gl.framebufferRenderbuffer(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.RENDERBUFFER, depth);
    gl.viewport(0, 0, columns, rows);
    this.drawView(this.cameraOf(walker, width / height), mode);
    const texels = new Float32Array(4 * columns * rows);
    gl.readPixels(0, 0, columns, rows, gl.RGBA, gl.FLOAT, texels);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.deleteFramebuffer(target);
    gl.deleteRenderbuffer(depth);
    gl.deleteTexture(colour);
    const picture = new Float32Array(3 * width * height);
    for (let row = 0; row < rows; ++row) {
      const y = height - 1 - Math.floor(row / samples);
      for (let column = 0; column < columns; ++column) {
        const at = 3 * (y * width + Math.floor(column / samples));
        for (let c = 0; c < 3; ++c) {
          picture[at + c] += texels[4 * (row * columns + column) + c] * this.unit / samples ** 2;
        }
      }
    }
    return picture;
  }

  /// What is seen of a place from another: cd/m2.
  luminance(eye, place) {
    const forward = normalized(subtract(place, eye)), right = normalized(cross(forward, [1e-6, 1, 0]));
    return room.lux * luminanceOf(this.radiance({eye, forward, right, angle: 1e-3}, 1, 1));
  }

  /// Light of each lamp, linear RGB at its power, at a place of the light maps.
  lightAt(lightUv) {
    const {width, height} = room.atlas;
    const x = lightUv[0] * width - 0.5, y = lightUv[1] * height - 0.5;
    const column = clamp(Math.floor(x), 0, width - 2), row = clamp(Math.floor(y), 0, height - 2);
    const fx = x - column, fy = y - row;
    const corners = [[0, (1 - fx) * (1 - fy)], [1, fx * (1 - fy)], [width, (1 - fx) * fy],
                     [width + 1, fx * fy]];
    const colour = [0, 0, 0];
    return this.layers.map((texels, layer) => {
      const light = [0, 0, 0];
      for (const [offset, weight] of corners) {
        unpack(texels[row * width + column + offset], colour);
        for (let c = 0; c < 3; ++c) light[c] += weight * colour[c];
      }
      return light.map((part, c) => part * room.lights[layer].brightest * this.lit[layer][c]);
    });
  }
}
