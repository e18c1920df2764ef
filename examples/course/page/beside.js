// What stands beside the picture and does not move: how good the structure is, and the program.

/** Of each structure a paragraph: its four measures. The words are explained on the index, if this page has one. */
function showStandings() {
  const words = ['responsive', 'efficient', 'local', 'compact'];
  $('standings').replaceChildren(...(data.standings ?? []).map((standing) => {
    const line = document.createElement('p'), bold = (text) => {
      const part = document.createElement('b');
      part.textContent = text;
      return part;
    };
    line.append(standing.structure, ' \u2013 ');
    words.forEach((word, i) => line.append(bold(word + ':'), ` ${standing[word]}${i < 3 ? '; ' : '.'} `));
    return line;
  }));
  if (data.standings && document.querySelector('nav')) {
    const link = document.createElement('a');
    Object.assign(link, {href: 'index.html#good', textContent: 'What do these words mean?'});
    $('standings').lastChild.append(link);
  }
}

/** Lines of the program wrap to where they begin. It is open where it stands beside the picture. */
function showProgram() {
  if (!$('code')) return;
  for (const pre of $('code').querySelectorAll('pre')) {
    pre.replaceChildren(...pre.textContent.split(/(?<=\n)/).map((text) => {
      const line = document.createElement('span');
      const depth = /^ */.exec(text)[0].length + 4;
      Object.assign(line.style, {paddingLeft: `${depth}ch`, textIndent: `-${depth}ch`});
      line.classList.toggle('remark', /^ *\/\//.test(text));
      line.textContent = text;
      return line;
    }));
    pre.tabIndex = 0;
  }
  const wide = matchMedia('(min-width: 94em)');
  const follow = () => { $('code').open = wide.matches; };
  follow();
  addEventListener('load', follow);  // a page in a frame may not know its width before
  wide.addEventListener('change', follow);
  $('code').addEventListener('toggle', resize);
}
function toggleProgram() {
  if ($('code')) $('code').open = !$('code').open;
}
