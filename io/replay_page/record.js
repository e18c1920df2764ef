"use strict";
// The record of a run: where each body is at a time, and what it meets.
//
// data: { title, begin, duration, response, domain: {min, max, walls}?, meshes: [{vertices, triangles}],
//   bodies: [{name, shape: "sphere" | "box" | "capsule" | number of the mesh, size: [x, y, z] (of a capsule: radius,
//             radius, half length), turn: quaternion [x, y, z, w], fixed: true or left out, sensor: the same, until: time
//             from which it is not there, or left out, motion: [[start, c0x, c0y, c0z, c1x, ...]...], spins: [[quaternion x, y, z, w at
//             the start, angular velocity x, y, z]...] of these pieces, if it turns, frames: [[time, x, y, z of the first
//             vertex, ...]...] if it is a mesh that bends}],
//   touches: [[time, kind (0 contact, 1 separation, 2 overlap, 10 let through), a, b, point x, y, z, normal x, y, z]...],
//   walls: [[time, body, wall 0-5 (-x, +x, -y, ...), point x, y, z, normal x, y, z]...],
//   rests: [[time, 1 begins or -1 ceases, a, b (none at a wall)]...] }: contacts that last
// Times count from `begin`. A piece of motion is a polynomial in the time since its own start. Normals point from a to b.
const data = JSON.parse(document.getElementById("data").textContent);
const contact = 0, separation = 1, overlap = 2, letThrough = 10;   // kinds of touches

/** Place of the last element of the ascending list that is <= x, or -1. */
function lastUpTo(list, x) {
  let low = 0, high = list.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (list[middle] <= x) low = middle + 1; else high = middle;
  }
  return low - 1;
}

for (const body of data.bodies) {
  if (body.frames) body.frameTimes = body.frames.map(frame => frame[0]);
  body.starts = body.motion.map(piece => piece[0]);
  body.quaternion = new THREE.Quaternion(...body.turn);
  body.touchTimes = [];
  body.touching = [];   // how many bodies it is in contact with after each of touchTimes
  body.touches = [];    // numbers of its touches
  body.walls = [];      // and of its contacts with walls
  body.restTimes = [];
  body.resting = [];    // how many contacts last after each of restTimes
  body.rests = [];      // numbers of these
}
/** Whether a contact of two bodies lasts until they are apart: those that bounce touch for an instant only. */
const goesOn = (a, b) => data.response !== "elastic" || data.bodies[a].sensor || data.bodies[b].sensor;
const contactTimes = [];
data.touches.forEach(([time, kind, a, b], number) => {
  if (kind === contact) contactTimes.push(time);
  const watched = data.bodies[a].sensor || data.bodies[b].sensor;
  for (const i of a === b ? [a] : [a, b]) {
    data.bodies[i].touches.push(number);
    const body = data.bodies[i], before = body.touching.length ? body.touching[body.touching.length - 1] : 0;
    if (watched && !body.sensor) continue;   // The sensor is red, what it reports goes on as it was.
    const after = goesOn(a, b) ? Math.max(0, before + (kind === separation ? -1 : 1)) : 0;
    body.touchTimes.push(time);
    body.touching.push(after);
  }
});
data.walls.forEach(([, i], number) => data.bodies[i].walls.push(number));

data.rests.forEach(([time, change, ...pair], number) => {
  for (const i of pair) {
    data.bodies[i].rests.push(number);
    const body = data.bodies[i], before = body.resting.length ? body.resting[body.resting.length - 1] : 0;
    body.restTimes.push(time);
    body.resting.push(before + change);
  }
});

/** Writes the position at time t to `to`; false before the body's motion begins, and when it has been removed. */
function position(body, t, to) {
  const i = lastUpTo(body.starts, t);
  if (i < 0 || t >= body.until) return false;
  const c = body.motion[i], dt = t - c[0], n = (c.length - 1) / 3;
  let x = 0, y = 0, z = 0;
  for (let k = n - 1; k >= 0; --k) {
    x = x * dt + c[1 + 3 * k]; y = y * dt + c[2 + 3 * k]; z = z * dt + c[3 + 3 * k];
  }
  to.set(x, y, z);
  return true;
}

/** Writes the orientation at time t, when the motion has begun, to `to`: turned about the axis of its piece. */
function orientation(body, t, to) {
  if (!body.spins) return to.copy(body.quaternion);
  const i = Math.max(0, lastUpTo(body.starts, t));
  const [x, y, z, w, a, b, c] = body.spins[i];
  const rate = Math.hypot(a, b, c), half = rate * (t - body.starts[i]) / 2;
  const s = rate > 0 ? Math.sin(half) / rate : 0;
  return to.set(s * a, s * b, s * c, Math.cos(half)).multiply(begun.set(x, y, z, w));
}
const begun = new THREE.Quaternion();

/** Writes where the vertices of a body that bends are at time t: between two frames, or at the first or last. */
function bend(body, t, to) {
  const { frames, frameTimes } = body, i = Math.max(0, lastUpTo(frameTimes, t));
  const a = frames[i], b = frames[Math.min(i + 1, frames.length - 1)];
  const s = b === a ? 0 : Math.max(0, (t - a[0]) / (b[0] - a[0]));
  for (let k = 1; k < a.length; ++k) to[k - 1] = a[k] + s * (b[k] - a[k]);
}

/** 1 in contact, fading to 0 after it. */
function redness(body, t, fade) {
  const i = lastUpTo(body.touchTimes, t);
  if (i < 0) return 0;
  if (body.touching[i] > 0) return 1;
  const age = (t - body.touchTimes[i]) / fade;
  return age < 1 ? 1 - age * age : 0;
}

/** Whether the body lies or slides on something. */
function rests(body, t) {
  const i = lastUpTo(body.restTimes, t);
  return i >= 0 && body.resting[i] > 0;
}

/** The velocity at time t, when the motion has begun: the derivative of its piece. */
function velocity(body, t, to) {
  const c = body.motion[Math.max(0, lastUpTo(body.starts, t))], dt = t - c[0], n = (c.length - 1) / 3;
  let x = 0, y = 0, z = 0;
  for (let k = n - 1; k > 0; --k) {
    x = x * dt + k * c[1 + 3 * k]; y = y * dt + k * c[2 + 3 * k]; z = z * dt + k * c[3 + 3 * k];
  }
  return to.set(x, y, z);
}

/** The others that a body is in contact with at time t: those that it passes through, and sensors. */
function partners(i, t) {
  const together = new Set();
  for (const number of data.bodies[i].touches) {
    const [time, kind, a, b] = data.touches[number];
    if (time > t) break;
    if (!goesOn(a, b)) continue;
    if (kind === separation) together.delete(a === i ? b : a); else together.add(a === i ? b : a);
  }
  return [...together];
}

/** What a body rests on or carries at time t: numbers of bodies, -1 for a wall. */
function supports(i, t) {
  const count = new Map();
  for (const number of data.bodies[i].rests) {
    const [time, change, a, b = -1] = data.rests[number], other = a === i ? b : a;
    if (time > t) break;
    count.set(other, (count.get(other) || 0) + change);
  }
  return [...count.keys()].filter(other => count.get(other) > 0);
}

const wallNames = ["\u2212x", "+x", "\u2212y", "+y", "\u2212z", "+z"];

/** All contacts, overlaps and passes of one body, or of all (i < 0), with walls: {time, text}, by time. */
const eventsOf = (() => {
  const known = new Map();
  const name = i => data.bodies[i].name;
  const touchText = (i, [, kind, a, b]) => {
    const word = kind === overlap ? "overlaps " : kind === letThrough ? "passes through " : "";
    return i < 0 ? `${name(a)} ${word || "meets "}${name(b)}` : word + name(a === i ? b : a);
  };
  return i => {
    if (known.has(i)) return known.get(i);
    const touches = i < 0 ? data.touches : data.bodies[i].touches.map(number => data.touches[number]);
    const walls = i < 0 ? data.walls : data.bodies[i].walls.map(number => data.walls[number]);
    const list = touches.filter(touch => touch[1] !== separation)
      .map(touch => ({ time: touch[0], text: touchText(i, touch) }))
      .concat(walls.map(([time, body, wall]) =>
        ({ time, text: (i < 0 ? name(body) + " meets " : "") + "the wall " + wallNames[wall] })));
    list.sort((x, y) => x.time - y.time);
    known.set(i, list);
    return list;
  };
})();
