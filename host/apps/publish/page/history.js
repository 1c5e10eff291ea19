// What was set before, for undo and redo.

const mostSteps = 100;

class LightHistory {
  ///   restored(what)   the lights are as they were before or after a change of this kind
  constructor(lights, restored) {
    this.lights = lights;
    this.restored = restored;
    this.before = [];  // {what, state}, the newest last
    this.after = [];
    this.holds = false;
    this.beyond = null;  // is asked to undo or redo where there is no step of lights
    this.settle();
    window.addEventListener('keydown', (event) => this.press(event));
    for (const type of ['pointerup', 'pointercancel', 'keyup']) {
      window.addEventListener(type, () => { this.holds = false; });
    }
    // A picker of colours is a window of its own.
    window.addEventListener('change', ({target}) => { if (target.type === 'color') this.holds = false; });
    find('#undo').addEventListener('click', () => this.undo());
    find('#redo').addEventListener('click', () => this.redo());
  }

  press(event) {
    if (!(event.ctrlKey || event.metaKey) || event.altKey || isWriting(event.target)) return;
    const key = event.key.toUpperCase();
    if (key !== 'Z' && key !== 'Y') return;
    event.preventDefault();
    if (key === 'Z' && !event.shiftKey) this.undo();
    else this.redo();
  }

  /// The lights have changed.
  ///   holds   whether a control is held whose next changes are of the same step
  note(what, holds) {
    if (!this.holds) {
      this.before.push({what, state: this.state});
      if (this.before.length > mostSteps) this.before.shift();
      this.after = [];
    }
    this.holds = holds;
    this.settle();
  }

  /// The lights are these now, which nobody here has changed.
  settle() {
    const {states, sky, hour} = this.lights;
    this.state = structuredClone({states, sky, hour});
    find('#undo').disabled = this.before.length === 0;
    find('#redo').disabled = this.after.length === 0;
  }

  undo() { this.go(this.before, this.after); }
  redo() { this.go(this.after, this.before); }

  go(from, to) {
    if (from.length === 0) {
      this.beyond?.(from === this.before ? 'undo' : 'redo');
      return;
    }
    const {what, state} = from.pop();
    to.push({what, state: this.state});
    Object.assign(this.lights.sky, state.sky);
    Object.assign(this.lights, {states: structuredClone(state.states), hour: state.hour});
    this.settle();
    this.restored(what);
  }
}
