// The buttons, keys and the slider, and the loop that draws.
const fadeSeconds = 0.25;   // how long a body stays red after a contact, in seconds of the viewer
const playSeconds = 12;     // how long the whole replay takes at the speed it opens with
const slider = $("#track input"), chart = $("#track canvas"), clock = $("#clock"), count = $("#count b");
document.title = data.title + " \u2013 replay";
$("#head h1").textContent = data.title;
$("#head p").textContent = number(data.bodies.length) + (data.bodies.length === 1 ? " body" : " bodies") +
  (data.response === "elastic" ? ", elastic" : ", passing through each other");
// What colours mean, of those that there are.
const legend = [["sensor", "sensors", body => body.sensor], ["fixed", "fixed", body => body.fixed && !body.sensor],
  ["lying", "at rest", body => body.rests.length > 0]];
for (const [name, text, has] of legend) {
  if (!data.bodies.some(has)) continue;
  const entry = document.createElement("span");
  entry.className = name;
  entry.textContent = text;
  $("#legend").append(entry);
}
$("#count span").textContent = "of " + number(contactTimes.length) + (contactTimes.length === 1 ? " contact" : " contacts");

let time = 0, playing = true, dragging = false, shown = -1, marksShown = true, said = 0;
const nice = x => { const e = 10 ** Math.floor(Math.log10(x)); return [1, 2, 5, 10].find(m => m * e >= 0.999 * x) * e; };
let speed = data.duration > 0 ? nice(data.duration / playSeconds) : 1;
for (const factor of [0.1, 0.25, 0.5, 1, 2, 5, 10]) {
  const option = document.createElement("option");
  option.value = speed * factor;
  option.textContent = "\u00d7 " + +(speed * factor).toPrecision(3);
  option.selected = factor === 1;
  $("#speed").append(option);
}
$("#speed").onchange = event => { speed = +event.target.value; shown = -1; };

function setPlaying(on) {
  playing = on;
  if (on && time >= data.duration) time = 0;
  $("#play path").setAttribute("d", on ? "M2 1h3.5v12H2zM8.5 1H12v12H8.5z" : "M2.5 0.8v12.4L13 7z");
}
$("#play").onclick = () => setPlaying(!playing);

/** Goes to the next contact, or to the last one, and stops there. */
function goToContact(step) {
  const t = contactTime(time, step);
  if (t === undefined) return;
  setPlaying(false);
  time = Math.min(data.duration, Math.max(0, t));
}
$("#next").onclick = () => goToContact(1);
$("#before").onclick = () => goToContact(-1);
$("#drop").onclick = () => choose(-1);

function showMarks(on) {
  marksShown = on;
  $("#marks").classList.toggle("off", !on);
  shown = -1;
}
$("#marks").onclick = () => showMarks(!marksShown);
const axes = ["z", "y", "x", "\u2212z", "\u2212y", "\u2212x"];
for (const axis of axes) {
  const option = document.createElement("option");
  option.value = axis;
  option.textContent = axis + " up";
  $("#up").append(option);
}
$("#up").onchange = event => { setUp(event.target.value); event.target.blur(); };
$("#fit").onclick = () => fit();

// A click that does not drag chooses the body under it.
let pressed = null;
canvas.addEventListener("pointerdown", event => { pressed = [event.clientX, event.clientY]; });
canvas.addEventListener("pointerup", event => {
  if (!pressed || Math.hypot(event.clientX - pressed[0], event.clientY - pressed[1]) > 4) return;
  choose(bodyAt(event.clientX, event.clientY, time));
});
slider.oninput = () => { time = slider.value * data.duration; };
slider.onpointerdown = () => { dragging = true; };
window.addEventListener("pointerup", () => { dragging = false; });
window.addEventListener("keydown", event => {
  if (event.target.tagName === "SELECT" || event.ctrlKey || event.metaKey || event.altKey) return;
  const step = { ArrowLeft: -0.01, ArrowRight: 0.01 }[event.key];
  const key = event.key.toLowerCase();
  if (event.key === " ") setPlaying(!playing);
  else if (key === "n") goToContact(1);
  else if (key === "p") goToContact(-1);
  else if (key === "c") showMarks(!marksShown);
  else if (key === "f") fit();
  else if (key === "u") setUp($("#up").value = axes[(axes.indexOf($("#up").value) + 1) % axes.length]);
  else if (key === "escape") choose(-1);
  else if (step) time = Math.min(data.duration, Math.max(0, time + step * data.duration));
  else return;
  event.preventDefault();
});

/** Contacts over time, behind the slider. */
function drawChart() {
  const ratio = window.devicePixelRatio, width = chart.clientWidth, height = chart.clientHeight;
  chart.width = width * ratio; chart.height = height * ratio;
  const c = chart.getContext("2d");
  c.scale(ratio, ratio);
  c.fillStyle = "#1d2530";
  c.fillRect(0, height / 2 - 1, width, 2);
  const bins = new Array(Math.max(1, Math.floor(width / 4))).fill(0);
  for (const t of contactTimes) bins[Math.min(bins.length - 1, Math.floor(t / data.duration * bins.length))]++;
  const most = Math.max(1, ...bins);
  c.fillStyle = "rgba(255, 75, 58, .55)";
  bins.forEach((n, i) => {
    if (n === 0) return;
    const h = 3 + (height - 8) * n / Math.max(most, 4);
    c.fillRect(i * width / bins.length + 0.5, (height - h) / 2, width / bins.length - 1, h);
  });
}

function resize() {
  const width = window.innerWidth, height = window.innerHeight;
  renderer.setSize(width, height, false);
  camera.aspect = width / height;
  camera.fov = 38 * Math.max(1, Math.min(2, 1.1 * height / width));
  const top = $("#head").getBoundingClientRect().bottom, bottom = $("#bar").getBoundingClientRect().top;
  freeHeight = Math.max(0.3, (bottom - top) / height);
  camera.setViewOffset(width, height, 0, (height - top - bottom) / 2, width, height);
  drawChart();
}
window.addEventListener("resize", resize);

function draw() {
  if (time !== shown) {
    shown = time;
    pose(time, fadeSeconds * speed);
    mark(time, fadeSeconds * speed, marksShown);
    // The panel is text, which need not change sixty times a second.
    if (!playing || Math.abs(time - said) > 0.1 * speed || shown < 0) inspect(said = time);
    count.textContent = number(lastUpTo(contactTimes, time) + 1);
    slider.value = data.duration > 0 ? time / data.duration : 0;
    const digits = Math.max(0, 3 - Math.floor(Math.log10(Math.max(data.duration, 1e-9))));
    clock.innerHTML = (data.begin + time).toFixed(Math.min(digits, 9)) + " <span>s</span>";
  }
  controls.update();
  // The sun goes with the viewer, so that no side is dark.
  sun.position.copy(camera.position).sub(centre).applyAxisAngle(camera.up, 0.6).add(centre);
  sun.position.addScaledVector(camera.up, sceneRadius);
  sun.target.position.copy(centre); sun.target.updateMatrixWorld();
  rim.position.copy(centre).multiplyScalar(2).sub(camera.position);
  rim.target.position.copy(centre); rim.target.updateMatrixWorld();
  renderer.render(scene, camera);
}

// #t=0.5 opens the page at that time, paused; #t=0.5&body=NAME&up=y with a body chosen, and with an axis up.
const asked = /[#&]t=([0-9.eE+-]+)/.exec(location.hash);
if (asked) time = Math.min(data.duration, Math.max(0, parseFloat(asked[1]) || 0));
setPlaying(!asked && data.duration > 0);
const askedUp = /[#&]up=([xyz]|-[xyz])(&|$)/.exec(location.hash);
const up = askedUp ? askedUp[1].replace("-", "\u2212") : "z";
resize();
setUp($("#up").value = up);
const askedBody = /[#&]body=([^&]*)/.exec(location.hash);
if (askedBody) choose(data.bodies.findIndex(body => body.name === decodeURIComponent(askedBody[1])));
let last = performance.now();
(function frame(now) {
  const elapsed = Math.min(0.1, Math.max(0, (now - last) / 1000));
  last = now;
  if (playing && !dragging) {
    time = Math.min(data.duration, time + elapsed * speed);
    if (time >= data.duration) setPlaying(false);
  }
  draw();
  requestAnimationFrame(frame);
})(last);
