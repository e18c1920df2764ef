// To change the motions: points and velocities are dragged in the picture, or numbers typed. Each time the program of
// this page runs anew, and what it says takes the place of what was recorded.
const recorded = JSON.parse($('data').textContent);
const most = 20;
let program = null, grip = null;

/** What a handle adds to a position: the way of so many seconds at the velocity of now. */
const ahead = duration * 0.09;

const motionsOf = (run) => run.elements.map(({pieces: [{start, x, y}]}) => ({start, ...(x && {x: [...x]}), y: [...y]}));
const coordinates = data.view === 'line' ? ['y'] : ['x', 'y'];

/** Rounded so that formulas stay short. */
function rounded(number) {
  const {ky} = $('figure').dataset;
  const range = $('figure').getBoundingClientRect().height / Math.abs(ky);
  return Number(number.toFixed(Math.max(0, 3 - Math.floor(Math.log10(range)))));
}

/** Runs the program. If it refuses the motions, all stays as it was. */
function change(motions) {
  try {
    showRun(JSON.parse(pageOf(program, motions)));
  } catch (error) {
    $('change-says').textContent = `The program refused that: ${error.message}`;
    return false;
  }
  fillTable();
  return true;
}

/** The motion with another position or velocity at `now`, in one coordinate; the other of the two stays. */
function moved(coefficients, elapsed, position, velocity) {
  const c = [...coefficients];
  if (c.length > 1) {
    c[1] = rounded(c[1] + velocity - slope(c, elapsed));
    c[0] = 0;
  }
  c[0] = rounded(position - (value(c, elapsed) - c[0]));
  if (c.length === 1) c[0] = rounded(position);
  return c;
}

/** A grip at a point of the model: what is dragged is the element, or the handle of its velocity. */
function dragTo(x, y) {
  const motions = motionsOf(data);
  const motion = motions[grip.index];
  const elapsed = now - motion.start;
  const target = {x, y};
  for (const name of coordinates) {
    const [p, v] = [value(motion[name], elapsed), slope(motion[name], elapsed)];
    motion[name] = grip.velocity ? moved(motion[name], elapsed, p, (target[name] - p) / ahead)
                                 : moved(motion[name], elapsed, target[name], v);
  }
  change(motions);
}

function pointed(event) {
  const {x0, kx, y0, ky} = $('figure').dataset;
  const {left, top} = $('figure').getBoundingClientRect();
  return [(event.clientX - left - x0) / kx, (event.clientY - top - y0) / ky];
}

function take(event) {
  const handle = event.target.closest('[data-velocity]'), element = event.target.closest('[data-element]');
  if (!program || (!handle && !element)) return;
  event.stopImmediatePropagation();
  event.preventDefault();
  play(false);
  const id = Number((handle ?? element).getAttribute(handle ? 'data-velocity' : 'data-element'));
  grip = {index: data.elements.findIndex((e) => e.id === id), velocity: handle !== null, from: [event.clientX, event.clientY]};
  try { $('figure').setPointerCapture(event.pointerId); } catch { /* a pointer that a script has made up */ }
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
  const {x0, kx, y0, ky} = $('figure').dataset;
  handles.replaceChildren();
  if (handles.parentNode !== $('figure')) $('figure').append(handles);
  if ((!program && !guessing) || kx === undefined) return;  // in space nothing is dragged but the view
  for (const element of data.elements) {
    const piece = pieceAt(element, now);
    const elapsed = now - piece.start;
    const at = (name) => (piece[name] ? value(piece[name], elapsed) : now);
    const rate = (name) => (piece[name] ? slope(piece[name], elapsed) : 1);
    const [x, y] = [Number(x0) + kx * at('x'), Number(y0) + ky * at('y')];
    const [u, v] = [kx * rate('x') * ahead, ky * rate('y') * ahead];
    const length = Math.hypot(u, v) || 1;
    const [from, to] = [10 / length, Math.max(1, 22 / length)];  // a grip under the point could not be taken
    const stroke = colour.get(element.id);
    make('path', {class: 'velocity', stroke, d: `M${x + from * u} ${y + from * v}L${x + to * u} ${y + to * v}`}, handles);
    if (!program) continue;
    const group = make('g', {class: 'handle', 'data-velocity': element.id,
                             transform: `translate(${x + to * u} ${y + to * v})`}, handles);
    make('title', {text: `velocity of ${element.name}`}, group);
    make('circle', {r: 14, class: 'reach'}, group);
    make('circle', {r: 5, stroke}, group);
  }
}

/** Coefficients, to be typed: with a keyboard alone everything can be changed. */
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
      Object.assign(input, {type: 'number', step: 'any', value: Number(c.toPrecision(4)), title: c});
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
  $('figure').addEventListener('pointer' + name, does, true);
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
  $('change-says').textContent = 'Drag a point, or the ring ahead of it: its velocity. The program of this page then ' +
    'runs anew, in your browser.';
  $('change').classList.add('ready');
  $('figure').classList.add('changeable');
  fillTable();
  draw();
  resize();
  return true;
}
