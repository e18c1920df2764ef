// Structures, drawn beside the picture: places, some of them joined. What is where, and since when, is recorded; values
// and places that move are those of the time.
const drawings = [];  // one for each title

/** The value of a place: of a box that of one of its ends. */
function valueOf(place, axis, t) {
  const at = position(place.of, t), half = elements.get(place.of).half;
  return at[axis === 0 ? 'x' : 'y'] + (place.side && half ? place.side * half[axis] : 0);
}

/** Least and greatest of numbers that a function gives for each of these things, at some times. */
function extent(things, times, of) {
  let [low, high] = [Infinity, -Infinity];
  for (const thing of things) {
    for (const t of times) {
      const number = of(thing, t);
      low = Math.min(low, number), high = Math.max(high, number);
    }
  }
  return [low, high];
}

function layOutDrawings() {
  const kept = drawings.map(({range, box}) => ({range, box}));
  $('drawings').replaceChildren();
  $('drawings').hidden = data.drawings.length === 0;
  drawings.length = 0;
  const times = Array.from({length: 101}, (_, k) => data.begin + duration * k / 100);
  const titles = [...new Set(data.drawings.map(({title}) => title))];
  // All are there before the first is measured, since they share the width.
  const frames = titles.map((title) => {
    const figure = document.createElement('figure'), caption = document.createElement('figcaption');
    $('drawings').append(figure);
    figure.append(caption);
    const named = {'data-title': title, role: 'img', 'aria-label': title};
    const loose = data.changeable?.includes(title) ? ' loose' : '';
    const svg = make('svg', {class: 'drawing' + loose, height: 0, ...named}, figure);
    return {caption, svg};
  });
  titles.forEach((title, i) => {
    const {caption, svg} = frames[i];
    const versions = data.drawings.filter((drawing) => drawing.title === title);
    const {kind, axis} = versions[0], places = versions.flatMap((drawing) => drawing.places);
    const moves = kind === 'plane' ? times : [data.begin];
    // While somebody drags, the scale stays, as that of the picture does.
    const box = rangeKept && kind === 'plane' && kept[i] ? kept[i].box
      : ['x', 'y'].map((name) => extent(places, moves, (place, t) => value(place[name], t)));
    const width = svg.clientWidth;
    const height = {tree: 46 + 44 * (box[1][1] - box[1][0]), ruler: 92, plane: 190}[kind];
    set(svg, {viewBox: `0 0 ${width} ${height}`, height});
    const drawing = {title, versions, kind, axis, svg, caption, box, width, height};
    if (kind === 'ruler') {
      // Every version has all ends.
      drawing.range = rangeKept && kept[i] ? kept[i].range
        : extent(versions[0].places, times, (place, t) => valueOf(place, axis, t));
    }
    scaleDrawing(drawing);
    drawings.push(drawing);
  });
}

/** Where a drawing has its places, and how large. */
function scaleDrawing(drawing) {
  const {kind, box: [[x0, x1], [y0, y1]], width, height, svg} = drawing;
  const [left, top, bottom] = {plane: [18, 18, 18], ruler: [20, 70, 22], tree: [20, 14, 32]}[kind];
  let kx = Math.min((width - 2 * left) / (x1 - x0 || 1), 90), ky = (height - top - bottom) / (y1 - y0 || 1);
  if (kind === 'plane') kx = ky = Math.min(kx, ky, (width - 2 * left) / (x1 - x0 || 1));
  const [mx, my] = [width / 2 - kx * (x0 + x1) / 2, y1 > y0 ? top + ky * y1 : top];
  const radius = Math.min(kind === 'plane' ? 9 : 10, kx * (kind === 'ruler' ? 0.34 : 0.42));
  Object.assign(drawing, {x: (x) => mx + kx * x, y: (y) => my - ky * y, radius});
  drawing.roomy = kx >= 40;  // for a number under each place
  set(svg, {'data-x0': mx, 'data-kx': kx, 'data-y0': my, 'data-ky': -ky});
  drawing.still = make('g', {}, svg);
  drawing.moving = make('g', {}, svg);
  if (kind !== 'ruler') return;
  const [low, high] = drawing.range, k = (width - 2 * left) / (high - low || 1);
  drawing.along = (v) => left + (v - low) * k;
  set(svg, {'data-v0': drawing.along(0), 'data-kv': k});
  make('path', {class: 'axis', d: `M${left} 24H${width - left}`}, drawing.still);
  for (const v of ticks(low, high, width / 80)) {
    make('path', {class: 'axis', d: `M${drawing.along(v)} 20v4`}, drawing.still);
    make('text', {x: drawing.along(v), y: 16, 'text-anchor': 'middle', text: v}, drawing.still);
  }
}

function drawDrawings(t) {
  for (const drawing of drawings) {
    let now = drawing.versions[0];
    for (const version of drawing.versions) if (version.since <= t) now = version;
    drawOne(drawing, now, t);
  }
}

function drawOne({kind, axis, svg, caption, moving, x, y, along, radius, roomy}, {places, links, circle, title}, t) {
  moving.replaceChildren();
  const at = places.map((place) => [x(value(place.x, t)), y(value(place.y, t))]);
  const fails = Math.min(...links.map(([, , time]) => time ?? Infinity));
  const next = links.find((link) => link[2] === fails) ?? null;
  const when = document.createElement('span');
  when.className = 'when';
  const names = next && next.slice(0, 2).map((i) => nameOf(places[i])).join(', ');
  when.textContent = next ? `, fails next at ${seconds(fails)} s: ${names}` : '';
  caption.replaceChildren(title, when);

  if (circle) {
    const {x: cx, y: cy, r} = circumcircle(...circle.slice(0, 3).map((i) => at[i]));
    if (r < 1e5) make('circle', {class: 'witness', cx, cy, r, 'data-circle': circle.join(' ')}, moving);
  }
  for (const link of links) {
    const [i, k] = link, same = places[i].of !== undefined && places[i].of === places[k].of && kind === 'tree';
    make('line', {class: `link${link === next ? ' next' : ''}${same ? ' won' : ''}`, 'data-link': `${i}-${k}`,
                  x1: at[i][0], y1: at[i][1], x2: at[k][0], y2: at[k][1]}, moving);
  }
  places.forEach((place, i) => {
    const [px, py] = at[i];
    const v = place.of === undefined ? null : valueOf(place, axis, t);
    const swaps = next && next.slice(0, 2).includes(i) ? ' next' : '';
    const fill = place.of === undefined ? 'var(--point)' : colour.get(place.of);
    if (kind === 'ruler') {
      const d = `M${along(v)} 24L${px} ${py - radius - 2}`;
      make('path', {class: 'leader' + swaps, 'data-leader': i, stroke: fill, d}, moving);
    }
    const group = make('g', {class: 'element', 'data-node': i, transform: `translate(${px} ${py})`}, moving);
    if (place.of !== undefined) group.dataset.of = place.of;
    if (place.side) group.dataset.side = place.side;
    make('circle', {class: 'dot', r: radius, fill}, group);
    make('text', {y: radius * 0.4, style: `font-size: ${radius * 1.15}px`, text: nameOf(place)}, group);
    if (place.side) {  // a bracket that opens to the inside of the interval
      const [edge, tip] = [place.side * (radius + 2), place.side * (radius - 1)];
      make('path', {class: 'bracket', stroke: fill, d: `M${tip} ${-radius - 1}H${edge}V${radius + 1}H${tip}`}, group);
    } else if (v !== null && roomy) {
      const below = {x: px, y: py + radius + 11};
      make('text', {class: 'value', ...below, 'data-value': v, text: Number(v.toPrecision(3))}, moving);
    }
  });
}

const nameOf = (place) => (place.of === undefined ? place.name : elements.get(place.of).label);
