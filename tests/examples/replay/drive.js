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
      check(chosen === i || (nearer || body.fixed), `${body.name} clicked at ${time}: chosen is ${chosen}`);
      check(!panel.hidden && panel.textContent.includes(data.bodies[chosen].name), `the panel does not name ${body.name}`);
      choose(i);
      draw();
      const v = new THREE.Vector3();
      position(body, time, v);
      check(panel.textContent.includes(vectorText(v)), `the panel does not say where ${body.name} is`);
    });
    // Nobody is far above the window's middle, where the sky is: a click there chooses nobody.
    check(bodyAt(window.innerWidth / 2, -1e5, time) === -1, 'somebody is in the sky');
  }

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

  // All is seen, whichever axis is up, also in a tall and in a wide window.
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
