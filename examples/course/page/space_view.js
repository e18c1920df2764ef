// Space: points, the edges between them, and the certificate that fails next, drawn by three.js on a canvas behind the
// picture, which has the names. Dragging turns the view.
function spaceView(svg) {
  const axis = () => ({from: 8, to: size.width - 8});  // no time axis in the picture: the slider has the whole width
  let size = {width: 0, height: 0};
  const canvas = document.createElement('canvas');
  canvas.id = 'space';
  svg.before(canvas);
  svg.classList.add('space');
  let renderer;
  try {
    renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true});
  } catch (error) {
    const sorry = document.createElement('p');
    sorry.textContent = typeof THREE === 'undefined'
      ? 'There is no picture: three.js was not installed where this page was made (Debian and Ubuntu: libjs-three).'
      : 'There is no picture: it is drawn with WebGL, which this browser does not offer.';
    canvas.replaceWith(sorry);
    return {layout: (width, height) => { size = {width, height}; }, draw: () => {}, axis, timeAt: null};
  }
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  const camera = new THREE.PerspectiveCamera(32, 1, 0.01, 100);
  camera.up.set(0, 0, 1);
  const controls = new THREE.OrbitControls(camera, svg);
  // The wheel and keys go on doing what they do on the other pages.
  Object.assign(controls, {enablePan: false, enableZoom: false, enableKeys: false});
  controls.addEventListener('change', () => { if (scene) render(); });

  const vector = ({x, y, z}) => new THREE.Vector3(x, y, z);
  const css = (colour) => new THREE.Color(
    getComputedStyle(document.documentElement).getPropertyValue(/--[a-z0-9]+/.exec(colour)[0]).trim());
  const ballSize = 0.05;
  let scene, sceneRadius, balls, rods, trails, witness, labels, ring;

  /** All as large as the box around everything that moves; the camera sees most of the ball around that box. */
  function layout(width, height) {
    size = {width, height};
    svg.replaceChildren();
    const box = new THREE.Box3();
    for (const element of data.elements) {
      for (let k = 0; k <= 200; ++k) box.expandByPoint(vector(position(element.id, data.begin + duration * k / 200)));
    }
    const centre = box.getCenter(new THREE.Vector3());
    if (!scene) camera.position.copy(centre).add(new THREE.Vector3(-0.55, -1, 0.45));
    sceneRadius = box.getSize(new THREE.Vector3()).length() / 2 || 1;
    camera.aspect = width / height;
    const narrow = Math.atan(Math.tan(camera.fov * Math.PI / 360) * Math.min(1, camera.aspect));
    controls.target.copy(centre);
    // What moves stays away from the corners of its box, which may leave the picture.
    camera.position.sub(centre).setLength(0.9 * sceneRadius / Math.sin(narrow)).add(centre);
    camera.updateProjectionMatrix();
    renderer.setSize(width, height, false);

    scene = new THREE.Scene();
    scene.fog = new THREE.Fog(css('--card'), camera.position.distanceTo(centre), camera.position.distanceTo(centre) + 2 * sceneRadius);
    scene.add(new THREE.HemisphereLight(0xffffff, 0x888888, 0.75));
    const sun = new THREE.DirectionalLight(0xffffff, 0.5);
    camera.add(sun);
    scene.add(camera);
    const frame = new THREE.Box3Helper(box, css('--rule'));
    scene.add(frame);
    const sphere = new THREE.SphereBufferGeometry(ballSize * sceneRadius, 32, 20);
    balls = new Map(data.elements.map((element) => {
      const ball = new THREE.Mesh(sphere, new THREE.MeshLambertMaterial({color: css(colour.get(element.id))}));
      scene.add(ball);
      return [element.id, ball];
    }));
    rods = [];
    trails = new THREE.Group();
    witness = new THREE.Group();
    scene.add(trails, witness);
    ring = make('circle', {class: 'witness', r: 17}, svg);
    labels = new Map(data.elements.map((element) => [element.id, drawElement(element, svg, 1)]));
    controls.update();
  }

  const rodShape = new THREE.CylinderBufferGeometry(1, 1, 1, 10);
  function drawEdges(edges, t) {
    while (rods.length < edges.length) {
      const rod = new THREE.Mesh(rodShape, new THREE.MeshLambertMaterial({color: css('--faint')}));
      scene.add(rod);
      rods.push(rod);
    }
    rods.forEach((rod, i) => {
      rod.visible = i < edges.length;
      if (!rod.visible) return;
      const [a, b] = edges[i].map((id) => vector(position(id, t)));
      const along = b.clone().sub(a);
      rod.userData = edges[i];
      rod.position.copy(a).add(b).divideScalar(2);
      rod.scale.set(0.006 * sceneRadius, along.length(), 0.006 * sceneRadius);
      rod.quaternion.setFromUnitVectors(new THREE.Vector3(0, 1, 0), along.normalize());
    });
  }

  /** Where each has been of late, and where it will be soon. */
  function drawTrails(t) {
    trails.remove(...trails.children);
    const far = duration * 0.08;
    for (const element of data.elements) {
      for (const [from, to, ahead] of [[t - far, t, false], [t, t + far, true]]) {
        const [a, b] = [Math.max(from, data.begin), Math.min(to, data.end)];
        if (!(a < b) || (ahead && guessing && !answered)) continue;
        const places = [];
        for (let k = 0; k <= 12; ++k) places.push(vector(position(element.id, a + (b - a) * k / 12)));
        const shape = new THREE.BufferGeometry().setFromPoints(places);
        const color = css(colour.get(element.id));
        const line = new THREE.Line(shape, ahead
          ? new THREE.LineDashedMaterial({color, dashSize: 0.02 * sceneRadius, gapSize: 0.02 * sceneRadius})
          : new THREE.LineBasicMaterial({color}));
        if (ahead) line.computeLineDistances();
        trails.add(line);
      }
    }
  }

  /** The centre of the sphere through four points: that is as far from the first as from each of the others. */
  function centreOf([a, ...others]) {
    const rows = others.map((p) => p.clone().sub(a));
    const [u, v, w] = rows, squares = rows.map((row) => row.lengthSq());
    const cross = (p, q) => new THREE.Vector3().crossVectors(p, q);
    return cross(v, w).multiplyScalar(squares[0]).add(cross(w, u).multiplyScalar(squares[1]))
      .add(cross(u, v).multiplyScalar(squares[2])).divideScalar(2 * u.dot(cross(v, w))).add(a);
  }

  /** Of five points the sphere through the first four; of four and three the tetrahedron and the triangle. */
  function drawWitness(points) {
    witness.remove(...witness.children);
    if (points.length < 3) return;
    const look = {color: css('--accent'), transparent: true, opacity: 0.16, depthWrite: false, side: THREE.DoubleSide};
    const material = new THREE.MeshBasicMaterial(look);
    let shape;
    if (points.length === 5) {
      const centre = centreOf(points);
      const radius = centre.distanceTo(points[0]);
      if (!(radius < 20 * sceneRadius)) return;
      shape = new THREE.Mesh(new THREE.SphereBufferGeometry(radius, 48, 32), material);
      shape.position.copy(centre);
    } else {
      const faces = points.length === 4 ? [0, 1, 2, 0, 3, 1, 1, 3, 2, 2, 3, 0] : [0, 1, 2];
      shape = new THREE.Mesh(new THREE.BufferGeometry().setFromPoints(faces.map((i) => points[i])), material);
    }
    witness.add(shape);
  }

  let waits = false;
  let about = null;  // who the certificate that fails next is about in the end
  function draw(t, number, lit) {
    const state = data.states[number];
    const next = guessing && !answered ? null : nextToFail(number);
    for (const [id, ball] of balls) ball.position.copy(vector(position(id, t)));
    for (const [id, label] of labels) {
      label.classList.toggle('marked', (state.marked ?? []).includes(id));
      label.classList.toggle('lit', lit.includes(id));
    }
    drawEdges(state.edges ?? [], t);
    drawTrails(t);
    drawWitness(next ? next.members.map((id) => vector(position(id, t))) : []);
    about = next ? next.members[next.members.length - 1] : null;
    // Once a frame, however often the time has been moved.
    if (!waits) requestAnimationFrame(render);
    waits = true;
  }

  /** The names go where the balls are; that of a ball which another hides is not shown. */
  function render() {
    waits = false;
    renderer.render(scene, camera);
    const scale = size.height / 2 / Math.tan(camera.fov * Math.PI / 360);
    const seen = [...balls].map(([id, ball]) => {
      const at = ball.position.clone().project(camera);
      const far = ball.position.distanceTo(camera.position);
      return {id, x: (at.x + 1) / 2 * size.width, y: (1 - at.y) / 2 * size.height, far, radius: ballSize * sceneRadius / far * scale};
    });
    for (const one of seen) {
      const hidden = seen.some((o) => o.far < one.far && Math.hypot(o.x - one.x, o.y - one.y) < o.radius);
      set(labels.get(one.id), {transform: `translate(${one.x} ${one.y})`, opacity: hidden ? 0 : 1});
      if (one.id === about) set(ring, {cx: one.x, cy: one.y});
    }
    ring.toggleAttribute('hidden', about === null);
  }

  /** What stands in the scene: points, and the ends of the edges, read back from what three.js draws. */
  function drawn() {
    const places = (mesh, ends) => {
      mesh.updateMatrixWorld();
      return ends.map((end) => new THREE.Vector3(0, end, 0).applyMatrix4(mesh.matrixWorld).toArray()).flat();
    };
    return {
      positions: [...balls].map(([id, ball]) => [id, ...places(ball, [0])]),
      edges: rods.filter((rod) => rod.visible).map((rod) => [...rod.userData, ...places(rod, [-0.5, 0.5])]),
    };
  }

  return {layout, draw, drawn, axis, timeAt: null};
}
