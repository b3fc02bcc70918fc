// What the page of grasps draws: object, voxels, surroundings, what marks the selected grasp. Reads the
// data element. After controls.js.

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

let selected = 0;       // of the grasps, which come in the order of the file
let highlighted = -1;   // contact under the pointer in the table
const current = () => data.grasps[selected];

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
  if (hasTable && layers.surroundings) tableSheet(triangle, objectBounds, surroundings.table_z);
  return made();
}

function boundsOfScene() {
  const bounds = {low: objectBounds.low.slice(), high: objectBounds.high.slice()};
  if (layers.surroundings) {
    const corners = obstacles.flatMap((obstacle) => [obstacle.bounds.low, obstacle.bounds.high])
        .concat(hasTable ? tableCorners(objectBounds, surroundings.table_z) : []);
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
