// The storey of the viewer from above, cut below its ceiling. The page shows it in place of what the viewer sees.

/// The part of the way from the eye to the ceiling at which it is cut, as trace::Room has it; how many times the height
/// that is shown the plan is seen from, so that a wall is as narrow as its top; directions in which walls are looked
/// for; the part of the page that the room takes; metres that the page is high, at least and at most; pixels within
/// which what is moved comes to a line.
const planning = {cut: 0.9, away: 2000, directions: 64, filled: 0.86, metres: [0.5, 2000], reach: 8};

function svgElement(name, attributes = {}) {
  const made = document.createElementNS('http://www.w3.org/2000/svg', name);
  Object.entries(attributes).forEach(([key, value]) => made.setAttribute(key, value));
  return made;
}

/// Looks down like a Walker, as far as pages draw what one sees and pointers move it.
class Plan {
  forward = [0, -1, 0];
  right = [1, 0, 0];
  isPlan = true;
  on = false;
  moved = false;  // since the last frame

  constructor(page) {
    this.page = page;
    this.walls = svgElement('path', {class: 'walls'});
    this.lines = svgElement('path', {class: 'lines'});
    this.scaled = svgElement('g');
    this.scaled.append(this.walls, this.lines);
    this.labels = svgElement('g');
    this.svg = svgElement('svg', {id: 'drawing', 'aria-hidden': true});
    this.svg.append(this.scaled, this.labels);
    page.canvas.after(this.svg);
  }

  ///   shown   {middle, metres}: what of it; none = the room around the viewer
  open(shown = null) {
    const {surfaces, walker} = this.page, {eye} = walker;
    this.floor = walker.ground(eye) ?? surfaces.low[1];
    // A luminaire above the viewer is no ceiling.
    const heights = this.around(eye).map((way) => {
      const place = add(eye, scaled(way, 0.5)), above = surfaces.meet(place, [0, 1, 0]);
      return above ? place[1] + above.distance : Math.max(surfaces.high[1], eye[1]);
    }).sort((a, b) => a - b);
    this.ceiling = heights[Math.floor(heights.length / 2)] ?? Math.max(surfaces.high[1], eye[1]);
    this.cut = eye[1] + planning.cut * (this.ceiling - eye[1]);
    this.near = planning.away * Math.max(1, this.cut - this.floor);
    this.far = this.near + this.cut - surfaces.low[1] + 1;
    this.eye = [eye[0], this.cut + this.near, eye[2]];
    this.on = true;
    document.body.classList.add('plan');
    if (shown) Object.assign(this, {metres: shown.metres, eye: [shown.middle[0], this.eye[1], shown.middle[1]]});
    else this.fit(this.around([eye[0], this.cut, eye[2]]));
    this.walls.setAttribute('d', this.section());
    this.changed();
  }

  close() {
    this.on = false;
    document.body.classList.remove('plan');
    this.changed();
  }

  changed() {
    find('#plan').setAttribute('aria-pressed', this.on);
    if (this.page.renderer.mode === 2) this.page.setScale();
    this.page.wake();
  }

  get shown() { return this.on ? {middle: [this.eye[0], this.eye[2]], metres: this.metres} : null; }
  get angle() { return 2 * Math.atan(this.metres / 2 / this.near); }
  /// Of a pixel.
  get metresAcross() { return this.metres / this.page.canvas.clientHeight; }

  /// Ways over the level from a place to what is met.
  around(place) {
    return Array.from({length: planning.directions}, (_, i) => {
      const angle = 2 * Math.PI * i / planning.directions, way = [Math.sin(angle), 0, Math.cos(angle)];
      const hit = this.page.surfaces.meet(place, way);
      return hit && scaled(way, hit.distance);
    }).filter(Boolean);
  }

  /// Puts what lies along these ways between the header and the panel.
  fit(ways) {
    const {clientWidth: width, clientHeight: height} = this.page.canvas, panel = find('#panel').getBoundingClientRect();
    const top = find('header').getBoundingClientRect().bottom;
    const isWide = panel.left > width / 3;
    const right = isWide ? panel.left : width, bottom = isWide || panel.top < height / 3 ? height : panel.top;
    const [across, along] = [0, 2].map((axis) => ways.map((way) => way[axis]));
    const [low, high] = [Math.min, Math.max].map((of) => [of(0, ...across), of(0, ...along)]);
    const pixel = Math.max((high[0] - low[0]) / right, (high[1] - low[1]) / (bottom - top), 1e-3) / planning.filled;
    this.metres = pixel * height;
    this.eye[0] += (low[0] + high[0]) / 2 + pixel * (width - right) / 2;
    this.eye[2] += (low[1] + high[1]) / 2 + pixel * (height - top - bottom) / 2;
  }

  /// All surfaces at the height of the cut, as the lines of a path.
  section() {
    const {surfaces} = this.page, lines = [];
    for (let t = 0; t < surfaces.indices.length / 3; ++t) {
      const corners = surfaces.corners(t), ends = [];
      corners.forEach((a, i) => {
        const b = corners[(i + 1) % 3];
        if (a[1] > this.cut === b[1] > this.cut) return;
        const [x, , z] = add(a, scaled(subtract(b, a), (this.cut - a[1]) / (b[1] - a[1])));
        ends.push(`${x.toFixed(4)} ${z.toFixed(4)}`);
      });
      if (ends.length === 2) lines.push(`M${ends[0]}L${ends[1]}`);
    }
    return lines.join('');
  }

  // As pointers move it (listen).

  drag(across, down) {
    this.eye = add(this.eye, scaled([-across, 0, -down], this.metresAcross));
    this.moved = true;
  }
  dragTwo(across, down, spread, x, y) {
    this.drag(across, down);
    this.zoom(1 / spread, x, y);
  }
  orbit() {}
  /// So that a place of the page stays.
  zoom(factor, x, y) {
    const before = this.metres, {clientWidth: width, clientHeight: height} = this.page.canvas;
    this.metres = clamp(factor * before, ...planning.metres);
    const less = (before - this.metres) / height;
    this.eye = add(this.eye, [(x - width / 2) * less, 0, (y - height / 2) * less]);
    this.moved = true;
  }

  advance() {
    const {moved} = this;
    this.moved = false;
    return moved;
  }

  /// Draws lines over the frame.
  draw() {
    const {clientWidth: width, clientHeight: height} = this.page.canvas;
    this.scaled.setAttribute('transform', `translate(${width / 2} ${height / 2}) scale(${1 / this.metresAcross})` +
                                          ` translate(${-this.eye[0]} ${-this.eye[2]})`);
  }

  /// Whether a luminaire belongs to the storey: not far above its ceiling, which may slope.
  holds([, y]) { return y > this.floor && y < this.ceiling + 0.5; }

  /// The point at a place of the page, so high.
  pointAt(x, y, height) {
    const direction = this.page.directionTo(x, y);
    return add(this.eye, scaled(direction, (height - this.eye[1]) / direction[1]));
  }

  /// The nearest walls along an axis, 0 or 2: [lower, upper], infinite where there is none.
  wallsAlong(axis, [x, , z]) {
    return [-1, 1].map((sign) => {
      const way = axis === 0 ? [sign, 0, 0] : [0, 0, sign], from = [x, this.cut, z];
      return from[axis] + sign * (this.page.surfaces.meet(from, way)?.distance ?? Infinity);
    });
  }

  /// Brings a place to lines of others or to the middle between walls, if these are near; else to a step of the scene
  /// file's coordinates. {place, guides}, of these {axis, at} for each line.
  ///   offsets   from there to each that moves with it
  ///   others    that it may come into line with
  ///   step      metres; 0 = none
  snap(place, offsets, others, step) {
    const snapped = place.slice(), guides = [];
    for (const axis of [0, 2]) {
      const [lower, upper] = this.wallsAlong(axis, place);
      const values = (list) => new Set(list.map((one) => Number(one[axis].toFixed(4))));
      const lines = [...values(others)].flatMap((at) => [...values(offsets)].map((offset) => [at - offset, at]));
      if (Number.isFinite(upper - lower)) lines.push([(lower + upper) / 2, (lower + upper) / 2]);
      const away = ([to]) => Math.abs(to - place[axis]);
      const nearest = lines.reduce((best, line) => (best && away(best) <= away(line) ? best : line), null);
      if (nearest && away(nearest) <= planning.reach * this.metresAcross) {
        snapped[axis] = nearest[0];
        guides.push({axis, at: nearest[1]});
      } else if (step > 0) {
        const {origin} = room.world;
        snapped[axis] = Math.round((place[axis] + origin[axis]) / step) * step - origin[axis];
      }
    }
    return {place: snapped, guides};
  }

  /// Draws guides over the whole plan, and from the outermost of some places how far the walls are.
  show(guides, places) {
    const {low, high} = this.page.surfaces, lines = guides.map(({axis, at}) => (
        axis === 0 ? `M${at} ${low[2]}V${high[2]}` : `M${low[0]} ${at}H${high[0]}`));
    const labels = [];
    for (const axis of places.length > 0 ? [0, 2] : []) {
      const sorted = [...places].sort((a, b) => a[axis] - b[axis]);
      for (const [side, from] of [sorted[0], sorted.at(-1)].entries()) {
        const to = from.slice();
        to[axis] = this.wallsAlong(axis, from)[side];
        if (!Number.isFinite(to[axis])) continue;
        lines.push(`M${from[0]} ${from[2]}L${to[0]} ${to[2]}`);
        const [x, y] = this.page.placeOf(scaled(add(from, to), 0.5));
        const label = svgElement('text', {x, y});
        label.textContent = Math.abs(to[axis] - from[axis]).toFixed(2);
        labels.push(label);
      }
    }
    this.lines.setAttribute('d', lines.join(''));
    this.labels.replaceChildren(...labels);
  }
}
