// What is around the bodies: the space, light and camera.
const canvas = document.getElementById("view");
/** Whether there are many bodies, and the processor draws: then each has fewer triangles and simpler light. */
const coarse = data.bodies.length > 1000 && (() => {
  const gl = document.createElement("canvas").getContext("webgl");
  const names = gl && gl.getExtension("WEBGL_debug_renderer_info");
  const name = names ? gl.getParameter(names.UNMASKED_RENDERER_WEBGL) : "";
  if (gl && gl.getExtension("WEBGL_lose_context")) gl.getExtension("WEBGL_lose_context").loseContext();
  return /swiftshader|llvmpipe|softpipe|software|basic render/i.test(name);
})();
let renderer;
try {
  renderer = new THREE.WebGLRenderer({ canvas, antialias: !coarse });
} catch (error) {
  document.getElementById("sorry").style.display = "grid";
  throw error;
}
renderer.setPixelRatio(coarse ? 1 : Math.min(window.devicePixelRatio, 2));
renderer.gammaOutput = true;
renderer.setClearColor(0x0b0e13);
const scene = new THREE.Scene();

/** The box around a shape in the frame of its body: of one that bends, around all its frames. */
function boxOf(body) {
  const box = new THREE.Box3(), size = new THREE.Vector3(...body.size), v = new THREE.Vector3();
  if (body.frames) {
    for (const frame of body.frames) {
      for (let i = 1; i < frame.length; i += 3) box.expandByPoint(v.fromArray(frame, i));
    }
    return box;
  }
  if (typeof body.shape === "number") {
    box.copy(data.meshes[body.shape].box);
    box.min.multiply(size);
    box.max.multiply(size);
    return box;
  }
  if (body.shape === "capsule") size.z += size.x;
  return box.set(size.clone().negate(), size);
}
for (const mesh of data.meshes) {
  mesh.box = new THREE.Box3();
  mesh.radius = 0;
  const v = new THREE.Vector3();
  for (let i = 0; i < mesh.vertices.length; i += 3) {
    mesh.box.expandByPoint(v.fromArray(mesh.vertices, i));
    mesh.radius = Math.max(mesh.radius, v.length());
  }
}

/** Whether the body is where it is at all times. */
function stands(body) {
  return body.fixed && !body.frames && !body.spins && body.motion.length === 1 &&
         body.motion[0].slice(4).every(x => x === 0);
}

/** What is to be seen: all that moves, and of what stands what is no farther from that than it is wide. */
function boundsOfAll() {
  if (data.domain) return new THREE.Box3(new THREE.Vector3(...data.domain.min), new THREE.Vector3(...data.domain.max));
  const moving = new THREE.Box3(), standing = new THREE.Box3();
  const at = new THREE.Vector3(), turn = new THREE.Quaternion(), unscaled = new THREE.Vector3(1, 1, 1);
  const place = new THREE.Matrix4();
  const moments = 8;
  for (const body of data.bodies) {
    const box = boxOf(body), bounds = stands(body) ? standing : moving;
    for (let i = 0; i <= moments; ++i) {
      const t = data.duration * i / moments;
      if (!position(body, t, at)) continue;
      bounds.union(box.clone().applyMatrix4(place.compose(at, orientation(body, t, turn), unscaled)));
      if (bounds === standing) break;
    }
  }
  if (!moving.isEmpty() && !standing.isEmpty()) {
    const size = moving.getSize(at);
    standing.intersect(moving.clone().expandByScalar(Math.max(size.x, size.y, size.z)));
  }
  if (!standing.isEmpty()) moving.union(standing);
  return moving.isEmpty() ? new THREE.Box3(new THREE.Vector3(-1, -1, -1), new THREE.Vector3(1, 1, 1)) : moving;
}
const bounds = boundsOfAll();
const centre = bounds.getCenter(new THREE.Vector3());
const extent = bounds.getSize(new THREE.Vector3());
const sceneRadius = extent.length() / 2;

scene.fog = new THREE.Fog(0x0b0e13, 2 * sceneRadius, 7 * sceneRadius);
scene.add(new THREE.HemisphereLight(0xdfe9ff, 0x3a3630, 0.85));
const sun = new THREE.DirectionalLight(0xfff4e2, 1.0);
scene.add(sun);
const rim = new THREE.DirectionalLight(0x6aa0ff, 0.35);
scene.add(rim);

const camera = new THREE.PerspectiveCamera(38, 1, sceneRadius / 200, sceneRadius * 40);
let controls;
let freeHeight = 1;   // the part of the window's height that title and bar leave free; the view is in its middle

/** Puts the camera where the whole box is seen, from the direction in which it looks, or from the usual one. */
function fit(fromWhere) {
  const from = (fromWhere || camera.position.clone().sub(controls.target)).clone().normalize();
  const back = from.clone(), right = new THREE.Vector3().crossVectors(camera.up, back).normalize();
  const above = new THREE.Vector3().crossVectors(back, right);
  const half = Math.tan(camera.fov * Math.PI / 360), tall = half * freeHeight * 0.96, wide = half * camera.aspect * 0.84;
  let distance = sceneRadius / 10;
  const corner = new THREE.Vector3();
  for (let k = 0; k < 8; ++k) {
    corner.set(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5).multiply(extent);
    const needed = Math.max(Math.abs(corner.dot(right)) / wide, Math.abs(corner.dot(above)) / tall);
    distance = Math.max(distance, needed + corner.dot(back));
  }
  controls.target.copy(centre);
  camera.position.copy(centre).addScaledVector(from, 1.02 * distance);
}

/** Turns the view so that an axis, "x", "y", "z" or their opposites, points up. */
function setUp(axis) {
  const i = "xyz".indexOf(axis[axis.length - 1]), sign = axis.length > 1 ? -1 : 1;
  camera.up.set(0, 0, 0).setComponent(i, sign);
  // The controls read the axis when they are made.
  if (controls) controls.dispose();
  controls = new THREE.OrbitControls(camera, canvas);
  controls.enableDamping = true;
  controls.dampingFactor = 0.08;
  controls.rotateSpeed = 0.7;
  controls.minDistance = sceneRadius / 50;
  controls.maxDistance = sceneRadius * 12;
  const from = new THREE.Vector3();
  from.setComponent(i, 0.34 * sign).setComponent((i + 1) % 3, -0.52).setComponent((i + 2) % 3, -0.8);
  fit(from);
}

if (data.domain) {
  const edges = new THREE.EdgesGeometry(new THREE.BoxBufferGeometry(extent.x, extent.y, extent.z));
  const strength = data.domain.walls ? 0.75 : 0.3;
  const frame = new THREE.LineSegments(edges, new THREE.LineBasicMaterial(
    { color: 0x4d5d73, transparent: true, opacity: strength, fog: false }));
  frame.position.copy(centre);
  scene.add(frame);
  const floor = new THREE.Mesh(new THREE.PlaneBufferGeometry(extent.x, extent.y),
    new THREE.MeshBasicMaterial({ color: 0x0a0d12, depthWrite: false, transparent: true, opacity: 0.8 }));
  floor.position.set(centre.x, centre.y, bounds.min.z);
  floor.renderOrder = -1;
  scene.add(floor);
}

