// Luminaires on the live page: the server keeps their list (host/apps/serve/live_luminaires.cpp), and loads
// the scene again with them.

/// Openings that are outlined, at most.
const mostOutlines = 500;

class Luminaires {
  ///   live   that hears of them
  constructor(live) {
    this.live = live;
    this.page = live.page;
    this.places = false;  // whether the next click does
    this.drags = null;    // the selected lamps: {from, to}, directions to where they are held
    this.outlines = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
    this.outlines.id = 'outlines';
    this.page.canvas.after(this.outlines);
    this.makeSection();
    this.listen();
    this.page.history.beyond = (what) => this.edit({[what]: true});
    find('#about dl').insertAdjacentHTML('beforeend', `<dt><kbd>B</kbd> <kbd>R</kbd> <kbd>Ctrl+D</kbd> <kbd>Delete</kbd></dt>
        <dd>place, turn, duplicate, remove luminaires</dd>`);
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
        element('div', {className: 'place'}, this.file, this.placer), this.list, this.selected);
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

  /// Outlines of all openings over the picture.
  outline() {
    if (!this.state) return;
    const shapes = [];
    this.state.entries.forEach(({middles, across, along}, i) => {
      for (const middle of middles.slice(0, mostOutlines - shapes.length)) {
        const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1]].map(([x, y]) => this.page.placeOf(
            add(middle, add(scaled(across, x), scaled(along, y)))));
        if (corners.includes(null)) continue;
        const shape = document.createElementNS('http://www.w3.org/2000/svg', 'polygon');
        shape.setAttribute('points', corners.map((corner) => corner.join()).join(' '));
        shape.classList.toggle('selected', i === this.state.selected);
        shapes.push(shape);
      }
    });
    this.outlines.replaceChildren(...shapes);
  }

  /// Whether a click is for lamps.
  async click(x, y) {
    if (!this.state) return false;
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

  listen() {
    const {outlines} = this;
    outlines.addEventListener('pointerdown', (event) => {
      outlines.setPointerCapture(event.pointerId);
      const from = this.page.directionTo(event.clientX, event.clientY);
      this.drags = {eye: this.page.walker.eye.slice(), from, to: from};
    });
    outlines.addEventListener('pointermove', (event) => {
      if (!this.drags) return;
      this.drags.to = this.page.directionTo(event.clientX, event.clientY);
      this.drag();
    });
    outlines.addEventListener('lostpointercapture', () => this.release());
    window.addEventListener('keydown', (event) => this.press(event));
    window.addEventListener('beforeunload', (event) => {
      if (this.state?.unsaved && !this.live.reloads) event.preventDefault();
    });
  }

  /// Moves what is held to where the pointer is by now; one post follows the other.
  async drag() {
    const {drags} = this;
    if (this.moves) return;
    this.moves = true;
    while (drags.to !== drags.from) {
      const {eye, from, to} = drags;
      drags.from = to;
      await this.edit({drag: {eye, from, to}, held: true});
    }
    this.moves = false;
    if (this.drags !== drags) await this.edit({held: false});
  }

  release() {
    const {drags} = this;
    this.drags = null;
    if (!this.moves && drags) this.edit({held: false});
  }

  press(event) {
    if (isWriting(event.target) || find('#about').open) return;
    const key = event.key.toUpperCase(), control = event.ctrlKey || event.metaKey;
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
