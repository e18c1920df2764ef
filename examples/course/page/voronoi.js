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

/**
 * [a, b, p, q] for each two neighbours a and b: from p to q the places within the box that both are nearest to. All are
 * on the line between the two, however far away the middles of flat triangles are, where roundings would turn it.
 */
function voronoiLines(triangles, at, box) {
  const left = new Map();  // of an edge: the middle of the triangle's circle on its left
  for (const [a, b, c] of triangles) {
    const {x, y} = circumcircle(at(a), at(b), at(c));
    for (const [p, q] of [[a, b], [b, c], [c, a]]) left.set(`${p} ${q}`, {p, q, x, y});
  }
  const lines = [];
  for (const {p, q, x, y} of left.values()) {
    const right = left.get(`${q} ${p}`);
    if (right && p > q) continue;
    const [[px, py], [qx, qy]] = [at(p), at(q)];
    const [mx, my, nx, ny] = [(px + qx) / 2, (py + qy) / 2, py - qy, qx - px];
    // How far the middle of a circle is to the left of the edge, in lengths of it.
    const along = ({x, y}) => ((x - mx) * nx + (y - my) * ny) / (nx * nx + ny * ny);
    const beyond = 4 * Math.hypot(box[2] - box[0], box[3] - box[1]) / Math.hypot(nx, ny);
    const from = along({x, y});
    const to = right ? along(right) : Math.min(0, from) - beyond;  // of the hull: outwards, out of the box
    const line = clipped([mx + from * nx, my + from * ny], [mx + to * nx, my + to * ny], box);
    if (line) lines.push([p, q, ...line]);
  }
  return lines;
}
