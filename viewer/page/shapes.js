// What all pages draw with: numbers, colors, shapes, the hand's links and pads. Stands first in the
// one function that a page's scripts make. Frames and units are those of the library: object frame O
// (or the hand's H), meters, radians.

const data = JSON.parse(document.getElementById('data').textContent);
const byId = (id) => document.getElementById(id);

// ---------------------------------------------------------------------------------------- numbers

function bytesOf(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes.buffer;  // little-endian, as every machine with WebGL is
}
const floats = (base64) => new Float32Array(bytesOf(base64));
const integers = (base64) => new Uint32Array(bytesOf(base64));
const shorts = (base64) => new Uint16Array(bytesOf(base64));

const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const times = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) =>
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = (a) => Math.hypot(a[0], a[1], a[2]);
const unit = (a) => {
  const l = length(a);
  return l > 0 ? times(a, 1 / l) : [0, 0, 1];
};

// 4x4 matrices are column-major arrays of 16.
function multiply(a, b) {
  const c = new Array(16).fill(0);
  for (let j = 0; j < 4; ++j) {
    for (let i = 0; i < 4; ++i) {
      for (let k = 0; k < 4; ++k) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
    }
  }
  return c;
}
const kIdentity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const rotated = (X, v) => [0, 1, 2].map((i) => X[i] * v[0] + X[4 + i] * v[1] + X[8 + i] * v[2]);
const mapped = (X, p) => add(rotated(X, p), [X[12], X[13], X[14]]);

function anyPerpendicular(v) {
  const a = v.map(Math.abs);
  const axis = a[0] <= a[1] && a[0] <= a[2] ? [1, 0, 0] : a[1] <= a[2] ? [0, 1, 0] : [0, 0, 1];
  return unit(cross(v, axis));
}
// Maps the unit shape along z to one of this radius and length from `from` along `direction`.
function alongZ(from, direction, radius, extent) {
  const z = unit(direction);
  const x = anyPerpendicular(z);
  const y = cross(z, x);
  return [...times(x, radius), 0, ...times(y, radius), 0, ...times(z, extent), 0, ...from, 1];
}
const placed = (center, size) =>
    [size, 0, 0, 0, 0, size, 0, 0, 0, 0, size, 0, ...center, 1];

// ----------------------------------------------------------------------------------------- colors

const hex = (text, alpha = 1) =>
    [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255).concat(alpha);
const kColors = {
  object: '#d9cfbf', hand: '#6f8fae', contact: '#d3302a', stable: '#2f8f57', edge: '#8a9097',
  palm: '#7b4bb3', center: '#20242a', target: '#e08a00', clip: '#139aa5', voxel: '#9fb3c4',
  surroundings: '#8fa38a', pad: '#d07a1f', joint: '#20242a', follower: '#8a9097',
  x: '#c8382f', y: '#3b8f3f', z: '#2f5fb5',
};

// --------------------------------------------------------------------------------------- surfaces

// Corners with a normal each: the mean over the faces around a vertex that bend less than 40 degrees
// away, so that edges of links stay sharp and scanned surfaces look smooth.
function surface(vertices, faces) {
  const numFaces = faces.length / 3;
  const numVertices = vertices.length / 3;
  const areas = new Float32Array(3 * numFaces);
  const units = new Float32Array(3 * numFaces);
  const first = new Uint32Array(numVertices + 1);
  for (let f = 0; f < numFaces; ++f) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * faces[3 * f + k]);
    const ux = vertices[b] - vertices[a], uy = vertices[b + 1] - vertices[a + 1],
          uz = vertices[b + 2] - vertices[a + 2];
    const vx = vertices[c] - vertices[a], vy = vertices[c + 1] - vertices[a + 1],
          vz = vertices[c + 2] - vertices[a + 2];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const l = length(n);
    for (let k = 0; k < 3; ++k) {
      areas[3 * f + k] = n[k];
      units[3 * f + k] = l > 0 ? n[k] / l : 0;
      ++first[faces[3 * f + k] + 1];
    }
  }
  for (let v = 0; v < numVertices; ++v) first[v + 1] += first[v];
  const next = first.slice();
  const around = new Uint32Array(3 * numFaces);
  for (let i = 0; i < 3 * numFaces; ++i) around[next[faces[i]]++] = Math.floor(i / 3);

  const cosine = Math.cos(40 * Math.PI / 180);
  const position = new Float32Array(9 * numFaces);
  const normal = new Float32Array(9 * numFaces);
  for (let i = 0; i < 3 * numFaces; ++i) {
    const f = 3 * Math.floor(i / 3);
    const v = faces[i];
    let x = 0, y = 0, z = 0;
    for (let k = first[v]; k < first[v + 1]; ++k) {
      const g = 3 * around[k];
      if (units[f] * units[g] + units[f + 1] * units[g + 1] + units[f + 2] * units[g + 2] >= cosine) {
        x += areas[g], y += areas[g + 1], z += areas[g + 2];
      }
    }
    const l = Math.hypot(x, y, z) || 1;
    position.set([vertices[3 * v], vertices[3 * v + 1], vertices[3 * v + 2]], 3 * i);
    normal.set([x / l, y / l, z / l], 3 * i);
  }
  return {position, normal};
}

// Solid of revolution around z of a polyline (radius, z), normals of each band from its slope unless
// the shape is a ball.
function revolved(profile, segments, isBall) {
  const position = [];
  const normal = [];
  for (let b = 0; b + 1 < profile.length; ++b) {
    const [[r0, z0], [r1, z1]] = [profile[b], profile[b + 1]];
    const slope = [z1 - z0, r0 - r1];
    const size = Math.hypot(...slope) || 1;
    const corner = (r, z, angle) => {
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      position.push(r * c, r * s, z);
      if (isBall) {
        normal.push(r * c, r * s, z);
      } else {
        normal.push(slope[0] / size * c, slope[0] / size * s, slope[1] / size);
      }
    };
    for (let i = 0; i < segments; ++i) {
      const [a0, a1] = [i, i + 1].map((k) => 2 * Math.PI * k / segments);
      corner(r0, z0, a0), corner(r0, z0, a1), corner(r1, z1, a1);
      corner(r0, z0, a0), corner(r1, z1, a1), corner(r1, z1, a0);
    }
  }
  return {position: new Float32Array(position), normal: new Float32Array(normal)};
}
const kBands = 14;
const ballProfile = Array.from({length: kBands + 1}, (_, i) => {
  const angle = -Math.PI / 2 + Math.PI * i / kBands;
  return [Math.cos(angle), Math.sin(angle)];
});
const shapes = {
  ball: revolved(ballProfile, 24, true),
  tube: revolved([[0, 0], [1, 0], [1, 1], [0, 1]], 14, false),
  cone: revolved([[0, 0], [1, 0], [0, 1]], 20, false),
  cube: (() => {
    const position = [];
    const normal = [];
    for (let axis = 0; axis < 3; ++axis) {
      for (const side of [-1, 1]) {
        const at = (u, v) => {
          const p = [0, 0, 0];
          p[axis] = side / 2, p[(axis + 1) % 3] = u / 2, p[(axis + 2) % 3] = side * v / 2;
          const n = [0, 0, 0];
          n[axis] = side;
          position.push(...p), normal.push(...n);
        };
        at(-1, -1), at(1, -1), at(1, 1), at(-1, -1), at(1, 1), at(-1, 1);
      }
    }
    return {position: new Float32Array(position), normal: new Float32Array(normal)};
  })(),
};

// ------------------------------------------------------------------------------------------- hand

function boundsOf(vertices) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < vertices.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      low[k] = Math.min(low[k], vertices[i + k]);
      high[k] = Math.max(high[k], vertices[i + k]);
    }
  }
  return {low, high};
}
// Of the part of a table that is drawn: around an object, as wide again as it on each side.
function tableCorners({low, high}, z) {
  const margin = 0.75 * Math.max(high[0] - low[0], high[1] - low[1]);
  return [[low[0] - margin, low[1] - margin, z], [high[0] + margin, low[1] - margin, z],
          [high[0] + margin, high[1] + margin, z], [low[0] - margin, high[1] + margin, z]];
}
function tableSheet(triangle, bounds, z) {
  const [a, b, c, d] = tableCorners(bounds, z);
  const rgba = hex(kColors.surroundings, 0.45);
  triangle(a, b, c, rgba);
  triangle(a, c, d, rgba);
}
const links = data.hand.links.map((link) => {
  const vertices = floats(link.mesh.vertices);
  return {name: link.name, vertices, faces: integers(link.mesh.faces), bounds: boundsOf(vertices)};
});
let handOpacity = 0.8;

// The palm's center and direction, given the pose of its link.
function palmAt(X) {
  return {
    center: mapped(X, data.hand.palm.center),
    direction: unit(rotated(X, data.hand.palm.direction)),
  };
}

// Corners, faces and edges of the pads' clip volumes, given the poses of the links.
function clipVolumesAt(X_OL) {
  return data.hand.pads.filter((pad) => pad.clip).map((pad) => {
    const X_OC = multiply(X_OL[pad.link], pad.X_LC);
    return {...pad.clip, points: pad.clip.points.map((point) => mapped(X_OC, point))};
  });
}

// Collects balls, tubes and cones.
function markMaker() {
  const marks = {ball: [], tube: [], cone: []};
  const ball = (center, radius, color) =>
      marks.ball.push({matrix: placed(center, radius), color: hex(color)});
  const tube = (a, b, radius, color) => marks.tube.push(
      {matrix: alongZ(a, subtract(b, a), radius, length(subtract(b, a))), color: hex(color)});
  const arrow = (from, direction, extent, radius, color) => {
    const head = Math.min(5 * radius, 0.5 * extent);
    const neck = add(from, times(unit(direction), extent - head));
    tube(from, neck, radius, color);
    marks.cone.push({matrix: alongZ(neck, direction, 2.4 * radius, head), color: hex(color)});
  };
  return {marks, ball, tube, arrow};
}

// Collects triangles with a color each.
function sheetMaker() {
  const position = [];
  const normal = [];
  const color = [];
  const triangle = (a, b, c, rgba) => {
    const n = unit(cross(subtract(b, a), subtract(c, a)));
    for (const p of [a, b, c]) position.push(...p), normal.push(...n), color.push(...rgba);
  };
  const made = () => ({position: new Float32Array(position), normal: new Float32Array(normal),
                       color: new Float32Array(color)});
  return {triangle, made};
}

// Widens {low, high} by the links' boxes.
function includeLinks(bounds, X_OL) {
  links.forEach((link, i) => {
    if (link.vertices.length === 0) return;
    for (let corner = 0; corner < 8; ++corner) {
      const p = mapped(X_OL[i],
                       [0, 1, 2].map((k) => (corner >> k & 1 ? link.bounds.high : link.bounds.low)[k]));
      for (let k = 0; k < 3; ++k) {
        bounds.low[k] = Math.min(bounds.low[k], p[k]);
        bounds.high[k] = Math.max(bounds.high[k], p[k]);
      }
    }
  });
}
