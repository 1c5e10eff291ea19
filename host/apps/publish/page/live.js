// The page while photile computes (host/apps/serve): light, exact pictures and lux come from the server
// that the page came from; the view and the lamps go there.

/// Milliseconds between posts while the viewer moves, after which he rests, and between lamps; seconds
/// in which light and pictures fade.
const pace = {moving: 150, rest: 250, lamps: 60, light: 0.5, picture: 0.35};

/// What a page keeps for the text that follows it: the server has loaded the scene again.
const kept = room.live ? JSON.parse(sessionStorage.getItem('kept')) : null;
if (kept) {
  sessionStorage.removeItem('kept');
  find('#loading').style.background = `center / cover url(${kept.picture})`;
  find('#loading').replaceChildren(find('#loading progress'));
}

class Live {
  constructor(page) {
    this.page = page;
    this.renderer = page.renderer;
    this.name = [...crypto.getRandomValues(new Uint32Array(3))].map((part) => part.toString(16)).join('');
    this.known = this.wanted = 0;  // states of the light
    this.fading = 0;               // seconds left
    this.exposes = true;           // until the first exact picture, or the viewer's own exposure
    // A link has them, and they are to be everybody's.
    this.ownLamps = location.hash.length > 1;
    if (kept && !kept.exposes) {
      this.exposes = false;
      this.renderer.unit = kept.unit;
    }
    this.work = find('#work');
    this.posts = new Promise((opened) => { this.open = opened; });
    this.makeMoods();
    this.photons = new PhotonMap(this);
    this.glare = new Glare(this);
    this.makeExr();
    const news = new EventSource(`events?viewer=${this.name}&since=${room.live}`);
    news.onopen = () => {
      this.open();
      this.view = null;
      page.points.all.forEach((point) => this.measure(point));
      page.wake();
    };
    news.onmessage = ({data}) => this.hear(JSON.parse(data));
    news.onerror = () => this.showWork('photile does not answer any more');
  }

  /// Asks the server for something that depends on what is posted.
  async ask(what, body) {
    const answer = await fetch(`${what}?viewer=${this.name}`, {
      method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
    if (answer.status === 400) tell(await answer.text());
    return answer;
  }

  /// Posts follow each other. Returns the answer; null where there is none.
  post(what, body) {
    const answered = this.posts.then(async () => {
      const answer = await this.ask(what, body);
      if (answer.status !== 200) return null;
      const told = await answer.json();
      if (told.message) tell(told.message);
      return told;
    }).catch(() => null);
    this.posts = answered;
    return answered;
  }

  /// A header and the bytes behind it; null where there is no such thing any more.
  ///   body   that is posted to ask for it
  async load(what, body) {
    const answer = await (body ? this.ask(what, body) : fetch(what));
    if (answer.status !== 200) return null;
    const bytes = new Uint8Array(await answer.arrayBuffer());
    const text = new TextDecoder();
    const start = 8 + parseInt(text.decode(bytes.subarray(0, 8)), 16);
    return {header: JSON.parse(text.decode(bytes.subarray(8, start))), bytes: bytes.subarray(start)};
  }

  hear(news) {
    if (news.stale) this.wanted = 0;  // the server has the light of another room by now
    if (news.reload) {
      this.reload();
      return;
    }
    if (news.light > this.wanted) {
      this.wanted = news.light;
      this.takeLight();
    }
    if (news.white) {
      room.display.white = news.white;
      this.page.wake();
    }
    if (news.picture) this.takePicture(news.picture);
    if (news.lamps && !this.ownLamps) this.page.setLamps(news.lamps);
    if (news.presets) {
      room.presets = news.presets;
      this.page.panel.makePresets((name) => this.post('moods', {remove: name}),
                                  (name) => this.post('moods', {write: name}));
      find('#presets').hidden = false;
    }
    for (const {number, from, repeats} of news.points ?? []) {
      this.page.points.all.find((point) => point.number === number)?.repeats.splice(from, Infinity, ...repeats);
    }
    if (news.points) this.page.points.show();
    if (news.luminaires) (this.luminaires ??= new Luminaires(this)).show(news.luminaires);
    if (news.settings) (this.settings ??= new Settings(this)).show(news.settings);
    if (news.year) (this.year ??= new Year(this)).show(news.year);
    if (news.message) tell(news.message);
    if (news.work !== undefined) this.showWork(news.work);
  }

  /// Loads the page of the scene as it is by now; this one's picture stays until that has light.
  reload() {
    if (this.luminaires?.drags) {
      setTimeout(() => this.reload(), pace.rest);
      return;
    }
    const {page, renderer} = this, {canvas, unit} = renderer;
    renderer.draw(page.view);
    const exposes = this.exposes || room.lights.some(({name}) => name === 'work_light');
    this.reloads = true;
    sessionStorage.setItem('kept', JSON.stringify({
      state: page.state, plan: page.plan.shown, step: this.luminaires?.step, mode: renderer.mode, exposes, unit, folded: find('#controls').hidden,
      pace: Number(find('#speed').value), follows: find('#follow').checked,
      points: page.points.all.map(({place, normal}) => ({place, normal})), scroll: find('#controls').scrollTop, picture: canvas.toDataURL('image/jpeg')}));
    location.reload();
  }

  showWork(work) {
    this.work.hidden = !work;
    if (work === null && this.savesExr) this.saveExr();
    if (!work) return;
    const [bar, text] = this.work.children;
    text.textContent = work.stage
        ? `Light is being computed: ${work.stage}${work.share ? ` ${Math.round(100 * work.share)}%` : ''}` : work;
    bar.hidden = !work.share;
    bar.value = work.share ?? 0;
  }

  async takeLight() {
    if (this.takes) return;
    this.takes = true;
    while (this.wanted > this.known) {
      const loaded = await this.load(`light?viewer=${this.name}&since=${this.known}`).catch(() => null);
      if (!loaded) break;
      const {header, bytes} = loaded;
      if (!this.renderer.isLit) {
        room.lights.forEach((light, i) => { light.brightest = header.brightest[i]; });
        this.renderer.fillMaps(header.mean);
      }
      for (const {x, y, at, packed, brightest} of header.tiles) {
        const plain = await inflate(bytes.subarray(at, at + packed));
        this.renderer.setTile(x, y, header.side, decodeLight(plain, header.side, brightest));
      }
      this.known = header.version;
      this.showLight(header.mean);
      await this.pause();
    }
    this.takes = false;
  }

  /// Waits for the next frame and four times as long as it takes: without a graphics chip it is drawn on the processor
  /// that computes the light.
  async pause() {
    const later = (milliseconds) => new Promise((done) => { setTimeout(done, milliseconds); });
    const {gl} = this.renderer;
    await new Promise(requestAnimationFrame);
    const began = performance.now(), fence = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    while (gl.clientWaitSync(fence, 0, 0) === gl.TIMEOUT_EXPIRED) await later(10);
    gl.deleteSync(fence);
    await later(4 * (performance.now() - began));
  }

  showLight(mean) {
    const {renderer, page} = this, weights = page.lights.weights();
    if (!renderer.isLit) {
      const lit = weights.reduce((sum, weight, i) => sum + luminanceOf(
          weight.map((part, c) => part * mean[i][c])) * room.lights[i].brightest, 0);
      renderer.unit = Math.max(lit / Math.PI, 1e-30);
      renderer.isLit = true;
    }
    if (this.exposes) {
      const opening = new Walker(page.surfaces);
      opening.stand(room.cameras[0]);
      renderer.mix(weights, true);
      [renderer.light, renderer.fresh] = [renderer.fresh, renderer.light];
      renderer.unit = 1 / page.seenExposure(opening);
      [renderer.light, renderer.fresh] = [renderer.fresh, renderer.light];
    }
    renderer.mix(weights, !find('#loading'));
    this.fading = find('#loading') ? 0 : pace.light;
    if (find('#loading')) find('#controls').scrollTop = kept.scroll;
    find('#loading')?.remove();
    page.lightIsOld = false;
    if (renderer.mode === 2) page.setScale();
    page.points.show();
    page.wake();
  }

  async takePicture(number) {
    const view = this.view;
    this.picture = number;  // the newest
    const loaded = await this.load(`picture?viewer=${this.name}`).catch(() => null);
    if (!loaded || view !== this.view) return;
    const {header, bytes} = loaded, {lights} = this.page, {size} = this.renderer;
    if (header.width !== size[0] || header.height !== size[1]) return;
    this.exposes = false;
    const numbers = header.layers.map((name) => room.lights.findIndex((light) => light.name === name));
    // The sky's layer has the powers of the hour.
    const weigh = () => {
      const weights = lights.weights();
      return numbers.map((i) => (i < 0 ? Array(3).fill(lights.skyFactor) : weights[i]));
    };
    this.renderer.setRest(header, weigh, new Uint16Array(bytes.slice().buffer));
    this.renderer.rest.number = number;
    this.glare.find();
    this.page.wake();
  }

  /// Goes on with what fades. Returns whether there is more to come.
  advance(seconds) {
    const {renderer} = this, {rest} = renderer;
    if (this.fading > 0) {
      this.fading -= seconds;
      renderer.fade(this.fading > 0 ? 1 - Math.exp(-8 * seconds / pace.light) : 1);
    }
    if (rest) rest.shown = Math.min(1, rest.shown + seconds / pace.picture);
    return this.fading > 0 || (rest && rest.shown < 1);
  }

  /// Whether a click at a place of the page is for one of the tools.
  async click(x, y) {
    return (!this.page.plan.on && await this.photons.click(x, y)) || Boolean(await this.luminaires?.click(x, y));
  }

  /// Tells where the viewer looks, if that has changed.
  look() {
    this.luminaires?.outline();
    const {walker, lights} = this.page, [width, height] = this.renderer.size;
    const view = {eye: walker.eye, forward: walker.forward, angle: walker.angle, width, height};
    if (this.glare.on) view.glare = true;
    if (lights.hour) {
      view.sky = room.lights.map((light, i) => (light.patch === undefined ? 0 : lights.skyPower(i)));
    }
    const text = JSON.stringify(view);
    if (text === this.view) return;
    this.view = text;
    this.renderer.dropRest();
    const now = performance.now();
    if (now - (this.posted ?? 0) > pace.moving) {
      this.posted = now;
      this.post('view', {...view, moving: true});
    }
    clearTimeout(this.resting);
    this.resting = setTimeout(() => this.post('view', view), pace.rest);
  }

  lampsChanged() {
    if (this.renderer.rest) this.renderer.rest.shown = 1;
    this.fading = 0;
    this.glare.find();
    this.ownLamps = true;  // those of others that are under way are older
    clearTimeout(this.lamps);
    this.lamps = setTimeout(async () => {
      await this.post('lamps', this.page.lamps);
      this.ownLamps = false;
    }, pace.lamps);
  }

  /// Has the light at a point measured from now on: for each repeat the irradiance of each light. Without a place:
  /// no more.
  measure({number, place, normal}) { return this.post('point', {number, place, normal}); }

  /// Power and tint of each light as it shines, for pictures that the server makes.
  mix() {
    const {lights} = this.page, weights = lights.weights();
    return room.lights.map((light, i) => {
      const {power, tint} = light.patch === undefined ? lights.states[i] : light;
      return [weights[i].some((part) => part > 0) ? power : 0, ...tint];
    });
  }

  makeExr() {
    const save = () => {
      this.savesExr = true;
      if (this.work.hidden) this.saveExr();
      else tell('The picture is saved as soon as it is complete.');
    };
    const button = element('button', {type: 'button', textContent: 'EXR',
                                      title: 'Save the exact picture with a layer for each light (Ctrl+S)'});
    button.addEventListener('click', save);
    find('#picture').after(button);
    find('#about dl').insertAdjacentHTML('beforeend', '<dt><kbd>Ctrl+S</kbd></dt><dd>save the exact picture</dd>');
    window.addEventListener('keydown', (event) => {
      if (!(event.ctrlKey || event.metaKey) || event.key.toUpperCase() !== 'S') return;
      event.preventDefault();
      this.luminaires?.save();
      save();
    });
  }

  async saveExr() {
    this.savesExr = false;
    const answer = await this.ask('exr', {mix: this.mix()});
    if (answer.status === 404) tell('There is no exact picture to save.');
    if (!answer.ok) return;
    saveFile(`${room.title}.exr`, await answer.blob());
    tell('The picture is saved.');
  }

  makeMoods() {
    const form = find('#keep');
    form.hidden = false;
    form.addEventListener('submit', (event) => {
      event.preventDefault();
      const name = form.elements.mood.value.trim();
      if (!name) return;
      const lights = room.lights.flatMap((light, i) => {
        if (light.patch !== undefined) return [];
        const {power, on, kelvin, tint} = this.page.lights.states[i];
        const colour = tint.some((part, c) => part !== light.tint[c])
            ? {colour: tint} : {};
        return [[light.name, {power, on, ...(kelvin ? {kelvin} : colour)}]];
      });
      this.post('moods', {keep: name, lights: Object.fromEntries(lights)});
      form.reset();
      document.activeElement.blur();
    });
  }
}
