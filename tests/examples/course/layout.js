// Put at the end of a page, in windows of several sizes: nothing hides a name or a number, nothing is cut off, and the
// page fills its window, with larger text too.
window.addEventListener('load', async () => {
  await window.course.ready;
  const wrong = [...window.pageErrors];
  let checks = 0;
  const check = (right, ...what) => { ++checks; if (!right && wrong.length < 40) wrong.push(what.join(' ')); };
  const $ = (id) => document.getElementById(id);
  const all = (what, inside = document) => [...inside.querySelectorAll(what)];
  const wide = innerWidth >= 1900, figure = $('figure');
  const {data, setTime} = window.course;

  const shown = (part) => part.getClientRects().length > 0 && part.getAttribute('opacity') !== '0';
  const box = (part) => part.getBoundingClientRect();
  const apart = (p, q) => p.right <= q.left + 0.5 || q.right <= p.left + 0.5 || p.bottom <= q.top + 0.5 || q.bottom <= p.top + 0.5;
  const within = (p, q) => p.left >= q.left - 1 && p.right <= q.right + 1 && p.top >= q.top - 1 && p.bottom <= q.bottom + 1;
  /** A disc and a box do not meet. */
  const clear = (disc, q) => {
    const [x, y, r] = [(disc.left + disc.right) / 2, (disc.top + disc.bottom) / 2, disc.width / 2];
    return Math.hypot(x - Math.min(Math.max(x, q.left), q.right), y - Math.min(Math.max(y, q.top), q.bottom)) > r - 1;
  };

  function look(when) {
    // Numbers and names of the axes: apart, whole, and under nothing.
    const texts = all(':scope > text', figure).map((text) => [text.textContent, box(text)]);
    texts.forEach(([a, p], i) => {
      texts.slice(i + 1).forEach(([b, q]) => check(apart(p, q), when, 'texts overlap:', a, b));
      check(within(p, box(figure)), when, a, 'is cut off');
    });
    const names = all('[data-element]', figure).filter(shown)
      .map((element) => [element.querySelector('text').textContent, box(element.querySelector('.named .dot'))]);
    const rings = all('[data-velocity]', figure).map((handle) => ['a ring', box(handle.querySelector('[stroke]'))]);
    for (const [name, disc] of [...names, ...rings]) {
      for (const [text, q] of texts) check(clear(disc, q), when, name, 'covers', text);
    }
    if (data.view !== 'space') {
      names.forEach(([a, p], i) => names.slice(i + 1).forEach(([b, q]) => {
        check(Math.hypot(p.left - q.left, p.top - q.top) > p.width - 1, when, 'names overlap:', a, b);
      }));
    }
    for (const svg of all('.drawing')) {
      const inside = all('text', svg).map((text) => [text.textContent, box(text)]);
      inside.forEach(([a, p], i) => {
        inside.slice(i + 1).forEach(([b, q]) => check(apart(p, q), when, svg.dataset.title, 'texts overlap:', a, b));
        check(within(p, box(svg)), when, svg.dataset.title, a, 'is cut off');
      });
    }
    // Parts of the page: apart, as wide as their text, none wider than the window.
    const parts = all('header > *, #stage > :not(.hidden), #controls > *, aside > section, #code, footer').filter(shown);
    parts.forEach((a, i) => parts.slice(i + 1).forEach((b) => {
      const nested = a.contains(b) || b.contains(a);
      check(nested || apart(box(a), box(b)), when, a.id || a.tagName, 'covers', b.id || b.tagName);
    }));
    for (const part of all('h1, h2, p, li, figcaption, button, summary, output, .further').filter(shown)) {
      check(part.scrollWidth <= part.clientWidth + 1 || part.clientWidth === 0, when, part.textContent.slice(0, 30), 'is cut off');
    }
    check(document.documentElement.scrollWidth <= innerWidth, when, 'wider than the window:', document.documentElement.scrollWidth);
  }

  // A page in a frame hears of its width with the first picture only.
  const pause = (ms) => new Promise((done) => setTimeout(done, ms));
  for (let i = 0; i < 100 && $('code').open !== wide; ++i) await pause(50);
  const plain = parseFloat(getComputedStyle($('about')).fontSize);
  for (const larger of [false, true]) {
    if (larger) $('larger').click();
    await pause(100);
    const size = parseFloat(getComputedStyle($('about')).fontSize);
    check(larger ? size > 1.2 * plain : size === plain, 'text is of', size, 'pixels');
    const times = [data.begin, data.end, ...data.events.slice(0, 6).map(({time}) => time)];
    for (let k = 1; k < 8; ++k) times.push(data.begin + (data.end - data.begin) * k / 8);
    for (const t of times) {
      setTime(t);
      look(`${larger ? 'larger, ' : ''}t = ${t}:`);
    }
    const [stage, code] = [box($('stage')), box($('code'))];
    if (wide) {
      check($('code').open && code.left > box($('aside')).right && code.top === stage.top, 'the program is not beside the picture');
      check(larger || document.documentElement.scrollHeight <= innerHeight, 'the page is higher than its window:', document.documentElement.scrollHeight);
      check(larger || stage.bottom > 0.9 * innerHeight, 'the picture ends at', stage.bottom);
      check(code.right > 0.98 * innerWidth, 'the page is as wide as', code.right);
    } else {
      check(!$('code').open && code.top > box($('aside')).bottom - 1, 'the program is not below');
    }
  }
  $('larger').click();
  finished(wrong.length > 0 ? wrong : `all ${checks} checks are right`);
});
