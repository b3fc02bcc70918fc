// The page that replays how a hand tidies a table: its moves one after the other. After player.js.

const {objects, moves} = data;
const objectPoses = floats(data.object_poses);
const allLinkPoses = floats(data.link_poses);
const layers = {objects: true, hand: true, table: true, path: true};
handOpacity = 1;

const numFramesNow = () => data.num_frames;
const timeOf = (at) => at * data.frame_time;
const objectPose = (at, i) => poseAt(objectPoses, at * objects.length + i);
const linkPosesAt = (at) => links.map((_, i) => poseAt(allLinkPoses, at * links.length + i));
const centerAt = (at, i) => mapped(objectPose(at, i), objects[i].center);
for (const object of objects) {
  object.mesh = meshOf(object.mesh);
  object.bounds = boundsOf(object.mesh.vertices);
}
// The move that a frame belongs to; where two meet, the first.
const moveAt = (at) => Math.max(0, moves.findIndex((move) => at <= move.last));
const phaseAt = (at) => moves[moveAt(at)].phases.find((phase) => at <= phase.last).name;

// ------------------------------------------------------------------------------------------ scene

// All places of all objects, and room for the hand over them.
const sceneBounds = (() => {
  const bounds = {low: [Infinity, Infinity, 0], high: [-Infinity, -Infinity, -Infinity]};
  for (const at of [0, ...moves.map((move) => move.last)]) {
    objects.forEach((object, i) => {
      const X = objectPose(at, i);
      for (let corner = 0; corner < 8; ++corner) {
        const p = mapped(X, [0, 1, 2].map(
            (k) => (corner >> k & 1 ? object.bounds.high : object.bounds.low)[k]));
        for (let k = 0; k < 3; ++k) {
          bounds.low[k] = Math.min(bounds.low[k], p[k]);
          bounds.high[k] = Math.max(bounds.high[k], p[k]);
        }
      }
    });
  }
  bounds.low[2] = 0;
  return bounds;
})();
const kMargin = 0.08;  // of the table around what stands on it [m]

function sizeOfScene() {
  return length(subtract(sceneBounds.high, sceneBounds.low));
}
function linkPoses() {
  return layers.hand ? linkPosesAt(frame) : null;
}
function boundsOfScene() {
  const {low, high} = sceneBounds;
  return {low: [low[0] - kMargin, low[1] - kMargin, 0],
          high: [high[0] + kMargin, high[1] + kMargin, high[2] + 0.15]};
}
function makeBackdrop() {
  scene.objects = objects.map((object) => uploadMesh(object.mesh));
  const [x0, y0, x1, y1] = [0, 1].map((k) => sceneBounds.low[k] - kMargin)
      .concat([0, 1].map((k) => sceneBounds.high[k] + kMargin));
  const kThickness = 0.012;
  const corners = [0, -kThickness].flatMap(
      (z) => [[x0, y0, z], [x1, y0, z], [x1, y1, z], [x0, y1, z]]);
  const sides = [[0, 1, 2, 3], [7, 6, 5, 4], [0, 4, 5, 1], [1, 5, 6, 2], [2, 6, 7, 3], [3, 7, 4, 0]];
  scene.table = uploadMesh({
    vertices: new Float32Array(corners.flat()),
    faces: new Uint32Array(sides.flatMap(([a, b, c, d]) => [a, b, c, a, c, d])),
  });
}
function drawBackdrop() {
  if (layers.table) {
    constantColor(hex(kColors.surroundings), kIdentity);
    drawMesh(scene.table);
  }
  if (!layers.objects) return;
  const moved = moves[moveAt(frame)].object;
  objects.forEach((_, i) => {
    constantColor(hex(i === moved ? '#dcb878' : kColors.object), objectPose(frame, i));
    drawMesh(scene.objects[i]);
  });
}
function marks() {
  const {marks: made, tube} = markMaker();
  if (!layers.path) return made;
  const move = moves[moveAt(frame)];
  for (let at = move.first + 1; at <= frame; ++at) {
    const [a, b] = [at - 1, at].map((k) => centerAt(k, move.object));
    if (length(subtract(a, b)) > 1e-6) tube(a, b, 0.0012, kColors.edge);
  }
  return made;
}
function sheets() {
  return sheetMaker().made();
}
function labels() {
  return [];
}
function view(name) {
  const toward = {front: [0.25, -1, 0.55], left: [-1, -0.5, 0.4], right: [1, -0.5, 0.4],
                  above: [0, -0.02, 1]}[name];
  if (toward) lookAlong(unit(toward));
  fit();
  draw();
}

// -------------------------------------------------------------------------------------- controls

const nameOf = (move) => objects[move.object].name.replaceAll('_', ' ');

function makeControls() {
  makePlayer([['4', '4 ×'], ['2', '2 ×'], ['1', '1 ×'], ['0.25', '1/4 ×']], 1);
  byId('time').max = data.num_frames - 1;
  const list = element('div', {id: 'list', tabIndex: 0});
  list.setAttribute('role', 'listbox');
  list.setAttribute('aria-label', 'Moves');
  makeSection('grasps', 'Moves', list);
  moves.forEach((move, i) => {
    const row = element('div', {id: `move-${i}`},
        element('span', {className: 'number'}, String(i + 1)),
        element('span', {className: 'm'}, nameOf(move)),
        element('span', {className: 'parts'},
            `grasp: M ${fixed(move.m, 3)}   ${move.num_contacts} contacts`));
    row.setAttribute('role', 'option');
    row.addEventListener('click', () => select(i));
    list.append(row);
  });
  for (const [key, name, color] of [
    ['objects', 'Objects; the one that is moved is darker', kColors.object],
    ['hand', 'Hand', kColors.hand],
    ['table', 'Table', kColors.surroundings],
    ['path', 'Way of the center of mass', kColors.edge],
  ]) {
    const row = toggleRow(layers, key, color, '', false);
    row.append(element('span', {className: 'name'}, name));
    if (key === 'hand') row.append(opacitySlider());
    byId('toggles').append(row);
  }
  byId('summary').textContent =
      `${moves.length} moves · ${objects.length - data.unmoved.length} of ${objects.length} objects at their goals`;
}

// What the page may claim: only what was found when it was made.
const kFindings = {
  free: 'Every straight segment between two keyframes was proven free of collisions, not sampled: ' +
      'of hand, carried object, standing objects and table nothing touches anything else, and on ' +
      'the way to the object, through the air and back everything keeps ' +
      `${millimeters(data.proven_clearance, 1)} mm.`,
  not_free: 'Not all of it is free of collisions: at least one segment between two keyframes ' +
      'touches something, keeps less than ' + `${millimeters(data.proven_clearance, 1)} mm` +
      ' where it should, or could not be proven to. "graspfit motion" names each.',
  not_checked: 'Whether it is free of collisions was not checked when this page was made.',
};

function showStory() {
  const stays = data.unmoved.map(
      (one) => element('li', {}, `${nameOf(one)}: ${one.reason}`));
  byId('right').replaceChildren(
      element('h2', {}, 'The motion'),
      element('p', {id: 'story'}, 'Each object is taken by a planned grasp, lifted, turned in the air, ' +
          'put down and left. ' + kFindings[data.check]),
      element('p', {className: 'soft'}, 'Geometry alone: no arm, no forces, no times. What is shown ' +
          'takes as long as it looks well.'),
      ...(stays.length ? [element('h2', {}, 'Not moved'), element('ul', {}, ...stays)] : []));
}

function updateNow() {
  const move = moveAt(frame);
  byId('clock').textContent = `${fixed(timeOf(frame), 1)} s`;
  byId('phase').textContent = `${move + 1}. ${nameOf(moves[move])}: ${phaseAt(frame)}`;
  [...byId('list').children].forEach(
      (row, i) => row.setAttribute('aria-selected', String(i === move)));
}

function select(move) {
  play(false);
  const {first} = moves[Math.min(Math.max(move, 0), moves.length - 1)];
  showFrame(first === 0 ? 0 : first + 1);
}

listenToKeys((step) => select(moveAt(frame) + step));
camera.up = 2;
makeControls();
byId('hint').append(' · space: play · ← →: frame · ↑ ↓: move');
startStage(view, [
  ['fit', 'Fit', 'Table, same direction (F)'],
  ['front', 'Front', 'From the front'],
  ['left', 'Left', 'From the left'],
  ['right', 'Right', 'From the right'],
  ['above', 'Above', 'From above'],
]);
showStory();
showFrame(0);
if (gl) view('front');
