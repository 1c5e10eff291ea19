// Where the viewer stands and looks, and how keys, mouse, fingers and gamepads move them.

const walking = {pace: 1.4, fast: 2.5, radius: 0.22, step: 0.45, headroom: 0.12,
                 orbit: 0.005, ahead: 2};  // radians a pixel; metres, of what is turned around where nothing is ahead

class Walker {
  constructor(surfaces) {
    this.surfaces = surfaces;
    this.eye = [0, 1.6, 0];
    this.yaw = 0;    // radians from -z, clockwise as seen from above
    this.pitch = 0;  // radians above the horizon
    this.angle = 1;  // vertical field of view, radians
    this.flies = false;
    this.height = 1.6;  // of the eye above what it stands on
    this.keys = new Set();
    this.stick = [0, 0];  // right, forward: of the pad on the screen
    this.speed = [0, 0, 0];
    this.pace = walking.pace;  // metres a second
    this.enabled = true;
  }

  get forward() {
    return [Math.sin(this.yaw) * Math.cos(this.pitch), Math.sin(this.pitch),
            -Math.cos(this.yaw) * Math.cos(this.pitch)];
  }
  get right() { return [Math.cos(this.yaw), 0, Math.sin(this.yaw)]; }

  /// Stands where a camera of the scene does.
  stand(camera) {
    this.standAt(camera.position);
    this.lookAlong(camera.forward);
    this.angle = camera.angle;
  }

  lookAlong(forward) {
    this.yaw = Math.atan2(forward[0], -forward[2]);
    this.pitch = Math.asin(clamp(forward[1], -1, 1));
  }

  /// With the eye as high above the ground as it is there.
  standAt(eye) {
    this.eye = eye.slice();
    this.speed = [0, 0, 0];
    const ground = this.ground(this.eye);
    this.height = ground === null ? 1.6 : clamp(this.eye[1] - ground, 0.5, 2.2);
  }

  turn(across, up) {
    this.yaw += across;
    this.pitch = clamp(this.pitch + up, -1.5, 1.5);
  }

  /// Height of the surface below a place, or null.
  ground(place) {
    const hit = this.surfaces.meet(place, [0, -1, 0]);
    return hit ? place[1] - hit.distance : null;
  }

  // As pointers move it (listen): pixels, and the place of the page.

  drag(across, down, height) {
    const radians = this.angle / height;
    this.turn(-across * radians, down * radians);
  }
  /// Two fingers walk.
  dragTwo(across, down, spread, x, y, height) {
    const metres = 2.5 / height, level = [Math.sin(this.yaw), 0, -Math.cos(this.yaw)];
    this.move(add(scaled(this.right, -across * metres),
                  scaled(this.flies ? this.forward : level, down * metres)), 0.05);
  }
  zoom(factor) { this.angle = clamp(this.angle * factor, 0.25, 1.9); }

  /// Moves on by what is pressed. Returns whether anything has changed.
  advance(seconds) {
    const before = [...this.eye, this.yaw, this.pitch].join();
    const held = (...names) => names.some((name) => this.keys.has(name));
    const pad = [...(navigator.getGamepads?.() ?? [])].find((one) => one?.connected);
    const axis = (i) => (pad && Math.abs(pad.axes[i] ?? 0) > 0.15 ? pad.axes[i] : 0);
    let across = this.stick[0] + axis(0) + held('KeyD') - held('KeyA');
    let ahead = this.stick[1] - axis(1) + held('KeyW', 'ArrowUp') - held('KeyS', 'ArrowDown');
    const rise = held('KeyE') - held('KeyQ');
    this.turn((axis(2) + held('ArrowRight') - held('ArrowLeft')) * 1.6 * seconds,
              -axis(3) * 1.2 * seconds);
    const length = Math.max(1, Math.hypot(across, ahead));
    across /= length;
    ahead /= length;
    const pace = held('ShiftLeft', 'ShiftRight') ? walking.fast * this.pace : this.pace;
    const level = normalized([Math.sin(this.yaw), 0, -Math.cos(this.yaw)]);
    const wanted = scaled(add(scaled(this.right, across),
                              scaled(this.flies ? this.forward : level, ahead)), pace);
    if (this.flies) wanted[1] += rise * pace;
    else this.height = clamp(this.height + rise * 0.6 * seconds, 0.5, 2.2);
    const ease = 1 - Math.exp(-12 * seconds);
    this.speed = add(this.speed, scaled(subtract(wanted, this.speed), ease));
    if (Math.hypot(...this.speed) < 1e-3 && Math.hypot(...wanted) === 0) this.speed = [0, 0, 0];
    this.move(scaled(this.speed, seconds), seconds);
    return before !== [...this.eye, this.yaw, this.pitch].join();
  }

  /// Turns around a place. Who walks stays on the floor and within the walls, and looks at the place all the same.
  orbit(place, across, up) {
    const from = subtract(place, this.eye), distance = Math.hypot(...from);
    this.turn(across, up);
    const wanted = subtract(place, scaled(this.forward, distance));
    if (this.flies) {
      this.eye = wanted;
      return;
    }
    this.step([wanted[0] - this.eye[0], 0, wanted[2] - this.eye[2]]);
    this.height = clamp(this.height + wanted[1] - this.eye[1], 0.5, 2.2);
    this.eye[1] = (this.ground(this.eye) ?? this.eye[1] - this.height) + this.height;
    this.lookAlong(normalized(subtract(place, this.eye)));
  }

  /// Goes so far over the floor, if nothing is in the way. Returns whether it is not.
  step(offset) {
    const from = this.eye.slice();
    const next = this.pushed(add(this.eye, offset));
    // The viewer cannot walk off the edge of the floor, or through a wall in one long step.
    const way = subtract(next, from), length = Math.hypot(...way);
    const blocked = length > 0 &&
        (this.surfaces.meet(from, scaled(way, 1 / length))?.distance ?? Infinity) < length;
    if (blocked || this.ground(next) === null) return false;
    this.eye = next;
    return true;
  }

  move(offset, seconds) {
    if (this.flies) {
      this.eye = add(this.eye, offset);
      return;
    }
    if ((offset[0] !== 0 || offset[2] !== 0) && !this.step([offset[0], 0, offset[2]])) this.speed = [0, 0, 0];
    const ground = this.ground(this.eye);
    if (ground === null) return;
    const target = ground + this.height;
    // The height of the ground is rounded, which must not keep the page drawing for ever.
    if (Math.abs(target - this.eye[1]) < 1e-9) return;
    // A table is not climbed.
    if (target - this.eye[1] > walking.step) return;
    this.eye[1] += (target - this.eye[1]) * (1 - Math.exp(-10 * seconds));
    if (Math.abs(target - this.eye[1]) < 1e-4) this.eye[1] = target;
  }

  /// Moves away from what is closer than the width of a body, between the knees and the top of the
  /// head.
  pushed(place) {
    const foot = place[1] - this.height + walking.step, top = place[1] + walking.headroom;
    for (let round = 0; round < 3; ++round) {
      this.surfaces.around(place[0], place[2], walking.radius, (t) => {
        const corners = this.surfaces.corners(t);
        const heights = corners.map((c) => c[1]);
        const low = Math.min(...heights), high = Math.max(...heights);
        if (high < foot || low > top) return;
        const level = clamp((low + high) / 2, foot, top);
        for (const y of new Set([foot, level, top])) {
          const point = nearestPoint([place[0], y, place[2]], corners);
          if (point[1] < foot || point[1] > top) continue;
          const away = [place[0] - point[0], place[2] - point[2]];
          const distance = Math.hypot(...away);
          if (distance >= walking.radius || distance < 1e-6) continue;
          const more = (walking.radius - distance) / distance;
          place = [place[0] + more * away[0], place[1], place[2] + more * away[1]];
        }
      });
    }
    return place;
  }
}

/// Keys, mouse, fingers and the pad on the screen.
///   view()          what the page shows: a Walker or a Plan
///   pointed(x, y)   a click or a tap, pixels of the page
function listen(walker, view, canvas, pad, changed, pointed) {
  const typing = (event) => event.target.matches?.('input, select, textarea, button, summary, dialog *');
  window.addEventListener('keydown', (event) => {
    if (typing(event) || event.ctrlKey || event.metaKey || event.altKey) return;
    if (/^(Key[WASDQE]|Arrow|Shift)/.test(event.code)) {
      walker.keys.add(event.code);
      if (event.code.startsWith('Arrow')) event.preventDefault();
      changed();
    }
  });
  window.addEventListener('keyup', (event) => walker.keys.delete(event.code));
  window.addEventListener('blur', () => walker.keys.clear());

  const fingers = new Map();
  let travelled = 0;
  let pivot = null;  // that the right button turns around
  canvas.addEventListener('pointerdown', (event) => {
    canvas.focus({preventScroll: true});
    canvas.setPointerCapture(event.pointerId);
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    if (fingers.size === 1) travelled = 0;
    if (event.button !== 2) return;
    const ahead = walker.surfaces.meet(walker.eye, walker.forward)?.distance ?? walking.ahead;
    pivot = add(walker.eye, scaled(walker.forward, ahead));
  });
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  canvas.addEventListener('pointermove', (event) => {
    const before = fingers.get(event.pointerId);
    if (!before) return;
    const moved = [event.clientX - before[0], event.clientY - before[1]];
    fingers.set(event.pointerId, [event.clientX, event.clientY]);
    travelled += Math.hypot(...moved);
    const {clientHeight} = canvas;
    if (fingers.size > 1) {
      const [other] = [...fingers].filter(([id]) => id !== event.pointerId).map(([, place]) => place);
      const apart = ([x, y]) => Math.max(1, Math.hypot(x - other[0], y - other[1]));
      const spread = apart([event.clientX, event.clientY]) / apart(before);
      view().dragTwo(...moved, spread, event.clientX, event.clientY, clientHeight);
    } else if (pivot) {
      view().orbit(pivot, -moved[0] * walking.orbit, moved[1] * walking.orbit);
    } else {
      view().drag(...moved, clientHeight);
    }
    changed();
  });
  const lift = (event) => {
    const was = fingers.size;
    if (!fingers.delete(event.pointerId)) return;
    if (event.type === 'pointerup' && was === 1 && travelled < 6 && !pivot) {
      pointed(event.clientX, event.clientY);
    }
    pivot = null;
  };
  canvas.addEventListener('pointerup', lift);
  canvas.addEventListener('pointercancel', lift);
  canvas.addEventListener('wheel', (event) => {
    if (event.ctrlKey) return;  // the browser zooms
    event.preventDefault();
    view().zoom(Math.exp(event.deltaY * 0.0008), event.clientX, event.clientY);
    changed();
  }, {passive: false});

  const follow = (event) => {
    const box = pad.getBoundingClientRect();
    const offset = [(event.clientX - box.left) / box.width - 0.5,
                    0.5 - (event.clientY - box.top) / box.height].map((part) => part * 2.4);
    const length = Math.max(1, Math.hypot(...offset));
    walker.stick = offset.map((part) => part / length);
    pad.style.setProperty('--x', walker.stick[0]);
    pad.style.setProperty('--y', -walker.stick[1]);
    changed();
  };
  pad.addEventListener('pointerdown', (event) => {
    pad.setPointerCapture(event.pointerId);
    follow(event);
  });
  pad.addEventListener('pointermove', (event) => {
    if (pad.hasPointerCapture(event.pointerId)) follow(event);
  });
  for (const type of ['pointerup', 'pointercancel']) {
    pad.addEventListener(type, () => {
      walker.stick = [0, 0];
      pad.style.setProperty('--x', 0);
      pad.style.setProperty('--y', 0);
    });
  }
}
