// A game for the lecture: which certificate fails next? What gives it away is hidden until somebody has guessed.
let guessing = false, answered = false, right = 0, asked = 0;

/** The certificate that fails next while the page lasts; null if none does. */
function answer() {
  const next = nextToFail(stateNumber(now));
  return next && next.fails <= data.end ? next : null;
}

function guess(held) {
  if (!guessing || answered) return;
  const next = answer();
  // Of those that fail at one time any is right.
  const correct = held === null ? next === null : next !== null && held.fails === next.fails;
  ++asked;
  if (correct) ++right;
  answered = true;
  shown = -1;
  draw();
  const of = (c) => (c.fails === null ? 'never fails' : `would fail at ${seconds(c.fails)} s`);
  const truth = next ? `${next.fact} fails next, at ${seconds(next.fails)} s` : 'none fails before the end';
  tellGuess(`${correct ? 'Right' : 'No'}: ${truth}` + (correct || held === null ? '.' : `; ${held.fact} ${of(held)}.`),
            next ? ['Go there, and guess again', () => { ask(); setTime(next.fails); }] : null);
}

function ask() {
  answered = false;
  shown = -1;
}

function tellGuess(text, offer) {
  $('guess-says').textContent = asked > 0 ? `${text} (${right} of ${asked})` : text;
  $('guess-on').hidden = !offer;
  $('guess-none').hidden = answered;
  if (offer) [$('guess-on').textContent, $('guess-on').onclick] = offer;
}

/** To be called when another state is shown: that is another question. */
function drawGuess() {
  const hide = guessing && !answered;
  document.documentElement.classList.toggle('guessing', hide);
  $('guess').hidden = !guessing;
  $('game').setAttribute('aria-pressed', guessing);
  if (hide) tellGuess('Which certificate fails next? Click it in the list, or between its two points.', null);
}

function startGuessing(on) {
  guessing = on;
  right = asked = 0;
  ask();
  if (on) play(false);
  draw();
  resize();
}

$('game').hidden = data.certificates.length === 0;
$('game').addEventListener('click', () => startGuessing(!guessing));
$('guess-none').addEventListener('click', () => guess(null));
$('figure').addEventListener('pointerdown', (event) => {
  const held = event.target.closest('[data-held]');
  if (!held || !guessing || answered) return;
  event.stopImmediatePropagation();
  guess(data.certificates[Number(held.dataset.held)]);
}, true);
