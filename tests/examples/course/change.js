// Put at the end of a page whose program is in it: changes motions as somebody would, and reports what the page then
// shows, for the checker (../browser/open_pages.cmake puts a collector of errors at the beginning of the page).
window.addEventListener('load', async () => {
  const ready = await window.course.ready;
  const report = {ready, says: document.getElementById('change-says').textContent, runs: [], guesses: []};
  const figure = document.getElementById('figure');
  const note = (what) => report.runs.push({
    what, motions: motionsOf(window.course.data), points: drawnOf(window.course.data), data: JSON.parse(JSON.stringify(window.course.data)),
    events: document.querySelectorAll('#events button').length, drawn: figure.querySelectorAll('[data-element]').length,
    formula: document.getElementById('formula').textContent,
  });
  /** Drags a part of the picture by so many pixels, in steps. */
  function drag(part, dx, dy, inside = figure) {
    const box = part.getBoundingClientRect();
    const [x, y] = [box.left + box.width / 2, box.top + box.height / 2];
    const send = (kind, k) => (kind === 'down' ? part : inside).dispatchEvent(new PointerEvent('pointer' + kind, {
      bubbles: true, cancelable: true, pointerId: 1, clientX: x + dx * k / 3, clientY: y + dy * k / 3}));
    send('down', 0);
    for (let k = 1; k <= 3; ++k) send('move', k);
    send('up', 3);
  }

  if (ready) {
    note('as recorded');
    window.course.setTime(window.course.data.begin + (window.course.data.end - window.course.data.begin) / 3);
    drag(figure.querySelector('[data-element="0"]'), 12, -40);
    note('a point is dragged');
    drag(figure.querySelector('[data-velocity="1"]'), 5, 31);
    note('a velocity is dragged');
    const loose = document.querySelector('.loose')?.dataset.title;
    for (const part of loose ? ['[data-node="2"]', '[data-velocity="0"]'] : []) {
      drag(document.querySelector(`[data-title="${loose}"] ${part}`), -14, 9, document.getElementById('drawings'));
      note(`of a drawing ${part} is dragged`);
    }
    document.getElementById('more').click();
    note('one more');
    const input = document.querySelector('#motions input');
    input.value = Number(input.value) + 0.5;
    input.dispatchEvent(new Event('change', {bubbles: true}));
    note('a number is typed');
    for (let i = 0; i < 4; ++i) {
      document.getElementById('shuffle').click();
      note('shuffled');
    }

    // Guesses: the right one, and another.
    document.getElementById('game').click();
    for (const right of [true, false]) {
      const next = window.course.state(window.course.now()).certificates;
      const rows = [...document.querySelectorAll('#certificates li')];
      const facts = next.filter((held) => held.fails !== null && held.fails <= window.course.data.end).map((held) => held.fact);
      if (rows.length < 2 || facts.length === 0) break;
      const row = rows.find((one) => one.firstChild.textContent === facts[0] === right);
      row.click();
      report.guesses.push([right, document.getElementById('guess-says').textContent]);
      const on = document.getElementById('guess-on');
      if (!on.hidden) on.click();
    }
    document.getElementById('game').click();
    document.getElementById('reset').click();
    note('reset');
  }
  report.errors = window.pageErrors;
  finished(report);
});
