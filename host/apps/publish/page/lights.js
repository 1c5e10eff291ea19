// The state of the lights: what sliders, switches, presets and hours say.

const kelvins = {low: 1500, high: 10000, step: 100};

class Lights {
  constructor() {
    this.states = room.lights.map((light) => ({
      power: light.power, on: light.power > 0, solo: false, kelvin: 0, tint: light.tint.slice(),
    }));
    this.hour = null;  // {day, time}: of the year, and an index into room.hours
  }

  /// What the light of each layer at power 1 is multiplied by.
  weights() {
    const sky = this.hour ? this.skyPowers() : null, {skyFactor} = this;
    return room.lights.map((light, i) => {
      const state = this.states[i];
      if (light.patch !== undefined) {
        const power = sky ? light.scale * sky[light.patch] * light.unitPower : light.scale * light.power;
        return scaled(light.tint, power * skyFactor);
      }
      return scaled(state.tint, this.isLit(i) ? light.scale * state.power : 0);
    });
  }

  sky = {on: true, factor: 1};

  /// While any light is solo, only such lights shine, whether they are on or not.
  get anySolo() { return this.states.some(({solo}) => solo); }
  isLit(i) { return this.anySolo ? this.states[i].solo : this.states[i].on; }
  get skyFactor() { return this.sky.on && !this.anySolo ? this.sky.factor : 0; }

  /// Of a patch, in the unit of the light maps.
  skyPower(i) {
    const {scale, patch, unitPower} = room.lights[i];
    return scale * this.skyPowers()[patch] * unitPower;
  }

  skyPowers() {
    const {times, luminances, lights} = room.hours;
    const {before, after, part} = this.days, whole = Math.floor(this.hour.time), of = this.hour.time - whole;
    const next = Math.min(whole + 1, times.length - 1);
    const rows = [[before, whole, (1 - part) * (1 - of)], [before, next, (1 - part) * of],
                  [after, whole, part * (1 - of)], [after, next, part * of]];
    return Array.from({length: lights}, (_, i) => rows.reduce((sum, [date, time, weight]) =>
      sum + weight * luminances[(date * times.length + time) * lights + i], 0));
  }

  /// The days of room.hours before and after the day, and what part of the way it lies; the nearest one's weather.
  get days() {
    const {days, weather} = room.hours, {day} = this.hour, count = days.length;
    const after = (days.findLastIndex((one) => one <= day) + 1) % count, before = (after + count - 1) % count;
    const since = (date) => (day - days[date] + 365) % 365, past = since(before);
    const part = past / (past + 365 - since(after));
    return {before, after, part: weather ? Math.round(part) : part};
  }

  ///   kelvin   0: the light's own colour
  setKelvin(i, kelvin) {
    const state = this.states[i];
    state.kelvin = kelvin;
    if (kelvin === 0) {
      state.tint = room.lights[i].tint.slice();
      return;
    }
    // A tinted light emits the same power (host/pictures/image/light_change.cpp).
    const wanted = room.temperatures[Math.round((kelvin - kelvins.low) / kelvins.step)];
    state.tint = wanted.map((part, c) => part / Math.max(room.lights[i].color[c], 1e-30));
  }

  /// Tints a light by a colour as CSS has it; the power stays (host/pictures/image/light_change.cpp). Returns false
  /// where the light emits nothing of that colour.
  setColour(i, hex) {
    const linear = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255).map(
        (part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4));
    const emitted = luminanceOf(linear.map((part, c) => part * room.lights[i].color[c]));
    if (!(emitted > 0)) return false;
    Object.assign(this.states[i], {kelvin: 0, tint: scaled(linear, 1 / emitted)});
    return true;
  }

  apply(preset) {
    for (const {light, power, tint, kelvin} of preset.lights) {
      Object.assign(this.states[light], {
        power: power > 0 ? power : this.states[light].power, on: power > 0, solo: false, tint: tint.slice(), kelvin});
    }
  }
}

/// A colour as CSS has it, as bright as can be.
function hexOf(linear) {
  const most = Math.max(...linear, 1e-9);
  return `#${linear.map((part) => part / most).map(
      (part) => Math.round(255 * (part <= 0.0031308 ? 12.92 * part : 1.055 * part ** (1 / 2.4) - 0.055))).map(
      (byte) => byte.toString(16).padStart(2, '0')).join('')}`;
}

/// How a slider from 0 to 1 becomes a power: fine steps where it is dark.
const powerOfSlider = (place, full) => 2 * full * place * place;
const sliderOfPower = (power, full) => Math.sqrt(power / (2 * full));

const shortNumber = (value) => {
  if (value === 0) return '0';
  const digits = Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))));
  return digits > 2 ? value.toPrecision(2) : Number(value.toPrecision(3)).toLocaleString('en');
};
