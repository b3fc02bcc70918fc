// What the page of grasps says: its lists and tables. After grasp_scene.js.

// Contacts that are opposite each other but for rounding close exactly as rounded, with less ε.
const kRoundedEpsilon = 1e-9;
function closes(grasp) {
  return grasp.wrench.is_force_closure && grasp.wrench.epsilon > kRoundedEpsilon;
}

function listenToKeys() {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.altKey || event.metaKey) return;
    if (event.target.matches('select, input[type=range]')) return;
    const step = {ArrowDown: 1, ArrowRight: 1, ArrowUp: -1, ArrowLeft: -1}[event.key];
    if (step && data.grasps.length > 0) {
      select(Math.min(Math.max(selected + step, 0), data.grasps.length - 1));
      event.preventDefault();
    } else if (event.key === 'Home' && data.grasps.length > 0) {
      select(0);
    } else if (event.key === 'End' && data.grasps.length > 0) {
      select(data.grasps.length - 1);
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
  data.grasps.forEach((grasp, index) => {
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
    row.addEventListener('click', () => select(index));
    list.append(row);
  });
  if (data.grasps.length === 0) list.append(element('p', {className: 'soft'}, 'No grasps.'));
  const valid = data.grasps.filter((grasp) => grasp.is_valid).length;
  const usable = data.grasps.filter((grasp) => grasp.is_usable).length;
  const size = subtract(objectBounds.high, objectBounds.low).map((s) => (1000 * s).toFixed(0));
  byId('summary').textContent =
      `${data.hand.name} hand · ${data.grasps.length} grasp${data.grasps.length === 1 ? '' : 's'}, ` +
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
  panel.append(element('h2', {}, `Grasp #${selected + 1}`));
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

function select(index) {
  selected = index;
  highlighted = -1;
  const list = byId('list');
  [...list.children].forEach((row, i) => {
    row.setAttribute('aria-selected', String(i === index));
    if (i === index) {
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
