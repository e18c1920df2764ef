// Time: slider, keys, play and pause, the list of events, the certificates that hold now.
const $ = (id) => document.getElementById(id);
const view = {line: lineView, plane: planeView, space: spaceView}[data.view]($('figure'));
let now = data.begin, shown = -1, playing = false, lit = [];

document.title = data.title;
$('title').textContent = data.title;
$('about').textContent = data.about;
set($('time'), {min: data.begin, max: data.end});

function setTime(t) {
  now = Math.min(data.end, Math.max(data.begin, t));
  $('time').value = now;
  draw();
}

function draw() {
  const number = stateNumber(now);
  if (number !== shown && answered && shown !== -1) answered = false;  // the time has been moved: another question
  view.draw(now, number, lit);
  drawDrawings(now);
  drawHandles();
  $('figure').dataset.time = now;
  $('now').textContent = `t = ${seconds(now)} s`;
  $('time').setAttribute('aria-valuetext', `${seconds(now)} seconds`);
  moveRibbon();
  if (number === shown) return;
  shown = number;
  $('state').textContent = data.states[number].text;
  showNext(number);
  showFormula(number);
  drawGuess();
  showCertificates(number);
  markEvents(number);
  drawRibbon();
}

function showNext(number) {
  const next = nextToFail(number);
  $('next').replaceChildren();
  if (data.certificates.length === 0) return;
  if (!next) return $('next').append('No certificate is going to fail.');
  const time = document.createElement('b');
  time.textContent = `${seconds(next.fails)} s`;
  $('next').append(`Next to fail: ${next.fact}, at `, time);
}

/** A polynomial in the time since the page begins, rounded to so many digits as are read at a glance. */
function formula(coefficients) {
  const power = (k) => (k === 0 ? '' : ` ${data.begin === 0 ? 't' : `(t \u2212 ${data.begin})`}` +
    (k === 1 ? '' : String(k).replace(/./g, (digit) => '\u2070\u00B9\u00B2\u00B3\u2074\u2075\u2076\u2077\u2078\u2079'[digit])));
  let text = '';
  coefficients.forEach((c, k) => {
    if (c === 0) return;
    const rounded = Number(Math.abs(c).toPrecision(3));
    const size = rounded === 1 && k > 0 ? '' : String(rounded);
    const sign = text === '' ? (c < 0 ? '\u2212' : '') : (c < 0 ? ' \u2212 ' : ' + ');
    text += sign + (size ? size + power(k) : power(k).trim());
  });
  return text || '0';
}

function showFormula(number) {
  const next = nextToFail(number);
  const polynomial = next?.polynomial;
  $('formula').textContent = polynomial
    ? `${next.function ?? 'f(t)'} = ${formula(polynomial)}, negative after t = ${seconds(next.fails)}` : '';
  $('formula').hidden = !data.certificates.some((held) => held.polynomial);
}

function showCertificates(number) {
  const all = [...certificatesAt(number)], most = 60;
  // Their order would give away which one fails first.
  if (guessing && !answered) all.sort((a, b) => (a.fact < b.fact ? -1 : 1));
  const next = nextToFail(number);
  $('certificates-title').textContent = `Certificates that hold: ${all.length}`;
  $('certificates').replaceChildren(...all.slice(0, most).map((held) => {
    const row = document.createElement('li');
    const [fact, time] = [document.createElement('span'), document.createElement('span')];
    fact.textContent = held.fact;
    time.textContent = held.fails === null ? 'for ever' : `until ${seconds(held.fails)}`;
    row.classList.toggle('next', held === next);
    row.append(fact, time);
    row.addEventListener('mouseenter', () => { lit = held.members; draw(); });
    row.addEventListener('mouseleave', () => { lit = []; draw(); });
    if (guessing && !answered) {
      set(row, {role: 'button', tabindex: 0});
      row.addEventListener('click', () => guess(held));
      row.addEventListener('keydown', ({key}) => { if (key === 'Enter') guess(held); });
    }
    return row;
  }));
  if (all.length > most) {
    const rest = document.createElement('li');
    rest.className = 'none';
    rest.textContent = `and ${all.length - most} more, which hold longer`;
    $('certificates').append(rest);
  }
  $('proof').hidden = data.certificates.length === 0;
}

function listEvents() {
  $('events-title').textContent = `Events: ${data.events.length}`;
  $('events').replaceChildren();
  data.events.forEach((event, k) => {
    const row = document.createElement('li');
    const button = document.createElement('button');
    const [time, text] = [document.createElement('time'), document.createElement('span')];
    button.type = 'button';
    button.dataset.event = k;
    time.textContent = seconds(event.time);
    text.textContent = event.text;
    button.append(time, text);
    button.addEventListener('click', () => setTime(event.time));
    row.append(button);
    $('events').append(row);
  });
  if (data.events.length === 0) $('events').innerHTML = '<li class="none">none</li>';
}

function markEvents(number) {
  [...$('events').children].forEach((row, k) => {
    row.classList.toggle('past', k < number);
    row.classList.toggle('latest', k === number - 1);
    if (k !== number - 1) return row.firstChild.removeAttribute?.('aria-current');
    row.firstChild.setAttribute('aria-current', 'step');
  });
  showLatest();
}
/** Scrolls the list of events to the latest one, if that is not wholly seen. */
function showLatest() {
  const [list, row] = [$('events'), $('events').querySelector('.latest')];
  if (!row) return;
  if (row.offsetTop < list.scrollTop || row.offsetTop + row.offsetHeight > list.scrollTop + list.clientHeight) {
    list.scrollTop = row.offsetTop - list.clientHeight / 2;
  }
}

// Under the slider: what has happened and will, and when the certificates of now fail. Some of those will never come to
// it: an event before may put others in their place.
// It has the time axis of the picture, and so has the slider.
const ribbonX = (t) => {
  const {from, to} = view.axis();
  return from + (t - data.begin) / duration * (to - from);
};
function drawRibbon() {
  $('ribbon').replaceChildren();
  data.events.forEach((event, k) => {
    const past = k < shown ? ' past' : '';
    make('path', {class: 'cursor' + past, opacity: past ? 1 : 0.35, d: `M${ribbonX(event.time)} 2v10`}, $('ribbon'));
  });
  const next = nextToFail(shown);
  for (const held of certificatesAt(shown)) {
    if (held.fails === null || held.fails > data.end) continue;
    const kind = held === next ? ' next' : '';
    make('path', {class: 'fails' + kind, d: `M${ribbonX(held.fails) - 4} 14h8l-4 7z`}, $('ribbon'));
  }
  make('path', {class: 'cursor', id: 'hand', 'stroke-width': 2}, $('ribbon'));
  moveRibbon();
}
function moveRibbon() {
  const hand = $('hand');
  if (hand) set(hand, {d: `M${ribbonX(now)} 0v24`});
}

function goToEvent(step) {
  const times = data.events.map((event) => event.time);
  const target = step > 0 ? times.find((t) => t > now) : times.filter((t) => t < now).pop();
  setTime(target ?? (step > 0 ? data.end : data.begin));
}

let last = 0;
function play(on) {
  playing = on;
  $('play').textContent = on ? 'Pause' : 'Play';
  $('play').setAttribute('aria-pressed', on);
  if (!on) return;
  if (now >= data.end) setTime(data.begin);
  last = performance.now();
  requestAnimationFrame(tick);
}
function tick(moment) {
  if (!playing) return;
  const pace = duration / data.play * Number($('speed').value);
  setTime(now + Math.max(0, moment - last) / 1000 * pace);
  last = moment;
  if (now >= data.end) play(false); else requestAnimationFrame(tick);
}

// The picture takes the height that the rest of the page leaves of the window, if that is enough for it.
let laidOut = '';
function resize() {
  const width = $('frame').clientWidth;
  if (width === 0) return;  // the page is not shown
  layOutDrawings();
  drawDrawings(now);
  drawHandles();
  const [stage, code] = [$('stage'), $('code')];
  const beside = (part) => part.offsetLeft > stage.offsetLeft + stage.offsetWidth / 2;
  const rest = stage.offsetHeight - $('figure').getBoundingClientRect().height;
  const footer = document.querySelector('footer');
  const below = footer.offsetHeight + parseFloat(getComputedStyle(footer).marginTop) +
    parseFloat(getComputedStyle(document.body).paddingBottom);
  // Of a program that stands below, its first line.
  const gap = parseFloat(getComputedStyle(document.querySelector('main')).rowGap);
  const edges = code ? 2 * parseFloat(getComputedStyle(code).paddingTop) + gap + 2 : 0;
  const folded = code && !beside(code) ? code.firstElementChild.offsetHeight + edges : 0;
  const room = innerHeight - rest - stage.offsetTop - below - folded;
  const height = Math.round(Math.max(260, Math.min(width * (width < 520 ? 0.95 : 0.75), room)));
  if (`${width} ${height}` !== laidOut) {
    laidOut = `${width} ${height}`;
    layOut(width, height);
  }
  // Side by side, lists that are longer than the stage scroll.
  const least = document.querySelector('main').style;
  least.setProperty('--stage-height', `${Math.max(stage.offsetHeight, 560)}px`);
  $('aside').style.maxHeight = beside($('aside')) ? 'var(--stage-height)' : '';
  showLatest();
}
function layOut(width, height) {
  set($('figure'), {viewBox: `0 0 ${width} ${height}`, height});
  view.layout(width, height);
  set($('ribbon'), {viewBox: `0 0 ${$('ribbon').clientWidth} 24`});
  // The middle of a slider's thumb (16 pixels wide, by the style) goes from 8 to its width less 8.
  const {from, to} = view.axis();
  $('time').style.marginLeft = `${from - 8}px`;
  $('time').style.width = `${to - from + 16}px`;
  drawRibbon();
  draw();
}

/** Another run of the program in place of the one that is shown. */
function showRun(run) {
  takeUp(run);
  shown = -1;
  lit = [];
  drawLegend();
  showStandings();
  listEvents();
  layOutDrawings();
  layOut(...laidOut.split(' ').map(Number));
}

$('time').addEventListener('input', () => { play(false); now = Number($('time').value); draw(); });
$('play').addEventListener('click', () => play(!playing));
$('before').addEventListener('click', () => goToEvent(-1));
$('after').addEventListener('click', () => goToEvent(1));
$('ribbon').addEventListener('click', (click) => {
  const {left} = $('ribbon').getBoundingClientRect();
  const {from, to} = view.axis();
  setTime(data.begin + (click.clientX - left - from) / (to - from) * duration);
});
if (view.timeAt) {
  const drag = (event) => {
    if (event.type === 'pointermove' && event.buttons !== 1) return;
    play(false);
    setTime(view.timeAt(event.clientX - $('figure').getBoundingClientRect().left));
  };
  $('figure').addEventListener('pointerdown', drag);
  $('figure').addEventListener('pointermove', drag);
}
document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey || event.target.matches('select, input[type=number]')) return;
  const nudge = event.shiftKey ? duration / 200 : 0;
  const actions = {
    ArrowRight: () => (nudge ? setTime(now + nudge) : goToEvent(1)),
    ArrowLeft: () => (nudge ? setTime(now - nudge) : goToEvent(-1)),
    Home: () => setTime(data.begin), End: () => setTime(data.end),
  };
  // Remote controls of presenters send these, which else would scroll.
  const whole = document.documentElement.scrollHeight <= innerHeight && !event.target.closest('pre');
  if (whole) Object.assign(actions, {PageDown: actions.ArrowRight, PageUp: actions.ArrowLeft});
  const switches = {l: () => $('larger').click(), f: fullScreen, g: () => $('game').click(), c: toggleProgram};
  if (!event.target.matches('button, summary, input[type=checkbox]')) switches[' '] = () => play(!playing);
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const action = actions[key] ?? switches[key];
  if (!action) return;
  event.preventDefault();
  if (actions[key]) play(false);
  action();
});

function larger(on) {
  document.documentElement.classList.toggle('larger', on);
  $('larger').setAttribute('aria-pressed', on);
  laidOut = '';
  resize();
}
function fullScreen() {
  const done = document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen();
  done.catch(() => { $('full').disabled = true; });  // a browser may refuse, within a frame for example
}
// What lies on top of a triangulation can be taken away.
$('layers').hidden = !data.states.some((state) => state.triangles);
$('cells').addEventListener('change', () => $('figure').classList.toggle('without-cells', !$('cells').checked));
$('hull').addEventListener('change', () => $('figure').classList.toggle('without-hull', !$('hull').checked));
// The next page of a lecture has larger text too. A browser may refuse to remember.
const remembered = {
  get: (name) => { try { return localStorage.getItem(name); } catch { return null; } },
  put: (name, text) => { try { localStorage.setItem(name, text); } catch { /* then it does not */ } },
};
$('larger').addEventListener('click', () => {
  const on = $('larger').getAttribute('aria-pressed') !== 'true';
  remembered.put('larger', on);
  larger(on);
});
$('full').addEventListener('click', fullScreen);
document.addEventListener('fullscreenchange', () => {
  $('full').setAttribute('aria-pressed', document.fullscreenElement !== null);
});
addEventListener('resize', () => requestAnimationFrame(resize));
