// Voronoi cells, from the triangles that the program recorded: lines between the middles of their circles.

/** The part of a line from p to q within a box, or null. Paper: Liang and Barsky, 1984. */
function clipped([px, py], [qx, qy], [x0, y0, x1, y1]) {
  let from = 0, to = 1;
  for (const [rate, room] of [[px - qx, px - x0], [qx - px, x1 - px], [py - qy, py - y0], [qy - py, y1 - py]]) {
    if (rate === 0) {
      if (room < 0) return null;
    } else if (rate < 0) {
      from = Math.max(from, room / rate);
    } else {
      to = Math.min(to, room / rate);
    }
  }
  const at = (s) => [px + s * (qx - px), py + s * (qy - py)];
  return from < to ? [at(from), at(to)] : null;
}

/** [a, b, p, q] for each two neighbours a and b: from p to q the places within the box that both are nearest to. */
function voronoiLines(triangles, at, box) {
  const far = 4 * Math.hypot(box[2] - box[0], box[3] - box[1]);
  const left = new Map();  // of an edge: the middle of the triangle's circle on its left
  for (const [a, b, c] of triangles) {
    const middle = circumcircle(at(a), at(b), at(c));
    for (const [p, q] of [[a, b], [b, c], [c, a]]) left.set(`${p} ${q}`, {p, q, middle: [middle.x, middle.y]});
  }
  const lines = [];
  for (const {p, q, middle} of left.values()) {
    const right = left.get(`${q} ${p}`);
    if (right && p > q) continue;
    let end = right?.middle;
    if (!end) {  // the edge is on the hull: its line goes on outwards, beyond the box wherever it begins
      const [[px, py], [qx, qy]] = [at(p), at(q)];
      const away = (far + Math.hypot(middle[0] - px, middle[1] - py)) / Math.hypot(qx - px, qy - py);
      end = [middle[0] + away * (qy - py), middle[1] - away * (qx - px)];
    }
    const line = clipped(middle, end, box);
    if (line) lines.push([p, q, ...line]);
  }
  return lines;
}
