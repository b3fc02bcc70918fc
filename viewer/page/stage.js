// What all pages share: camera and drawing with WebGL 2. Stands between shapes.js and
// controls.js, before the page's own script (grasp_scene.js, hand.js, replay.js, motion.js), which has
//   boundsOfScene()    {low, high} of what is to be in view
//   sizeOfScene()      length to which marks and zoom are scaled
//   linkPoses()        of the hand's links, or null if it is not shown
//   marks()            {ball, tube, cone}: lists of {matrix, color}
//   sheets()           faces seen through, {position, normal, color}
//   makeBackdrop()     uploads what drawBackdrop(uniforms) draws before the hand
//   labels(project)    [{text, kind, x, y}]

// ----------------------------------------------------------------------------------------- camera

const kFieldOfView = 28 * Math.PI / 180;
// `isFitted` until the user pans or zooms: then another grasp is brought into view as well.
const camera = {azimuth: 0.6, elevation: 0.25, target: [0, 0, 0], distance: 1, up: 1, isFitted: true};

function cameraAxes() {
  const up = [0, 0, 0];
  up[camera.up] = 1;
  const e1 = [0, 0, 0];
  e1[(camera.up + 1) % 3] = 1;
  const e2 = cross(up, e1);
  const [ca, sa] = [Math.cos(camera.azimuth), Math.sin(camera.azimuth)];
  const [ce, se] = [Math.cos(camera.elevation), Math.sin(camera.elevation)];
  const level = add(times(e1, ca), times(e2, sa));
  const back = add(times(level, ce), times(up, se));     // from the target to the eye
  const right = add(times(e1, -sa), times(e2, ca));
  return {right, up: cross(back, right), back};
}
function lookAlong(back) {
  const up = camera.up;
  const [a, b] = [back[(up + 1) % 3], back[(up + 2) % 3]];
  camera.elevation = Math.asin(Math.min(Math.max(back[up], -1), 1));
  if (Math.hypot(a, b) > 1e-6) camera.azimuth = Math.atan2(b, a);
}
function fit() {
  const {low, high} = boundsOfScene();
  camera.target = times(add(low, high), 0.5);
  // The corners of the box must lie inside the frustum.
  const {right, up, back} = cameraAxes();
  const slope = Math.tan(kFieldOfView / 2);
  const aspect = Math.max(canvas.clientWidth, 1) / Math.max(canvas.clientHeight, 1);
  let distance = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const p = subtract([0, 1, 2].map((k) => (corner >> k & 1 ? high : low)[k]), camera.target);
    const depth = dot(p, back);
    distance = Math.max(distance, depth + Math.abs(dot(p, up)) / slope,
                        depth + Math.abs(dot(p, right)) / (slope * aspect));
  }
  camera.distance = distance * 1.06;
  camera.isFitted = true;
}
// ------------------------------------------------------------------------------------------ WebGL

const canvas = byId('scene');
const gl = canvas.getContext('webgl2', {antialias: true, alpha: false});

const kVertexShader = `#version 300 es
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 color;
layout(location = 3) in mat4 model;
uniform mat4 view_projection;
out vec3 p;
out vec3 n;
out vec3 local;
out vec4 rgba;
void main() {
  vec4 world = model * vec4(position, 1.0);
  // Inverse transpose of a rotation times a scaling along the axes.
  vec3 squares = vec3(dot(model[0], model[0]), dot(model[1], model[1]), dot(model[2], model[2]));
  n = mat3(model) * (normal / squares);
  p = world.xyz;
  local = position;
  rgba = color;
  gl_Position = view_projection * world;
}`;
const kFragmentShader = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler3D;
in vec3 p;
in vec3 n;
in vec3 local;
in vec4 rgba;
uniform vec3 eye;
uniform vec3 lamp;             // unit, toward the main light
uniform float opacity;
uniform float shininess;       // strength of the highlight
uniform float flatness;        // 0: shaded, 1: its color wherever the light is
uniform bool has_cube_edges;
uniform bool has_scores;
uniform sampler3D scores;      // per voxel: 0 without a patch, else 1/255 + 254/255 score
uniform ivec3 lowest;          // voxel of the first texel
uniform vec3 origin;
uniform float voxel_size;
uniform vec3 ramp[5];
out vec4 fragment;
void main() {
  vec3 base = rgba.rgb;
  if (has_scores) {
    // A thousandth of a voxel up: surface in the plane between two voxels belongs to the upper one.
    ivec3 voxel = ivec3(floor((p - origin) / voxel_size + 1e-3));
    ivec3 texel = voxel - lowest;
    ivec3 size = textureSize(scores, 0);
    float value = all(greaterThanEqual(texel, ivec3(0))) && all(lessThan(texel, size))
        ? texelFetch(scores, texel, 0).r : 0.0;
    if (value > 0.0) {
      float t = clamp((value * 255.0 - 1.0) / 254.0, 0.0, 1.0) * 4.0;
      int i = min(int(t), 3);
      base = mix(ramp[i], ramp[i + 1], t - float(i));
    } else {
      base = vec3(0.72);
    }
    // Lines where the voxels' planes cut the surface; none where it lies in such a plane.
    vec3 q = (p - origin) / voxel_size + 1e-3;
    vec3 to_plane = abs(q - round(q));
    vec3 width = fwidth(q);
    if (any(lessThan(to_plane, 0.6 * width)) && max(width.x, max(width.y, width.z)) < 0.25) base *= 0.84;
  }
  if (has_cube_edges) {
    vec3 a = abs(local);
    float largest = max(a.x, max(a.y, a.z));
    float second = a.x + a.y + a.z - largest - min(a.x, min(a.y, a.z));
    base *= mix(1.0, 0.72, smoothstep(0.44, 0.47, second));
  }
  vec3 to_eye = normalize(eye - p);
  vec3 m = normalize(n);
  if (dot(m, to_eye) < 0.0) m = -m;
  float main_light = max(dot(m, lamp), 0.0);
  float head_light = max(dot(m, to_eye), 0.0);
  float highlight = pow(max(dot(m, normalize(lamp + to_eye)), 0.0), 48.0) * shininess;
  vec3 lit = base * mix(0.40 + 0.42 * main_light + 0.24 * head_light, 1.0, flatness) + highlight;
  fragment = vec4(lit, rgba.a * opacity);
}`;

const scene = {};  // what was made for the graphics card

function program() {
  const made = gl.createProgram();
  for (const [type, text] of [[gl.VERTEX_SHADER, kVertexShader],
                              [gl.FRAGMENT_SHADER, kFragmentShader]]) {
    const shader = gl.createShader(type);
    gl.shaderSource(shader, text);
    gl.compileShader(shader);
    if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS) && !gl.isContextLost()) {
      throw new Error(gl.getShaderInfoLog(shader));
    }
    gl.attachShader(made, shader);
  }
  gl.linkProgram(made);
  if (!gl.getProgramParameter(made, gl.LINK_STATUS) && !gl.isContextLost()) {
    throw new Error(gl.getProgramInfoLog(made));
  }
  const uniforms = {};
  for (const name of ['view_projection', 'eye', 'lamp', 'opacity', 'shininess', 'flatness', 'has_cube_edges',
                      'has_scores', 'scores', 'lowest', 'origin', 'voxel_size', 'ramp']) {
    uniforms[name] = gl.getUniformLocation(made, name);
  }
  return {made, uniforms};
}
function attribute(location, size, values, usage) {
  const buffer = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
  gl.bufferData(gl.ARRAY_BUFFER, values, usage);
  gl.enableVertexAttribArray(location);
  gl.vertexAttribPointer(location, size, gl.FLOAT, false, 0, 0);
  return buffer;
}
function upload(mesh) {
  const vertexArray = gl.createVertexArray();
  gl.bindVertexArray(vertexArray);
  attribute(0, 3, mesh.position, gl.STATIC_DRAW);
  attribute(1, 3, mesh.normal, gl.STATIC_DRAW);
  return {vertexArray, count: mesh.position.length / 3};
}
// A shape drawn many times, each with its own color and matrix.
function uploadInstanced(mesh) {
  const made = upload(mesh);
  made.colors = attribute(2, 4, new Float32Array(4), gl.DYNAMIC_DRAW);
  gl.vertexAttribDivisor(2, 1);
  made.matrices = gl.createBuffer();
  gl.bindBuffer(gl.ARRAY_BUFFER, made.matrices);
  for (let column = 0; column < 4; ++column) {
    gl.enableVertexAttribArray(3 + column);
    gl.vertexAttribPointer(3 + column, 4, gl.FLOAT, false, 64, 16 * column);
    gl.vertexAttribDivisor(3 + column, 1);
  }
  made.instances = 0;
  return made;
}
function setInstances(shape, colors, matrices) {
  gl.bindBuffer(gl.ARRAY_BUFFER, shape.colors);
  gl.bufferData(gl.ARRAY_BUFFER, colors, gl.DYNAMIC_DRAW);
  gl.bindBuffer(gl.ARRAY_BUFFER, shape.matrices);
  gl.bufferData(gl.ARRAY_BUFFER, matrices, gl.DYNAMIC_DRAW);
  shape.instances = colors.length / 4;
}
// The score of every voxel with a patch, as a 3D texture over the voxels' box.
function placeholderTexture() {
  const texture = gl.createTexture();
  gl.bindTexture(gl.TEXTURE_3D, texture);
  gl.texImage3D(gl.TEXTURE_3D, 0, gl.R8, 1, 1, 1, 0, gl.RED, gl.UNSIGNED_BYTE, new Uint8Array(1));
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MIN_FILTER, gl.NEAREST);
  gl.texParameteri(gl.TEXTURE_3D, gl.TEXTURE_MAG_FILTER, gl.NEAREST);
  return texture;
}
function makeScene() {
  Object.assign(scene, program());
  scene.links = links.map((link) => upload(surface(link.vertices, link.faces)));
  for (const name of ['ball', 'tube', 'cone', 'cube']) scene[name] = uploadInstanced(shapes[name]);
  scene.sheets = upload({position: new Float32Array(9), normal: new Float32Array(9)});
  scene.placeholder = placeholderTexture();
  scene.axisTube = upload(shapes.tube);
  scene.axisCone = upload(shapes.cone);
  makeBackdrop();
  gl.bindVertexArray(null);
}
function updateMarks() {
  if (!gl) return;
  const made = marks();
  for (const name of ['ball', 'tube', 'cone']) {
    setInstances(scene[name], new Float32Array(made[name].flatMap((mark) => mark.color)),
                 new Float32Array(made[name].flatMap((mark) => mark.matrix)));
  }
  const {position, normal, color} = sheets();
  gl.deleteVertexArray(scene.sheets.vertexArray);
  for (const buffer of scene.sheets.buffers || []) gl.deleteBuffer(buffer);
  const vertexArray = gl.createVertexArray();
  gl.bindVertexArray(vertexArray);
  const buffers = [attribute(0, 3, position, gl.DYNAMIC_DRAW),
                   attribute(1, 3, normal, gl.DYNAMIC_DRAW),
                   attribute(2, 4, color, gl.DYNAMIC_DRAW)];
  gl.bindVertexArray(null);
  scene.sheets = {vertexArray, buffers, count: position.length / 3};
}
function constantColor(color, matrix) {
  gl.vertexAttrib4fv(2, color);
  for (let column = 0; column < 4; ++column) {
    gl.vertexAttrib4fv(3 + column, matrix.slice(4 * column, 4 * column + 4));
  }
}
function drawMesh(mesh) {
  if (mesh.count === 0) return;
  gl.bindVertexArray(mesh.vertexArray);
  gl.drawArrays(gl.TRIANGLES, 0, mesh.count);
}
function drawInstances(shape) {
  if (shape.instances === 0) return;
  gl.bindVertexArray(shape.vertexArray);
  gl.drawArraysInstanced(gl.TRIANGLES, 0, shape.count, shape.instances);
}
function drawMarks() {
  for (const name of ['ball', 'tube', 'cone']) drawInstances(scene[name]);
}
function drawHand(X_OL) {
  links.forEach((_, i) => {
    constantColor(hex(kColors.hand), X_OL[i]);
    drawMesh(scene.links[i]);
  });
}

// Projection times view, for a frustum or (scale given) a parallel view of that half height.
function viewProjection(aspect, axes, eye, near, far, halfHeight) {
  const {right, up, back} = axes;
  const toCamera = [
    right[0], up[0], back[0], 0, right[1], up[1], back[1], 0, right[2], up[2], back[2], 0,
    -dot(right, eye), -dot(up, eye), -dot(back, eye), 1];
  const projection = new Array(16).fill(0);
  if (halfHeight) {
    projection[0] = 1 / (halfHeight * aspect);
    projection[5] = 1 / halfHeight;
    projection[10] = -2 / (far - near);
    projection[14] = -(far + near) / (far - near);
    projection[15] = 1;
  } else {
    const f = 1 / Math.tan(kFieldOfView / 2);
    projection[0] = f / aspect;
    projection[5] = f;
    projection[10] = (far + near) / (near - far);
    projection[11] = -1;
    projection[14] = 2 * far * near / (near - far);
  }
  return multiply(projection, toCamera);
}

let isDrawPending = false;
function draw() {
  if (!gl || isDrawPending) return;
  isDrawPending = true;
  requestAnimationFrame(() => {
    isDrawPending = false;
    if (!gl.isContextLost()) render();
  });
}

function render() {
  const ratio = Math.min(window.devicePixelRatio || 1, 2);
  const [width, height] = [canvas.clientWidth, canvas.clientHeight];
  if (width === 0 || height === 0) return;
  const [w, h] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== w || canvas.height !== h) canvas.width = w, canvas.height = h;

  const axes = cameraAxes();
  const eye = add(camera.target, times(axes.back, camera.distance));
  const bounds = boundsOfScene();
  const reach = length(subtract(bounds.high, bounds.low)) + length(subtract(camera.target, bounds.low));
  const far = camera.distance + 2 * reach;
  const near = Math.max(camera.distance - 2 * reach, far * 2e-3);
  const matrix = viewProjection(width / height, axes, eye, near, far);
  const lamp = unit(add(add(times(axes.back, 0.7), times(axes.up, 0.6)), times(axes.right, -0.45)));

  gl.viewport(0, 0, w, h);
  gl.clearColor(...hex('#f4f5f4'));
  gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
  gl.enable(gl.DEPTH_TEST);
  gl.depthFunc(gl.LEQUAL);
  gl.depthMask(true);
  gl.disable(gl.BLEND);
  gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  gl.useProgram(scene.made);
  const u = scene.uniforms;
  gl.uniformMatrix4fv(u.view_projection, false, matrix);
  gl.uniform3fv(u.eye, eye);
  gl.uniform3fv(u.lamp, lamp);
  gl.uniform1f(u.opacity, 1);
  gl.uniform1f(u.shininess, 0.06);
  gl.uniform1f(u.flatness, 0);
  gl.uniform1i(u.has_cube_edges, 0);
  gl.uniform1i(u.has_scores, 0);
  gl.uniform1i(u.scores, 0);
  gl.activeTexture(gl.TEXTURE0);
  gl.bindTexture(gl.TEXTURE_3D, scene.placeholder);
  drawBackdrop(u);
  gl.uniform1f(u.shininess, 0.15);
  gl.uniform1f(u.flatness, 0.35);
  drawMarks();
  gl.uniform1f(u.flatness, 0);
  const X_OL = linkPoses();
  if (X_OL && handOpacity > 0) {
    gl.uniform1f(u.shininess, 0.12);
    if (handOpacity < 1) {
      // Depth first, so that of the hand only its nearest surface is blended.
      gl.colorMask(false, false, false, false);
      drawHand(X_OL);
      gl.colorMask(true, true, true, true);
      gl.enable(gl.BLEND);
      gl.uniform1f(u.opacity, handOpacity);
    }
    drawHand(X_OL);
    gl.uniform1f(u.opacity, 1);
    gl.disable(gl.BLEND);
  }
  // Marks that something hides shine through.
  gl.enable(gl.BLEND);
  gl.depthMask(false);
  gl.depthFunc(gl.GREATER);
  gl.uniform1f(u.opacity, 0.42);
  gl.uniform1f(u.flatness, 0.5);
  drawMarks();
  gl.depthFunc(gl.LEQUAL);
  gl.uniform1f(u.opacity, 1);
  gl.uniform1f(u.shininess, 0);
  for (let column = 0; column < 4; ++column) {
    gl.vertexAttrib4fv(3 + column, kIdentity.slice(4 * column, 4 * column + 4));
  }
  drawMesh(scene.sheets);
  gl.depthMask(true);
  gl.disable(gl.BLEND);

  placeLabels(matrix, width, height, drawAxes(axes, ratio, h));
  placeScale(height);
}

// The axes of O in the lower left corner.
function drawAxes(axes, ratio, h) {
  const size = 96;
  const halfHeight = 1.35;
  gl.viewport(Math.round(6 * ratio), Math.round(6 * ratio), Math.round(size * ratio), Math.round(size * ratio));
  gl.enable(gl.SCISSOR_TEST);
  gl.scissor(Math.round(6 * ratio), Math.round(6 * ratio), Math.round(size * ratio), Math.round(size * ratio));
  gl.clear(gl.DEPTH_BUFFER_BIT);
  gl.disable(gl.SCISSOR_TEST);
  const u = scene.uniforms;
  const eye = times(axes.back, 5);
  gl.uniformMatrix4fv(u.view_projection, false, viewProjection(1, axes, eye, 1, 10, halfHeight));
  gl.uniform3fv(u.eye, times(axes.back, 100));
  const texts = [];
  ['x', 'y', 'z'].forEach((name, k) => {
    const direction = [0, 0, 0];
    direction[k] = 1;
    // Shapes without their instance arrays: the constants of constantColor apply.
    constantColor(hex(kColors[name]), alongZ([0, 0, 0], direction, 0.045, 0.75));
    drawMesh(scene.axisTube);
    constantColor(hex(kColors[name]), alongZ(times(direction, 0.72), direction, 0.12, 0.28));
    drawMesh(scene.axisCone);
    const tip = times(direction, 1.2);
    texts.push({text: name, kind: 'axis', color: kColors[name],
                 x: 6 + size / 2 * (1 + dot(tip, axes.right) / halfHeight),
                 y: h / ratio - 6 - size / 2 * (1 + dot(tip, axes.up) / halfHeight)});
  });
  return texts;
}

function placeLabels(matrix, width, height, texts) {
  const project = (p) => {
    const c = [0, 1, 3].map(
        (i) => matrix[i] * p[0] + matrix[4 + i] * p[1] + matrix[8 + i] * p[2] + matrix[12 + i]);
    return {x: (c[0] / c[2] + 1) / 2 * width, y: (1 - c[1] / c[2]) / 2 * height};
  };
  texts = texts.concat(labels(project));
  const box = byId('labels');
  while (box.children.length < texts.length) box.append(document.createElement('span'));
  while (box.children.length > texts.length) box.lastChild.remove();
  texts.forEach((label, i) => {
    const span = box.children[i];
    span.textContent = label.text;
    span.className = label.kind;
    span.style.color = label.color || '';
    span.style.transform =
        `translate(${label.x.toFixed(1)}px, ${label.y.toFixed(1)}px) translate(-50%, -50%)`;
  });
}

function placeScale(height) {
  const metersPerPixel = 2 * camera.distance * Math.tan(kFieldOfView / 2) / height;
  const wanted = 110 * metersPerPixel;
  const power = 10 ** Math.floor(Math.log10(wanted));
  const size = [5, 2, 1].map((k) => k * power).find((value) => value <= wanted) || power;
  byId('scale-bar').style.width = `${(size / metersPerPixel).toFixed(1)}px`;
  byId('scale-text').textContent =
      size >= 1 ? `${size.toPrecision(1)} m` : size >= 0.0099 ? `${Math.round(size * 100)} cm`
      : size >= 0.00099 ? `${Math.round(size * 1000)} mm` : `${(size * 1000).toPrecision(1)} mm`;
  byId('scale').title = 'In the plane through the center of view';
}

// ------------------------------------------------------------------------------------------ start

// Shows the note, makes the scene, a button for each of `views`, [name, caption, explanation], and listens; `view`
// looks along what a button's name says.
function startStage(view, views) {
  if (data.note) byId('summary').after(element('p', {id: 'note'}, data.note));
  for (const [name, caption, title] of views) {
    const button = element('button', {type: 'button', title}, caption);
    button.dataset.view = name;
    byId('up').parentElement.before(button);
  }
  byId('up').selectedIndex = camera.up;
  if (!gl) {
    say('This browser does not offer WebGL 2, so there is no picture; all numbers are here.');
    return;
  }
  makeScene();
  listenToPointers();
  canvas.addEventListener('webglcontextlost', (event) => {
    event.preventDefault();
    say('The graphics card was reset; the picture comes back when it is ready.');
  });
  canvas.addEventListener('webglcontextrestored', () => {
    say('');
    makeScene();
    updateMarks();
    draw();
  });
  // At once: in the next animation frame the old picture would have been shown stretched, its labels
  // where they no longer belong, and a screenshot may keep that.
  new ResizeObserver(() => {
    if (camera.isFitted) fit();
    if (!gl.isContextLost()) render();
  }).observe(byId('stage'));
  for (const button of document.querySelectorAll('#views button')) {
    button.addEventListener('click', () => view(button.dataset.view));
  }
  byId('up').addEventListener('change', (event) => {
    camera.up = event.target.selectedIndex;
    view('side');
  });
}
