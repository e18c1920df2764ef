// Voronoi cells, from the triangles that the program recorded: lines between the middles of their circles.

/** The ends of the part of x + s d, s between from and to, within a box; or null. Paper: Liang and Barsky, 1984. */
function clipped([x, y], [dx, dy], from, to, [x0, y0, x1, y1]) {
  for (const [rate, room] of [[-dx, x - x0], [dx, x1 - x], [-dy, y - y0], [dy, y1 - y]]) {
    if (rate === 0 && room < 0) return null;
    if (rate < 0) from = Math.max(from, room / rate);
    if (rate > 0) to = Math.min(to, room / rate);
  }
  return from < to ? [[x + from * dx, y + from * dy], [x + to * dx, y + to * dy]] : null;
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
    const from = right ? along(right) : -Infinity;  // beyond the hull without end
    const line = clipped([mx, my], [nx, ny], from, along({x, y}), box);
    if (line) lines.push([p, q, ...line]);
  }
  return lines;
}
