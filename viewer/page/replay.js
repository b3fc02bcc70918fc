// The page that replays a hold test: one grasp, its loads one after the other. After player.js.

const {protocol, verdict, directions} = data;
const limits = {shift: protocol.largest_shift, turn: protocol.largest_turn};
let shown = data.shown;   // of `directions`
const hasTable = data.table_z !== null;
const layers = {object: true, hand: true, load: true, path: true, table: true, pieces: false};
handOpacity = 0.75;

// ------------------------------------------------------------------------------------------- data

for (const direction of directions) {
  direction.object_poses = floats(direction.object_poses);
  direction.link_poses = floats(direction.link_poses);
}
const current = () => directions[shown];
const numFrames = (direction) => direction.times.length;
const objectPose = (direction, at) => poseAt(direction.object_poses, at);
const linkPosesAt = (direction, at) =>
    links.map((_, i) => poseAt(direction.link_poses, at * links.length + i));
const centerAt = (direction, at) => mapped(objectPose(direction, at), data.center_of_mass);
const numFramesNow = () => numFrames(current());
const timeOf = (at) => current().times[at];
const time = () => timeOf(frame);
const isLoaded = () => protocol.is_lift || time() > protocol.load_start + 1e-9;

const object = meshOf(data.object);
const objectBounds = boundsOf(object.vertices);
const objectSize = length(subtract(objectBounds.high, objectBounds.low));

// The first frame in which a limit is passed, and which; null if none is. The verdict is the engine's,
// at its checks; this is for the eye.
function crossing(direction) {
  for (let at = 0; at < numFrames(direction); ++at) {
    for (const key of ['shift', 'turn']) {
      if (direction[`${key}s`][at] >= limits[key]) return {at, key};
    }
  }
  return null;
}

// ------------------------------------------------------------------------------------------ scene

function sizeOfScene() {
  return objectSize;
}
function linkPoses() {
  return layers.hand ? linkPosesAt(current(), frame) : null;
}
const kArrow = 0.55;  // length of the load's arrow, over the object's size
// Of the hand where the test starts and where the object is grasped, and of the loads' arrows there:
// the view stands still.
function boundsOfScene() {
  const direction = current();
  const bounds = {low: objectBounds.low.slice(), high: objectBounds.high.slice()};
  const grasped = direction.times.findIndex((t) => t >= protocol.approach_time - 1e-9);
  for (const at of [0, Math.max(grasped, 0)]) includeLinks(bounds, linkPosesAt(direction, at));
  for (const one of directions) {
    const tip = add(data.center_of_mass, times(one.direction, kArrow * objectSize));
    for (let k = 0; k < 3; ++k) {
      bounds.low[k] = Math.min(bounds.low[k], tip[k]);
      bounds.high[k] = Math.max(bounds.high[k], tip[k]);
    }
  }
  return bounds;
}
function makeBackdrop() {
  scene.object = uploadMesh(object);
  scene.objectPieces = uploadMesh(meshOf(data.pieces.object));
  scene.linkMeshes = scene.links;
  scene.linkPieces = data.pieces.links.map((link) => uploadMesh(meshOf(link)));
}
function drawBackdrop() {
  scene.links = layers.pieces ? scene.linkPieces : scene.linkMeshes;
  if (!layers.object) return;
  constantColor(hex(kColors.object), objectPose(current(), frame));
  drawMesh(layers.pieces ? scene.objectPieces : scene.object);
}

function marks() {
  const {marks: made, ball, tube, arrow} = markMaker();
  const s = objectSize;
  const direction = current();
  const center = centerAt(direction, frame);
  ball(center, 0.013 * s, kColors.center);
  if (layers.path) {
    for (let at = 1; at <= frame; ++at) {
      const [a, b] = [at - 1, at].map((i) => centerAt(direction, i));
      if (length(subtract(a, b)) > 1e-6) tube(a, b, 0.004 * s, kColors.edge);
    }
  }
  if (layers.load && isLoaded()) {
    arrow(center, direction.direction, kArrow * s, 0.009 * s, kColors.contact);
  }
  return made;
}
function sheets() {
  const {triangle, made} = sheetMaker();
  if (hasTable && layers.table) tableSheet(triangle, objectBounds, data.table_z);
  return made();
}
function labels(project) {
  if (!layers.load || !isLoaded()) return [];
  const tip = add(centerAt(current(), frame), times(current().direction, kArrow * objectSize));
  const {x, y} = project(tip);
  return [{text: `${fixed(protocol.force, 2)} N`, kind: '', x: x + 22, y: y - 10}];
}
function view(name) {
  const toward = {x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1]}[name];
  if (toward) lookAlong(toward);
  if (name === 'side') {
    // Across the load and, of the two sides, where the palm does not hide the object, or from above a
    // table.
    const palm = palmAt(linkPosesAt(current(), 0)[data.hand.palm.link]).direction;
    const across = cross(palm, current().direction);
    const side = length(across) > 0.2 ? unit(across) : anyPerpendicular(palm);
    const above = [side[0], side[1], 0.35 * Math.hypot(side[0], side[1])];
    lookAlong(unit(hasTable ? above : add(side, times(palm, 0.25))));
  }
  fit();
  draw();
}

// ------------------------------------------------------------------------------- time and controls

const kStages = {
  held: ['valid', 'held', 'Not lost under any load'],
  load: ['unusable', 'lost under load', 'Lost while the load pulled'],
  approach: ['unusable', 'lost before the load', 'Lost between pre-grasp and squeeze'],
  rejected: ['unusable', 'rejected', 'Not simulated'],
};
const badge = (stage) => {
  const [className, text, title] = kStages[stage];
  return element('span', {className: `badge ${className}`, title}, text);
};

function makeControls() {
  makePlayer([['1', '1 ×'], ['0.5', '1/2 ×'], ['0.2', '1/5 ×']], 0.5);
  const list = element('div', {id: 'list', tabIndex: 0});
  list.setAttribute('role', 'listbox');
  list.setAttribute('aria-label', 'Loads');
  makeSection('grasps', protocol.is_lift ? 'Load' : 'Loads', list);
  directions.forEach((direction, i) => {
    const row = element('div', {id: `direction-${i}`},
        element('span', {className: 'number'}, direction.name === 'lift' ? '↑' : direction.name),
        element('span', {className: 'm'}, `${fixed(protocol.force, 2)} N`), badge(direction.stage),
        element('span', {className: 'parts'},
            `${millimeters(direction.largest_shift, 1)} mm   ${degrees(direction.largest_turn)}°` +
            (isNumber(direction.failed_at) ? `   after ${fixed(direction.failed_at, 1)} s` : '')));
    row.setAttribute('role', 'option');
    row.addEventListener('click', () => select(i));
    list.append(row);
  });
  for (const [key, name, color] of [
    ['object', 'Object', kColors.object], ['hand', 'Hand', kColors.hand],
    ['load', protocol.is_lift ? 'Weight' : 'Load', kColors.contact],
    ['path', 'Way of the center of mass', kColors.edge],
    ...(hasTable ? [['table', 'Table', kColors.surroundings]] : []),
    ['pieces', `Convex pieces, as the engine sees it (object: ${data.pieces.num_object})`, ''],
  ]) {
    const row = toggleRow(layers, key, color, '', false);
    row.append(element('span', {className: 'name'}, name));
    if (key === 'hand') row.append(opacitySlider());
    byId('toggles').append(row);
  }
  byId('summary').textContent = `${protocol.name} · ` +
      `${directions.filter((direction) => direction.stage === 'held').length} of ` +
      `${directions.length} loads held`;
}

function phase() {
  const t = time();
  if (t <= protocol.approach_time) return 'closing: pre-grasp to grasp';
  if (t <= protocol.load_start) return 'squeezing';
  return protocol.is_lift ? 'lifting and holding' : 'under load';
}

// --------------------------------------------------------------------------------- right: verdict

const kSvg = element('div', {innerHTML: '<svg></svg>'}).firstChild.namespaceURI;
function svg(name, attributes, ...children) {
  const made = document.createElementNS(kSvg, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  made.append(...children);
  return made;
}
const kChart = {width: 300, height: 96, left: 34, bottom: 14};

// Values over time with the limit as a line; what is above one and a half limits is cut off.
function chart(key, name, unitName, scaled) {
  const direction = current();
  const end = direction.times[numFrames(direction) - 1] || 1;
  const {width, height, left, bottom} = kChart;
  const top = 1.5 * limits[key];
  const x = (t) => left + (width - left - 4) * t / end;
  const y = (value) => (height - bottom) * (1 - Math.min(value / top, 1)) + 2;
  const points = direction[`${key}s`].map(
      (value, i) => `${x(direction.times[i]).toFixed(1)},${y(value).toFixed(1)}`).join(' ');
  const start = x(protocol.load_start);
  const picture = svg('svg', {viewBox: `0 0 ${width} ${height + 4}`, class: 'chart', id: `chart-${key}`},
      svg('rect', {x: start, y: 2, width: Math.max(width - 4 - start, 0), height: height - bottom,
                   class: 'loaded'}),
      svg('line', {x1: left, x2: width - 4, y1: y(0), y2: y(0), class: 'axis'}),
      svg('line', {x1: left, x2: width - 4, y1: y(limits[key]), y2: y(limits[key]), class: 'limit'}),
      svg('text', {x: left - 4, y: y(limits[key]) + 4, class: 'tick'}, scaled(limits[key])),
      svg('text', {x: left - 4, y: y(0), class: 'tick'}, '0'),
      svg('text', {x: width - 4, y: height + 2, class: 'tick'}, `${fixed(end, 1)} s`),
      svg('polyline', {points, class: 'curve'}),
      svg('line', {x1: left, x2: left, y1: 2, y2: height - bottom + 2, class: 'now', id: `now-${key}`}));
  return element('figure', {}, element('figcaption', {}, `${name} [${unitName}]`,
      element('span', {id: `value-${key}`, className: 'range'})), picture);
}

const kQuantities = [
  ['shift', 'Shift of the center of mass', 'mm', (value) => millimeters(value, 1)],
  ['turn', 'Turn', '°', degrees],
];

// What happened, in words.
function story() {
  const direction = current();
  const load = protocol.is_lift ? `lifted against ${fixed(protocol.force, 2)} N`
                                : `pulled along ${direction.name} with ${fixed(protocol.force, 2)} N`;
  const most = `${millimeters(direction.largest_shift, 1)} mm and ${degrees(direction.largest_turn)}°`;
  if (direction.stage === 'held') return `Held: ${load}, the object moved by at most ${most} at any check.`;
  const passed = crossing(direction);
  const which = passed ? ` It passed ${passedText(direction, passed)}.` : '';
  if (direction.stage === 'approach') {
    return `The object was lost while the hand closed and squeezed, before any load.${which}`;
  }
  return `Lost: ${load}, the object was out of its limits at the check after ` +
      `${fixed(direction.failed_at, 1)} s (${most}).${which}`;
}

// "15.0° after 0.62 s" of the load, or "50 mm at 0.31 s" of the test, before it.
function passedText(direction, {at, key}) {
  const limit = key === 'turn' ? `${degrees(limits.turn)}°` : `${millimeters(limits.shift, 0)} mm`;
  const since = direction.times[at] - protocol.load_start;
  return since > 1e-9 ? `${limit} after ${fixed(since, 2)} s`
                      : `${limit} at ${fixed(direction.times[at], 2)} s`;
}

function showVerdict() {
  const panel = byId('right');
  const jump = element('button', {type: 'button', id: 'jump'}, 'Show where it passed the limit');
  const passed = crossing(current());
  jump.disabled = !passed;
  jump.addEventListener('click', () => {
    play(false);
    showFrame(passed.at);
  });
  const parameters = protocol.parameters.map(([name, value]) => element('tr', {},
      element('td', {}, name), element('td', {}, Array.isArray(value) ? value.join(', ') : String(value))));
  panel.replaceChildren(
      element('h2', {}, 'The grasp'),
      element('p', {className: 'headline', id: 'verdict'}, badge(verdict.stage),
              element('span', {className: 'soft'}, verdict.reason ||
                  `squeezed with ${fixed(verdict.squeeze_force, 1)} N in all`)),
      element('h2', {}, 'This load'),
      element('p', {id: 'story'}, story()), element('p', {}, jump),
      ...kQuantities.map((quantity) => chart(...quantity)),
      element('p', {className: 'soft'}, 'Of the object in the palm’s frame: under load (shaded) since the ' +
          'squeezed pose, before it since the planned one. Red: the limit.'),
      element('details', {}, element('summary', {}, `Protocol ${protocol.name}`),
          element('p', {className: 'soft'}, protocol.source),
          element('table', {id: 'parameters'}, element('tbody', {}, ...parameters))));
}

function updateNow() {
  const direction = current();
  const end = direction.times[numFrames(direction) - 1] || 1;
  byId('clock').textContent = `${fixed(time(), 2)} s`;
  byId('phase').textContent = phase();
  for (const [key, , unitName, scaled] of kQuantities) {
    byId(`value-${key}`).textContent = `${scaled(direction[`${key}s`][frame])} ${unitName}`;
    const x = kChart.left + (kChart.width - kChart.left - 4) * time() / end;
    for (const end_name of ['x1', 'x2']) byId(`now-${key}`).setAttribute(end_name, x.toFixed(1));
  }
}

function select(direction) {
  play(false);
  shown = direction;
  [...byId('list').children].forEach(
      (row, i) => row.setAttribute('aria-selected', String(i === direction)));
  byId(`direction-${direction}`).scrollIntoView({block: 'nearest'});
  byId('time').max = numFrames(current()) - 1;
  const open = [...document.querySelectorAll('#right details')].map((details) => details.open);
  showVerdict();
  [...document.querySelectorAll('#right details')].forEach((details, i) => details.open = open[i]);
  // Where the load begins: what comes before is the same for all loads.
  showFrame(nearestFrame(protocol.load_start));
}

listenToKeys((step) => select(Math.min(Math.max(shown + step, 0), directions.length - 1)));
camera.up = 2;
makeControls();
byId('hint').append(' · space: play · ← →: frame · ↑ ↓: load');
startStage(view, [
  ['fit', 'Fit', 'Object and hand, same direction (F)'],
  ['side', 'Side', 'Across palm direction and load'],
  ['x', '+x', 'From +x of the object frame'],
  ['y', '+y', 'From +y'],
  ['z', '+z', 'From +z'],
]);
select(shown);
if (gl) view('side');
