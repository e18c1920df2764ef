// What the signs in the picture mean: of those only that occur.
function drawLegend() {
  document.getElementById('legend').replaceChildren();
  const entry = (text, tag, attributes) => {
    const row = document.createElement('li');
    const picture = make('svg', {viewBox: '0 0 22 18', 'aria-hidden': true});
    const sign = make(tag, attributes, picture);
    row.append(picture, text);
    document.getElementById('legend').append(row);
    return sign;
  };
  if (colourful) {
    for (const element of data.elements) {
      const group = entry(element.name, 'g', {class: 'element', transform: 'translate(11 9)'});
      make('circle', {class: 'dot', r: 8.5, fill: colour.get(element.id)}, group);
      make('text', {y: 4, text: element.label}, group);
    }
  }
  const some = (name) => data.states.some((state) => state[name] && state[name].length > 0);
  const onLine = data.view === 'line';
  if (some('marked')) {
    if (onLine) {
      entry(data.names.marked, 'path', {class: 'known', d: 'M0 9H22'});
    } else {
      const group = entry(data.names.marked, 'g', {class: 'element marked', transform: 'translate(11 9)'});
      make('circle', {class: 'ring', r: 7}, group);
    }
  }
  if (some('outline')) entry(data.names.outline, 'rect', {class: 'outline', x: 2, y: 2, width: 18, height: 14});
  if (some('edges')) entry(data.names.edges, 'path', {class: 'edge ' + (data.edges ?? ''), d: 'M0 9H22'});
  if (some('triangles')) {
    entry('between two Voronoi cells', 'path', {class: 'cell', d: 'M0 9H22'});
    entry('four points on it, a moment ago', 'circle', {class: 'past-circle', cx: 11, cy: 9, r: 7.5});
  }
  if (onLine && data.events.length > 0) entry(data.names.event, 'circle', {class: 'mark past', cx: 11, cy: 9, r: 4.5});
  if (data.certificates.length > 0) {
    if (onLine) entry('a certificate', 'path', {class: 'held', d: 'M11 1V17'});
    entry('when a certificate fails, if nothing happens before', 'path', {class: 'fails', d: 'M4 3h14l-7 12z'});
    entry('the one that fails next', 'path', {class: 'fails next', d: 'M4 3h14l-7 12z'});
    if (!onLine) entry('what it is about', 'circle', {class: 'witness', cx: 11, cy: 9, r: 7.5});
  }
  if (!onLine) {
    entry('where it was', 'path', {class: 'trail', d: 'M0 9H22', stroke: 'var(--faint)'});
    entry('where it will be', 'path', {class: 'trail ahead', d: 'M0 9H22', stroke: 'var(--faint)'});
  }
  if (data.intervals) entry('shadows on the axes', 'path', {class: 'interval', d: 'M1 9H21', stroke: 'var(--faint)'});
}
