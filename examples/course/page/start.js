// What runs when all the other scripts have been read.
/** For whoever drives the page from outside: the same numbers that are drawn. */
window.course = {
  data, setTime, position, now: () => now,
  drawn: () => view.drawn?.(),
  state: (t) => ({...data.states[stateNumber(t)], number: stateNumber(t), certificates: certificatesAt(stateNumber(t))}),
};

drawLegend();
showStandings();
showProgram();
listEvents();
const wanted = /^#t=(.+)$/.exec(location.hash);
if (wanted && Number.isFinite(Number(wanted[1]))) now = Math.min(data.end, Math.max(data.begin, Number(wanted[1])));
$('time').value = now;
// In the next frame, for the picture's height follows its width, and the observer would hear of that amidst its work.
new ResizeObserver(() => requestAnimationFrame(resize)).observe($('frame'));
larger(remembered.get('larger') === 'true');
window.course.ready = data.coefficients ? readyToChange() : Promise.resolve(false);
