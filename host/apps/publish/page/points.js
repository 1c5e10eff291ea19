// Points that are measured: rings in the picture, their list in the panel, and files of them.

const mostPoints = 99;
/// Metres before the surface, which positions on the page are rounded to less than.
const sensorHeight = 1e-4;

/// A place of the page in the scene's file, and a direction.
const directionInWorld = (d) => room.world.axes.reduce((sum, axis, i) => add(sum, scaled(axis, d[i])), [0, 0, 0]);
const positionInWorld = (p) => directionInWorld(add(p, room.world.origin));

const rounded = (value, digits) => String(Number(value.toPrecision(digits)));
const csvField = (text) => (/[",;\t\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);

class Points {
  constructor(page) {
    this.page = page;
    this.all = [];       // {number, hit, place, normal, repeats, ring, row}
    this.clicked = 0;
    this.opened = null;  // whose reading is shown in the picture
    // Patches of the sky are one light.
    const names = room.lights.map(({name, patch}) => (patch === undefined ? name : 'sky'));
    this.layers = [...new Set(names)];
    this.layerOf = names.map((name) => this.layers.indexOf(name));
    this.list = find('#points ol');
    this.factor = find('#maintenance');
    this.target = find('#target');
    this.ownTarget = find('#lux');
    const option = (textContent, value, title = '') => element('option', {textContent, value, title});
    const areas = [...new Set(room.targets.map(({area}) => area))];
    this.target.append(option('no target', 0), option('another target', ''), ...areas.map((label) => element(
        'optgroup', {label}, ...room.targets.filter(({area}) => area === label).map(
            ({name, what, lux}) => option(`${lux} lx ${name.replaceAll('-', ' ')}`, lux, what)))));
    for (const field of [this.factor, this.target, this.ownTarget]) {
      field.addEventListener('input', () => {
        this.ownTarget.hidden = this.target.value !== '';
        this.show();
      });
    }
    find('#save-csv').addEventListener('click', () => this.save('points.csv', this.csv()));
    find('#save-pts').addEventListener('click', () => this.save('points.pts', this.pts()));
    find('#no-points').addEventListener('click', () => this.removeAll());
  }

  ///   hit   as Page.meet finds it
  add(hit) {
    if (this.all.length === mostPoints) {
      tell(`${mostPoints} points are measured at most: remove some in the list.`);
      return;
    }
    const number = ++this.clicked;
    const [a, b, c] = this.page.surfaces.corners(hit.triangle);
    const normal = normalized(cross(subtract(b, a), subtract(c, a)));
    const point = {number, hit, normal, place: add(hit.place, scaled(normal, sensorHeight)), repeats: [],
                   eye: (hit.eye ?? this.page.walker.eye).slice()};
    point.ring = element('i', {textContent: number});
    const open = element('button', {type: 'button', className: 'ring', textContent: number,
                                    title: 'Show in the picture'});
    const drop = element('button', {type: 'button', className: 'drop', textContent: '×',
                                    title: `Remove point ${number}`});
    open.setAttribute('aria-label', `Show point ${number} in the picture`);
    drop.setAttribute('aria-label', drop.title);
    open.addEventListener('click', () => this.open(point));
    drop.addEventListener('click', () => this.remove(point));
    point.value = element('span');
    point.row = element('li', {}, open, element('div', {}, point.value, element('small', {
      textContent: `${positionInWorld(hit.place).map((part) => part.toFixed(3)).join(', ')} m`})), drop);
    find('#rings').append(point.ring);
    this.list.append(point.row);
    this.all.push(point);
    this.page.live?.measure(point);
    this.open(point);
    find('#points').hidden = false;
  }

  open(point) {
    this.opened = point;
    this.show();
    this.place();
  }

  close() { this.open(null); }

  remove(point) {
    this.all = this.all.filter((other) => other !== point);
    point.ring.remove();
    point.row.remove();
    this.page.live?.measure({number: point.number});
    find('#points').hidden = this.all.length === 0;
    if (this.opened === point) this.close();
  }

  removeAll() { this.all.forEach((point) => this.remove(point)); }

  /// Lux of all light, then of each layer, times the maintenance factor, with standard errors; null: not known yet.
  read({hit, repeats}) {
    const factor = this.factor.checkValidity() ? Number(this.factor.value) : 1;
    const sums = (values) => values.reduce((all, value, i) => {
      all[0] += value;
      all[1 + this.layerOf[i]] += value;
      return all;
    }, Array(1 + this.layers.length).fill(0));
    if (repeats.length < 2) {
      const {lights, errors} = this.page.illuminance(hit);
      return {lux: sums(lights).map((value) => factor * value),
              // Lights err apart: their variances add.
              error: errors && sums(errors.map((error) => error ** 2)).map((value) => factor * Math.sqrt(value))};
    }
    const count = repeats.length, {lit} = this.page.renderer;
    const rows = repeats.map((repeat) => sums(repeat.map(
        (light, i) => factor * room.lux * luminanceOf(light.map((part, c) => part * lit[i][c])))));
    const lux = rows[0].map((_, i) => rows.reduce((sum, row) => sum + row[i], 0) / count);
    return {lux, error: lux.map((mean, i) => Math.sqrt(
        rows.reduce((sum, row) => sum + (row[i] - mean) ** 2, 0) / (count - 1) / count))};
  }

  /// Brings the values up to date.
  show() {
    const {page} = this;
    find('#reading').hidden = !this.opened;
    if (this.all.length === 0 || !page.renderer.isLit) return;
    page.mixLight();
    const target = Number(this.target.value || this.ownTarget.value);
    for (const point of this.all) {
      const {lux: [all, ...lights], error} = this.read(point);
      const value = [element('b', {textContent: `${shortNumber(all)} lx`}),
                     error ? ` ± ${shortNumber(error[0])}` : ' …'];
      const short = all < target;
      point.value.replaceChildren(...value, ...(target > 0 ? [element('em', {
        className: short ? 'short' : '', textContent: short ? 'below' : 'met'})] : []));
      if (point !== this.opened) continue;
      const most = lights.map((lux, i) => [lux, this.layers[i].replaceAll('_', ' ')]).sort((a, b) => b[0] - a[0])
          .filter(([lux]) => lux > 0.005 * all).slice(0, 4);
      find('#reading').replaceChildren(
          ...value.map((part) => part.cloneNode?.(true) ?? part),
          `\n${shortNumber(page.renderer.luminance(point.eye, point.hit.place))} cd/m²`,
          ...(most.length > 1 ? most.map(([lux, name]) => `\n${shortNumber(lux)}  ${name}`) : []));
    }
  }

  /// Puts the rings where their points are in the picture.
  place() {
    const {clientWidth: width, clientHeight: height} = this.page.canvas;
    const put = (box, {hit}) => {
      const [x, y] = this.page.placeOf(hit.place) ?? [-1, -1];
      box.style.visibility = x > 0 && x < width && y > 0 && y < height ? '' : 'hidden';
      box.style.left = `${x}px`;
      box.style.top = `${y}px`;
      box.classList.toggle('left', x > width / 2);  // of its point, where the page has room
    };
    for (const point of this.all) put(point.ring, point);
    if (this.opened) put(find('#reading'), this.opened);
  }

  /// As `photile measure --points` reads it: places and normals in the scene's file.
  pts() {
    return this.all.map(({place, normal}) => `${[...positionInWorld(place), ...directionInWorld(normal)].map(
        (value) => rounded(value, 9)).join(' ')}\n`).join('');
  }

  csv() {
    const names = this.layers.flatMap((name) => [`lux ${name}`, `standard_error ${name}`].map(csvField));
    const head = ['point,x,y,z,dx,dy,dz,lux,standard_error', ...names].join(',');
    return [head, ...this.all.map((point) => {
      const {lux, error} = this.read(point);
      return [point.number, ...positionInWorld(point.place).map((part) => rounded(part, 9)),
              ...directionInWorld(point.normal).map((part) => rounded(part, 6)),
              ...lux.flatMap((value, i) => (error ? [rounded(value, 6), rounded(error[i], 3)] : ['', '']))].join(',');
    })].join('\n') + '\n';
  }

  save(name, text) { saveFile(name, new Blob([text], {type: 'text/plain'})); }
}
