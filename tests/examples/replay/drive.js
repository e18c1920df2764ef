// Put at the end of a replay: uses it as somebody would, and reports what is wrong.
window.addEventListener('load', () => {
  const wrong = [...window.pageErrors];
  let checks = 0;
  const check = (right, what) => { ++checks; if (!right) wrong.push(what); };
  const press = key => window.dispatchEvent(new KeyboardEvent('keydown', {key}));
  setPlaying(false);

  /** Where a body's centre is in the window at time t. */
  const inWindow = (body, t) => {
    const at = new THREE.Vector3();
    position(body, t, at);
    camera.updateMatrixWorld();
    at.project(camera);
    return [(at.x + 1) / 2 * window.innerWidth, (1 - at.y) / 2 * window.innerHeight];
  };

  // Whoever is clicked is chosen, and described.
  for (const part of [0, 0.3, 0.71, 1]) {
    time = part * data.duration;
    draw();
    data.bodies.forEach((body, i) => {
      const [x, y] = inWindow(body, time);
      for (const type of ['pointerdown', 'pointerup']) {
        canvas.dispatchEvent(new PointerEvent(type, {clientX: x, clientY: y, bubbles: true}));
      }
      draw();
      const nearer = chosen >= 0 && chosen !== i && distanceTo(data.bodies[chosen], time) <= distanceTo(body, time);
      check(chosen === i || (nearer || seenThrough(body)), `${body.name} clicked at ${time}: chosen is ${chosen}`);
      check(!panel.hidden && panel.textContent.includes(data.bodies[chosen].name), `the panel does not name ${body.name}`);
      choose(i);
      draw();
      const v = new THREE.Vector3();
      position(body, time, v);
      check(panel.textContent.includes(vectorText(v)), `the panel does not say where ${body.name} is`);
      check(panel.getBoundingClientRect().bottom <= $('#bar').getBoundingClientRect().top,
        `the panel of ${body.name} lies behind the bar`);
    });
    // Nobody is far above the window's middle, where the sky is: a click there chooses nobody.
    check(bodyAt(window.innerWidth / 2, -1e5, time) === -1, 'somebody is in the sky');
  }

  const instancesOf = body => drawn.find(group => group.bodies.includes(body));
  const brightness = body => {
    const { bodies, colours } = instancesOf(body), i = bodies.indexOf(body);
    return colours.getX(i) + colours.getY(i) + colours.getZ(i);
  };
  const show = t => { time = t; draw(); };
  const name = i => i === undefined ? 'a wall' : data.bodies[i].name;

  // What rests is darker, from then on until it ceases, and the panel says on what it rests.
  choose(-1);
  for (const [begin, change, a, b] of data.rests) {
    const ceases = data.rests.find(([t, change, c, d]) => change < 0 && t > begin && c === a && d === b);
    const end = ceases ? ceases[0] : data.duration, mover = data.bodies[a].fixed ? b : a, body = data.bodies[mover];
    if (change < 0 || end - begin < 4 * fadeSeconds * speed) continue;
    choose(-1);
    show((begin + end) / 2);
    check(rests(body, time), `${body.name} does not rest on ${name(b)}`);
    check(brightness(body) < 0.7 * (body.colour.r + body.colour.g + body.colour.b), `${body.name} rests and is not darker`);
    choose(mover);
    draw();
    const on = mover === a ? b : a;
    check(panel.textContent.includes('rests on' + name(on)), `the panel does not say that ${body.name} rests on ${name(on)}`);
    check($('#legend .lying'), 'no legend of what is at rest');
  }

  // Bodies that are let pass are marked in amber, and told of.
  data.touches.forEach(([t, kind, a, b]) => {
    if (kind !== letThrough) return;
    choose(a);
    show(t);
    const colours = Array.from({length: markLines.drawRange.count}, (_, k) => markColours.array.slice(3 * k, 3 * k + 3));
    check(colours.some(c => c.every((x, k) => Math.abs(x - amber[k]) < 1e-3)), `the pass at ${t} is not marked`);
    check(panel.textContent.includes('passes through ' + name(b)), `the panel does not say that it passes at ${t}`);
  });

  // One looks through sensors, which are red while they report something, and say of what.
  data.bodies.forEach((body, i) => {
    const { material } = instancesOf(body).instances;
    check(!body.sensor || (material.transparent && material.opacity < 0.5), `${body.name} is opaque`);
    check(seenThrough(body) || !material.transparent, `${body.name} is not opaque`);
    if (!body.sensor) return;
    check($('#legend .sensor'), 'no legend of sensors');
    choose(i);
    draw();
    check(panel.textContent.includes('sensor'), `the panel does not say that ${body.name} is a sensor`);
    const begun = data.touches.filter(([, kind, a, b]) => kind === contact && (a === i || b === i));
    for (const [t, , a, b] of begun) {
      const other = a === i ? b : a;
      const ended = data.touches.find(([u, kind, c, d]) => kind === separation && u > t && c === a && d === b);
      show((t + (ended ? ended[0] : data.duration)) / 2);
      check(redness(body, time, 0) === 1, `${body.name} is not red at ${time}`);
      check(partners(i, time).includes(other), `${body.name} does not report ${name(other)}`);
      check(partners(other, time).includes(i), `${name(other)} is not told of ${body.name}`);
      check(panel.textContent.includes('touches'), `the panel of ${body.name} does not say what it touches`);
      check(!ended || !partners(i, ended[0]).includes(other), `${body.name} reports ${name(other)} still`);
    }
  });

  // From contact to contact, and back.
  data.bodies.forEach((body, i) => {
    const times = data.touches.filter(([, kind, a, b]) => kind !== 1 && (a === i || b === i)).map(touch => touch[0])
      .concat(data.walls.filter(wall => wall[1] === i).map(wall => wall[0])).sort((x, y) => x - y);
    const distinct = [...new Set(times)].filter(t => t > 0);
    choose(i);
    time = 0;
    const seen = [];
    for (let k = 0; k < distinct.length + 2; ++k) {
      const before = time;
      press('n');
      if (time > before) seen.push(time);
      draw();
      if (time > before) check(markLines.drawRange.count > 0, `no mark at the contact at ${time}`);
    }
    check(JSON.stringify(seen) === JSON.stringify(distinct), `${body.name}: contacts at ${seen}, not ${distinct}`);
    for (let k = 0; k < distinct.length; ++k) press('p');
    check(distinct.length < 2 || time === distinct[0], `${body.name}: not back at the first contact`);
  });
  press('c');
  draw();
  check(markLines.drawRange.count === 0, 'marks are shown though they are switched off');
  press('c');
  press('Escape');
  check(chosen === -1 && panel.hidden, 'somebody is chosen still');

  // All is seen, between the title and the bar.
  choose(-1);
  resize();
  setUp('z');
  draw();
  for (let k = 0; k < 8 && data.domain; ++k) {
    camera.updateMatrixWorld();
    const corner = new THREE.Vector3(k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y,
      k & 4 ? bounds.max.z : bounds.min.z).project(camera), y = (1 - corner.y) / 2 * window.innerHeight;
    check(y > $('#head').getBoundingClientRect().bottom && y < $('#bar').getBoundingClientRect().top,
      `a corner of the space is at ${y}, behind the title or the bar`);
  }

  // So it is whichever axis is up, also in a tall and in a wide window.
  const size = [camera.aspect, camera.fov];
  for (const aspect of [0.5, 1, 2.5]) {
    camera.aspect = aspect;
    camera.clearViewOffset();
    camera.updateProjectionMatrix();
    for (const axis of axes) {
      setUp(axis);
      camera.lookAt(controls.target);
      camera.updateMatrixWorld();
      for (let k = 0; k < 8; ++k) {
        const corner = new THREE.Vector3(k & 1 ? bounds.max.x : bounds.min.x, k & 2 ? bounds.max.y : bounds.min.y,
          k & 4 ? bounds.max.z : bounds.min.z).project(camera);
        check(Math.abs(corner.x) < 1 && Math.abs(corner.y) < 1, `${axis} up: a corner of the space is not seen`);
      }
    }
  }
  [camera.aspect, camera.fov] = size;
  resize();
  draw();

  finished(wrong.length > 0 ? wrong : `all ${checks} checks are right`);
});
