// What pages that play frames share. Stands between controls.js and replay.js or motion.js, which have
//   numFramesNow()   how many frames there are to play
//   timeOf(frame)    in seconds
//   updateNow()      puts what is said of the frame in its places

let frame = 0;
let isPlaying = false;
let speed = 1;  // of real time

// Frames hold x, y, z and a quaternion w, x, y, z per body.
function poseAt(numbers, index) {
  const [x, y, z, w, i, j, k] = numbers.subarray(7 * index, 7 * index + 7);
  return [1 - 2 * (j * j + k * k), 2 * (i * j + k * w), 2 * (i * k - j * w), 0,
          2 * (i * j - k * w), 1 - 2 * (i * i + k * k), 2 * (j * k + i * w), 0,
          2 * (i * k + j * w), 2 * (j * k - i * w), 1 - 2 * (i * i + j * j), 0, x, y, z, 1];
}
const meshOf = (mesh) => ({vertices: floats(mesh.vertices), faces: integers(mesh.faces)});
const uploadMesh = ({vertices, faces}) => upload(surface(vertices, faces));

function showFrame(at) {
  frame = Math.min(Math.max(at, 0), numFramesNow() - 1);
  byId('time').value = frame;
  updateNow();
  updateMarks();
  draw();
}
function nearestFrame(seconds) {
  const last = numFramesNow() - 1;
  for (let at = 0; at < last; ++at) {
    if (timeOf(at) >= seconds - 1e-9) return at;
  }
  return last;
}

function play(on) {
  isPlaying = on;
  byId('play').textContent = on ? 'Pause' : 'Play';
  if (!on) return;
  if (frame === numFramesNow() - 1) showFrame(0);
  const [from, began] = [timeOf(frame), performance.now()];
  const step = (now) => {
    if (!isPlaying) return;
    showFrame(nearestFrame(from + Math.max(now - began, 0) / 1000 * speed));
    if (frame === numFramesNow() - 1) play(false); else requestAnimationFrame(step);
  };
  requestAnimationFrame(step);
}

// The section with play and pause, speeds [[value, caption], ...], time and a line for the phase.
function makePlayer(speeds, first) {
  speed = first;
  const button = element('button', {type: 'button', id: 'play', title: 'Play or pause (space)'}, 'Play');
  button.addEventListener('click', () => play(!isPlaying));
  const pace = element('select', {id: 'speed', title: 'Speed'},
      ...speeds.map(([value, text]) => element('option', {value}, text)));
  pace.value = String(speed);
  pace.addEventListener('change', () => {
    speed = Number(pace.value);
    if (isPlaying) play(true);
  });
  const slider = element('input', {type: 'range', id: 'time', min: 0, step: 1});
  slider.setAttribute('aria-label', 'Time');
  slider.addEventListener('input', () => {
    play(false);
    showFrame(Number(slider.value));
  });
  makeSection('replay', 'Replay',
      element('div', {id: 'player'}, button, pace, element('span', {id: 'clock', className: 'range'})),
      slider, element('p', {id: 'phase', className: 'soft'}));
}

// Space, arrows and F; choose(step) goes to the next or last load or move.
function listenToKeys(choose) {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target.matches('select, button, input[type=range]')) return;
    const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
    const other = {ArrowDown: 1, ArrowUp: -1}[event.key];
    if (event.key === ' ') {
      play(!isPlaying);
      event.preventDefault();
    } else if (step) {
      play(false);
      showFrame(frame + step);
    } else if (other) {
      choose(other);
      event.preventDefault();
    } else if (event.key === 'f' || event.key === 'F') {
      view('fit');
    }
  });
}
