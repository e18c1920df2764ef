// What the program recorded, and where everything is at a time. Nothing else on this page evaluates a polynomial, and
// nothing at all on it decides who is in order, on the hull or in touch: that is read from the recorded states.
const data = JSON.parse(document.getElementById('data').textContent);
const duration = data.end - data.begin;
const elements = new Map(), colour = new Map(), certificatesOf = new Map();
let colourful;  // a colour for each element while there are few

/** Shows another run of the same program: the one that was recorded is the first. */
function takeUp(run) {
  Object.assign(data, run);
  for (const of of [elements, colour, certificatesOf]) of.clear();
  colourful = data.elements.length <= 8;
  data.elements.forEach((element, i) => {
    elements.set(element.id, element);
    colour.set(element.id, colourful ? `var(--e${i})` : 'var(--point)');
  });
}
takeUp(data);

/** While somebody drags, the picture keeps its scale. */
let rangeKept = false;

function value(coefficients, elapsed) {
  let sum = 0;
  for (let i = coefficients.length; i-- > 0;) sum = sum * elapsed + coefficients[i];
  return sum;
}

function slope(coefficients, elapsed) {
  let sum = 0;
  for (let i = coefficients.length; i-- > 1;) sum = sum * elapsed + i * coefficients[i];
  return sum;
}

/** The piece of motion that an element has at t+. */
function pieceAt(element, t) {
  let found = element.pieces[0];
  for (const piece of element.pieces) if (piece.since <= t) found = piece;
  return found;
}

/** Where an element is: x and y in the plane, z too in space; on a line x is the time and y the value. */
function position(id, t) {
  const piece = pieceAt(elements.get(id), t);
  const elapsed = t - piece.start;
  const [x, y, z] = [piece.x, piece.y, piece.z].map((coefficients) => coefficients && value(coefficients, elapsed));
  return {x: x ?? t, y, z: z ?? 0};
}

/** How many events there have been up to and including t: the number of the state that holds at t+. */
function stateNumber(t) {
  let low = 0, high = data.events.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (data.events[middle].time <= t) low = middle + 1; else high = middle;
  }
  return low;
}

/** The certificates of a state, the one that fails first in front. `fails` is null for those that never do. */
function certificatesAt(number) {
  if (!certificatesOf.has(number)) {
    const held = data.certificates.filter((c) => c.from <= number && number < c.until);
    held.sort((a, b) => (a.fails ?? Infinity) - (b.fails ?? Infinity));
    certificatesOf.set(number, held);
  }
  return certificatesOf.get(number);
}

/** The certificate that will fail next, if there is one. */
function nextToFail(number) {
  const first = certificatesAt(number)[0];
  return first && first.fails !== null ? first : null;
}

const digits = Math.max(0, Math.min(9, 3 - Math.floor(Math.log10(duration / 4))));
const seconds = (t) => t.toFixed(digits);

/** The circle through three points that turn left; where roundings bring them on a line, a very large one. */
function circumcircle([ax, ay], [bx, by], [cx, cy]) {
  const [ux, uy, vx, vy] = [bx - ax, by - ay, cx - ax, cy - ay];
  const [u, v] = [ux * ux + uy * uy, vx * vx + vy * vy];
  const turn = ux * vy - uy * vx, least = 1e-12 * Math.max(u, v);
  const d = 2 * (Math.abs(turn) < least ? least : turn);
  const [x, y] = [(u * vy - v * uy) / d, (v * ux - u * vx) / d];
  return {x: ax + x, y: ay + y, r: Math.hypot(x, y)};
}

function make(tag, attributes, parent) {
  const node = document.createElementNS('http://www.w3.org/2000/svg', tag);
  set(node, attributes);
  if (parent) parent.append(node);
  return node;
}
function set(node, attributes) {
  for (const [name, content] of Object.entries(attributes)) {
    if (name === 'text') node.textContent = content; else node.setAttribute(name, content);
  }
}

/** Round numbers between low and high, about as many as asked for. */
function ticks(low, high, about) {
  const rough = (high - low) / about;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((m) => m * power >= rough);
  const result = [];
  for (let i = Math.ceil(low / step); i * step <= high + 1e-9 * step; ++i) result.push(+(i * step).toPrecision(12));
  return result;
}
