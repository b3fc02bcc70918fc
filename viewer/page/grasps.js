// The page of grasps: reads the data element, draws the scene, fills the lists. After stage.js.

// Contacts that are opposite each other but for rounding close exactly as rounded, with less ε.
const kRoundedEpsilon = 1e-9;
function closes(grasp) {
  return grasp.wrench.is_force_closure && grasp.wrench.epsilon > kRoundedEpsilon;
}

const kRamp = ['#c8392b', '#e8803a', '#f3cf5b', '#9cc45b', '#2f8f4e'];
function rampColor(score) {
  const t = Math.min(Math.max(score, 0), 1) * (kRamp.length - 1);
  const i = Math.min(Math.floor(t), kRamp.length - 2);
  const a = hex(kRamp[i]);
  const b = hex(kRamp[i + 1]);
  return a.map((value, k) => value + (b[k] - value) * (t - i));
}

// Edges of the convex hull of a few points, as index pairs. A pair is an edge if a plane through it and
// a third point has all others on one side.
function hullEdges(points) {
  const edges = [];
  const n = points.length;
  for (let i = 0; i < n; ++i) {
    for (let j = i + 1; j < n; ++j) {
      let isEdge = n <= 3;
      for (let k = 0; k < n && !isEdge; ++k) {
        if (k === i || k === j) continue;
        const normal = cross(subtract(points[j], points[i]), subtract(points[k], points[i]));
        let above = 0, below = 0;
        for (let l = 0; l < n; ++l) {
          if (l === i || l === j || l === k) continue;
          if (dot(normal, subtract(points[l], points[i])) > 0) ++above; else ++below;
        }
        isEdge = above === 0 || below === 0;
      }
      if (isEdge) edges.push([i, j]);
    }
  }
  return edges;
}

// ------------------------------------------------------------------------------------------ scene

const object = {
  vertices: floats(data.object.vertices),
  faces: integers(data.object.faces),
};
const objectBounds = boundsOf(object.vertices);
const objectSize = length(subtract(objectBounds.high, objectBounds.low));
const voxels = data.voxels && {
  origin: data.voxels.origin,
  size: data.voxels.size,
  indices: shorts(data.voxels.indices),
  scores: floats(data.voxels.scores),
};

// Scores are in [0, 1] unless the raw formula was chosen; then the ramp ends where 95 % of them do.
let scoreTop = 1;
if (voxels) {
  const finite = Array.from(voxels.scores).filter(Number.isFinite).sort((a, b) => a - b);
  if (finite.length > 0 && finite[finite.length - 1] > 1) {
    scoreTop = finite[Math.floor(0.95 * (finite.length - 1))] || 1;
  }
}
const relativeScore = (i) => Math.min(voxels.scores[i] / scoreTop, 1);

// Best M first; equal ones in the order of the file.
const order = data.grasps.map((_, i) => i);
order.sort((a, b) => (data.grasps[b].quality.m - data.grasps[a].quality.m) || (a - b));
let selected = 0;       // position in `order`
let highlighted = -1;   // contact under the pointer in the table
const current = () => data.grasps[order[selected]];

// What of a grasp the hand is shown in; the grasp itself where there is no such configuration.
const kConfigurations = [
  ['pre_grasp', 'Pre-grasp', 'Open and clear: where to start from'],
  ['grasp', 'Grasp', 'In contact'],
  ['squeeze', 'Squeeze', 'Joints commanded beyond the surface, so that the hand presses'],
];
let configuration = 'grasp';
const shown = (grasp) => grasp[configuration] || grasp.grasp;

const surroundings = data.surroundings || {table_z: null, obstacles: []};
const hasTable = surroundings.table_z !== null;
const obstacles = surroundings.obstacles.map((mesh) => {
  const vertices = floats(mesh.vertices);
  return {vertices, faces: integers(mesh.faces), bounds: boundsOf(vertices)};
});
const hasSurroundings = hasTable || obstacles.length > 0;
if (hasTable) camera.up = 2;

const layers = {
  object: true, hand: true, contacts: true, polygon: true, palm: true, center: true,
  targets: false, clips: false, voxels: false, scores: false, surroundings: true,
};

function sizeOfScene() {
  return objectSize;
}
function linkPoses() {
  return layers.hand && data.grasps.length > 0 ? shown(current()).X_OL : null;
}
function palmOf(grasp) {
  return palmAt(shown(grasp).X_OL[data.hand.palm.link]);
}

// Balls, tubes and cones that mark things, in O.
function marks() {
  const grasp = data.grasps.length > 0 ? current() : null;
  const {marks: made, ball, tube, arrow} = markMaker();
  const s = objectSize;

  if (layers.center && data.center_of_mass) ball(data.center_of_mass, 0.013 * s, kColors.center);
  if (!grasp) return made;
  if (layers.contacts) {
    grasp.contacts.forEach((contact, i) => {
      const scale = i === highlighted ? 1.6 : 1;
      ball(contact.point, 0.0125 * s * scale, kColors.contact);
      arrow(contact.point, contact.normal, 0.12 * s, 0.0035 * s * scale, kColors.contact);
    });
  }
  if (layers.polygon) {
    const points = grasp.contacts.map((contact) => contact.point);
    const isStable = (i, j) => grasp.quality.stable_pairs.some(
        (pair) => pair.first === Math.min(i, j) && pair.second === Math.max(i, j));
    const edges = hullEdges(points);
    for (let i = 0; i < points.length; ++i) {
      for (let j = i + 1; j < points.length; ++j) {
        const stable = isStable(i, j);
        if (!stable && !edges.some((edge) => edge[0] === i && edge[1] === j)) continue;
        tube(points[i], points[j], (stable ? 0.0038 : 0.0026) * s,
             stable ? kColors.stable : kColors.edge);
      }
    }
  }
  if (layers.palm) {
    const palm = palmOf(grasp);
    arrow(palm.center, palm.direction, 0.25 * s, 0.005 * s, kColors.palm);
  }
  if (layers.targets) {
    for (const target of grasp.targets) {
      ball(target.point, 0.0115 * s, kColors.target);
      arrow(target.point, target.normal, 0.1 * s, 0.003 * s, kColors.target);
    }
  }
  if (layers.clips) {
    for (const {points, edges} of clipVolumesAt(shown(grasp).X_OL)) {
      for (const [i, j] of edges) tube(points[i], points[j], 0.0014 * s, kColors.clip);
    }
  }
  return made;
}

// Faces seen through: the contact polygon of three contacts, the sides of clip volumes.
function sheets() {
  const grasp = data.grasps.length > 0 ? current() : null;
  const {triangle, made} = sheetMaker();
  if (grasp && layers.polygon && grasp.contacts.length === 3) {
    triangle(...grasp.contacts.map((contact) => contact.point), hex(kColors.stable, 0.16));
  }
  if (grasp && layers.clips) {
    const rgba = hex(kColors.clip, 0.28);
    for (const {points, faces} of clipVolumesAt(shown(grasp).X_OL)) {
      for (const [i, j, k] of faces) triangle(points[i], points[j], points[k], rgba);
    }
  }
  if (hasTable && layers.surroundings) {
    const [a, b, c, d] = tableCorners();
    const rgba = hex(kColors.surroundings, 0.45);
    triangle(a, b, c, rgba);
    triangle(a, c, d, rgba);
  }
  return made();
}

// Of the part of the table that is drawn: around the object, as wide again as it on each side.
function tableCorners() {
  const [low, high] = [objectBounds.low, objectBounds.high];
  const margin = 0.75 * Math.max(high[0] - low[0], high[1] - low[1]);
  const z = surroundings.table_z;
  return [[low[0] - margin, low[1] - margin, z], [high[0] + margin, low[1] - margin, z],
          [high[0] + margin, high[1] + margin, z], [low[0] - margin, high[1] + margin, z]];
}

function boundsOfScene() {
  const bounds = {low: objectBounds.low.slice(), high: objectBounds.high.slice()};
  if (layers.surroundings) {
    const corners = obstacles.flatMap((obstacle) => [obstacle.bounds.low, obstacle.bounds.high])
        .concat(hasTable ? tableCorners() : []);
    for (const corner of corners) {
      for (let k = 0; k < 3; ++k) {
        bounds.low[k] = Math.min(bounds.low[k], corner[k]);
        bounds.high[k] = Math.max(bounds.high[k], corner[k]);
      }
    }
  }
  const X_OL = linkPoses();
  if (X_OL) includeLinks(bounds, X_OL);
  return bounds;
}

// Contact polygon's normal (for two contacts, across their line and the palm direction).
function polygonNormal(grasp) {
  const points = grasp.contacts.map((contact) => contact.point);
  const palm = palmOf(grasp);
  if (points.length < 2) return anyPerpendicular(palm.direction);
  const along = subtract(points[1], points[0]);
  const normal = points.length === 2 ? cross(along, palm.direction)
                                     : cross(along, subtract(points[2], points[0]));
  return length(normal) > 0 ? unit(normal) : anyPerpendicular(palm.direction);
}
function view(name) {
  if (name !== 'fit' && data.grasps.length > 0) {
    const palm = palmOf(current());
    const normal = polygonNormal(current());
    if (name === 'front') lookAlong(palm.direction);
    if (name === 'behind') lookAlong(times(palm.direction, -1));
    if (name === 'polygon') {
      // From the side that the palm does not cover.
      lookAlong(dot(normal, palm.direction) < 0 ? times(normal, -1) : normal);
    }
    if (name === 'side') {
      const across = [0, 1, 2].map((k) => normal[k] - dot(normal, palm.direction) * palm.direction[k]);
      let best = length(across) > 0.2 ? unit(across) : anyPerpendicular(palm.direction);
      // Of the directions across the palm's, one that is close to level and shows the polygon.
      const other = cross(palm.direction, best);
      let bestScore = -Infinity;
      const start = best;
      for (let i = 0; i < 48; ++i) {
        const angle = 2 * Math.PI * i / 48;
        const candidate = add(times(start, Math.cos(angle)), times(other, Math.sin(angle)));
        const score = Math.abs(dot(candidate, normal)) - 0.8 * Math.abs(candidate[camera.up] - 0.2);
        if (score > bestScore + 1e-9) bestScore = score, best = candidate;
      }
      lookAlong(best);
    }
  }
  fit();
  draw();
}

// The score of every voxel with a patch, as a 3D texture over the voxels' box.
function scoreTexture() {
  const {indices, scores} = voxels;
  const low = [65535, 65535, 65535];
  const high = [0, 0, 0];
  for (let i = 0; i < indices.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], indices[i]);
    high[i % 3] = Math.max(high[i % 3], indices[i]);
  }
  const size = [0, 1, 2].map((k) => high[k] - low[k] + 1);
  if (scores.length === 0 || Math.max(...size) > gl.getParameter(gl.MAX_3D_TEXTURE_SIZE)) return null;
  const texels = new Uint8Array(size[0] * size[1] * size[2]);
  for (let i = 0; i < scores.length; ++i) {
    if (Number.isNaN(scores[i])) continue;
    const [x, y, z] = [0, 1, 2].map((k) => indices[3 * i + k] - low[k]);
    texels[x + size[0] * (y + size[1] * z)] = 1 + Math.round(254 * relativeScore(i));
  }
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_3D, texture);
  gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
  gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, ...size, 0, gl.RED, gl.UNSIGNED_BYTE, texels);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return {texture, lowest: low};
}
function makeBackdrop() {
  scene.object = upload(surface(object.vertices, object.faces));
  scene.obstacles = obstacles.map((mesh) => upload(surface(mesh.vertices, mesh.faces)));
  scene.scoreTexture = voxels && scoreTexture();
  scene.voxelsShown = '';
}
function updateVoxels() {
  const wanted = layers.voxels ? (layers.scores ? 'scores' : 'plain') : '';
  if (!voxels || scene.voxelsShown === wanted) return;
  scene.voxelsShown = wanted;
  const count = wanted ? voxels.scores.length : 0;
  const colors = new Float32Array(4 * count);
  const matrices = new Float32Array(16 * count);
  const plain = hex(kColors.voxel);
  for (let i = 0; i < count; ++i) {
    const center = [0, 1, 2].map(
        (k) => voxels.origin[k] + voxels.size * (voxels.indices[3 * i + k] + 0.5));
    const hasScore = wanted === 'scores' && !Number.isNaN(voxels.scores[i]);
    colors.set(hasScore ? rampColor(relativeScore(i)) : plain, 4 * i);
    matrices.set(placed(center, voxels.size), 16 * i);
  }
  setInstances(scene.cube, colors, matrices);
}

function drawBackdrop(u) {
  gl.uniform1f(u.shininess, layers.scores ? 0 : 0.06);
  gl.uniform1f(u.flatness, layers.scores ? 0.5 : 0);  // colors must match the legend
  if (layers.object) {
    const showScores = layers.scores && scene.scoreTexture;
    if (showScores) {
      gl.bindTexture(gl.TEXTURE_3D, scene.scoreTexture.texture);
      gl.uniform1i(u.has_scores, 1);
      gl.uniform3iv(u.lowest, scene.scoreTexture.lowest);
      gl.uniform3fv(u.origin, voxels.origin);
      gl.uniform1f(u.voxel_size, voxels.size);
      gl.uniform3fv(u.ramp, kRamp.flatMap((color) => hex(color).slice(0, 3)));
    }
    constantColor(hex(kColors.object), kIdentity);
    drawMesh(scene.object);
    gl.uniform1i(u.has_scores, 0);
  }
  if (layers.surroundings) {
    constantColor(hex(kColors.surroundings), kIdentity);
    scene.obstacles.forEach(drawMesh);
  }
  updateVoxels();
  if (layers.voxels && voxels) {
    gl.uniform1i(u.has_cube_edges, 1);
    drawInstances(scene.cube);
    gl.uniform1i(u.has_cube_edges, 0);
  }
}

function labels(project) {
  const texts = [];
  if (data.grasps.length > 0 && layers.contacts) {
    current().contacts.forEach((contact, i) => {
      const {x, y} = project(contact.point);
      texts.push({text: i === highlighted ? `${i + 1} ${contact.finger}` : `${i + 1}`, kind: '',
                   x: x + 14, y: y - 14});
    });
  }
  if (layers.center && data.center_of_mass) {
    const {x, y} = project(data.center_of_mass);
    texts.push({text: 'CoM', kind: 'note', x: x + 18, y: y + 12});
  }
  return texts;
}

function listenToKeys() {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target.matches('select, input[type=range]')) return;
    const step = {ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1}[event.key];
    if (step && data.grasps.length > 0) {
      select(Math.min(Math.max(selected + step, 0), order.length - 1));
      event.preventDefault();
    } else if (event.key === 'Home' && data.grasps.length > 0) {
      select(0);
    } else if (event.key === 'End' && data.grasps.length > 0) {
      select(order.length - 1);
    } else if (event.key === 'f' || event.key === 'F') {
      view('fit');
    }
  });
}

const kind = (grasp) => grasp.is_valid ? 'valid' : grasp.is_usable ? 'usable' : 'unusable';
const kKinds = {
  valid: 'M > 0, touches nothing else, every requested finger and palm touches',
  usable: 'M > 0, but it penetrates or misses a requested contact',
  unusable: 'M = 0',
};
const badge = (grasp) => element(
    'span', {className: `badge ${kind(grasp)}`, title: kKinds[kind(grasp)]}, kind(grasp));

function makeList() {
  const list = element('div', {id: 'list', tabIndex: 0});
  list.setAttribute('role', 'listbox');
  list.setAttribute('aria-label', 'Grasps');
  makeSection('grasps', 'Grasps, best first', list);
  order.forEach((index, position) => {
    const grasp = data.grasps[index];
    const {m, m1, m2, m3} = grasp.quality;
    const row = element('div', {id: `grasp-${index + 1}`},
        element('span', {className: 'number'}, `#${index + 1}`),
        element('span', {className: 'm'}, `M ${fixed(m, 3)}`),
        badge(grasp),
        element('span', {className: 'parts'},
                `M1 ${fixed(m1, 3)}   M2 ${fixed(m2, 3)}   M3 ${fixed(m3, 3)}` +
                    (grasp.wrench ? `   ε ${closes(grasp) ? fixed(grasp.wrench.epsilon, 3) : 'open'}`
                                  : '')));
    row.setAttribute('role', 'option');
    row.addEventListener('click', () => select(position));
    list.append(row);
  });
  if (order.length === 0) list.append(element('p', {className: 'soft'}, 'No grasps.'));
  const valid = data.grasps.filter((grasp) => grasp.is_valid).length;
  const usable = data.grasps.filter((grasp) => grasp.is_usable).length;
  const size = subtract(objectBounds.high, objectBounds.low).map((s) => (1000 * s).toFixed(0));
  byId('summary').textContent =
      `${data.hand.name} hand · ${order.length} grasp${order.length === 1 ? '' : 's'}, ` +
      `${usable} usable, ${valid} valid · object ${size.join(' × ')} mm`;
}

// Buttons for pre-grasp, grasp and squeeze; those that the selected grasp lacks are off.
function makeConfigurations() {
  const buttons = element('div', {id: 'configurations'});
  buttons.setAttribute('role', 'group');
  buttons.setAttribute('aria-label', 'Configuration of the hand');
  for (const [name, caption, title] of kConfigurations) {
    const button = element('button', {type: 'button', id: `configuration-${name}`, title}, caption);
    button.addEventListener('click', () => {
      configuration = name;
      select(selected);
    });
    buttons.append(button);
  }
  makeSection('hand-shown', 'Hand', buttons);
}
function updateConfigurations() {
  for (const [name] of kConfigurations) {
    const button = byId(`configuration-${name}`);
    button.disabled = !current()[name];
    button.setAttribute('aria-pressed', String(shown(current()) === current()[name]));
  }
}

function makeToggles() {
  const without = voxels ? '' : 'This page was written without voxels and scores';
  const rows = [
    ['object', 'Object', kColors.object, ''],
    ['hand', 'Hand', kColors.hand, ''],
    ['contacts', 'Contacts, inward normals', kColors.contact, '', 'round'],
    ['polygon', 'Contact polygon', null, ''],
    ['palm', 'Palm direction', kColors.palm, ''],
    ['center', 'Center of mass (CoM)', kColors.center, '', 'round'],
    ['targets', 'Targets, outward normals', kColors.target, '', 'round'],
    ['clips', 'Clip volumes of pads', kColors.clip, ''],
    ...(hasSurroundings ? [['surroundings', 'Table and obstacles', kColors.surroundings, '']] : []),
    ['voxels', 'Voxels with surface', kColors.voxel, without],
    ['scores', 'Score map', 'ramp', without],
  ];
  for (const [key, name, color, missing, shape] of rows) {
    const isRamp = color === 'ramp';
    const row = toggleRow(
        layers, key, isRamp ? '' :
        color || `linear-gradient(135deg, ${kColors.stable} 50%, ${kColors.edge} 50%)`, shape, missing !== '');
    row.title = missing;
    row.append(element('span', {className: 'name'}, name));
    if (isRamp) {
      row.append(element('span', {className: 'range'}, '0'));
      const ramp = element('span', {className: 'ramp'});
      ramp.style.background = `linear-gradient(to right, ${kRamp.join(', ')})`;
      row.append(ramp);
      row.append(element('span', {className: 'range'}, scoreTop === 1 ? '1' : `≥ ${scoreTop.toPrecision(3)}`));
      row.title = missing || 'Suitability of each surface patch for a contact: red low, green high';
    } else if (key === 'polygon') {
      row.title = 'Green edge: stable pair, its line lies inside both friction cones. Gray: other edges';
      row.append(element('span', {className: 'range'}, 'green: stable pair'));
    } else if (key === 'hand') {
      row.append(opacitySlider());
    }
    byId('toggles').append(row);
  }
}

function showMeasures() {
  const panel = byId('right');
  panel.replaceChildren();
  if (data.grasps.length === 0) {
    panel.append(element('p', {className: 'soft'}, 'No grasp was found; the object is shown alone.'));
    return;
  }
  const grasp = current();
  const {quality, penetration} = grasp;
  panel.append(element('h2', {}, `Grasp #${order[selected] + 1}`));
  panel.append(element('div', {className: 'headline', title: kKinds[kind(grasp)]},
      element('span', {className: 'value', id: 'm'}, `M ${fixed(quality.m, 4)}`), badge(grasp)));
  panel.append(element('p', {className: 'soft'}, kKinds[kind(grasp)]));
  if (shown(grasp) !== grasp.grasp) {
    const name = kConfigurations.find(([key]) => key === configuration)[1].toLowerCase();
    panel.append(element('p', {className: 'soft', id: 'shown'},
                         `The hand is shown in its ${name}; numbers are the grasp’s.`));
  }

  const rows = element('tbody', {},
      measureRow('M1 sustainability', 'single contacts: far from pad edges, large area', fixed(quality.m1, 4)),
      measureRow('M2 stability', 'pairs: lines well inside both friction cones', fixed(quality.m2, 4)),
      measureRow('M3 shape', 'whole set: regular and around the CoM', fixed(quality.m3, 4)),
      measureRow('R regularity', 'of the contact polygon, 1 is regular', fixed(quality.regularity, 4)),
      measureRow('D centroid distance', 'contact polygon’s centroid to CoM', millimeters(quality.centroid_distance), 'mm'),
      measureRow('D as in M3', 'in the units chosen for the measure', fixed(quality.scaled_centroid_distance, 4)),
      measureRow('M of the targets', 'what the planner aimed for', fixed(grasp.ideal_m, 4)));
  if (grasp.wrench) {
    const row = measureRow('ε', closes(grasp) ? 'force closure' : 'no force closure',
                           fixed(grasp.wrench.epsilon, 4));
    row.title = grasp.wrench.convention;
    rows.append(row);
  }
  panel.append(element('h2', {}, 'Measures'), element('table', {id: 'measures'}, rows));

  panel.append(element('h2', {}, 'Contacts'));
  const contacts = element('tbody');
  grasp.contacts.forEach((contact, i) => {
    const notes = [contact.target ? '' : 'no target', contact.weak ? 'weak' : ''].filter(Boolean);
    const row = element('tr', {className: 'contact', title: `link ${contact.link}`},
        element('td', {}, `${i + 1} ${contact.finger}`,
                ...notes.map((note) => element('small', {className: 'soft'}, ` ${note}`))),
        element('td', {}, millimeters(contact.gap, 3)),
        element('td', {}, fixed(contact.area * 1e6, contact.area < 1e-6 ? 3 : 1)),
        element('td', {}, millimeters(contact.d)),
        element('td', {}, contact.term ? fixed(contact.term.s, 0) : '–'));
    row.addEventListener('mouseenter', () => highlight(i));
    row.addEventListener('mouseleave', () => highlight(-1));
    contacts.append(row);
  });
  panel.append(element('table', {id: 'contacts'},
      element('thead', {}, element('tr', {},
          element('th', {scope: 'col'}, 'Finger'),
          element('th', {scope: 'col', title: 'Between the pad’s part of the link’s mesh and the object'}, 'gap mm'),
          element('th', {scope: 'col', title: 'Object surface inside the pad’s clip volume'}, 'area mm²'),
          element('th', {scope: 'col', title: 'From the contact point to the pad’s edge'}, 'd mm'),
          element('th', {scope: 'col', title: 'Strength: 0 on a weak feature of the object, else 1'}, 'S'))),
      contacts));
  if (grasp.contacts.length === 0) panel.append(element('p', {className: 'soft'}, 'None.'));

  panel.append(element('h2', {}, 'Stable pairs'));
  const pairs = element('tbody');
  for (const pair of quality.stable_pairs) {
    const name = (i) => `${i + 1} ${grasp.contacts[i].finger}`;
    pairs.append(element('tr', {}, element('td', {}, `${name(pair.first)} – ${name(pair.second)}`),
                         element('td', {}, `${degrees(pair.angle)}°`)));
  }
  panel.append(quality.stable_pairs.length === 0
      ? element('p', {className: 'soft'}, 'None: nothing opposes anything.')
      : element('table', {id: 'pairs', title: 'Mean angle between the line and the contact normals'}, pairs));

  panel.append(element('h2', {}, 'Penetration'));
  const depth = (value, bound) => bound > value
      ? `${millimeters(value)} to ${millimeters(bound)} mm` : `${millimeters(value)} mm`;
  panel.append(element('table', {id: 'penetration'}, element('tbody', {},
      measureRow('Hand and object', penetration.object_link ? `deepest: ${penetration.object_link}` : '',
                 penetration.object ? depth(penetration.object_depth, penetration.object_depth_bound) : 'none'),
      measureRow('Hand and itself',
                 penetration.self_link_a ? `${penetration.self_link_a}, ${penetration.self_link_b}` : '',
                 penetration.self ? `${millimeters(penetration.self_depth)} mm` : 'none'),
      measureRow('Hand and surroundings', 'table and obstacles', penetration.surroundings ? 'touch' : 'none'),
      measureRow('Requested contacts', '', grasp.has_all_contacts ? 'all there' : 'some missing'))));

  const {pre_grasp: start, squeeze} = grasp;
  const ways = element('tbody');
  if (start) {
    ways.append(
        measureRow('Pre-grasp clearance', 'of the nearest link', millimeters(start.clearance, 1), 'mm'),
        measureRow('Pre-grasp opening', 'share of the way to open joints', fixed(100 * start.opening, 0), '%'),
        measureRow('Pre-grasp retreat', 'of the palm', millimeters(start.retreat, 1), 'mm'));
  }
  if (squeeze) {
    ways.append(
        measureRow('Squeeze', 'contact forces', squeeze.is_balanced ? 'balanced' : 'not balanced'),
        measureRow('Unbalanced share', squeeze.is_clamped ? 'a joint is at its limit' : '',
                   fixed(100 * squeeze.residual, 1), '%'));
  }
  if (start || squeeze) {
    panel.append(element('h2', {}, 'Before and after'), element('table', {id: 'ways'}, ways));
  }

  const joints = element('tbody');
  data.hand.joints.forEach((joint, i) => joints.append(measureRow(
      joint.name, joint.is_coupled ? 'coupled' : '',
      joint.is_angle ? degrees(shown(grasp).q[i]) : millimeters(shown(grasp).q[i]), joint.is_angle ? '°' : 'mm')));
  const X_OH = shown(grasp).X_OL[data.hand.palm.link];
  const terms = element('tbody');
  grasp.contacts.forEach((contact, i) => contact.term && terms.append(measureRow(
      `${i + 1} ${contact.finger}`, '', `${fixed(contact.term.d, 4)}   ${fixed(contact.term.a, 4)}`)));
  panel.append(element('details', {}, element('summary', {}, 'Hand pose and joints'),
      element('table', {}, element('tbody', {},
          measureRow('Palm position in O', 'x, y, z',
                     X_OH.slice(12, 15).map((value) => millimeters(value, 1)).join(', '), 'mm'),
          measureRow('Palm direction in O', 'x, y, z',
                     palmOf(grasp).direction.map((value) => fixed(value, 3)).join(', '))), joints)));
  panel.append(element('details', {}, element('summary', {}, 'Terms of M1, planner'),
      element('p', {className: 'soft'}, 'd and A of each contact in the units of the measure'),
      element('table', {}, terms, element('tbody', {},
          measureRow('Attempt', 'number of the target set', grasp.attempt >= 0 ? `${grasp.attempt}` : '–'),
          measureRow('Iterations', 'of the fitting loop', `${grasp.iterations}`)))));
}

function highlight(contact) {
  highlighted = contact;
  updateMarks();
  draw();
}

function select(position) {
  selected = position;
  highlighted = -1;
  const list = byId('list');
  [...list.children].forEach((row, i) => {
    row.setAttribute('aria-selected', String(i === position));
    if (i === position) {
      list.setAttribute('aria-activedescendant', row.id);
      row.scrollIntoView({block: 'nearest'});
    }
  });
  const open = [...document.querySelectorAll('#right details')].map((details) => details.open);
  showMeasures();
  updateConfigurations();
  [...document.querySelectorAll('#right details')].forEach((details, i) => details.open = open[i]);
  updateMarks();
  if (camera.isFitted) fit();
  draw();
}

makeList();
if (data.grasps.length > 0) makeConfigurations();
makeToggles();
listenToKeys();
byId('hint').append(' · ↑ ↓: other grasp');
startStage(view, [
  ['fit', 'Fit', 'The whole scene, same direction (F)'],
  ['side', 'Side', 'Across the palm direction'],
  ['front', 'Front', 'Toward the palm, object in front'],
  ['behind', 'Behind', 'Along the palm direction, hand in front'],
  ['polygon', 'Polygon', 'Contact polygon face on'],
]);
if (data.grasps.length > 0) {
  select(0);
} else {
  showMeasures();
  updateMarks();
}
if (gl) view('side');
