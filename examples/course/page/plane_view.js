// The plane, seen from above: points, balls and boxes, what is known of them, and the certificate that fails next.
function planeView(svg) {
  let scale, moving = {}, size, kept;

  function bounds() {
    if (data.window) return data.window;
    if (rangeKept && kept) return kept;
    let [x0, y0, x1, y1] = [Infinity, Infinity, -Infinity, -Infinity];
    for (const element of data.elements) {
      const w = element.half ? element.half[0] : element.radius ?? 0;
      const h = element.half ? element.half[1] : element.radius ?? 0;
      for (let k = 0; k <= 200; ++k) {
        const {x, y} = position(element.id, data.begin + duration * k / 200);
        x0 = Math.min(x0, x - w), x1 = Math.max(x1, x + w), y0 = Math.min(y0, y - h), y1 = Math.max(y1, y + h);
      }
    }
    return kept = [x0, y0, x1, y1];
  }

  function layout(width, height) {
    svg.replaceChildren();
    size = {width, height};
    const strip = data.intervals ? 14 + 7 * data.elements.length : 0;
    const [x0, y0, x1, y1] = bounds();
    // There is room for numbers like this one, and what is at the edge covers none of them.
    const widest = make('text', {text: '-0.25'}, svg), length = widest.getComputedTextLength();
    widest.remove();
    const ring = 15, right = 8, top = 8, left = length + 10 + strip, bottom = 24 + strip;
    const k = Math.min((width - left - right - 2 * ring) / (x1 - x0), (height - top - bottom - 2 * ring) / (y1 - y0));
    const middle = {x: (left + width - right) / 2, y: (top + height - bottom) / 2};
    scale = {
      k, x: (x) => middle.x + (x - (x0 + x1) / 2) * k, y: (y) => middle.y - (y - (y0 + y1) / 2) * k,
      xs: [left, width - right], ys: [top, height - bottom],
    };
    set(svg, {'data-x0': scale.x(0), 'data-kx': k, 'data-y0': scale.y(0), 'data-ky': -k});

    const from = {x: x0 + (left - scale.x(x0)) / k, y: y0 - (height - bottom - scale.y(y0)) / k};
    const to = {x: x1 + (width - right - scale.x(x1)) / k, y: y1 + (scale.y(y1) - top) / k};
    for (const x of ticks(from.x, to.x, width / 90)) {
      make('path', {class: 'grid', d: `M${scale.x(x)} ${top}V${height - bottom}`}, svg);
      make('text', {x: scale.x(x), y: height - 8, 'text-anchor': 'middle', text: x}, svg);
    }
    for (const y of ticks(from.y, to.y, height / 70)) {
      make('path', {class: 'grid', d: `M${left} ${scale.y(y)}H${width - right}`}, svg);
      make('text', {x: length + 2, y: scale.y(y) + 4, 'text-anchor': 'end', text: y}, svg);
    }
    if (data.walls) {
      const [wx0, wy0, wx1, wy1] = data.walls;
      const box = {x: scale.x(wx0), y: scale.y(wy1), width: (wx1 - wx0) * k, height: (wy1 - wy0) * k};
      make('rect', {class: 'wall', ...box}, svg);
    }
    const all = {x: left, y: top, width: width - left - right, height: height - top - bottom};
    make('rect', all, make('clipPath', {id: 'inside'}, make('defs', {}, svg)));
    for (const layer of ['outline', 'cells', 'edges', 'happened', 'witness', 'trails', 'intervals']) {
      moving[layer] = make('g', {class: `${layer}-layer`}, svg);
      if (layer !== 'intervals') set(moving[layer], {'clip-path': 'url(#inside)'});
    }
    moving.elements = new Map(data.elements.map((e) => [e.id, drawElement(e, svg, k)]));
  }

  const point = (id, t) => {
    const {x, y} = position(id, t);
    return [scale.x(x), scale.y(y)];
  };

  function draw(t, number, lit) {
    const state = data.states[number];
    const next = nextToFail(number);
    placeElements([...moving.elements.values()], [...moving.elements.keys()].map((id) => point(id, t)), inside());
    for (const [id, group] of moving.elements) {
      group.classList.toggle('marked', (state.marked ?? []).includes(id));
      group.classList.toggle('lit', lit.includes(id));
    }
    moving.outline.replaceChildren();
    if (state.outline) {
      make('polygon', {class: 'outline', 'data-outline': state.outline.join(' '),
                       points: state.outline.map((id) => point(id, t).join()).join(' ')}, moving.outline);
    }
    moving.edges.replaceChildren();
    for (const [a, b] of state.edges ?? []) {
      const [[xa, ya], [xb, yb]] = [point(a, t), point(b, t)];
      make('line', {class: 'edge ' + (data.edges ?? ''), 'data-edge': `${a}-${b}`, x1: xa, y1: ya, x2: xb, y2: yb},
           moving.edges);
    }
    moving.cells.replaceChildren();
    if (state.triangles) drawCells(state.triangles, t);
    drawHappened(t, number);
    moving.witness.replaceChildren();
    if (next) drawWitness(next.members.map((id) => point(id, t)));
    drawTrails(t);
    if (data.intervals) drawIntervals(t);
  }

  function drawCells(triangles, t) {
    const box = [(scale.xs[0] - scale.x(0)) / scale.k, (scale.y(0) - scale.ys[1]) / scale.k,
                 (scale.xs[1] - scale.x(0)) / scale.k, (scale.y(0) - scale.ys[0]) / scale.k];
    const at = (id) => { const {x, y} = position(id, t); return [x, y]; };
    for (const [a, b, p, q] of voronoiLines(triangles, at, box)) {
      make('line', {class: 'cell', 'data-cell': `${a}-${b}`, x1: scale.x(p[0]), y1: scale.y(p[1]),
                    x2: scale.x(q[0]), y2: scale.y(q[1])}, moving.cells);
    }
  }

  /** Four points that the latest event was about are on one circle then: the circle through three, for a while. */
  function drawHappened(t, number) {
    moving.happened.replaceChildren();
    const event = data.events[number - 1];
    if (event?.members.length !== 4 || t - event.time > 0.02 * duration) return;
    const {x: cx, y: cy, r} = circumcircle(...event.members.slice(0, 3).map((id) => point(id, t)));
    if (r < 2 * Math.max(size.width, size.height)) {
      make('circle', {class: 'past-circle', 'data-happened': event.members.join(' '), cx, cy, r}, moving.happened);
    }
  }

  /** Two points and the line between them, three and their triangle, four: the circle through the first three. */
  function drawWitness(points) {
    const radius = 2 * Math.max(size.width, size.height);
    if (points.length === 4) {
      const {x: cx, y: cy, r} = circumcircle(...points.slice(0, 3));
      if (!(r < radius)) return;
      make('circle', {class: 'witness', cx, cy, r}, moving.witness);
    } else if (points.length > 1) {
      make('polygon', {class: 'witness', points: points.map((p) => p.join()).join(' ')}, moving.witness);
    }
    const [x, y] = points[points.length - 1];
    make('circle', {class: 'witness', cx: x, cy: y, r: 15}, moving.witness);
  }

  /** Where each has been of late, and where it will be soon. */
  function drawTrails(t) {
    moving.trails.replaceChildren();
    const shown = duration * 0.08;
    for (const element of data.elements) {
      for (const [name, from, to] of [['', t - shown, t], ['ahead', t, t + shown]]) {
        const [a, b] = [Math.max(from, data.begin), Math.min(to, data.end)];
        if (!(a < b)) continue;
        const places = [];
        for (let k = 0; k <= 12; ++k) places.push(point(element.id, a + (b - a) * k / 12).join(' '));
        const line = {d: 'M' + places.join('L'), stroke: colour.get(element.id)};
        make('path', {class: 'trail ' + name, ...line}, moving.trails);
      }
    }
  }

  /** The shadows of boxes on both axes, a row each: boxes overlap when both of their shadows do. */
  function drawIntervals(t) {
    moving.intervals.replaceChildren();
    const [left] = scale.xs, [, floor] = scale.ys;
    data.elements.forEach((element, i) => {
      const [x, y] = point(element.id, t);
      const [w, h] = element.half.map((half) => half * scale.k);
      const stroke = colour.get(element.id);
      make('path', {class: 'interval', stroke, d: `M${x - w} ${floor + 10 + 7 * i}h${2 * w}`}, moving.intervals);
      make('path', {class: 'interval', stroke, d: `M${left - 10 - 7 * i} ${y - h}v${2 * h}`}, moving.intervals);
    });
  }

  /** There is no time axis in the picture: the slider has the whole width. */
  const axis = () => ({from: 8, to: size.width - 8});

  /** The part of the picture within its axes: x, y, x, y. */
  const inside = () => [scale.xs[0], scale.ys[0], scale.xs[1], scale.ys[1]];

  return {layout, draw, axis, inside, timeAt: null};
}
