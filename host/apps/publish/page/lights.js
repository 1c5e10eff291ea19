// The state of the lights: what sliders, switches, presets and hours say.

const kelvins = {low: 1500, high: 10000, step: 100};

class Lights {
  constructor() {
    this.states = room.lights.map((light) => ({
      power: light.power, on: light.power > 0, kelvin: 0, tint: light.tint.slice(),
    }));
    this.hour = null;  // {date, time}: indices into room.hours
  }

  /// What the light of each layer at power 1 is multiplied by.
  weights() {
    const sky = this.hour ? this.skyPowers() : null;
    return room.lights.map((light, i) => {
      const state = this.states[i];
      if (light.patch !== undefined) {
        const power = sky ? light.scale * sky[light.patch] * light.unitPower : light.scale * light.power;
        return scaled(light.tint, this.sky.on ? power * this.sky.factor : 0);
      }
      return scaled(state.tint, state.on ? light.scale * state.power : 0);
    });
  }

  sky = {on: true, factor: 1};

  /// Of a patch, in the unit of the light maps.
  skyPower(i) {
    const {scale, patch, unitPower} = room.lights[i];
    return scale * this.skyPowers()[patch] * unitPower;
  }

  skyPowers() {
    const {times, luminances, lights} = room.hours;
    const row = this.hour.date * times.length, whole = Math.floor(this.hour.time);
    const next = Math.min(whole + 1, times.length - 1), part = this.hour.time - whole;
    return Array.from({length: lights}, (_, i) =>
      luminances[(row + whole) * lights + i] * (1 - part) + luminances[(row + next) * lights + i] * part);
  }

  /// Returns false where the light lacks a primary colour that the temperature has.
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

  apply(preset) {
    for (const {light, power, tint, kelvin} of preset.lights) {
      Object.assign(this.states[light], {
        power: power > 0 ? power : this.states[light].power, on: power > 0, tint: tint.slice(), kelvin});
    }
  }
}

/// How a slider from 0 to 1 becomes a power: fine steps where it is dark.
const powerOfSlider = (place, full) => 2 * full * place * place;
const sliderOfPower = (power, full) => Math.sqrt(power / (2 * full));

const shortNumber = (value) => {
  if (value === 0) return '0';
  const digits = Math.max(0, 2 - Math.floor(Math.log10(Math.abs(value))));
  return digits > 2 ? value.toPrecision(2) : Number(value.toPrecision(3)).toLocaleString('en');
};
