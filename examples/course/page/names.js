// Elements in a picture: a dot with a name each, put so that no name hides another.

/** A dot with the element's letter, or its body if it has a size. */
function drawElement(element, parent, scale) {
  const group = make('g', {class: 'element', 'data-element': element.id}, parent);
  const fill = colour.get(element.id);
  make('title', {text: element.name}, group);
  if (element.half) {
    const [w, h] = element.half.map((half) => half * scale);
    make('rect', {class: 'body', x: -w, y: -h, width: 2 * w, height: 2 * h, fill, stroke: fill}, group);
  }
  if (element.radius) make('circle', {class: 'body', r: element.radius * scale, fill, stroke: fill}, group);
  make('path', {class: 'to-name', stroke: fill}, group);
  make('circle', {class: 'spot', r: 3, fill}, group);
  const named = make('g', {class: 'named'}, group);
  make('circle', {class: 'ring', r: 13}, named);
  make('circle', {class: 'dot', r: nameRadius, fill}, named);
  make('text', {y: 4, text: element.label}, named);
  return group;
}

const nameRadius = 9;

/**
 * Moves discs apart that would hide one another, and keeps them within a box (x, y, x, y). Returns
 * where each comes to lie: its place, unless another is in its way.
 */
function apart(places, radius, [x0, y0, x1, y1]) {
  const at = places.map((place) => [...place]);
  const inside = (value, low, high) => Math.min(Math.max(value, low + radius), high - radius);
  const least = 2 * radius + 1;
  for (let round = 0, moved = true; moved && round < 200; ++round) {
    moved = false;
    for (let i = 0; i < at.length; ++i) {
      for (let k = 0; k < i; ++k) {
        let [dx, dy] = [at[i][0] - at[k][0], at[i][1] - at[k][1]];
        const distance = Math.hypot(dx, dy);
        if (distance > least - 0.1) continue;
        [dx, dy] = distance < 1e-6 ? [0, -1] : [dx / distance, dy / distance];
        const way = (least - distance) / 2;
        for (const [disc, sign] of [[at[i], way], [at[k], -way]]) {
          disc[0] = inside(disc[0] + sign * dx, x0, x1);
          disc[1] = inside(disc[1] + sign * dy, y0, y1);
        }
        moved = true;
      }
    }
  }
  return at;
}

/** Puts elements where they are, and their names beside them where those would hide one another. */
function placeElements(groups, places, box, sideways = 0) {
  const names = apart(places, nameRadius, box);
  groups.forEach((group, i) => {
    const [x, y] = places[i];
    set(group, {transform: `translate(${x} ${y})`});
    let [dx, dy] = [names[i][0] - x, names[i][1] - y];
    const beside = Math.hypot(dx, dy) > 0.5;
    // On a line names that give way would only cover the line elsewhere.
    if (beside) dx += sideways;
    group.classList.toggle('beside', beside);
    set(group.querySelector('.named'), {transform: beside ? `translate(${dx} ${dy})` : ''});
    set(group.querySelector('.to-name'), {d: beside ? `M0 0L${dx} ${dy}` : ''});
  });
}
