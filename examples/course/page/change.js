// To change the motions: points and velocities are dragged in the picture, or numbers typed. Each time the program of
// this page runs anew, and what it says takes the place of what was recorded.
const recorded = JSON.parse($('data').textContent);
const most = 20;
let program = null, grip = null;

/** A handle stands where its point would be so many seconds later at the velocity of now: or fewer, or earlier. */
const usualAhead = duration * 0.09;

/** The points of drawings that may be changed, by title. They stay the same points for the whole run. */
const drawnOf = (run) => Object.fromEntries((run.changeable ?? []).map((title) => [title,
  run.drawings.find((drawing) => drawing.title === title).places.map(({x, y}) => ({start: 0, x: [...x], y: [...y]}))]));
const motionsOf = (run) => run.elements.map(({pieces: [{start, x, y}]}) => ({start, ...(x && {x: [...x]}), y: [...y]}));
const coordinates = data.view === 'line' ? ['y'] : ['x', 'y'];

/** Rounded so that formulas stay short, in the scale of a picture. */
function rounded(number, svg = $('figure')) {
  const range = svg.getBoundingClientRect().height / Math.abs(svg.dataset.ky);
  return Number(number.toFixed(Math.max(0, 3 - Math.floor(Math.log10(range)))));
}

/** Runs the program. If it refuses the motions, all stays as it was. */
function change(motions, drawn = drawnOf(data)) {
  try {
    showRun(JSON.parse(pageOf(program, motions, drawn)));
  } catch (error) {
    $('change-says').textContent = `The program refused that: ${error.message}`;
    return false;
  }
  fillTable();
  return true;
}

/** The motion with another position or velocity at `now`, in one coordinate; the other of the two stays. */
function moved(coefficients, elapsed, position, velocity) {
  const c = [...coefficients], short = (number) => rounded(number, gripped());
  if (c.length > 1) {
    c[1] = short(c[1] + velocity - slope(c, elapsed));
    c[0] = 0;
  }
  c[0] = short(position - (value(c, elapsed) - c[0]));
  if (c.length === 1) c[0] = short(position);
  return c;
}

/** The picture or drawing in which something is dragged; drawings are made anew in every run. */
const gripped = () => drawings.find(({title}) => title === grip.title)?.svg ?? $('figure');

/** Of the motion that is gripped, in each of its coordinates: where it is now, and how fast. */
function grippedMotion(motions, drawn) {
  const motion = (grip.title ? drawn[grip.title] : motions)[grip.index];
  const elapsed = now - motion.start;
  const names = grip.title ? ['x', 'y'] : coordinates;
  const states = names.map((name) => [name, value(motion[name], elapsed), slope(motion[name], elapsed)]);
  return {motion, elapsed, states};
}

/** A grip at a point of the model: what is dragged is the element, or the handle of its velocity. */
function dragTo(x, y) {
  const motions = motionsOf(data), drawn = drawnOf(data);
  const {motion, elapsed, states} = grippedMotion(motions, drawn);
  for (const [name, p, v] of states) {
    const target = {x, y}[name] - grip.beside[name];
    motion[name] = grip.ahead ? moved(motion[name], elapsed, p, (target - p) / grip.ahead)
                              : moved(motion[name], elapsed, target, v);
  }
  change(motions, drawn);
}

function pointed(event) {
  const svg = gripped(), {x0, kx, y0, ky} = svg.dataset;
  const {left, top} = svg.getBoundingClientRect();
  return [(event.clientX - left - x0) / kx, (event.clientY - top - y0) / ky];
}

function take(event) {
  const handle = event.target.closest('[data-velocity]');
  const element = event.target.closest('[data-element], [data-node]');
  const title = event.target.closest('svg')?.dataset.title;
  if (!program || (!handle && !element) || (title && !data.changeable?.includes(title))) return;
  event.stopImmediatePropagation();
  event.preventDefault();
  play(false);
  const {velocity, ahead, node, element: of} = (handle ?? element).dataset;
  const number = Number(velocity ?? node ?? of);
  const index = title ? number : data.elements.findIndex((e) => e.id === number);
  grip = {title, index, ahead: Number(ahead ?? 0), from: [event.clientX, event.clientY]};
  // Nothing jumps to the pointer: it may have taken the name beside a point, or the rim of a ring.
  const [x, y] = pointed(event), {states} = grippedMotion(motionsOf(data), drawnOf(data));
  grip.beside = Object.fromEntries(states.map(([name, p, v]) => [name, {x, y}[name] - p - v * grip.ahead]));
  try { event.currentTarget.setPointerCapture(event.pointerId); } catch { /* a pointer that a script has made up */ }
  rangeKept = true;
}

let waiting = null;
function drag(event) {
  if (!grip) return;
  event.stopImmediatePropagation();
  if (Math.hypot(event.clientX - grip.from[0], event.clientY - grip.from[1]) < 2) return;
  grip.from = [Infinity, Infinity];  // from here on every move counts
  // One run a frame is enough.
  if (!waiting) {
    requestAnimationFrame(() => {
      const place = waiting;
      waiting = null;
      if (grip) dragTo(...place);
    });
  }
  waiting = pointed(event);
}

function drop(event) {
  if (!grip) return;
  event.stopImmediatePropagation();
  if (waiting) dragTo(...waiting);
  grip = null;
  rangeKept = false;
  showRun(data);
}

const handles = make('g', {});
/** Velocities of now, as lines with a grip at their end. */
function drawHandles() {
  if (program) drawings.filter(({title}) => data.changeable?.includes(title)).forEach(drawHandlesOf);
  handles.replaceChildren();
  if (handles.parentNode !== $('figure')) $('figure').append(handles);
  if ((!program && !guessing) || !view.inside) return;  // in space nothing is dragged but the view
  data.elements.forEach((element, i) => {
    const piece = pieceAt(element, now), elapsed = now - piece.start;
    const at = (name) => (piece[name] ? value(piece[name], elapsed) : now);
    const rate = (name) => (piece[name] ? slope(piece[name], elapsed) : 1);
    drawHandle({parent: handles, svg: $('figure'), box: view.inside(), i, number: element.id, name: element.name,
                stroke: colour.get(element.id), place: [at('x'), at('y')], velocity: [rate('x'), rate('y')]});
  });
}
function drawHandlesOf({title, versions, svg, moving, width, height}) {
  versions[0].places.forEach(({x, y, name}, i) => drawHandle({
    parent: moving, svg, box: [0, 0, width, height], title, i, number: i, name, stroke: 'var(--point)',
    place: [value(x, now), value(y, now)], velocity: [slope(x, now), slope(y, now)]}));
}

/** How much of a way from a place, both in pixels, stays in a box: 1 for all of it. */
function shareInside(place, way, [x0, y0, x1, y1]) {
  const room = 6;
  const share = (at, by, low, high) => (Math.abs(by) < 1e-9 ? 1 : ((by > 0 ? high - room : low + room) - at) / by);
  return Math.max(0, Math.min(1, share(place[0], way[0], x0, x1), share(place[1], way[1], y0, y1)));
}

/** The line from a point to where it would be later; earlier, if more of that is in the picture. */
function drawHandle({parent, svg, box, title, i, number, name, stroke, place, velocity}) {
  const {x0, kx, y0, ky} = svg.dataset;
  const [x, y] = [Number(x0) + kx * place[0], Number(y0) + ky * place[1]];
  const way = [kx * velocity[0] * usualAhead, ky * velocity[1] * usualAhead];
  const [later, earlier] = [1, -1].map((sign) => sign * shareInside([x, y], way.map((by) => sign * by), box));
  let ahead = usualAhead * (later > 0.4 || later >= -earlier ? later : earlier);
  if (grip?.ahead && grip.title === title && grip.index === i) ahead = grip.ahead;
  let [u, v] = way.map((by) => by * ahead / usualAhead);
  const length = Math.hypot(u, v), least = 22;
  if (length < 0.5) {
    // Of a point at rest the grip is above it: one under it could not be taken.
    [ahead, u, v] = [usualAhead, 0, -least];
  } else if (length < least) {
    const sign = shareInside([x, y], [u, v].map((part) => part * least / length), box) < 1 ? -1 : 1;
    [ahead, u, v] = [ahead, u, v].map((part) => sign * part * least / length);
  }
  const from = 10 / Math.hypot(u, v);
  make('path', {class: 'velocity', stroke, d: `M${x + from * u} ${y + from * v}L${x + u} ${y + v}`}, parent);
  if (!program) return;
  const group = make('g', {class: 'handle', 'data-velocity': number, 'data-ahead': ahead,
                           transform: `translate(${x + u} ${y + v})`}, parent);
  make('title', {text: `velocity of ${name}`}, group);
  make('circle', {r: 14, class: 'grip'}, group);
  make('circle', {r: 5, stroke}, group);
}

/** Coefficients of elements, to be typed: with a keyboard alone all of these can be changed. */
function fillTable() {
  const names = ['', ' t', ' t\u00B2'];
  const rows = motionsOf(data).flatMap((motion, i) => coordinates.map((name) => {
    const row = document.createElement('tr'), head = document.createElement('th');
    head.textContent = data.elements[i].name + (coordinates.length > 1 ? ` ${name}` : '');
    head.style.color = colour.get(data.elements[i].id);
    row.append(head);
    for (let k = 0; k < data.coefficients; ++k) {
      const cell = document.createElement('td'), input = document.createElement('input');
      const c = motion[name][k] ?? 0;
      // Seven characters are seen on a telephone.
      const four = Number(c.toPrecision(4)), shown = String(four).length > 7 ? Number(c.toPrecision(3)) : four;
      Object.assign(input, {type: 'number', step: 'any', value: shown, title: c});
      input.setAttribute('aria-label', `${data.elements[i].name} ${name}${names[k] ? ', times' + names[k] : ''}`);
      input.dataset.of = `${i} ${name} ${k}`;
      input.addEventListener('change', () => type(input, i, name, k));
      cell.append(input, names[k]);
      row.append(cell);
    }
    return row;
  }));
  const focus = document.activeElement?.dataset?.of;
  $('motions').replaceChildren(...rows);
  if (focus) $('motions').querySelector(`[data-of="${focus}"]`)?.focus();
  $('more').disabled = data.elements.length >= most;
  $('fewer').disabled = data.elements.length <= 2;
}
function type(input, i, name, k) {
  const motions = motionsOf(data);
  motions[i][name][k] = Number(input.value);
  if (input.value === '' || !change(motions)) fillTable();
}

/** A motion that stays in sight: from one place to another, bent a little. */
function anyMotion() {
  const {x0, kx, y0, ky} = $('figure').dataset;
  const {width, height} = $('figure').getBoundingClientRect();
  const span = {x: [-x0 / kx, (width - x0) / kx], y: [(height - y0) / ky, -y0 / ky]};
  const motion = {start: data.begin};
  for (const name of coordinates) {
    const [low, high] = span[name];
    const place = () => low + (high - low) * (0.12 + 0.76 * Math.random());
    const [p, q] = [place(), place()];
    const bend = data.coefficients > 2 ? (Math.random() - 0.5) * 2 * (high - low) / duration ** 2 : 0;
    // Rates want more digits than places: rounded like these, many would be equal.
    const fine = (number) => Number(number.toPrecision(2));
    motion[name] = [rounded(p), fine((q - p) / duration - bend * duration), fine(bend)].slice(0, data.coefficients);
  }
  return motion;
}

$('more').addEventListener('click', () => change([...motionsOf(data), anyMotion()]));
$('fewer').addEventListener('click', () => change(motionsOf(data).slice(0, -1)));
$('shuffle').addEventListener('click', () => change(data.elements.map(anyMotion)));
$('reset').addEventListener('click', () => { showRun(recorded); fillTable(); });
for (const [name, does] of [['down', take], ['move', drag], ['up', drop], ['cancel', drop]]) {
  for (const id of ['figure', 'drawings']) $(id).addEventListener('pointer' + name, does, true);
}

/** Says plainly what is missing where the program is not in the page, or the browser cannot run it. */
async function readyToChange() {
  $('change').hidden = false;
  const text = $('program').textContent;
  if (text === '') {
    $('change-says').textContent = 'Here points could be dragged, and numbers typed: that needs the program of this ' +
      'page as WebAssembly, which this build has left out (see examples/README.md).';
    return false;
  }
  try {
    program = new WebAssembly.Module(await unpacked(text));
  } catch (error) {
    $('change-says').textContent = `Points cannot be dragged: this browser does not run the program (${error.message}).`;
    return false;
  }
  $('change-says').textContent = 'Drag a point, or the ring beside it: its velocity. The program of this page then ' +
    'runs anew, in your browser.' + (data.changeable ? ' The points of the drawings can be dragged too.' : '');
  $('change').classList.add('ready');
  for (const id of ['figure', 'drawings']) $(id).classList.add('changeable');
  fillTable();
  draw();
  resize();
  return true;
}
