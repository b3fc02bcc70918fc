// The page of a hand: joints move by sliders, links follow. After controls.js; frame H, the palm's.

const {hand, poses, plates} = data;
let q = poses[0].q.slice();
let shownPose = 0;       // of `poses`; -1 after a slider was moved
let highlighted = -1;    // joint under the pointer in the table
let X_HL = [];
const layers = {hand: true, joints: true, palm: true, pads: true, clips: true};
handOpacity = 0.75;
const joints = hand.joints;
const clamped = (value, low, high) => Math.min(Math.max(value, low), high);

// ------------------------------------------------------------------------------------- kinematics

// As hands::apply_couplings: a joint that may break away keeps a position that is further closed.
function applyCouplings(positions) {
  joints.forEach((joint, j) => {
    if (!joint.coupling) return;
    const {leader, ratio, offset, breakaway} = joint.coupling;
    const follows = clamped(ratio * positions[leader] + offset, joint.lower, joint.upper);
    const hasGoneOn = breakaway && joint.closing * (positions[j] - follows) > 0;
    positions[j] = hasGoneOn ? clamped(positions[j], joint.lower, joint.upper) : follows;
  });
}

function motionOf(joint, position) {
  const X = kIdentity.slice();
  if (!joint.is_angle) {
    for (let k = 0; k < 3; ++k) X[12 + k] = position * joint.axis[k];
    return X;
  }
  const [c, s] = [Math.cos(position), Math.sin(position)];
  const a = joint.axis;
  for (let column = 0; column < 3; ++column) {
    const e = [0, 0, 0];
    e[column] = 1;
    const turned = add(add(times(e, c), times(cross(a, e), s)), times(a, a[column] * (1 - c)));
    for (let k = 0; k < 3; ++k) X[4 * column + k] = turned[k];
  }
  return X;
}

function linkPosesAt(positions) {
  const X = [];
  hand.links.forEach((link, i) => {
    if (link.parent < 0) {
      X.push(kIdentity);
    } else if (link.joint < 0) {
      X.push(multiply(X[link.parent], link.X_PL));
    } else {
      const joint = joints[link.joint];
      X.push(multiply(multiply(X[link.parent], joint.X_PJ), motionOf(joint, positions[link.joint])));
    }
  });
  return X;
}

// Where a pad's frame is.
const padPose = (pad) => multiply(X_HL[hand.pads[pad].link], hand.pads[pad].X_LC);
const originOf = (X) => [X[12], X[13], X[14]];

// The joint frame: the child's origin, and the axis as the parent sees it.
function axisOf(joint) {
  const X = X_HL[joint.child];
  return {center: originOf(X), direction: unit(rotated(X, joint.axis))};
}

// ------------------------------------------------------------------------------------------ scene

// Of the first pose, so that marks keep their size while the hand moves.
const firstBounds = {low: [Infinity, Infinity, Infinity], high: [-Infinity, -Infinity, -Infinity]};
includeLinks(firstBounds, poses[0].X_HL);
if (!firstBounds.low.every(Number.isFinite)) {
  firstBounds.low = [-0.1, -0.1, -0.1], firstBounds.high = [0.1, 0.1, 0.1];  // no link has a surface
}
const handSize = length(subtract(firstBounds.high, firstBounds.low));

function sizeOfScene() {
  return handSize;
}
function boundsOfScene() {
  // All poses, so that the view stands still while the hand moves.
  const bounds = {low: firstBounds.low.slice(), high: firstBounds.high.slice()};
  for (const pose of poses) includeLinks(bounds, pose.X_HL);
  return bounds;
}
function linkPoses() {
  return layers.hand ? X_HL : null;
}
function makeBackdrop() {
  scene.plates = plates.map((plate) => {
    const faces = plate.faces.flat();
    return upload(surface(new Float32Array(plate.points.flat()), faces));
  });
}
function drawBackdrop() {
  if (!layers.pads) return;
  scene.plates.forEach((plate, pad) => {
    constantColor(hex(kColors.pad), padPose(pad));
    drawMesh(plate);
  });
}

function marks() {
  const {marks: made, ball, tube, arrow} = markMaker();
  const s = handSize;
  if (layers.joints) {
    joints.forEach((joint, j) => {
      const {center, direction} = axisOf(joint);
      const scale = j === highlighted ? 1.7 : 1;
      const color = joint.coupling ? kColors.follower : kColors.joint;
      ball(center, 0.011 * s * scale, color);
      const half = times(direction, 0.045 * s * scale);
      if (joint.is_angle) {
        tube(subtract(center, half), add(center, half), 0.003 * s * scale, color);
      } else {
        arrow(subtract(center, half), direction, 0.09 * s * scale, 0.003 * s * scale, color);
      }
    });
  }
  if (layers.palm) {
    const palm = palmAt(X_HL[hand.palm.link]);
    ball(palm.center, 0.014 * s, kColors.palm);
    arrow(palm.center, palm.direction, 0.22 * s, 0.0055 * s, kColors.palm);
  }
  if (layers.clips) {
    for (const {points, edges} of clipVolumesAt(X_HL)) {
      for (const [i, j] of edges) tube(points[i], points[j], 0.0011 * s, kColors.clip);
    }
  }
  return made;
}

function sheets() {
  const {triangle, made} = sheetMaker();
  if (layers.clips) {
    const rgba = hex(kColors.clip, 0.28);
    for (const {points, faces} of clipVolumesAt(X_HL)) {
      for (const [i, j, k] of faces) triangle(points[i], points[j], points[k], rgba);
    }
  }
  return made();
}

function labels(project) {
  if (highlighted < 0) return [];
  const {x, y} = project(axisOf(joints[highlighted]).center);
  return [{text: joints[highlighted].name, kind: 'note', x: x + 14, y: y - 14}];
}

function view(name) {
  const wanted = data.views.find((one) => one.name === name);
  if (wanted) lookAlong(wanted.back);
  fit();
  draw();
}

// ----------------------------------------------------------------------------------- lists, tables

const shownPosition = (joint, value) =>
    joint.is_angle ? `${degrees(value)}°` : `${millimeters(value, 1)} mm`;

function makeControls() {
  const poseButtons = element('div', {id: 'poses'});
  poseButtons.setAttribute('role', 'group');
  poseButtons.setAttribute('aria-label', 'Poses');
  makeSection('pose', 'Pose', poseButtons, element('div', {id: 'sliders'}));
  poses.forEach((pose, i) => {
    const button = element('button', {type: 'button', id: `pose-${i}`}, pose.name);
    button.addEventListener('click', () => {
      q = pose.q.slice();
      shownPose = i;
      update();
    });
    byId('poses').append(button);
  });
  joints.forEach((joint, j) => {
    const isFree = !joint.coupling || joint.coupling.breakaway;
    const slider = element('input', {
      type: 'range', id: `joint-${j}`, min: joint.lower, max: joint.upper, step: 'any',
      disabled: !isFree || joint.lower === joint.upper});
    slider.setAttribute('aria-label', joint.name);
    slider.addEventListener('input', () => {
      const before = q.slice();
      q[j] = Number(slider.value);
      // A joint that had broken away comes back with its leader.
      joints.forEach((follower, f) => {
        if (follower.coupling && follower.coupling.leader === j) {
          const {ratio, offset} = follower.coupling;
          const followed = clamped(ratio * before[j] + offset, follower.lower, follower.upper);
          if (before[f] === followed) q[f] = follower.closing > 0 ? follower.lower : follower.upper;
        }
      });
      applyCouplings(q);
      shownPose = -1;
      update();
    });
    const row = element('label', {className: isFree ? 'slider' : 'slider off',
                                  title: joint.coupling
                                      ? `follows ${joints[joint.coupling.leader].name}` +
                                          (joint.coupling.breakaway ? ', may close further' : '')
                                      : ''},
        element('span', {className: 'name'}, joint.name), slider,
        element('span', {className: 'range', id: `value-${j}`}));
    row.addEventListener('mouseenter', () => highlight(j));
    row.addEventListener('mouseleave', () => highlight(-1));
    byId('sliders').append(row);
  });
  for (const [key, name, color, shape] of [
    ['hand', 'Links', kColors.hand, ''],
    ['joints', 'Joints and their axes', kColors.joint, 'round'],
    ['palm', 'Palm center and direction', kColors.palm, ''],
    ['pads', 'Pads', kColors.pad, ''],
    ['clips', 'Clip volumes of pads', kColors.clip, ''],
  ]) {
    const row = toggleRow(layers, key, color, shape, false);
    row.append(element('span', {className: 'name'}, name));
    if (key === 'joints' && joints.some((joint) => joint.coupling)) {
      row.append(element('span', {className: 'range'}, 'gray: coupled'));
    }
    if (key === 'hand') row.append(opacitySlider());
    byId('toggles').append(row);
  }
  const free = joints.filter((joint) => !joint.coupling).length;
  byId('summary').textContent = [
    data.description,
    `${hand.fingers.length} fingers · ${joints.length} joints, ${free} independent · ` +
        `${hand.pads.length} pads`].filter(Boolean).join(' ');
}

function couplingText(joint) {
  if (!joint.coupling) return '';
  const {leader, ratio, offset, breakaway} = joint.coupling;
  const shift = offset === 0 ? ''
      : ` ${offset < 0 ? '−' : '+'} ${shownPosition(joint, Math.abs(offset))}`;
  return `${Number(ratio.toPrecision(4))} × ${joints[leader].name}${shift}` +
      (breakaway ? ', breakaway' : '');
}

function makeTables() {
  const panel = byId('right');
  panel.append(element('h2', {}, 'Fingertips in the palm’s frame'),
      element('table', {id: 'tips'},
          element('thead', {}, element('tr', {},
              ...['Finger', 'x mm', 'y mm', 'z mm'].map((name) => element('th', {scope: 'col'}, name)),
              element('th', {scope: 'col', title: 'Between the centers of the tip pads'}, 'to thumb mm'))),
          element('tbody')));
  const rows = element('tbody');
  joints.forEach((joint, j) => {
    const closes = joint.closing > 0 ? 'closes upward' : joint.closing < 0 ? 'closes downward' : 'neutral';
    const row = element('tr', {},
        element('th', {scope: 'row'}, joint.name,
                element('small', {}, [closes, couplingText(joint)].filter(Boolean).join('; '))),
        element('td', {}, shownPosition(joint, joint.lower)),
        element('td', {}, shownPosition(joint, joint.upper)));
    row.addEventListener('mouseenter', () => highlight(j));
    row.addEventListener('mouseleave', () => highlight(-1));
    rows.append(row);
  });
  panel.append(element('h2', {}, 'Joints'), element('table', {id: 'joints'},
      element('thead', {}, element('tr', {},
          ...['Joint', 'lower', 'upper'].map((name) => element('th', {scope: 'col'}, name)))), rows));
  const pads = element('tbody');
  for (const pad of hand.pads) {
    pads.append(element('tr', {}, element('td', {}, pad.name),
        element('td', {}, pad.finger < 0 ? 'palm' : hand.fingers[pad.finger].name),
        element('td', {}, hand.links[pad.link].name)));
  }
  panel.append(element('h2', {}, 'Pads'), element('table', {id: 'pads'}, pads));
}

function updateTips() {
  const center = (finger) => originOf(padPose(finger.tip_pad));
  const thumb = hand.fingers.find((finger) => finger.is_thumb && finger.tip_pad >= 0);
  const rows = hand.fingers.map((finger) => {
    const cells = finger.tip_pad < 0 ? ['–', '–', '–'] : center(finger).map((x) => millimeters(x));
    const distance = finger.tip_pad < 0 || !thumb || finger === thumb
        ? '–' : millimeters(length(subtract(center(finger), center(thumb))));
    return element('tr', {}, ...[finger.name, ...cells, distance].map((cell) => element('td', {}, cell)));
  });
  document.querySelector('#tips tbody').replaceChildren(...rows);
}

function highlight(joint) {
  highlighted = joint;
  updateMarks();
  draw();
}

function update() {
  X_HL = linkPosesAt(q);
  joints.forEach((joint, j) => {
    byId(`joint-${j}`).value = q[j];
    byId(`value-${j}`).textContent = shownPosition(joint, q[j]);
  });
  poses.forEach((_, i) => byId(`pose-${i}`).setAttribute('aria-pressed', String(i === shownPose)));
  updateTips();
  updateMarks();
  draw();
}

document.addEventListener('keydown', (event) => {
  if (event.ctrlKey || event.altKey || event.metaKey) return;
  if (event.key === 'f' || event.key === 'F') view('fit');
});
X_HL = linkPosesAt(q);
// Up on the screen: where the fingers point, as nearly as an axis of H does.
camera.up = data.views[0].up.map(Math.abs).reduce((best, x, k, all) => x > all[best] + 1e-9 ? k : best, 2);
makeControls();
makeTables();
startStage(view, [
  ['fit', 'Fit', 'The whole hand, same direction (F)'],
  ['oblique', 'Oblique', 'Palm and fingers from the side'],
  ['side', 'Side', 'Across the palm direction'],
  ['front', 'Front', 'Toward the palm'],
  ['behind', 'Behind', 'Along the palm direction'],
]);
update();
if (gl) view('oblique');
