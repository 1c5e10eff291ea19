// Luminaires on the live page: the server keeps their list (host/apps/serve/live_luminaires.cpp), and loads
// the scene again with them.

/// Openings that are outlined, at most; metres between the places where lamps are put on a plan; pixels within which
/// they are grasped there.
const mostOutlines = 500, planStep = 0.1, grasp = 10;

class Luminaires {
  ///   live   that hears of them
  constructor(live) {
    this.live = live;
    this.page = live.page;
    this.places = false;  // whether the next click does
    this.drags = null;    // the lamps that are held: {from, to, edit(from, to)}; on a plan they are places of theirs
    this.step = kept?.step ?? planStep;
    this.outlines = svgElement('svg', {id: 'outlines'});
    this.page.canvas.after(this.outlines);
    this.makeSection();
    this.listen();
    this.page.history.beyond = (what) => this.edit({[what]: true});
    find('#about dl').insertAdjacentHTML('beforeend', `<dt><kbd>B</kbd> <kbd>R</kbd> <kbd>Ctrl+D</kbd> <kbd>Delete</kbd></dt>
        <dd>place, turn, duplicate, remove luminaires; on the plan drag them, or use the arrow keys</dd>`);
  }

  makeSection() {
    const button = (text, title, act) => {
      const made = element('button', {type: 'button', textContent: text, title});
      made.addEventListener('click', act);
      return made;
    };
    const field = (name, label, count, attributes, edit) => {
      const inputs = Array.from({length: count}, (_, i) => {
        const input = element('input', {type: 'number', step: 'any', ...attributes});
        input.setAttribute('aria-label', count > 1 ? `${label} ${i + 1}` : label);
        input.addEventListener('change', () => {
          const numbers = inputs.map((one) => one.valueAsNumber);
          if (numbers.every(Number.isFinite)) this.edit(edit(numbers));
        });
        return input;
      });
      this.fields[name] = inputs;
      return element('div', {className: 'entry'}, element('span', {textContent: label}), ...inputs);
    };
    this.fields = {};
    this.status = element('output');
    this.saves = button('Save', 'Write the file (Ctrl+S)', () => this.save());
    this.file = element('select');
    this.file.setAttribute('aria-label', 'Photometric file of lamps to place');
    this.file.addEventListener('change', () => this.edit({file: this.file.value}));
    this.placer = button('Place', 'The next click on a surface places a lamp (B)', () => this.setPlaces(!this.places));
    this.list = element('div', {className: 'list'});
    const array = () => {
      const [count, spacing] = ['count', 'spacing'].map((name) => this.fields[name].map((one) => one.valueAsNumber));
      return {array: {count, spacing}};
    };
    const turn = (degrees) => this.edit({rotate: degrees});
    const step = element('input', {type: 'number', min: 0, step: 'any', value: this.step, id: 'snap'});
    step.addEventListener('input', () => { this.step = step.valueAsNumber || 0; });
    this.snaps = element('div', {className: 'entry', hidden: true}, element('label', {
      htmlFor: step.id, textContent: 'Snap, m', title: 'On the plan lamps are put at multiples of this in the coordinates ' +
          'of the scene file, or in line with others or with the middle of the room; with Shift anywhere'}), step);
    this.selected = element('div', {className: 'form'},
        field('position', 'Position, m', 3, {}, (position) => ({position})),
        field('rotation', 'Rotation, °', 1, {min: -180, max: 180},
              ([degrees]) => ({rotate: degrees - this.entry.rotation})),
        field('lumens', 'Lumens', 1, {min: 0}, ([lumens]) => ({lumens})),
        field('count', 'Count', 2, {min: 1, max: 100, step: 1}, array),
        field('spacing', 'Spacing, m', 2, {min: 0, max: 100}, array),
        element('div', {className: 'buttons'},
                button('Turn', 'Turn by 15 degrees; with Shift back (R)', (event) => turn(event.shiftKey ? -15 : 15)),
                button('Duplicate', 'Another one beside it (Ctrl+D)', () => this.edit({duplicate: true})),
                button('Remove', 'Remove it (Delete)', () => this.edit({remove: true}))));
    const section = element('section', {id: 'luminaires'},
        element('div', {className: 'name'}, element('b', {textContent: 'Luminaires'}), this.status,
                button('↶', 'Undo the last edit of luminaires', () => this.edit({undo: true})),
                button('↷', 'Redo it', () => this.edit({redo: true})), this.saves),
        element('div', {className: 'place'}, this.file, this.placer), this.snaps, this.list, this.selected);
    section.setAttribute('aria-label', 'Luminaires');
    find('#lights').before(section);
  }

  edit(body) { return this.live.post('luminaires', body); }

  async save() {
    if (this.state.unsaved) await this.edit({save: true});
  }

  get entry() { return this.state.entries[this.state.selected]; }

  ///   state   as LiveLuminaires::state gives it
  show(state) {
    this.state = state;
    this.status.textContent = state.loading ? 'loading …' : '';
    this.saves.disabled = !state.unsaved;
    if (state.files.join('\n') !== this.files) {
      this.files = state.files.join('\n');
      this.file.replaceChildren(...state.files.map((name) => element('option', {textContent: name})));
    }
    this.file.value = state.next;
    this.list.replaceChildren(...state.entries.map(({name}, i) => {
      const button = element('button', {type: 'button', textContent: name.replaceAll('_', ' ')});
      button.setAttribute('aria-current', i === state.selected);
      button.addEventListener('click', () => this.edit({select: i === state.selected ? -1 : i}));
      return button;
    }));
    const {entry} = this;
    this.selected.hidden = !entry?.lumens && entry?.lumens !== 0;
    if (!this.selected.hidden) {
      const values = {...entry, position: state.position};
      for (const [name, inputs] of Object.entries(this.fields)) {
        inputs.forEach((input, i) => {
          if (document.activeElement !== input) input.value = Number([values[name]].flat()[i].toFixed(3));
        });
      }
    }
    this.outline();
  }

  setPlaces(places) {
    this.places = places;
    this.placer.setAttribute('aria-pressed', places);
    this.placer.textContent = places ? 'Click a surface' : 'Place';
    this.outlines.classList.toggle('places', places);
  }

  /// Outlines of all openings over the picture, or of those of its storey over the plan.
  outline() {
    if (!this.state) return;
    const {plan} = this.page, shapes = [];
    let left = mostOutlines;
    this.state.entries.forEach(({middles, across, along}, i) => {
      for (const middle of middles.slice(0, left)) {
        const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => this.page.placeOf(
            add(middle, add(scaled(across, x), scaled(along, y)))));
        if (corners.includes(null) || (plan.on && !plan.holds(middle))) continue;
        --left;
        const [cx, cy] = this.page.placeOf(middle), points = corners.map((corner) => corner.join()).join(' ');
        const own = [svgElement('polygon', {points}), ...(plan.on ? [svgElement('circle', {cx, cy, r: grasp})] : [])];
        for (const shape of own) {
          shape.dataset.entry = i;
          shape.classList.toggle('selected', i === this.state.selected);
        }
        shapes.push(...own);
      }
    });
    this.outlines.replaceChildren(...shapes);
    this.snaps.hidden = !plan.on;
    if (plan.on) plan.show(this.drags?.guides ?? [], (this.entry?.middles ?? []).filter((middle) => plan.holds(middle)));
  }

  /// Whether a click is for lamps.
  async click(x, y) {
    if (!this.state) return false;
    const {plan} = this.page;
    if (plan.on) {
      if (this.places) await this.hang(plan.pointAt(x, y, plan.cut));
      return this.places;
    }
    const hit = this.page.meet(x, y), direction = this.page.directionTo(x, y);
    if (this.places) {
      if (!hit) return true;
      this.setPlaces(false);
      const [a, b, c] = this.page.surfaces.corners(hit.triangle);
      const normal = normalized(cross(subtract(b, a), subtract(c, a)));
      await this.edit({place: {place: hit.place, normal: dot(normal, direction) < 0 ? normal : scaled(normal, -1)}});
      return true;
    }
    if (this.state.entries.length === 0) return false;
    // An opening lies a little behind what a ray meets first.
    const answer = await this.edit(
        {pick: {eye: this.page.walker.eye, direction, farthest: hit ? hit.distance + 0.02 : 1e4}});
    return Boolean(answer?.picked);
  }

  /// Puts a lamp below the ceiling over a place of the plan.
  async hang(place) {
    const {plan, surfaces} = this.page, below = plan.snap(place, [[0, 0, 0]], this.middlesBut(-1), this.step).place;
    const above = surfaces.meet(below, [0, 1, 0]);
    if (!above) {
      tell('There is no ceiling.');
      return;
    }
    this.setPlaces(false);
    await this.edit({place: {place: add(below, [0, above.distance, 0]), normal: [0, -1, 0]}});
  }

  /// Of the lamps of other entries on the plan.
  middlesBut(entry) {
    return this.state.entries.flatMap(({middles}, i) => (i === entry ? [] : middles)).filter(
        (middle) => this.page.plan.holds(middle));
  }

  listen() {
    const {outlines} = this;
    outlines.addEventListener('pointerdown', (event) => {
      outlines.setPointerCapture(event.pointerId);
      const {page, page: {plan}} = this, at = (one) => [one.clientX, one.clientY];
      if (plan.on) {
        this.grasp(Number(event.target.dataset.entry), event);
        return;
      }
      const from = page.directionTo(...at(event)), eye = page.walker.eye.slice();
      this.drags = {from, to: from, follow: (one) => page.directionTo(...at(one)),
                    edit: (before, to) => ({drag: {eye, from: before, to}})};
    });
    outlines.addEventListener('pointermove', (event) => {
      if (!this.drags) return;
      this.drags.to = this.drags.follow(event);
      this.drag();
      this.outline();
    });
    outlines.addEventListener('lostpointercapture', () => this.release());
    window.addEventListener('keydown', (event) => this.press(event));
    window.addEventListener('beforeunload', (event) => {
      if (this.state?.unsaved && !this.live.reloads) event.preventDefault();
    });
  }

  /// The middle of an entry's lamps.
  middleOf({middles}) { return scaled(middles.reduce(add), 1 / middles.length); }

  /// Holds an entry on the plan. It is moved from its first place, so that what snaps does not creep.
  grasp(i, {clientX, clientY}) {
    const {plan} = this.page, entry = this.state.entries[i], from = this.middleOf(entry), others = this.middlesBut(i);
    const held = plan.pointAt(clientX, clientY, from[1]), offsets = entry.middles.map((one) => subtract(one, from));
    const follow = (event) => {
      const to = add(from, subtract(plan.pointAt(event.clientX, event.clientY, from[1]), held));
      const {place, guides} = event.shiftKey ? {place: to, guides: []} : plan.snap(to, offsets, others, this.step);
      this.drags.guides = guides;
      return place;
    };
    this.drags = {from, to: from, follow, edit: (_, to) => ({select: i, position: positionInWorld(to)})};
    if (i !== this.state.selected) this.edit({select: i});
  }

  /// Moves what is held to where the pointer is by now; one post follows the other.
  async drag() {
    const {drags} = this;
    if (this.moves) return;
    this.moves = true;
    while (drags.to !== drags.from) {
      const {from, to} = drags;
      drags.from = to;
      await this.edit({...drags.edit(from, to), held: true});
    }
    this.moves = false;
    if (this.drags !== drags) await this.edit({held: false});
  }

  release() {
    const {drags} = this;
    this.drags = null;
    this.page.wake();
    if (!this.moves && drags) this.edit({held: false});
  }

  press(event) {
    if (isWriting(event.target) || find('#about').open) return;
    const key = event.key.toUpperCase(), control = event.ctrlKey || event.metaKey;
    const arrow = {ARROWLEFT: [-1, 0, 0], ARROWRIGHT: [1, 0, 0], ARROWUP: [0, 0, -1], ARROWDOWN: [0, 0, 1]}[key];
    if (arrow && this.page.plan.on && this.entry?.middles.length > 0) {
      const to = add(this.middleOf(this.entry), scaled(arrow, this.step || planStep));
      this.edit({position: positionInWorld(to)});
      return;
    }
    const act = control ? {D: () => this.edit({duplicate: true})}[key] : {
      B: () => this.setPlaces(!this.places),
      R: () => this.edit({rotate: event.shiftKey ? -15 : 15}),
      DELETE: () => this.edit({remove: true}),
      ESCAPE: () => {
        this.setPlaces(false);
        if (this.state.selected !== undefined) this.edit({select: -1});
      },
    }[key];
    if (!act || !this.state) return;
    if (control) event.preventDefault();
    act();
  }
}
