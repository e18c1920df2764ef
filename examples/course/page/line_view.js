// The space-time diagram: values on a line, time to the right. A motion of degree two is a parabola, drawn exactly.
function lineView(svg) {
  const top = 14, ring = 13;
  let left = 46, right = 16, bottom = 38;
  let scale, moving = {}, kept;

  /** The world line of an element from a to b, both within one run. */
  function worldLine(element, a, b) {
    let path = '';
    element.pieces.forEach((piece, i) => {
      const from = Math.max(a, i === 0 ? data.begin : piece.since);
      const to = Math.min(b, i + 1 < element.pieces.length ? element.pieces[i + 1].since : data.end);
      if (!(from < to)) return;
      const at = (t) => [scale.x(t), scale.y(value(piece.y, t - piece.start))].join(' ');
      path += `M${at(from)}`;
      if (piece.y.length <= 3) {
        const half = (to - from) / 2;
        const control = value(piece.y, from - piece.start) + half * slope(piece.y, from - piece.start);
        path += `Q${scale.x(from + half)} ${scale.y(control)} ${at(to)}`;
      } else {
        for (let k = 1; k <= 64; ++k) path += `L${at(from + (to - from) * k / 64)}`;
      }
    });
    return path;
  }

  function range() {
    if (rangeKept && kept) return kept;
    let low = Infinity, high = -Infinity;
    for (const element of data.elements) {
      for (let k = 0; k <= 400; ++k) {
        const {y} = position(element.id, data.begin + duration * k / 400);
        low = Math.min(low, y), high = Math.max(high, y);
      }
    }
    if (data.window) [low, high] = data.window;
    const margin = 0.06 * (high - low || 1);
    return kept = [low - margin, high + margin];
  }

  function layout(width, height) {
    svg.replaceChildren();
    const ordered = data.states.some((state) => state.order);
    const heading = make('text', {'text-anchor': 'middle', text: ordered ? 'order' : ''}, svg);
    const column = heading.getComputedTextLength(), text = parseFloat(getComputedStyle(heading).fontSize);
    // What is at the beginning, at the end or at the bottom covers none of the numbers and names.
    right = ordered ? ring + 4 + column : 16;
    bottom = 2.5 * text + 8;
    set(heading, {x: width - column / 2 - 2, y: top + 8});
    const [low, high] = range();
    const labels = ticks(low, high, height / 55).map((v) => [v, make('text', {'text-anchor': 'end', text: v}, svg)]);
    left = ring + 6 + Math.max(...labels.map(([, label]) => label.getComputedTextLength()));
    const kx = (width - left - right) / duration, ky = (height - top - bottom) / (high - low);
    scale = {x: (t) => left + (t - data.begin) * kx, y: (v) => height - bottom - (v - low) * ky};
    set(svg, {'data-x0': left - data.begin * kx, 'data-kx': kx, 'data-y0': height - bottom + low * ky, 'data-ky': -ky});

    const defs = make('defs', {}, svg);
    make('rect', {x: left, y: top, width: width - left - right, height: height - top - bottom},
         make('clipPath', {id: 'inside'}, defs));
    moving.past = make('rect', {x: left, y: top, height: height - top - bottom}, make('clipPath', {id: 'past'}, defs));

    for (const [v, label] of labels) {
      make('path', {class: 'grid', d: `M${left} ${scale.y(v)}H${width - right}`}, svg);
      set(label, {x: left - ring - 3, y: scale.y(v) + 4});
    }
    for (const t of ticks(data.begin, data.end, width / 90)) {
      make('path', {class: 'grid', d: `M${scale.x(t)} ${top}V${height - bottom}`}, svg);
      make('text', {x: scale.x(t), y: height - bottom + text + 5, 'text-anchor': 'middle', text: t}, svg);
    }
    make('text', {x: (left + width - right) / 2, y: height - 3, 'text-anchor': 'middle', text: 'time in s'}, svg);

    const inside = make('g', {'clip-path': 'url(#inside)'}, svg);
    data.states.forEach((state, k) => {
      const from = k === 0 ? data.begin : data.events[k - 1].time;
      const to = k < data.events.length ? data.events[k].time : data.end;
      for (const id of state.marked ?? []) {
        make('path', {class: 'known', d: worldLine(elements.get(id), from, to)}, inside);
      }
    });
    for (const element of data.elements) {
      const shape = {d: worldLine(element, data.begin, data.end), stroke: colour.get(element.id)};
      make('path', {class: 'path ahead', ...shape}, inside);
      make('path', {class: 'path', 'clip-path': 'url(#past)', ...shape}, inside);
    }
    moving.held = make('g', {}, inside);
    moving.marks = data.events.map((event) => {
      const mark = make('circle', {class: 'mark', r: 4.5}, inside);
      if (event.members.length > 0) {
        const {x, y} = position(event.members[0], event.time);
        set(mark, {cx: scale.x(x), cy: scale.y(y)});
      } else {
        mark.remove();
      }
      make('title', {text: `${seconds(event.time)} s: ${event.text}`}, mark);
      mark.addEventListener('click', (click) => { click.stopPropagation(); setTime(event.time); });
      return mark;
    });
    moving.cursor = make('path', {class: 'cursor'}, svg);
    moving.elements = new Map(data.elements.map((e) => [e.id, drawElement(e, svg, 1)]));
    moving.order = make('g', {}, svg);
    moving.size = {width, height, column};
  }

  function draw(t, number, lit) {
    const {width, height} = moving.size, state = data.states[number];
    set(moving.past, {width: Math.max(0, scale.x(t) - left)});
    set(moving.cursor, {d: `M${scale.x(t)} ${top}V${height - bottom}`});
    moving.marks.forEach((mark, k) => mark.classList.toggle('past', k < number));
    const places = [...moving.elements.keys()].map((id) => [scale.x(t), scale.y(position(id, t).y)]);
    const sideways = (scale.x(t) - left > 3 * nameRadius + ring ? -1 : 1) * (2 * nameRadius + 6);
    const box = [left - ring, top - nameRadius, width, height - bottom];
    placeElements([...moving.elements.values()], places, box, sideways);
    for (const [id, group] of moving.elements) {
      group.classList.toggle('marked', (state.marked ?? []).includes(id));
      group.classList.toggle('lit', lit.includes(id));
    }
    drawCertificates(t, number);
    drawOrder(state.order ?? [], moving.size);
  }

  /** Between now's positions of those it is about; and a triangle where and when it is going to fail. */
  function drawCertificates(t, number) {
    moving.held.replaceChildren();
    const next = nextToFail(number);
    for (const held of certificatesAt(number)) {
      const kind = held === next ? ' next' : '';
      if (held.members.length === 2) {
        const [a, b] = held.members.map((id) => scale.y(position(id, t).y));
        const number = data.certificates.indexOf(held);
        make('path', {class: 'held' + kind, 'data-held': number, d: `M${scale.x(t)} ${a}V${b}`}, moving.held);
      }
      if (held.fails === null || held.fails > data.end) continue;
      const x = scale.x(held.fails), y = scale.y(position(held.members[0], held.fails).y);
      make('path', {class: 'fails' + kind, d: `M${x - 8} ${y - 7}h16l-8 14z`}, moving.held);
      if (kind) make('path', {class: 'lead', d: `M${x} ${y + 8}V${moving.size.height - bottom}`}, moving.held);
    }
  }

  /** The order as it is recorded, the greatest on top. */
  function drawOrder(order, {width, height, column}) {
    moving.order.replaceChildren();
    const step = Math.min(26, (height - top - bottom - 30) / Math.max(1, order.length));
    order.forEach((id, i) => {
      const y = (height - bottom + top) / 2 + step * ((order.length - 1) / 2 - i);
      const group = make('g', {class: 'element', 'data-place': i, 'data-of': id}, moving.order);
      set(group, {transform: `translate(${width - column / 2 - 2} ${y})`});
      make('circle', {class: 'dot', r: Math.min(10, step / 2), fill: colour.get(id)}, group);
      make('text', {y: 4, text: elements.get(id).label}, group);
    });
  }

  /** Where the time axis begins and ends, in pixels from the left edge of the picture. */
  const axis = () => ({from: scale.x(data.begin), to: scale.x(data.end)});

  /** The part of the picture within its axes: x, y, x, y. */
  const inside = () => [left, top, moving.size.width - right, moving.size.height - bottom];

  return {layout, draw, axis, inside, timeAt: (x) => data.begin + (x - left) / (scale.x(data.end) - left) * duration};
}
