// Points and normals of contacts, for a moment after each; and the path of the body that is looked at.
const most = 400;   // marks at a time
const markLines = new THREE.BufferGeometry();
const markPlaces = new THREE.Float32BufferAttribute(new Float32Array(18 * most), 3);
const markColours = new THREE.Float32BufferAttribute(new Float32Array(18 * most), 3);
markLines.setAttribute("position", markPlaces);
markLines.setAttribute("color", markColours);
const markObject = new THREE.LineSegments(markLines, new THREE.LineBasicMaterial(
  { vertexColors: THREE.VertexColors, depthTest: false, transparent: true, fog: false }));
markObject.frustumCulled = false;
markObject.renderOrder = 2;
scene.add(markObject);

const touchTimes = data.touches.map(touch => touch[0]), wallTimes = data.walls.map(wall => wall[0]);
const amber = [1, 0.72, 0.2], pale = [0.95, 0.95, 1], dim = [0.45, 0.62, 1];

/** Shows the contacts of the time t and of `fade` before it: of the chosen body, or of all. */
function mark(t, fade, shown) {
  let count = 0;
  const length = 0.03 * sceneRadius;
  const add = (time, values, colour) => {
    const [x, y, z, u, v, w] = values, strength = 1 - (t - time) / fade;
    // A cross in the plane of the contact, and the normal.
    const along = Math.abs(u) < 0.7 ? [0, w, -v] : [-w, 0, u], norm = Math.hypot(...along) || 1;
    const [a, b, c] = along.map(q => q / norm * length / 3);
    const [d, e, f] = [v * c - w * b, w * a - u * c, u * b - v * a];
    markPlaces.array.set([x - a, y - b, z - c, x + a, y + b, z + c, x - d, y - e, z - f, x + d, y + e, z + f,
      x, y, z, x + length * u, y + length * v, z + length * w], 18 * count);
    for (let k = 0; k < 6; ++k) markColours.array.set(colour.map(q => q * strength), 18 * count + 3 * k);
    ++count;
  };
  if (shown) {
    for (let i = lastUpTo(touchTimes, t); i >= 0 && count < most && touchTimes[i] > t - fade; --i) {
      const [time, kind, a, b, ...values] = data.touches[i];
      if (values.length === 6 && kind !== separation && (chosen < 0 || chosen === a || chosen === b)) {
        add(time, values, kind === letThrough ? amber : pale);
      }
    }
    for (let i = lastUpTo(wallTimes, t); i >= 0 && count < most && wallTimes[i] > t - fade; --i) {
      const [time, body, , ...values] = data.walls[i];
      if (chosen < 0 || chosen === body) add(time, values, dim);
    }
  }
  markLines.setDrawRange(0, 6 * count);
  markPlaces.needsUpdate = markColours.needsUpdate = true;
}

const pathGeometry = new THREE.BufferGeometry();
const pathObject = new THREE.Line(pathGeometry, new THREE.LineBasicMaterial(
  { color: 0xe8d28a, transparent: true, opacity: 0.55, fog: false }));
pathObject.frustumCulled = false;
scene.add(pathObject);

/** Draws the whole path of the chosen body; jumps are drawn as lines, too. */
function drawPath() {
  const points = [];
  if (chosen >= 0) {
    const body = data.bodies[chosen], at = new THREE.Vector3(), end = Math.min(data.duration, body.until || Infinity);
    body.motion.forEach((piece, i) => {
      const from = Math.max(0, piece[0]), to = i + 1 < body.motion.length ? body.starts[i + 1] : end;
      const parts = piece.length > 10 ? 48 : piece.length > 7 ? 12 : 1;   // curves, parabolas, lines
      for (let k = 0; k <= parts && to >= from; ++k) {
        const c = piece, dt = from + (to - from) * k / parts - c[0];
        at.set(0, 0, 0);
        for (let n = (c.length - 1) / 3 - 1; n >= 0; --n) {
          at.set(at.x * dt + c[1 + 3 * n], at.y * dt + c[2 + 3 * n], at.z * dt + c[3 + 3 * n]);
        }
        points.push(at.x, at.y, at.z);
      }
    });
  }
  pathGeometry.setAttribute("position", new THREE.Float32BufferAttribute(points, 3));
  pathGeometry.setDrawRange(0, points.length / 3);
}
