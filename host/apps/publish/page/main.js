// Puts the parts of the page together.

/// Factor that brings the log-average luminance to the display's key, without lamps and black: the
/// rule of automatic_exposure in host/pictures/image/display.cpp.
function automaticExposure(radiance) {
  const {key, outliers, share, black, highlights} = room.display;
  const luminances = [];
  for (let i = 0; i < radiance.length; i += 3) {
    const value = luminanceOf([radiance[i], radiance[i + 1], radiance[i + 2]]);
    if (value > 0 && Number.isFinite(value)) luminances.push(value);
  }
  if (luminances.length === 0) return 1;
  luminances.sort((a, b) => a - b);
  const ofShare = (list) => Math.floor(share * list.length);
  const least = luminances.at(-1 - ofShare(luminances)) / black;
  const seen = luminances.filter((value) => value >= least);
  const median = seen[Math.floor(seen.length / 2)];
  const lit = seen.filter((value) => value >= median / outliers);
  const surfaces = lit.filter((value) => value <= outliers * median);
  const counted = lit.slice(0, Math.max(surfaces.length, lit.length - ofShare(seen)));
  const mean = counted.reduce((sum, value) => sum + Math.log(value), 0) / counted.length;
  return Math.min(key / Math.exp(mean), highlights / surfaces.at(-1 - ofShare(surfaces)));
}

const areNumbers = (list, count) => list.length === count &&
    list.every((value) => Number.isFinite(value) && Math.abs(value) <= 1e30);

/// Milliseconds of frames while something moves: slower ones are followed by ones of fewer pixels (without a graphics
/// chip), quicker ones by more; after `rest` nothing moves any more. `least` of the pixels, across and down.
const motion = {slow: 60, quick: 25, rest: 200, least: 0.25};

class Page {
  movingShare = 1;  // of the pixels that are drawn while something moves

  async open() {
    this.canvas = find('#view');
    this.renderer = new Renderer(this.canvas);
    const loading = find('#loading');
    const archive = new Archive();
    const bar = loading.querySelector('progress');
    const total = Object.keys(room.sections).length;
    let done = 0;
    const array = archive.array.bind(archive);
    archive.array = async (...parts) => {
      const result = await array(...parts);
      bar.value = ++done / total;
      return result;
    };
    if (room.hours) {
      const codes = await archive.array('hours');
      room.hours.luminances = Float64Array.from(
          codes, (code) => (code ? 2 ** (code / room.hours.steps - room.hours.offset) : 0));
    }
    this.lights = new Lights();
    if (room.hours) this.lights.hour = {day: room.hours.startDay, time: room.hours.startTime};
    await this.renderer.load(archive);
    if (!room.live) this.errors = await archive.array('errors');
    this.surfaces = new Surfaces(this.renderer.positions, this.renderer.indices);
    this.walker = new Walker(this.surfaces);
    this.plan = new Plan(this);
    this.panel = new Panel(this.lights, (what, holds) => this.changed(what, holds));
    this.points = new Points(this);
    this.history = new LightHistory(this.lights, (what) => {
      this.panel.show();
      this.show(what);
    });
    this.makeViews();
    this.makeDisplay();
    this.makeTools();
    this.walker.stand(room.cameras[0]);
    this.begin();
    if (room.live) this.live = new Live(this);
    this.restore();
    this.history.settle();
    this.panel.show();
    listen(this.walker, () => this.view, this.canvas, find('#pad'), () => this.wake(), (x, y) => this.click(x, y));
    window.addEventListener('resize', () => this.wake());
    window.addEventListener('hashchange', () => this.restore());
    window.addEventListener('gamepadconnected', () => this.wake());
    this.dirty = true;
    this.wake();
    if (this.renderer.isSlow) this.coarsen();
    if (kept) this.resume();
    else loading.remove();
    this.canvas.focus({preventScroll: true});
  }

  /// What is drawn, and what pointers move.
  get view() { return this.plan.on ? this.plan : this.walker; }

  /// Goes on as the page before was left.
  resume() {
    this.setMode(kept.mode);
    if (kept.plan) this.plan.open(kept.plan);
    this.panel.unfold(!kept.folded);
    this.setPace(kept.pace);
    find('#follow').checked = kept.follows;
    for (const {place, normal} of kept.points) {
      const from = add(place, scaled(normal, 0.01)), down = scaled(normal, -1);
      const hit = this.surfaces.meet(from, down);
      if (hit) this.points.add({...hit, place: add(from, scaled(down, hit.distance))});
    }
    this.points.close();
    setTimeout(() => find('#loading')?.remove(), 5000);
  }

  /// Shows the published light as `photile render` does. The light of an hour has its own exposure.
  begin() {
    this.renderer.mix(this.lights.weights());
    if (room.hours && !room.live) {
      this.renderer.unit = 1 / this.seenExposure();
      this.renderer.mix(this.lights.weights());
    }
    this.setExposure(0);
  }

  /// The exposure of what is in view.
  seenExposure(walker = this.walker) {
    const aspect = clamp(this.canvas.clientWidth / Math.max(1, this.canvas.clientHeight), 0.5, 2);
    return automaticExposure(this.renderer.radiance(walker, Math.round(96 * aspect), 96));
  }

  /// Exposes for what is in view: steps of the slider from the published light.
  adapt() {
    if (!this.renderer.isLit) return;
    if (this.live) this.live.exposes = false;
    this.renderer.mix(this.lights.weights());
    this.lightIsOld = false;
    this.setExposure(clamp(Math.log2(this.seenExposure() * this.renderer.unit), -12, 14));
  }

  setExposure(stops) {
    this.stops = stops;
    this.renderer.exposure = 2 ** stops;
    const slider = find('#exposure');
    if (stops < Number(slider.min)) slider.min = Math.floor(stops);
    if (stops > Number(slider.max)) slider.max = Math.ceil(stops);
    slider.value = stops;
    find('#display output').textContent = `${stops >= 0 ? '+' : '−'}${Math.abs(stops).toFixed(1)} EV`;
    this.wake();
  }

  /// False colours up to the lux that were asked for, or automatically as host/lighting/report/false_colour.cpp has
  /// it: the uppermost 2% are beyond, and steps have round middles.
  setScale() {
    const {falseColours} = this.renderer, steps = room.legendSteps;
    const lux = this.renderer.seenLux(this.view).filter((value) => value > 0).sort((a, b) => a - b);
    const step = (lux[lux.length - 1 - Math.floor(0.02 * lux.length)] ?? 1) / steps;
    const decade = 10 ** Math.floor(Math.log10(step));
    const round = [1, 1.2, 1.6, 2, 3, 4, 6, 8, 10].find((part) => part * decade >= step * 0.999) * decade;
    falseColours.top = find('#top').validity.valid && Number(find('#top').value) || round * steps;
    const colour = (share) => `rgb(${this.renderer.colours[Math.round(255 * share)].join(' ')})`;
    const middles = Array.from({length: steps}, (_, i) => (i + 0.5) / steps);
    find('#scale').style.background = `linear-gradient(to right, ${
        falseColours.contours === 0
            ? Array.from({length: 17}, (_, i) => colour(i / 16)).join(', ')
            : middles.map((share, i) => `${colour(share)} ${100 * i / steps}% ${100 * (i + 1) / steps}%`).join(', ')})`;
    const [part, unit] = falseColours.top < 1e4 ? [1, ''] : [1000, 'k'];
    find('#legend figcaption').replaceChildren(...middles.map((share) => element('span', {
      textContent: Number((share * falseColours.top / part).toPrecision(4)) + unit})));
  }

  ///   holds   whether a control is held that goes on changing
  changed(what, holds = false) {
    this.history.note(what, holds);
    this.show(what);
  }

  /// Shows lights that have changed.
  show(what) {
    this.lightIsOld = true;
    this.live?.lampsChanged();
    if (what === 'preset' || (what === 'hour' && find('#follow').checked)) this.adapt();
    this.wake();
    this.points.show();
  }

  mixLight() {
    if (!this.lightIsOld) return;
    this.renderer.mix(this.lights.weights());
    this.lightIsOld = false;
  }

  wake() {
    this.dirty = true;
    if (this.scheduled) return;
    this.scheduled = true;
    this.lastTime = performance.now();
    requestAnimationFrame((time) => this.frame(time));
  }

  frame(time) {
    const began = performance.now();
    this.scheduled = false;
    const since = time - this.lastTime, passed = clamp(since / 1000, 0, 0.1);
    const moved = this.view.advance(passed), mixed = this.lightIsOld;
    this.lastTime = time;
    this.mixLight();
    const fades = this.live?.advance(since / 1000);
    if (moved || fades || this.dirty) {
      this.renderer.draw(this.view);
      if (this.plan.on) this.plan.draw();
      this.points.place();
      this.live?.look();
    }
    this.dirty = fades;
    this.fitFrames(moved || mixed, since);
    const pads = [...(navigator.getGamepads?.() ?? [])].some((pad) => pad?.connected);
    if (moved || fades || pads || this.renderer.share < 1 || this.dirty || this.walker.keys.size > 0 || this.walker.stick.some((part) => part !== 0)) {
      this.scheduled = true;
      requestAnimationFrame((next) => this.frame(next));
    }
    this.frameTime = performance.now() - began;
  }

  /// Draws few pixels until all has rested for a moment.
  coarsen() {
    this.renderer.share = this.movingShare = motion.least;
    this.lastMotion = performance.now();
  }

  fitFrames(moved, milliseconds) {
    const {renderer} = this;
    if (moved) {
      this.lastMotion = this.lastTime;
      if (milliseconds > motion.slow) this.movingShare = Math.max(motion.least, 0.7 * this.movingShare);
      else if (milliseconds < motion.quick) this.movingShare = Math.min(1, this.movingShare / 0.9);
      renderer.share = this.movingShare;
    } else if (renderer.share < 1 && this.lastTime - this.lastMotion > motion.rest) {
      renderer.share = 1;
      this.dirty = true;
    }
  }

  makeViews() {
    const list = find('#bookmarks');
    room.cameras.forEach((camera, i) => {
      const button = element('button', {type: 'button', textContent: camera.name});
      button.addEventListener('click', () => this.stand(i));
      list.append(button);
    });
  }

  stand(i) {
    if (!room.cameras[i]) return;
    this.plan.close();
    this.walker.stand(room.cameras[i]);
    this.wake();
  }

  makeDisplay() {
    find('#exposure').addEventListener('input', (event) => {
      if (this.live) this.live.exposes = false;
      this.setExposure(Number(event.target.value));
    });
    find('#adapt').addEventListener('click', () => this.adapt());
    find('#follow').addEventListener('input', () => {
      if (this.live) this.live.exposes = false;
    });
    const kind = find('#contours');
    kind.addEventListener('input', () => {
      this.renderer.falseColours.contours = Number(kind.value);
      this.setMode(2);
    });
    const palette = find('#palette');
    palette.append(...room.palettes.map(({name}, value) => element('option', {value, textContent: name})));
    palette.addEventListener('input', () => {
      this.renderer.setPalette(Number(palette.value));
      this.setMode(2);
    });
    find('#top').addEventListener('input', () => this.setMode(2));
    document.querySelectorAll('[name=shown]').forEach((button) => {
      button.addEventListener('input', () => this.setMode(Number(button.value)));
    });
  }

  setMode(mode) {
    this.renderer.mode = mode;
    find(`[name=shown][value="${mode}"]`).checked = true;
    find('#legend').hidden = mode !== 2;
    if (mode === 2) this.setScale();
    this.wake();
  }

  makeTools() {
    const tools = {
      F: ['#fly', () => {
        this.walker.flies = !this.walker.flies;
        find('#fly').setAttribute('aria-pressed', this.walker.flies);
        this.wake();
      }],
      T: ['#plan', () => (this.plan.on ? this.plan.close() : this.plan.open())],
      P: ['#picture', () => this.save()],
      C: ['#link', () => this.share()],
      H: ['#help', () => {
        this.tellFrames();
        find('#about').showModal();
        find('#about-title').focus();  // rather than Close, which is at the end of a long dialog
      }],
      X: ['#adapt', () => this.adapt()],
      V: [null, () => this.setMode(this.renderer.mode === 2 ? 0 : 2)],
      L: [null, () => this.point(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2, true)],
    };
    for (const [button, act] of Object.values(tools)) {
      if (button && button !== '#adapt') find(button).addEventListener('click', act);
    }
    find('#speed').addEventListener('input', ({target}) => this.setPace(Number(target.value)));
    window.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey || find('#about').open) return;
      if (isWriting(event.target)) return;
      const key = event.key.toUpperCase();
      if (event.code === 'F2') {
        event.preventDefault();
        find('#panel').hidden = !find('#panel').hidden;
      } else if (this.panel.takeHourKey(event)) event.preventDefault();
      else if (tools[key]) tools[key][1]();
      else if (/^[1-9]$/.test(key)) this.stand(Number(key) - 1);
      else if (key === 'ESCAPE') this.points.close();
    });
    const {used, texel} = room.atlas;
    find('#facts').textContent =
        `${room.lights.length} light map${room.lights.length === 1 ? '' : 's'} of ${
            shortNumber(used)} texels, ${shortNumber(100 * texel)} cm apart; ${
            shortNumber(this.renderer.indices.length / 3)} triangles. Made by photile ${room.version}.`;
    find('#simplified').textContent = `Simplified here: ${room.simplified.join('; ')}.`;
  }

  ///   doublings   of the usual pace
  setPace(doublings) {
    this.walker.pace = walking.pace * 2 ** doublings;
    find('#speed').value = doublings;
    this.panel.tellValue('speed', `${shortNumber(this.walker.pace)} m/s`);
  }

  tellFrames() {
    const {drawCalls, texelsRead, rest, screen, canvas: {width, height}} = this.renderer;
    const samples = rest ? `${rest.samples} samples, rendered by photile` : `${Math.max(1, screen.count)} samples`;
    find('#frames').textContent = `The last frame: ${width} × ${height} pixels of ${samples}; draw calls: ${
        drawCalls}; texels of light maps: ${shortNumber(texelsRead)}; ${this.frameTime.toFixed(1)} ms of JavaScript.`;
  }

  /// From the eye to a place of the page.
  directionTo(x, y) {
    const {forward, right, angle} = this.view;
    const up = cross(right, forward), tangent = Math.tan(angle / 2);
    const aspect = this.canvas.clientWidth / this.canvas.clientHeight;
    return normalized(add(forward, add(
        scaled(right, (2 * x / this.canvas.clientWidth - 1) * tangent * aspect),
        scaled(up, (1 - 2 * y / this.canvas.clientHeight) * tangent))));
  }

  /// The triangle at a place of the page.
  meet(x, y) {
    const direction = this.directionTo(x, y), eye = add(this.view.eye, scaled(direction, this.view.near ?? 0));
    const hit = this.surfaces.meet(eye, direction, (triangle, facing) => {
      const part = this.partOf(triangle);
      return !part.clear && (part.interaction === 1 || facing < 0);
    });
    return hit && {...hit, eye, place: add(eye, scaled(direction, hit.distance))};
  }

  partOf(triangle) {
    return room.parts.find(({first, count}) => 3 * triangle >= first && 3 * triangle < first + count);
  }

  /// Illuminance at a point of a triangle: lux, its standard error, and those of each light.
  illuminance({triangle, u, v}) {
    const uv = [0, 1].map((axis) => [1 - u - v, u, v].reduce((sum, weight, i) =>
      sum + weight * this.renderer.lightUvs[2 * this.renderer.indices[3 * triangle + i] + axis], 0) / 65535);
    const lux = this.renderer.lightAt(uv).map((light) => luminanceOf(light) * room.lux);
    const all = lux.reduce((sum, value) => sum + value, 0);
    if (room.live) return {lux: all, error: null, lights: lux, errors: null};
    const {width, height, block} = room.atlas;
    const columns = Math.ceil(width / block), rows = Math.ceil(height / block);
    const cell = Math.min(rows - 1, Math.floor(uv[1] * height / block)) * columns +
                 Math.min(columns - 1, Math.floor(uv[0] * width / block));
    const errors = lux.map((value, i) => {
      const code = this.errors[i * columns * rows + cell];
      return value * (code ? 2 ** ((code - 255) / room.atlas.errorSteps) : 0);
    });
    return {lux: all, error: Math.hypot(...errors), lights: lux, errors};
  }

  async click(x, y) {
    if (!await this.live?.click(x, y)) this.point(x, y);
  }

  point(x, y, middle = false) {
    const hit = this.meet(x, y);
    find('#cross').hidden = !middle;
    if (hit) this.points.add(hit);
    else this.points.close();
  }

  /// Where the page shows a point; null where it lies behind the eye.
  placeOf(point) {
    const {forward, right, eye, angle} = this.view;
    const offset = subtract(point, eye), depth = dot(offset, forward);
    if (!(depth > 1e-6)) return null;
    const {clientWidth: width, clientHeight: height} = this.canvas;
    const scale = height / 2 / Math.tan(angle / 2) / depth;
    return [width / 2 + dot(offset, right) * scale, height / 2 - dot(offset, cross(right, forward)) * scale];
  }

  save() {
    this.renderer.share = 1;
    this.renderer.draw(this.view);
    this.canvas.toBlob((blob) => {
      saveFile(`${room.title}.png`, blob);
      tell('The picture is saved.');
    });
  }

  /// The view and the lights as the part of a link after its #.
  get state() {
    const short = (value) => Number(value.toPrecision(5));
    const {eye, yaw, pitch, angle, flies} = this.walker;
    return encodeURIComponent(JSON.stringify({
      eye: eye.map(short), look: [yaw, pitch, angle].map(short), fly: flies ? 1 : 0, ev: short(this.stops),
      ...this.lamps,
    }));
  }

  /// The lights as they differ from those of the scene.
  get lamps() {
    const short = (value) => Number(value.toPrecision(5));
    return {
      lights: Object.fromEntries(room.lights.flatMap((light, i) => {
        const {power, on, solo, kelvin, tint} = this.lights.states[i];
        const same = tint.every((part, c) => part === light.tint[c]);
        if (light.patch !== undefined) return [];
        if (power === light.power && on === light.power > 0 && same && !solo) return [];
        return [[light.name, [short(power), on ? 1 : 0, kelvin || (same ? 0 : tint.map(short)), solo ? 1 : 0]]];
      })),
      sky: this.lights.sky.on ? 1 : 0,
      day: this.lights.hour ? [this.lights.hour.day, this.lights.hour.time] : null,
    };
  }

  /// What `lamps` has written, its lights as a list; throws where it has not.
  lampsOf(state) {
    const lights = Object.entries(state.lights ?? {}).map(([name, [power, on, colour, solo]]) => {
      const sound = areNumbers([power], 1) && power >= 0 &&
          (Array.isArray(colour) ? areNumbers(colour, 3) : areNumbers([colour ?? 0], 1));
      if (!sound) throw new Error('light');
      return {name, power, on: Boolean(on), colour, solo: Boolean(solo)};
    });
    if (state.day && !areNumbers(state.day, 2)) throw new Error('day');
    return {...state, lights};
  }

  /// What `state` has written; throws where it has not.
  stateOf(text) {
    const state = this.lampsOf(JSON.parse(decodeURIComponent(text)));
    const sound = areNumbers(state.eye, 3) && areNumbers(state.look, 3) && areNumbers([state.ev], 1);
    if (!sound) throw new Error('numbers');
    return state;
  }

  restore() {
    const text = kept?.state ?? location.hash.slice(1);
    if (!text) return;
    let state;
    try {
      state = this.stateOf(text);
    } catch {
      tell('The link is damaged: this is the room as it was published.');
      if (this.live) this.live.ownLamps = false;
      return;
    }
    this.walker.standAt(state.eye);
    [this.walker.yaw, this.walker.pitch, this.walker.angle] = state.look;
    this.walker.flies = Boolean(state.fly);
    find('#fly').setAttribute('aria-pressed', this.walker.flies);
    this.takeLamps(state);
    this.live?.lampsChanged();
    this.setExposure(clamp(state.ev, -12, 14));
    this.history.settle();
    this.panel.show();
    this.wake();
  }

  takeLamps(state) {
    for (const {name, power, on, colour, solo} of state.lights) {
      const i = room.lights.findIndex((light) => light.name === name);
      if (i < 0) continue;
      Object.assign(this.lights.states[i], {power, on, solo});
      if (Array.isArray(colour)) this.lights.states[i].tint = colour;
      else if (colour) this.lights.setKelvin(i, clamp(colour, kelvins.low, kelvins.high));
    }
    this.lights.sky.on = Boolean(state.sky ?? 1);
    if (room.hours && state.day) {
      this.lights.hour = {day: clamp(Math.round(state.day[0]), 1, 365),
                          time: clamp(state.day[1], 0, room.hours.times.length - 1)};
    }
    this.lightIsOld = true;
  }

  /// Lamps as another page has them.
  setLamps(lamps) {
    this.lights.states = new Lights().states;
    this.takeLamps(this.lampsOf(lamps));
    this.history.settle();
    this.panel.show();
    this.wake();
    this.points.show();
  }

  async share() {
    history.replaceState(null, '', `#${this.state}`);
    try {
      await navigator.clipboard.writeText(location.href);
      tell('The link to this view and light is copied.');
    } catch {
      tell('The address of the page is now the link to this view and light.');
    }
  }
}

const page = new Page();
page.open().catch((error) => {
  const loading = document.getElementById('loading');
  if (loading) loading.textContent = `${error.message} Try another browser, or another machine.`;
  else throw error;
});
