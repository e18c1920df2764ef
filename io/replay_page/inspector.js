// The body that is looked at: how it is chosen, and what is said of it.
const $ = selector => document.querySelector(selector);
const number = n => n.toLocaleString("en-US").replace(/,/g, "\u2009");
const panel = $("#body");

const ray = new THREE.Raycaster(), from = new THREE.Vector3(), along = new THREE.Vector3();
const inverse = new THREE.Quaternion(), place = new THREE.Vector3();

/** How far along the ray a body is hit at time t, Infinity if it is not. */
function distanceTo(body, t) {
  if (!position(body, t, place)) return Infinity;
  // In the axes of the body, scaled to its shape of size 1.
  orientation(body, t, inverse).inverse();
  from.copy(ray.ray.origin).sub(place).applyQuaternion(inverse).divide(body.scale);
  along.copy(ray.ray.direction).applyQuaternion(inverse).divide(body.scale);
  const radius = typeof body.shape === "number" ? data.meshes[body.shape].radius
               : body.shape === "capsule" ? 1 + body.size[2] / body.size[0] : body.shape === "box" ? Math.sqrt(3) : 1;
  const a = along.lengthSq(), b = from.dot(along), c = from.lengthSq() - radius * radius, root = b * b - a * c;
  if (root < 0 || (c > 0 && b > 0)) return Infinity;
  const ball = Math.max(0, (-b - Math.sqrt(root)) / a);
  if (body.shape === "sphere" || body.frames) return ball;
  if (body.shape === "box") {
    let near = -Infinity, far = Infinity;
    for (const d of ["x", "y", "z"]) {
      const one = (-1 - from[d]) / along[d], other = (1 - from[d]) / along[d];
      near = Math.max(near, Math.min(one, other));
      far = Math.min(far, Math.max(one, other));
    }
    return near <= far && far >= 0 ? Math.max(0, near) : Infinity;
  }
  if (body.shape === "capsule") {   // by steps: no closer than the distance to it
    const half = body.size[2] / body.size[0], at = new THREE.Vector3(), speed = Math.sqrt(a);
    for (let s = ball, k = 0; k < 60; ++k) {
      at.copy(from).addScaledVector(along, s);
      at.z -= Math.max(-half, Math.min(half, at.z));
      const gap = at.length() - 1;
      if (gap < 1e-3) return s;
      s += gap / speed;
    }
    return Infinity;
  }
  const { vertices, triangles } = data.meshes[body.shape];
  const local = new THREE.Ray(from.clone(), along.clone()), corners = [0, 1, 2].map(() => new THREE.Vector3());
  let nearest = Infinity;
  for (let k = 0; k < triangles.length; k += 3) {
    corners.forEach((corner, j) => corner.fromArray(vertices, 3 * triangles[k + j]));
    const hit = local.intersectTriangle(corners[0], corners[1], corners[2], false, new THREE.Vector3());
    if (hit) nearest = Math.min(nearest, hit.sub(from).dot(along) / a);
  }
  return nearest;
}

/** The body at a place of the window, in pixels, or -1. One looks through what is fixed and through sensors, unless
 *  nothing else is there. */
function bodyAt(x, y, t) {
  ray.setFromCamera(new THREE.Vector2(2 * x / window.innerWidth - 1, 1 - 2 * y / window.innerHeight), camera);
  const best = { solid: -1, clear: -1 }, distance = { solid: Infinity, clear: Infinity };
  data.bodies.forEach((body, i) => {
    const kind = seenThrough(body) ? "clear" : "solid", d = distanceTo(body, t);
    if (d < distance[kind]) [distance[kind], best[kind]] = [d, i];
  });
  return best.solid >= 0 ? best.solid : best.clear;
}

function choose(i) {
  chosen = i;
  panel.hidden = i < 0;
  drawPath();
  shown = -1;
}

/** A line of the panel: a word, and text or names of bodies, which choose these. */
function line(word, ...parts) {
  const term = document.createElement("dt"), what = document.createElement("dd");
  term.textContent = word;
  parts.forEach((part, k) => {
    if (k > 0) what.append(", ");
    if (typeof part === "string") return what.append(part);
    const button = document.createElement("button");
    button.className = "name";
    button.textContent = data.bodies[part].name;
    button.onclick = () => choose(part);
    what.append(button);
  });
  $("#body dl").append(term, what);
}

const shapeText = body => {
  const text = body.shape === "sphere" ? `ball, radius ${+body.size[0].toPrecision(4)}`
    : body.shape === "box" ? "box, " + body.size.map(x => +(2 * x).toPrecision(4)).join(" \u00d7 ")
    : body.shape === "capsule" ? `capsule, radius ${+body.size[0].toPrecision(4)}, length ${+(2 * body.size[2]).toPrecision(4)}`
    : (body.frames ? "mesh that bends, " : "mesh, ") + number(data.meshes[body.shape].triangles.length / 3) + " triangles";
  return text + (body.fixed ? "; fixed" : "") + (body.sensor ? "; sensor" : "");
};
const vectorText = v => [v.x, v.y, v.z].map(x => (Math.abs(x) < 5e-7 * sceneRadius ? 0 : x).toPrecision(5)).join("  ");
const timeText = t => (data.begin + t).toPrecision(7) + " s";

/** Writes what there is to say of the chosen body at time t. */
function inspect(t) {
  if (chosen < 0) return;
  const body = data.bodies[chosen], v = new THREE.Vector3();
  $("#body h2").textContent = body.name;
  $("#body dl").textContent = "";
  line("shape", shapeText(body));
  if (!position(body, t, v)) {
    line("state", t >= body.until ? "removed" : "to enter");
  } else {
    line("position", vectorText(v));
    velocity(body, t, v);
    line("velocity", vectorText(v));
    line("speed", v.length().toPrecision(5));
    if (body.spins) {
      const spin = body.spins[Math.max(0, lastUpTo(body.starts, t))];
      line("turns", vectorText(v.set(spin[4], spin[5], spin[6])) + " rad/s");
    }
    const held = supports(chosen, t), met = partners(chosen, t);
    if (held.length > 0) line("rests on", ...held.map(other => other < 0 ? "a wall" : other));
    if (met.length > 0) line("touches", ...met);
  }
  const events = eventsOf(chosen), i = lastUpTo(events.map(event => event.time), t);
  if (i >= 0) line("last contact", timeText(events[i].time), events[i].text);
  if (i + 1 < events.length) line("next contact", timeText(events[i + 1].time), events[i + 1].text);
  if (events.length === 0) line("contacts", "none");
}

/** The time of the next contact of the chosen body, or of any, after t; of the last before it where step is -1. */
function contactTime(t, step) {
  const times = eventsOf(chosen).map(event => event.time);
  if (step > 0) return times[lastUpTo(times, t) + 1];
  let i = lastUpTo(times, t);
  while (i >= 0 && times[i] >= t) --i;
  return times[i];
}
