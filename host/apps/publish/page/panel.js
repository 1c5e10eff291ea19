// The controls.

const element = (name, properties = {}, ...children) => {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
};
const find = (selector) => document.querySelector(selector);
/// Whether keys belong to what has the focus.
const isWriting = (target) => target.matches('input[type=text], input[type=number], select');

function saveFile(download, blob) {
  const link = element('a', {href: URL.createObjectURL(blob), download});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

class Panel {
  ///   changed(what, holds)   'light', 'preset' or 'hour'; whether the same control goes on changing it
  constructor(lights, changed) {
    this.lights = lights;
    this.changed = changed;
    this.rows = [];
    this.makeLights();
    this.makePresets();
    this.makeHours();
    const fold = find('#fold');
    fold.addEventListener('click', () => this.unfold(fold.getAttribute('aria-expanded') !== 'true'));
    if (window.innerWidth <= 640) this.unfold(false);
  }

  unfold(open) {
    find('#fold').setAttribute('aria-expanded', open);
    find('#controls').hidden = !open;
  }

  makeLights() {
    const section = find('#lights');
    if (room.patches.length > 0) section.append(this.skyRow());
    room.lights.forEach((light, i) => {
      if (light.patch === undefined) section.append(this.lightRow(light, i));
    });
    section.hidden = section.childElementCount === 0;
  }

  skyRow() {
    const {sky} = this.lights;
    const toggle = element('input', {type: 'checkbox', className: 'switch', checked: true});
    toggle.setAttribute('role', 'switch');
    toggle.setAttribute('aria-label', 'Daylight on');
    const row = element('div', {className: 'light'}, element('div', {className: 'name'},
                        element('label', {textContent: 'Daylight'}), toggle));
    toggle.addEventListener('input', () => {
      sky.on = toggle.checked;
      this.changed('light');
    });
    this.rows.push(() => {
      toggle.checked = sky.on;
      row.classList.toggle('off', this.lights.skyFactor === 0);
    });
    return row;
  }

  lightRow(light, i) {
    const name = light.name.replaceAll('_', ' ');
    const slider = element('input', {type: 'range', min: 0, max: 1, step: 0.005, id: `light${i}`});
    const power = element('output');
    const toggle = element('input', {type: 'checkbox', className: 'switch'});
    toggle.setAttribute('role', 'switch');
    toggle.setAttribute('aria-label', `${name} on`);
    const dot = element('span', {className: 'dot'});
    const more = element('button', {type: 'button', className: 'more', title: 'Colour'}, dot);
    more.setAttribute('aria-label', `Colour of ${name}`);
    more.setAttribute('aria-expanded', false);
    const solo = element('button', {type: 'button', className: 'solo', textContent: 'S',
                                    title: 'Solo: the other lights are dark'});
    solo.setAttribute('aria-label', `${name} solo`);
    const picker = element('input', {type: 'color', title: 'Colour of a filter before the light'});
    picker.setAttribute('aria-label', `Colour of ${name}`);
    const colour = element('input', {type: 'range', min: kelvins.low, max: kelvins.high, step: kelvins.step});
    colour.setAttribute('aria-label', `Colour temperature of ${name}, kelvin`);
    const kelvin = element('output');
    const own = element('button', {type: 'button', textContent: '↺', title: 'Colour as made'});
    own.setAttribute('aria-label', `Colour of ${name} as made`);
    const colourRow = element('div', {className: 'colour', hidden: true}, picker, colour, kelvin, own);
    const label = element('label', {textContent: name, htmlFor: slider.id, title: name});
    const row = element('div', {className: 'light'},
                        element('div', {className: 'name'}, more, label, power, solo, toggle), slider, colourRow);
    const full = light.power > 0 ? light.power : 1000;
    // A light without red or blue cannot have every temperature.
    colour.disabled = light.color.some((part) => part < 0.02);
    const state = () => this.lights.states[i];
    slider.addEventListener('input', () => {
      state().power = powerOfSlider(Number(slider.value), full);
      state().on = state().power > 0;
      this.changed('light', true);
      show();
    });
    toggle.addEventListener('input', () => {
      state().on = toggle.checked;
      if (state().on && state().power === 0) state().power = full;
      this.changed('light');
      show();
    });
    more.addEventListener('click', () => {
      colourRow.hidden = !colourRow.hidden;
      more.setAttribute('aria-expanded', !colourRow.hidden);
    });
    colour.addEventListener('input', () => {
      this.lights.setKelvin(i, Number(colour.value));
      this.changed('light', true);
      show();
    });
    picker.addEventListener('input', () => {
      if (!this.lights.setColour(i, picker.value)) {
        tell(`${name} emits nothing of that colour.`);
        return;
      }
      this.changed('light', true);
      show();
    });
    own.addEventListener('click', () => {
      this.lights.setKelvin(i, 0);
      this.changed('light');
      show();
    });
    solo.addEventListener('click', () => {
      state().solo = !state().solo;
      this.changed('light');
      this.show();
    });
    const show = () => {
      const {on, solo: alone, power: now, kelvin: temperature, tint} = state();
      const shines = on || alone, made = tint.every((part, c) => part === light.tint[c]);
      slider.value = shines ? sliderOfPower(now, full) : 0;
      slider.setAttribute('aria-valuetext', `${shortNumber(shines ? now : 0)} ${light.unit}`);
      power.textContent = shines ? `${shortNumber(now)} ${light.unit}` : 'off';
      toggle.checked = on;
      solo.setAttribute('aria-pressed', alone);
      row.classList.toggle('off', !this.lights.isLit(i));
      colour.value = temperature || 4000;
      picker.value = hexOf(tint);
      kelvin.textContent = temperature ? `${temperature} K` : made ? 'as made' : picker.value;
      own.disabled = made;
      dot.style.setProperty('--light', hexOf(tint.map((part, c) => part * light.color[c])));
    };
    this.rows.push(show);
    show();
    return row;
  }

  ///   remove, write   a mood by its name; none where that is not offered
  makePresets(remove, write) {
    const section = find('#presets');
    section.querySelectorAll('.preset').forEach((button) => button.remove());
    for (const [i, preset] of room.presets.entries()) {
      const button = element('button', {type: 'button', textContent: preset.name});
      button.addEventListener('click', () => {
        this.lights.apply(preset);
        this.show();
        this.changed('preset');
      });
      const more = Object.entries({
        '→': [write, `Write a copy of the scene with the lights of ${preset.name}`],
        '×': [remove, `Remove ${preset.name}`],
      }).filter(([, [act]]) => act && i > 0).map(([textContent, [act, title]]) => {
        const made = element('button', {type: 'button', textContent, title});
        made.setAttribute('aria-label', title);
        made.addEventListener('click', () => act(preset.name));
        return made;
      });
      find('#keep').before(element('span', {className: 'preset'}, button, ...more));
    }
    section.hidden = room.presets.length < 2;
  }

  makeHours() {
    if (!room.hours) return;
    const section = find('#hours'), date = find('#date'), hour = find('#hour');
    section.hidden = false;
    if (room.hours.weather) find('label[for=date]').textContent = 'Nearest 21st';
    Object.assign(hour, {min: 0, max: room.hours.times.length - 1, step: 0.25});
    const change = () => this.setHour(Number(date.value), Number(hour.value), true);
    date.addEventListener('input', change);
    hour.addEventListener('input', change);
  }

  ///   day    of the year; after the last follows the first
  ///   time   an index into room.hours
  setHour(day, time, holds) {
    this.lights.hour = {day: (day + 364) % 365 + 1, time: clamp(time, 0, room.hours.times.length - 1)};
    this.showHour();
    this.changed('hour', holds);
  }

  /// Returns whether a key sets the hour or the day.
  takeHourKey({code, shiftKey}) {
    const hours = (code === 'BracketRight') - (code === 'BracketLeft');
    const days = (code === 'PageDown') - (code === 'PageUp');
    if (!room.hours || (!hours && !days)) return false;
    const {day, time} = this.lights.hour, {times} = room.hours;
    this.setHour(day + days * (shiftKey ? 30 : 1), time + hours * (shiftKey ? 1 : 0.25) / (times[1] - times[0]), true);
    return true;
  }

  showHour() {
    if (!room.hours || !this.lights.hour) return;
    const {day, time} = this.lights.hour, {year, weather, days} = room.hours, {before, after, part} = this.lights.days;
    const shown = new Date(year, 0, weather ? days[part ? after : before] : day);
    find('#date').value = day;
    this.tellValue('date', shown.toLocaleDateString('en-GB', {day: 'numeric', month: 'short'}));
    find('#hour').value = time;
    const {times} = room.hours, whole = Math.floor(time);
    const hours = times[whole] + (time - whole) * ((times[whole + 1] ?? times[whole]) - times[whole]);
    const minutes = Math.round(hours * 60);
    this.tellValue('hour', `${String(Math.floor(minutes / 60)).padStart(2, '0')}:${String(minutes % 60).padStart(2, '0')}`);
  }

  ///   id   of a slider
  tellValue(id, text) {
    find(`output[for=${id}]`).textContent = text;
    find(`#${id}`).setAttribute('aria-valuetext', text);
  }

  show() {
    this.rows.forEach((show) => show());
    this.showHour();
  }
}

let messageTimer = 0;
function tell(text) {
  const message = find('#message');
  message.textContent = text;
  message.classList.add('shown');
  clearTimeout(messageTimer);
  messageTimer = setTimeout(() => message.classList.remove('shown'), 3500);
}
