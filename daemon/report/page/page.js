// The page, from its data (diagnosis_page.cpp, identification_page.cpp); what it has not is left out:
//   kicker, verdict, sentence, details, data, zone, warnings: texts
//   matrix      {inputs, rows: [{tag, cells: [{state, text, findings: [{number, text}]}]}]}
//   numbers     {rows: [{cv, input, changed, gain, time_constant, dead_time}], csv, yaml}
//   views       [{title, finding, plots}]
//   findings    [{title, place, in_model, text, numbers, facts, plots}]
//   responses   plots of an identification; unexplained, refused, plan: texts
//   control     {text, cvs: {columns, rows}, mvs: {columns, rows}, note}
//   errors      [[cv, before, after, less by, fit before, fit after]]
//   closed_loop {text, rows}
//   cvs         [{tag, description, plots, errors}]; inputs: plots
//   chapters    [{title, text: paragraphs, tables: [{title, columns, rows, note}], plots: small ones side
//               by side, groups: [{title, plots above each other}], made: [[what, command]]}]
//   made_by     [[name, text]]; odds: what the words for them mean

const page = JSON.parse(document.getElementById('data').textContent);
const main = document.getElementById('main');
setZone(page.zone || 'UTC');

const paragraph = (text, name) => text ? element('p', name ? {class: name} : {}, text) : null;
const some = (list, make) => list && list.length ? make(list) : null;
const anchor = number => `finding-${number}`;

function table(name, columns, rows) {
  const cellOf = (cell, i) => element('td', {'data-label': columns[i], class: i > 0 ? 'number' : ''}, ...[cell].flat());
  return element('table', {class: name},
      element('thead', {}, element('tr', {}, ...columns.map((column, i) => element('th', {scope: 'col', class: i > 0 ? 'number' : ''}, column)))),
      element('tbody', {}, ...rows.map(row => element('tr', {class: row.name || ''}, ...(row.cells || row).map(cellOf)))));
}

function section(title, ...content) {
  const node = element('section', {}, title ? element('h2', {}, title) : null, ...content);
  main.append(node);
  return node;
}

function pairs(rows) {
  return element('dl', {}, ...rows.flatMap(([name, text]) => [element('dt', {}, name), element('dd', {}, text)]));
}

// --- first screen -----------------------------------------------------------------------------

function head() {
  const header = document.querySelector('header');
  const sentence = header.querySelector('h1');
  sentence.textContent = sentence.textContent.replaceAll(' → ', '\u00a0→\u00a0');  // no line begins with an arrow
  header.append(...[paragraph(page.details), paragraph(page.data, 'note')].filter(Boolean));
  if (page.warnings && page.warnings.length)
    header.append(element('div', {class: 'warnings'}, ...page.warnings.map(text => {
      const [word, ...rest] = text.split(': ');
      return element('p', {}, element('b', {}, word + ': '), rest.join(': '));
    })));
}

const GLYPHS = {wrong: '▲', doubt: '?', right: '✓', none: ''};
const STATES = page.responses ? {doubt: 'left out', right: 'identified'}
  : {wrong: 'a finding', doubt: 'in doubt, or not told by the data', right: 'as modelled'};

function matrix() {
  if (!page.matrix) return null;
  const {inputs, rows} = page.matrix;
  const glyph = state => element('span', {class: 'glyph', 'aria-hidden': 'true'}, GLYPHS[state]);
  const cell = (each, i) => {
    const text = each.findings ? each.findings.map(({number, text}) => element('a', {href: '#' + anchor(number)},
        ...text.split(', ').map((part, i, all) => element('span', {}, part + (i + 1 < all.length ? ', ' : '')))))
      : [each.text || element('span', {class: 'heard'}, STATES[each.state] || 'no channel')];
    return element('td', {class: each.state, 'data-label': inputs[i]}, GLYPHS[each.state] ? glyph(each.state) : '',
        element('div', {}, ...text));
  };
  const seen = Object.keys(STATES).filter(state => rows.some(row => row.cells.some(each => each.state === state)));
  return element('div', {}, element('div', {class: 'scroll'}, element('table', {class: 'matrix', id: 'matrix'},
      element('thead', {}, element('tr', {}, element('td', {}), ...inputs.map(tag => element('th', {scope: 'col'}, tag)))),
      element('tbody', {}, ...rows.map(row =>
        element('tr', {}, element('th', {scope: 'row'}, row.tag), ...row.cells.map(cell)))))),
      element('p', {class: 'tools note'}, ...seen.map(state => element('span', {}, glyph(state), STATES[state]))));
}

function copyButton(name, text) {
  const button = element('button', {type: 'button', 'data-copy': name}, `Copy ${name}`);
  button.addEventListener('click', async () => {
    let done = true;
    try {
      await navigator.clipboard.writeText(text);
    } catch {  // a page from a file may not, in some browsers
      const area = element('textarea', {class: 'heard'});
      area.value = text;
      document.body.append(area);
      area.select();
      done = document.execCommand('copy');
      area.remove();
    }
    button.textContent = done ? 'Copied' : 'Not allowed here';
    setTimeout(() => { button.textContent = `Copy ${name}`; }, 1500);
  });
  return button;
}

// Old above new: the new one is what is typed.
function numbers() {
  const {rows, csv, yaml} = page.numbers || {rows: []};
  if (!rows.length) return null;
  const anyOld = rows.some(row => [row.gain, row.time_constant, row.dead_time].some(each => each.old !== '–'));
  const value = each => {
    if (each.new === '–' && each.old === '–') return element('span', {class: 'muted'}, '–');
    const small = [each.interval, each.unit].filter(Boolean).join(' ');
    return [
      each.changed && each.old !== '–' ? element('s', {}, each.old) : null,
      element(each.changed && anyOld ? 'strong' : 'span', {}, each.new),
      small ? element('span', {class: 'range'}, small) : null,
    ].filter(Boolean);
  };
  // Broken behind the arrow, not within a tag.
  const channel = each => element('span', {}, element('span', {class: 'tag'}, `${each.input} →`), ' ', element('span', {class: 'tag'}, each.cv));
  const row = each => ({name: each.changed ? 'changed' : '', cells: [channel(each), value(each.gain), value(each.time_constant), value(each.dead_time)]});
  const columns = ['channel', 'gain', 'time constant', 'dead time'];
  const changed = rows.filter(each => each.changed), same = rows.filter(each => !each.changed);
  const shown = changed.length ? changed : rows;
  return element('div', {id: 'numbers'}, table('numbers', columns, shown.map(row)),
      changed.length && same.length ? element('details', {class: 'plain'}, element('summary', {}, `${same.length} others, within 5 % of the unit file’s`), table('numbers', columns, same.map(row))) : null,
      element('p', {class: 'tools'}, yaml ? copyButton('YAML', yaml) : null, copyButton('CSV', csv),
        element('span', {class: 'note'}, (anyOld && changed.length ? 'Struck out: the unit file’s. ' : '') + 'Small: 95 % interval.')));
}

// Plots of one axis above each other: the last one has its ticks.
function stack(plots, options = {}) {
  return plots.map((plot, i) => {
    const below = plots[i + 1], bare = below !== undefined && below.group === plot.group && !below.title;
    return figure({...plot, bare}, {...options, ...(i ? {keys: false, title: plot.title} : {})});
  });
}

function views() {
  if (!page.views || !page.views.length) return;
  const shown = page.views.map((view, i) => {
    const title = view.finding ? `${view.finding} ${view.title}` : view.title;
    return element('div', {class: 'view'}, ...stack(view.plots, {title, keys: i === 0}));
  });
  main.append(element('section', {id: 'views', class: 'grid'}, ...shown));
}

function firstScreen() {
  const parts = [matrix(), numbers()].filter(Boolean);
  if (parts.length) main.append(element('section', {class: 'first'}, ...parts));
  views();
}

// --- findings ---------------------------------------------------------------------------------

function findingCard(finding, i) {
  const rows = finding.numbers;  // none where the sentence has them
  const text = element('div', {class: 'said'}, paragraph(finding.text), pairs(finding.facts),
      some(rows, () => table('plain', ['', 'plant', '95 % interval'], rows)));
  return element('article', {id: anchor(i + 1), class: finding.in_model ? '' : 'outside'},
      element('h3', {}, `${i + 1} ${finding.title}: ${finding.place}`),
      element('div', {class: 'beside'}, text,
        some(finding.plots, plots => element('div', {class: 'pictures'}, ...plots.map((plot, k) => figure(plot, {keys: k === 0 || plot.lines.length !== plots[0].lines.length}))))));
}

function fold(title, texts) {
  return some(texts, list => element('details', {class: 'plain'}, element('summary', {}, `${title} (${list.length})`),
      element('ul', {}, ...list.map(text => element('li', {}, text)))));
}

function findings() {
  const folds = [fold('There, but without a name', page.unexplained), fold(page.responses ? 'Left out, and why' : 'Tried and refused', page.refused)].filter(Boolean);
  if (page.responses) {
    section('Step responses', some(page.responses, plots => element('div', {class: 'grid three'}, ...plots.map((plot, i) => figure(plot, {keys: i === 0})))),
        ...folds, page.plan ? element('pre', {}, page.plan) : null);
    return;
  }
  if (!page.findings || !page.findings.length && !folds.length) return;
  section('Findings', ...page.findings.map(findingCard), ...folds);
}

function control() {
  if (!page.control) return;
  const {text, cvs, mvs, note} = page.control;
  const body = () => [paragraph(text), ...[cvs, mvs].map(each => table('wide', each.columns, each.rows)), paragraph(note, 'note')];
  main.append(element('section', {id: 'control'}, panel('Control', 'errors, limits and predictions over the whole recording', body)));
}

// --- the rest ---------------------------------------------------------------------------------

function errors() {
  if (!page.errors || !page.errors.length) return;
  section('Error of the simulation', table('wide', ['CV', 'simulated', 'extended', 'less by', 'fit, simulated', 'fit, extended'], page.errors),
      paragraph('RMS of the free run, driven by the measured inputs, on samples that no fit has seen. “Less by” is a 95 % interval. ' +
        'Fit: 100 % is perfect, 0 % no better than the mean.', 'note'));
}

function closedLoop() {
  if (!page.closed_loop) return;
  section('In closed loop', table('wide', ['', 'of', 'simulated', 'extended'], page.closed_loop.rows), paragraph(page.closed_loop.text, 'note'));
}

// Drawn when first opened: a closed unit of twenty CVs costs nothing.
function panel(title, note, make, open) {
  const body = element('div');
  const node = element('details', open ? {open: ''} : {}, element('summary', {}, title, note ? element('span', {class: 'muted'}, ' ' + note) : null), body);
  node.fill = () => { if (node.open && !body.firstChild) body.append(...make()); };
  node.addEventListener('toggle', node.fill);
  node.fill();
  return node;
}

// A story in sections, each with its tables and figures and, folded, the commands that made them.
function chapters() {
  for (const {title, text = [], tables = [], plots = [], groups = [], made = []} of page.chapters || [])
    section(title, ...text.map(each => paragraph(each)),
        ...tables.flatMap(each => [element('h3', {}, each.title), table('wide told', each.columns, each.rows), paragraph(each.note, 'note')].filter(Boolean)),
        some(plots, list => element('div', {class: 'grid four'}, ...list.map((plot, i) =>
          plot.lines ? figure(plot, {keys: i === 0, height: 150}) : element('div', {class: 'note'}, element('b', {}, plot.title), element('p', {}, plot.text))))),
        some(groups, list => element('div', {class: 'grid'}, ...list.map(group => element('div', {class: 'view'}, element('h3', {}, group.title), ...stack(group.plots))))),
        some(made, rows => panel('How this was made', '', () => [element('div', {class: 'made'}, pairs(rows.map(([what, command]) => [what, element('code', {}, command)])))])));
}

function record() {
  if (!page.cvs) return;
  const panels = page.cvs.map(cv => panel(cv.tag, cv.description, () => [
    ...stack(cv.plots),
    cv.errors.length ? panel('Where the error is', 'over frequency and range, and with which input', () =>
      [element('div', {class: 'grid three'}, ...cv.errors.map((plot, i) => figure(plot, {keys: i === 0, height: 180})))]) : null].filter(Boolean)));
  if (page.inputs.length) panels.push(panel('Inputs', '', () => page.inputs.map(plot => figure(plot))));
  if (panels.length) section('The whole record', ...panels, element('p', {class: 'note screen'},
      'Drag across a plot to zoom, double-click to see all again; with the keyboard, arrows move the cursor and 0 shows all.'));
}

function madeBy() {
  const plots = [...(page.views || []), ...(page.cvs || [])].flatMap(each => each.plots);
  section('How this was made', element('div', {class: 'made'}, pairs(page.made_by)),
      element('p', {class: 'note'}, [page.odds ? `Odds in words: ${page.odds}.` : '',
        page.zone ? `Times are in ${page.zone}.` : 'The data carry no dates: times are counted from their clock’s zero.',
        plots.some(plot => 'unseen' in plot) ? 'Shaded in plots: data that no fit has seen.' : '',
        page.findings ? '“How the error goes with” an input: their correlation at each lag, both filtered so that the input is white; grey is what chance leaves at one lag in twenty, left of 0 is feedback.' : ''].filter(Boolean).join(' ')));
}

// On paper everything is open, and plots are as wide as the paper.
function onPaper(paper) {
  document.documentElement.classList.toggle('paper', paper);
  for (let more = true; more;) {  // a panel may hold others
    more = false;
    for (const each of document.querySelectorAll('details')) {
      if (paper && !each.open) { each.wasClosed = more = each.open = true; if (each.fill) each.fill(); }
      if (!paper && each.wasClosed) each.wasClosed = each.open = false;
    }
  }
  for (const each of document.querySelectorAll('figure')) each.make();
  redrawAll();
}

head();
firstScreen();
findings();
control();
errors();
closedLoop();
chapters();
record();
madeBy();
matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redrawAll);
matchMedia('print').addEventListener('change', event => onPaper(event.matches));
window.addEventListener('beforeprint', () => onPaper(true));
window.addEventListener('afterprint', () => onPaper(false));
