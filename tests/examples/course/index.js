// Put at the end of the index of the course: reports what is wrong.
window.addEventListener('load', async () => {
  const wrong = [...window.pageErrors];
  let checks = 0;
  const check = (right, what) => { ++checks; if (!right) wrong.push(what); };
  const all = (what) => [...document.querySelectorAll(what)];

  const pictures = all('.picture img');
  await Promise.all(pictures.map((picture) => picture.decode().catch(() => {})));
  check(pictures.length >= 13, `${pictures.length} pages`);
  for (const picture of pictures) {
    const page = picture.closest('a').getAttribute('href');
    check(picture.naturalWidth > 0, `${page} has no picture`);
    check(picture.closest('li').textContent.includes('You learn: '), `${page} does not say what one learns`);
  }
  const exercises = all('section li');
  check(exercises.length === 4, `${exercises.length} exercises`);
  exercises.forEach((exercise, i) => {
    check(exercise.querySelector('h2').textContent.startsWith(`Exercise ${i + 1}: `), `exercise ${i + 1} has no title`);
    const [given, solution] = [...exercise.querySelectorAll('details')].map((fold) => {
      check(!fold.open, 'a fold is open');
      fold.open = true;
      return fold.querySelector('pre').textContent;
    });
    check(given.includes('#pragma once') && solution.includes('#pragma once'), `exercise ${i + 1} has no code`);
    check(given !== solution, `exercise ${i + 1} is solved`);
  });
  const size = () => parseFloat(getComputedStyle(document.querySelector('header p')).fontSize), plain = size();
  for (const larger of [false, true, false]) {
    check(larger ? size() > 1.2 * plain : size() === plain, `text is of ${size()} pixels`);
    check(document.documentElement.scrollWidth <= window.innerWidth, 'the index is wider than its window');
    document.dispatchEvent(new KeyboardEvent('keydown', {key: 'l', bubbles: true}));
  }
  document.getElementById('larger').click();
  const linked = all('.more a').map((link) => link.getAttribute('href'));
  check(linked.filter((link) => /^docs\/.*\.html$/.test(link)).length === pictures.length, `it leads to ${linked}`);
  finished(wrong.length > 0 ? wrong : `all ${checks} checks are right`);
});
