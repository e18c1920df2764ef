// Put at the end of a page: uses its controls as somebody would, and reports what is then in the picture, for the
// checker. The collector of errors stands at the beginning of the page (see ../browser/open_pages.cmake).
window.addEventListener('load', () => {
  const report = {errors: window.pageErrors, frames: [], clicks: [], keys: []};
  const figure = document.getElementById('figure');
  const slider = document.getElementById('time');
  const numbers = (text) => text.match(/-?[\d.]+(e[-+]?\d+)?/g).map(Number);

  /** Picture units to those of the model. */
  function model(x, y) {
    const {x0, kx, y0, ky} = figure.dataset;
    return [(x - x0) / kx, (y - y0) / ky];
  }

  function look(wanted) {
    const elements = [...figure.querySelectorAll('[data-element]')];
    const frame = {
      wanted, time: Number(figure.dataset.time), slider: Number(slider.value), text: document.getElementById('state').textContent,
      next: document.getElementById('next').textContent,
      fails: window.course.state(Number(figure.dataset.time)).certificates[0]?.fails ?? null,
      latest: [...document.querySelectorAll('#events li')].findIndex((row) => row.className.includes('latest')),
      marked: elements.filter((group) => group.classList.contains('marked')).map((g) => Number(g.dataset.element)),
    };
    const inSpace = window.course.drawn();
    frame.positions = inSpace?.positions ?? elements.map((group) => [
      Number(group.dataset.element), ...model(...numbers(group.getAttribute('transform')))]);
    const places = [...figure.querySelectorAll('[data-place]')];
    const height = (group) => numbers(group.getAttribute('transform'))[1];
    frame.order = places.sort((a, b) => height(b) - height(a)).map((group) => Number(group.dataset.of));
    frame.edges = inSpace?.edges ?? [...figure.querySelectorAll('[data-edge]')].map((line) => {
      const at = (name) => Number(line.getAttribute(name));
      const ends = [...model(at('x1'), at('y1')), ...model(at('x2'), at('y2'))];
      return [...line.dataset.edge.split('-').map(Number), ...ends];
    });
    frame.cells = [...figure.querySelectorAll('[data-cell]')].map((line) => {
      const at = (name) => Number(line.getAttribute(name));
      return [...line.dataset.cell.split('-').map(Number), ...model(at('x1'), at('y1')), ...model(at('x2'), at('y2'))];
    });
    const happened = figure.querySelector('[data-happened]');
    if (happened) {
      const [cx, cy, r] = ['cx', 'cy', 'r'].map((name) => Number(happened.getAttribute(name)));
      frame.happened = {members: numbers(happened.dataset.happened), circle: [...model(cx, cy), r / figure.dataset.kx]};
    }
    frame.formula = document.getElementById('formula').textContent;
    frame.drawings = [...document.querySelectorAll('#drawings .drawing')].map(lookAtDrawing);
    const outline = figure.querySelector('[data-outline]');
    frame.outline = outline ? numbers(outline.dataset.outline) : [];
    const corners = outline ? numbers(outline.getAttribute('points')) : [];
    frame.corners = frame.outline.map((_, i) => model(corners[2 * i], corners[2 * i + 1]));
    return frame;
  }

  /** A structure beside the picture, in its own pixels. */
  function lookAtDrawing(svg) {
    const all = (what) => [...svg.querySelectorAll(what)];
    const {title, ...scale} = svg.dataset;
    const circle = svg.querySelector('[data-circle]');
    return {
      title, scale: Object.fromEntries(Object.entries(scale).map(([name, text]) => [name, Number(text)])),
      places: all('[data-node]').map((group) => ({
        of: Number(group.dataset.of ?? -1), side: Number(group.dataset.side ?? 0), label: group.textContent,
        at: numbers(group.getAttribute('transform'))})),
      links: all('[data-link]').map((line) => ({
        of: line.dataset.link.split('-').map(Number), next: line.classList.contains('next'),
        ends: ['x1', 'y1', 'x2', 'y2'].map((name) => Number(line.getAttribute(name)))})),
      leaders: all('[data-leader]').map((line) => numbers(line.getAttribute('d'))),
      values: all('[data-value]').map((text) => Number(text.textContent)),
      ...(circle && {circle: {of: numbers(circle.dataset.circle),
                              at: ['cx', 'cy', 'r'].map((name) => Number(circle.getAttribute(name)))}}),
    };
  }

  /** A slider rounds to some fifteen digits. */
  function drag(t) {
    slider.value = t;
    slider.dispatchEvent(new Event('input', {bubbles: true}));
    report.frames.push(look(t));
  }

  // Shortly before and after every event, at some of them, and at times that have nothing to do with them: forwards, and
  // some of it backwards.
  const events = window.course.data.events.map((event) => event.time);
  const {begin, end} = window.course.data;
  const moment = (end - begin) * 1e-6;
  const times = [begin, end];
  for (let i = 1; i < 16; ++i) times.push(begin + (end - begin) * ((i * 0.6180339887) % 1));
  events.forEach((t) => times.push(Math.max(begin, t - moment), Math.min(end, t + moment)));
  for (let i = 0; i < events.length; i += Math.ceil(events.length / 8)) times.push(events[i]);
  times.sort((a, b) => a - b).forEach(drag);
  times.reverse().filter((_, i) => i % 5 === 0).forEach(drag);

  const buttons = [...document.querySelectorAll('#events button')];
  for (let i = 0; i < buttons.length; i += Math.ceil(buttons.length / 6)) {
    buttons[i].click();
    report.clicks.push({event: i, ...look(null)});
  }
  const press = (name) => {
    const before = window.course.now(), shiftKey = name.startsWith('Shift+');
    const key = name.replace('Shift+', '');
    document.body.dispatchEvent(new KeyboardEvent('keydown', {key, shiftKey, bubbles: true, cancelable: true}));
    report.keys.push([name, before, window.course.now()]);
  };
  ['Home', 'ArrowRight', 'ArrowRight', 'Shift+ArrowRight', 'ArrowLeft', 'End', 'Shift+ArrowLeft', 'Home'].forEach(press);

  if (!document.getElementById('layers').hidden) {
    report.layers = ['cells', 'hull'].map((name) => {
      const shown = () => {
        const layer = figure.querySelector(name === 'cells' ? '[data-cell]' : '[data-outline]');
        return layer.getClientRects().length > 0;
      };
      const box = document.getElementById(name), seen = [shown()];
      for (let k = 0; k < 2; ++k) {
        box.click();
        seen.push(shown());
      }
      return seen;
    });
  }
  if (window.course.data.view === 'line') {
    const [thumb, picture] = [slider.getBoundingClientRect(), figure.getBoundingClientRect()];
    const x = (t) => picture.left + Number(figure.dataset.x0) + t * Number(figure.dataset.kx);
    report.axes = [[thumb.left + 8, x(begin)], [thumb.right - 8, x(end)]];
  }
  press('c');
  report.codeOpens = document.getElementById('code').open;
  press('c');
  report.keys.splice(-2);

  // What the page leads to, and the program beside it.
  report.links = [...document.querySelectorAll('nav a')].map((link) => link.getAttribute('href'));
  report.code = document.querySelector('#code pre').textContent;

  // Space is turned by dragging, which draws it at once. The canvas has its pixels until the next frame.
  if (window.course.data.view === 'space') {
    const canvas = document.getElementById('space');
    const turned = () => {
      const send = (node, kind, clientX) => node.dispatchEvent(
        new MouseEvent(kind, {bubbles: true, clientX, clientY: 200}));
      send(figure, 'mousedown', 100), send(document, 'mousemove', 160), send(document, 'mouseup', 160);
      const pen = Object.assign(document.createElement('canvas'), {width: 300, height: 200}).getContext('2d');
      pen.drawImage(canvas, 0, 0, 300, 200);
      const names = [...figure.querySelectorAll('[data-element]')].map((group) => group.getAttribute('transform'));
      return {names, bytes: [...pen.getImageData(0, 0, 300, 200).data]};
    };
    const [before, after] = [turned(), turned()];
    const drawn = ({bytes}) => bytes.filter((byte, i) => i % 4 === 3 && byte > 0).length / (bytes.length / 4);
    report.turned = {
      drawn: [drawn(before), drawn(after)], names: before.names.filter((name, i) => name !== after.names[i]).length,
      bytes: before.bytes.filter((byte, i) => byte !== after.bytes[i]).length / before.bytes.length,
    };
  }

  // Play, and pause a moment later.
  drag(begin);
  document.getElementById('play').click();
  let waits = 0;
  const watch = setInterval(() => {
    if (window.course.now() === begin && ++waits < 100) return;  // frames may be slow to come
    clearInterval(watch);
    document.getElementById('play').click();
    report.played = window.course.now();
    setTimeout(() => {
      report.stayed = window.course.now() === report.played;
      finished(report);
    }, 100);
  }, 50);
});
