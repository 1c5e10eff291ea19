// The page while photile computes (host/apps/serve): light, exact pictures and lux come from the server
// that the page came from; the view and the lamps go there.

/// Milliseconds between posts while the viewer moves, after which he rests, and between lamps; seconds
/// in which light and pictures fade.
const pace = {moving: 150, rest: 250, lamps: 60, light: 0.5, picture: 0.35};

class Live {
  constructor(page) {
    this.page = page;
    this.renderer = page.renderer;
    this.name = [...crypto.getRandomValues(new Uint32Array(3))].map((part) => part.toString(16)).join('');
    this.known = this.wanted = 0;  // states of the light
    this.fading = 0;               // seconds left
    this.exposes = true;           // until the first exact picture, or the viewer's own exposure
    this.ownLamps = location.hash.length > 1;  // a link has them, and they are to be everybody's
    this.work = find('#work');
    this.posts = new Promise((opened) => { this.open = opened; });
    this.makeMoods();
    const news = new EventSource(`events?viewer=${this.name}`);
    news.onopen = () => {
      this.open();
      this.view = null;
      page.points.all.forEach((point) => this.measure(point));
      page.wake();
    };
    news.onmessage = ({data}) => this.hear(JSON.parse(data));
    news.onerror = () => this.showWork('photile does not answer any more');
  }

  /// Posts follow each other.
  post(what, body) {
    this.posts = this.posts.then(async () => {
      const answer = await fetch(`${what}?viewer=${this.name}`, {
        method: 'POST', headers: {'Content-Type': 'application/json'}, body: JSON.stringify(body)});
      if (answer.status === 400) tell(await answer.text());
    }).catch(() => {});
    return this.posts;
  }

  /// A header and the bytes behind it; null where there is no such thing any more.
  async load(what) {
    const answer = await fetch(what);
    if (!answer.ok) return null;
    const bytes = new Uint8Array(await answer.arrayBuffer());
    const text = new TextDecoder();
    const start = 8 + parseInt(text.decode(bytes.subarray(0, 8)), 16);
    return {header: JSON.parse(text.decode(bytes.subarray(8, start))), bytes: bytes.subarray(start)};
  }

  hear(news) {
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
      this.page.panel.makePresets((name) => this.post('moods', {remove: name}));
      find('#presets').hidden = false;
    }
    for (const {number, from, repeats} of news.points ?? []) {
      this.page.points.all.find((point) => point.number === number)?.repeats.splice(from, Infinity, ...repeats);
    }
    if (news.points) this.page.points.show();
    if (news.message) tell(news.message);
    if (news.work !== undefined) this.showWork(news.work);
  }

  showWork(work) {
    this.work.hidden = !work;
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
      const loaded = await this.load(`light?since=${this.known}`).catch(() => null);
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
    }
    this.takes = false;
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
    renderer.mix(weights, true);
    this.fading = pace.light;
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
    const {header, bytes} = loaded, {lights} = this.page, {canvas} = this.renderer;
    if (header.width !== canvas.width || header.height !== canvas.height) return;
    this.exposes = false;
    const numbers = header.layers.map((name) => room.lights.findIndex((light) => light.name === name));
    // The sky's layer has the powers of the hour.
    const weigh = () => {
      const weights = lights.weights();
      return numbers.map((i) => (i < 0 ? Array(3).fill(lights.skyFactor) : weights[i]));
    };
    this.renderer.setRest(header, weigh, new Uint16Array(bytes.slice().buffer));
    this.renderer.rest.number = number;
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

  /// Tells where the viewer looks, if that has changed.
  look() {
    const {walker, lights} = this.page, {canvas} = this.renderer;
    const view = {eye: walker.eye, forward: walker.forward, angle: walker.angle, width: canvas.width,
                  height: canvas.height};
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
