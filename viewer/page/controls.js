// What moves the camera of all pages, and what they write beside the scene: tables, switches of layers,
// sections. Stands after stage.js.

// ------------------------------------------------------------------------------------------ input

function listenToPointers() {
  const pointers = new Map();
  const pan = (dx, dy) => {
    camera.isFitted = false;
    const {right, up} = cameraAxes();
    const s = 2 * camera.distance * Math.tan(kFieldOfView / 2) / canvas.clientHeight;
    camera.target = add(camera.target, add(times(right, -dx * s), times(up, dy * s)));
  };
  const zoom = (factor) => {
    camera.isFitted = false;
    camera.distance = Math.min(Math.max(camera.distance * factor, 0.02 * sizeOfScene()), 40 * sizeOfScene());
  };
  canvas.addEventListener('pointerdown', (event) => {
    canvas.setPointerCapture(event.pointerId);
    pointers.set(event.pointerId, {x: event.clientX, y: event.clientY});
    canvas.classList.add('dragging');
  });
  const release = (event) => {
    pointers.delete(event.pointerId);
    if (pointers.size === 0) canvas.classList.remove('dragging');
  };
  canvas.addEventListener('pointerup', release);
  canvas.addEventListener('pointercancel', release);
  canvas.addEventListener('pointermove', (event) => {
    const last = pointers.get(event.pointerId);
    if (!last) return;
    const now = {x: event.clientX, y: event.clientY};
    const [dx, dy] = [now.x - last.x, now.y - last.y];
    if (pointers.size === 2) {
      const [other] = [...pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      const before = Math.hypot(last.x - other.x, last.y - other.y);
      const after = Math.hypot(now.x - other.x, now.y - other.y);
      if (after > 1) zoom(before / after);
      pan(dx / 2, dy / 2);
    } else if (event.shiftKey || event.ctrlKey || event.buttons & 6) {
      pan(dx, dy);
    } else {
      camera.azimuth -= 0.008 * dx;
      camera.elevation =
          Math.min(Math.max(camera.elevation + 0.008 * dy, -Math.PI / 2), Math.PI / 2);
    }
    pointers.set(event.pointerId, now);
    draw();
  });
  canvas.addEventListener('wheel', (event) => {
    event.preventDefault();
    const pixels = event.deltaY * (event.deltaMode === 1 ? 16 : event.deltaMode === 2 ? 400 : 1);
    zoom(Math.exp(0.0012 * Math.min(Math.max(pixels, -400), 400)));
    draw();
  }, {passive: false});
  canvas.addEventListener('contextmenu', (event) => event.preventDefault());
}

// ----------------------------------------------------------------------------------- lists, tables

// element('td', {className: 'text'}, 'children', ...)
function element(name, properties, ...children) {
  const made = Object.assign(document.createElement(name), properties);
  made.append(...children);
  return made;
}
const isNumber = (value) => typeof value === 'number' && Number.isFinite(value);
const fixed = (value, digits) => isNumber(value) ? value.toFixed(digits) : '–';
const millimeters = (meters, digits = 2) => isNumber(meters) ? (1000 * meters).toFixed(digits) : '–';
const degrees = (radians) => isNumber(radians) ? (radians * 180 / Math.PI).toFixed(1) : '–';

function measureRow(name, explanation, value, measureUnit) {
  return element('tr', {},
      element('th', {scope: 'row'}, name, element('small', {}, explanation)),
      element('td', {}, measureUnit ? `${value} ${measureUnit}` : value));
}

// A row that switches a layer on and off and shows its color.
function toggleRow(layers, key, color, shape, isOff) {
  const box = element('input', {type: 'checkbox', id: `show-${key}`, checked: layers[key]});
  box.disabled = isOff;
  box.addEventListener('change', () => {
    layers[key] = box.checked;
    updateMarks();
    draw();
  });
  const row = element('label', {className: isOff ? 'toggle off' : 'toggle'}, box);
  if (color) {
    const swatch = element('span', {className: `swatch ${shape || ''}`});
    swatch.style.background = color;
    row.append(swatch);
  }
  return row;
}
function opacitySlider() {
  const slider = element('input', {type: 'range', id: 'opacity', min: 0.1, max: 1, step: 0.05,
                                   value: handOpacity, title: 'Opacity of the hand'});
  slider.addEventListener('input', () => {
    handOpacity = Number(slider.value);
    draw();
  });
  return slider;
}

function say(text) {
  byId('message').textContent = text;
  byId('message').hidden = text === '';
}

// A section of the left column, before the layers.
function makeSection(id, caption, ...children) {
  const section = element('section', {id}, element('h2', {}, caption), ...children);
  byId('layers').before(section);
  return section;
}
