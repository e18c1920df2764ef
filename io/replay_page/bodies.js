// The bodies as they are drawn.
const still = new THREE.Color(0.05, 0.055, 0.065);   // what lies or slides on something is darker
const red = new THREE.Color(2.6, 0.09, 0.04);   // linear; brighter than light allows, so that it glows
const sensorColour = new THREE.Color(0.3, 0.1, 0.62);
const chosenColour = new THREE.Color(1.5, 1.3, 0.5);
let chosen = -1;   // number of the body that is looked at

// Of radius 1, about z.
function capsuleGeometry(halfLength, detail) {
  const profile = [], quarter = detail >> 2;
  for (const end of [-1, 1]) {
    for (let i = 0; i <= quarter; ++i) {
      const angle = Math.PI / 2 * (end < 0 ? i - quarter : i) / quarter;
      profile.push(new THREE.Vector2(Math.cos(angle), Math.sin(angle) + end * halfLength));
    }
  }
  return new THREE.LatheBufferGeometry(profile, detail).rotateX(Math.PI / 2);
}

function geometryOf({ shape, size }, count) {
  const detail = coarse ? 4 : count > 3000 ? 12 : 28;
  if (shape === "sphere") return new THREE.SphereBufferGeometry(1, detail, detail * 3 >> 2);
  if (shape === "capsule") return capsuleGeometry(size[2] / size[0], detail);
  if (shape === "box") return new THREE.BoxBufferGeometry(2, 2, 2);
  const mesh = data.meshes[shape], geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.Float32BufferAttribute(mesh.vertices, 3));
  geometry.setIndex(mesh.triangles);
  geometry.computeVertexNormals();
  return geometry;
}

// One draw call for all bodies of a shape; capsules of one slenderness are of one shape, meshes that bend each of its own.
const groups = new Map();
data.bodies.forEach((body, i) => {
  const kind = body.shape === "capsule" ? `capsule ${body.size[2] / body.size[0]}` : body.shape;
  const own = body.frames ? `bending ${i}` : kind;
  const shape = body.sensor ? `sensor ${own}` : body.fixed ? `fixed ${own}` : own;
  if (!groups.has(shape)) groups.set(shape, []);
  groups.get(shape).push(body);
  body.number = i;
  // Quiet blues and greens, spread evenly by the golden ratio; red is for contacts alone.
  const u = (i * 0.618034) % 1, v = (i * 0.381966 + 0.37) % 1;
  body.colour = new THREE.Color().setHSL(0.47 + 0.16 * u, 0.24 + 0.2 * v, 0.42 + 0.22 * ((u + v) % 1))
    .convertGammaToLinear(2.2);
  if (body.sensor) body.colour.copy(sensorColour);
  body.scale = new THREE.Vector3(...body.size);
  if (body.shape === "capsule") body.scale.setScalar(body.size[0]);
});
const drawn = [];
for (const bodies of groups.values()) {
  const shape = bodies[0].shape;
  const geometry = geometryOf(bodies[0], bodies.length);
  const colours = new THREE.InstancedBufferAttribute(new Float32Array(3 * bodies.length), 3);
  geometry.setAttribute("color", colours);
  // A coarse mesh shows its triangles; a fine one looks smooth.
  const flat = shape === "box" || (typeof shape === "number" && data.meshes[shape].triangles.length < 3 * 600);
  const look = { vertexColors: THREE.VertexColors, side: THREE.DoubleSide };
  const material = coarse ? new THREE.MeshLambertMaterial(look)
    : new THREE.MeshPhongMaterial({ specular: 0x1c1c1c, shininess: 24, flatShading: flat, ...look });
  // What is fixed holds others, and sensors are around them: one looks through both.
  if (seenThrough(bodies[0])) {
    Object.assign(material, { transparent: true, opacity: bodies[0].sensor ? 0.3 : 0.18, depthWrite: false });
  }
  const instances = new THREE.InstancedMesh(geometry, material, bodies.length);
  instances.frustumCulled = false;
  scene.add(instances);
  drawn.push({ bodies, instances, colours, bent: bodies[0].frames && geometry });
}

/** Whether one looks through a body. */
function seenThrough(body) { return body.fixed || body.sensor; }

const matrix = new THREE.Matrix4(), point = new THREE.Vector3(), nothing = new THREE.Vector3(0, 0, 0);
const turned = new THREE.Quaternion();
const tint = new THREE.Color();
function pose(t, fade) {
  for (const { bodies, instances, colours, bent } of drawn) {
    if (bent) {
      bend(bodies[0], t, bent.attributes.position.array);
      bent.attributes.position.needsUpdate = true;
      bent.computeVertexNormals();
    }
    bodies.forEach((body, i) => {
      const there = position(body, t, point);
      matrix.compose(point, orientation(body, t, turned), there ? body.scale : nothing);
      instances.setMatrixAt(i, matrix);
      tint.copy(body.colour);
      if (!seenThrough(body) && rests(body, t)) tint.lerp(still, 0.6);
      if (body.number === chosen) tint.lerp(chosenColour, 0.6);
      tint.lerp(red, body.fixed && !body.sensor ? 0 : redness(body, t, fade));
      colours.setXYZ(i, tint.r, tint.g, tint.b);
    });
    instances.instanceMatrix.needsUpdate = true;
    colours.needsUpdate = true;
  }
}

