// What the report says, from the data in the page (daemon/report/page_data.cpp):
//   report   report.json itself
//   dates    the clock of the data tells dates, not seconds of a run
//   sets     [{name, start, step, samples, every, settled, boundary}]: the runs of the recordings, values
//            thinned `every`; the simulations have found their state after `settled` samples
//   inputs   [{tag, unit, new, sets: [values]}]
//   cvs      [{tag, unit, description, found, sets: [{measured, before, after, residual_before,
//            residual_after, block, rms_before, rms_after}], spectrum, levels, correlations, steps}]
//   curves   [{title, x_label, y_label, x, before, after}]
// `before` is the unit file's simulation, `after` the extended one.

const data = JSON.parse(document.getElementById('data').textContent);
const report = data.report;
const main = document.getElementById('main');
const BEFORE = 'simulated', AFTER = 'extended';

const words = text => String(text).replaceAll('->', '→');
const percent = share => known(share) ? number(100 * share, 3) + ' %' : '–';
const unitText = unit => unit ? ', ' + unit : '';
const some = (list, make) => list.length ? make(list) : null;

function clock(seconds) {
  if (!data.dates) return number(seconds, 6) + ' s';
  return new Date(seconds * 1000).toISOString().replace('T', ' ').slice(0, 19) + ' UTC';
}

// columns: [{label, number}]; rows of nodes or text.
function table(columns, rows) {
  const head = element('tr', {}, ...columns.map(column =>
    element('th', {scope: 'col', class: column.number ? 'number' : ''}, column.label)));
  const body = rows.map(cells => element('tr', {}, ...cells.map((cell, i) =>
    element('td', {class: columns[i].number ? 'number' : '', 'data-label': columns[i].label}, cell))));
  return element('table', {}, element('thead', {}, head), element('tbody', {}, ...body));
}

function section(title, ...content) {
  main.append(element('section', {}, element('h2', {}, title), ...content));
}

// --- verdict and findings ---------------------------------------------------------------------

function subjectText(item) {
  const from = item.tag || item.mv;
  return from && item.cv ? `${from} → ${item.cv}` : from || item.cv || '';
}

function verdict() {
  const glyph = {match: '✓', mismatch: '▲', undetermined: '?'}[report.verdict];
  const last = data.sets[0].start + data.sets[0].step * (data.sets[0].samples - 1);
  const when = report.used ? report.used.map(({from, until}) => `${clock(from)} to ${clock(until)}`).join(', ')
    : `${clock(data.sets[0].start)} to ${clock(last)}`;
  document.getElementById('verdict').append(element('p', {}, report.details), element('p', {},
      element('span', {class: 'badge ' + report.verdict}, glyph + ' ' + report.verdict),
      element('span', {class: 'muted'}, `${report.samples} samples from ${when}; ` +
        `${report.fit_samples} fitted, ${report.validation_samples} kept to measure the gain`)),
      ...(report.data || []).map(note => element('p', {}, element('span', {class: 'badge warn'}, note.compressed ? 'compressed' : 'coarse'), `${note.tag}: ${note.advice}`)));
}

function parameterTable(finding) {
  const rows = Object.entries(finding.parameters).map(([name, value]) => {
    const interval = finding.interval[name];
    const unit = (finding.units[name] || '').replace('x model', '× model');
    const text = typeof value === 'string' ? value.replaceAll('_', ' ')
      : name === 'onset' ? clock(value) : `${number(value)} ${unit}`;
    return [name.replaceAll('_', ' '), text, interval ? `${number(interval[0])} to ${number(interval[1])}` : ''];
  });
  return rows.length ? table([{label: 'parameter'}, {label: 'plant', number: true}, {label: '95 % interval', number: true}], rows) : null;
}

function rivalList(finding) {
  if (!finding.rivals.length) return 'no other explanation comes near';
  return element('ul', {}, ...finding.rivals.map(rival =>
    element('li', {}, rival.inseparable ? element('span', {class: 'badge warn'}, 'cannot be told apart') : null, words(rival.text))));
}

function findingCard(finding, label, refused) {
  const facts = element('dl');
  const fact = (name, value) => facts.append(element('dt', {}, name), element('dd', {}, value));
  fact('Confidence', `${finding.confidence > 0.999 ? 'more than 99.9 %' : percent(finding.confidence)} among the causes considered`);
  fact('Evidence', `2 ln odds ${number(finding.evidence, 3)} against the same model without it`);
  fact('Since', finding.onset === null ? 'the beginning of the data, or before' : clock(finding.onset));
  fact('Rivals', rivalList(finding));
  return element('div', {class: 'finding' + (refused ? ' refused' : '')},
      element('h3', {}, `${label}${finding.title}: ${subjectText(finding)}`),
      refused || finding.refused ? element('p', {},
          refused ? element('span', {class: 'badge warn'}, 'refused') : null,
          `Not in the extended model: ${finding.refused || 'its repair did not carry over'}.`) : null,
      finding.with ? element('p', {},
          `In the extended model only together with: ${words(finding.with.text)}.`) : null,
      element('p', {}, finding.explanation), parameterTable(finding), facts);
}

function findings() {
  const cards = report.findings.map((finding, i) => findingCard(finding, `${i + 1}. `, false));
  const refused = report.refused.map(finding => findingCard(finding, '', true));
  if (!cards.length) cards.push(element('p', {}, report.reason || 'No cause was found.'));
  section('Findings', ...cards, ...refused, some(report.unexplained, list => element('div', {},
      element('h3', {}, 'There, but without a name'),
      element('ul', {}, ...list.map(left => element('li', {}, left.text))))));
}

// --- tables -----------------------------------------------------------------------------------

// An interval of a share on a line from -20 % to 100 %.
function rangeBar(low, high) {
  const at = share => 4 + 142 * (Math.min(Math.max(share, -0.2), 1) + 0.2) / 1.2;
  const svg = drawn('svg', {class: 'range', width: 150, height: 12, viewBox: '0 0 150 12', 'aria-hidden': 'true'});
  svg.append(drawn('line', {x1: 4, x2: 146, y1: 6, y2: 6}), drawn('line', {class: 'bar', x1: at(low), x2: Math.max(at(high), at(low) + 2), y1: 6, y2: 6}),
      drawn('line', {class: 'zero', x1: at(0), x2: at(0), y1: 1, y2: 11}));
  return svg;
}

const fitText = score => score.fit_before === score.fit_after ? `${score.fit_before.toFixed(1)} %`
  : `${score.fit_before.toFixed(1)} → ${score.fit_after.toFixed(1)} %`;

function gains() {
  if (!report.validation.length) return;
  const columns = [{label: 'CV'}, {label: 'RMSE ' + BEFORE, number: true}, {label: 'RMSE ' + AFTER, number: true},
    {label: 'fit ' + BEFORE, number: true}, {label: 'fit ' + AFTER, number: true}, {label: 'error less by (95 %)', number: true}, {label: ''}];
  const fit = value => known(value) ? value.toFixed(1) + ' %' : '–';
  const rows = report.validation.map(score => {
    const [low, high] = score.gain_interval;
    const interval = score.refused ? 'tried, refused' : low === high ? 'unchanged' : `${number(100 * low, 3)} to ${number(100 * high, 3)} %`;
    const unit = score.unit ? ' ' + score.unit : '';
    return [score.cv, number(score.rmse_before) + unit, number(score.rmse_after) + unit, fit(score.fit_before), fit(score.fit_after), interval,
      score.refused || low === high ? '' : rangeBar(low, high)];
  });
  section('Gain', element('p', {}, `Free-running simulation, driven by the measured inputs, on the ${report.validation_samples} samples that no fit has seen. ` +
      'fit = 100 (1 − |y − simulated| / |y − mean of y|). The interval is a block bootstrap’s; the line beside it goes from −20 to 100 %.'), table(columns, rows));
}

function closedLoop() {
  const loop = report.closed_loop;
  if (!loop) return;
  const change = (before, after) => before > 0 ? `${number(100 * (after / before - 1), 3)} %` : '–';
  section('In closed loop', element('p', {}, `The simulator’s controller on the plant of scenario “${loop.scenario}”, with the unit file’s model and with the extended one: ` +
      `${loop.seeds.length} × ${loop.samples} samples, seeds ${loop.seeds.join(', ')}, the same for both.` +
      (loop.inputs_left_out.length ? ` Without ${loop.inputs_left_out.join(', ')}, which the simulated plant does not measure for its controller.` : '')), element('div', {class: 'narrow'},
      table([{label: 'CV'}, {label: 'variance of SP − CV before', number: true}, {label: 'after', number: true}, {label: 'change', number: true}],
        loop.cvs.map(cv => [cv.cv, number(cv.error_variance_before), number(cv.error_variance_after), change(cv.error_variance_before, cv.error_variance_after)])),
      table([{label: 'MV'}, {label: 'time at a limit before', number: true}, {label: 'after', number: true}],
        loop.mvs.map(mv => [mv.mv, percent(mv.at_limit_before), percent(mv.at_limit_after)]))));
}

function madeBy() {
  const made = report.made_by;
  const fact = (name, value) => [name, value === null || value === '' ? '–' : String(value)];
  section('How this was made', element('p', {}, element('code', {}, made.command)),
      table([{label: 'what'}, {label: 'value'}], [
        fact('program', made.program), fact('unit file', made.config), fact('data', made.data), fact('data kept for measuring', made.validation_data || `the last part of ${made.data}`),
        fact('samples', `${report.samples}, ${report.fit_samples} fitted, ${report.validation_samples} to measure the gain`),
        fact('share that is fitted', percent(made.fit_share)), fact('seed of the resampling', made.seed),
      ]), some(made.notices, list => element('ul', {class: 'note'}, ...list.map(text => element('li', {}, text)))),
      element('p', {class: 'note'}, 'extended.yaml beside this page is the unit file with the extended model; report.json holds all numbers.'));
}

// --- plots ------------------------------------------------------------------------------------

const timeAxis = set => ({label: data.dates ? `UTC, from ${clock(set.start).slice(0, 10)}` : 'time, s', unit: 's', kind: data.dates ? 'date' : 'linear',
  min: set.start, max: set.start + set.step * set.samples});

// Times of thinned values: two per run of `every` samples.
function times(set, count) {
  const value = i => set.every === 1 ? i : Math.floor(i / 2) * set.every + (i % 2) * set.every / 2;
  return Array.from({length: count}, (_, i) => set.start + set.step * value(i));
}

function unseen(set) {
  const end = set.start + set.step * set.samples;
  if (set.boundary !== null) return [set.boundary, end];
  return report.made_by.validation_data !== null && set === data.sets.at(-1) ? [set.start, end] : null;
}

function onsets(cv, set) {
  const end = set.start + set.step * set.samples;
  return report.findings.filter(finding => (finding.cv === cv.tag || !finding.cv) && finding.onset !== null && finding.onset >= set.start && finding.onset <= end)
    .map(finding => ({x: finding.onset, label: finding.title.toLowerCase()}));
}

function pair(x, before, after, more = {}) {
  return [{name: BEFORE, role: 'before', x, y: before, ...more}, {name: AFTER, role: 'after', x, y: after, ...more}];
}

function timePlots(cv, set, index) {
  const values = cv.sets[index];
  const x = times(set, values.measured.length);
  const common = {group: 'time' + index, x: timeAxis(set), unseen: unseen(set), marks: onsets(cv, set), settled: set.start + set.step * set.settled};
  const name = data.sets.length > 1 ? ` (${set.name})` : '';
  const blocks = values.rms_before.map((_, i) => set.start + set.step * Math.min((i + 0.5) * values.block, set.samples));
  const shaded = common.unseen ? 'Shaded: no fit has seen it.' : '';
  const thin = set.every > 1 ? ` Least and greatest of every ${set.every} samples.` : '';
  return [
    plot({...common, title: cv.tag + name, note: shaded + thin, height: 250, y: {label: cv.tag + unitText(cv.unit)},
      lines: [{name: 'measured', role: 'measured', x, y: values.measured}, ...pair(x, values.before, values.after)]}),
    plot({...common, title: `Residual of ${cv.tag}`, note: 'Measured minus simulation.', height: 170, y: {label: 'residual' + unitText(cv.unit)},
      lines: pair(x, values.residual_before, values.residual_after)}),
    plot({...common, title: 'Over time', note: `RMS of the residual, ${values.block} samples at a time.`, height: 150, y: {label: 'RMS' + unitText(cv.unit), min: 0},
      lines: pair(blocks, values.rms_before, values.rms_after, {dots: true})}),
  ];
}

function spectrumPlot(cv) {
  const {frequency, measured, before, after} = cv.spectrum;
  return plot({title: 'Over frequency', note: 'Spectrum of the residual beside the CV’s own.', height: 240,
    x: {label: 'frequency, 1/s', unit: '1/s', kind: 'log'}, y: {label: `(${cv.unit || cv.tag})² s`, kind: 'log'},
    lines: [{name: cv.tag, role: 'measured', x: frequency, y: measured}, ...pair(frequency, before, after)]});
}

function levelPlots(cv) {
  const top = Math.max(...cv.levels.flatMap(level => [...level.rms_before, ...level.rms_after]).filter(known), 0);
  const bottom = Math.min(...cv.levels.flatMap(level => [...level.mean_before, ...level.mean_after]).filter(known), 0);
  return cv.levels.filter(level => level.level.length > 1).map(level => plot({
    title: `Over ${level.tag}`, note: 'Residual’s RMS (line) and mean (dashed) by level.', height: 200,
    x: {label: level.tag + unitText(level.unit), unit: level.unit}, y: {label: 'residual' + unitText(cv.unit), min: bottom, max: top},
    lines: [...pair(level.level, level.rms_before, level.rms_after, {dots: true}), ...pair(level.level, level.mean_before, level.mean_after, {dashed: true})
      .map(line => ({...line, name: 'mean', quiet: true}))]}));
}

function correlationPlots(cv) {
  const shown = cv.correlations.filter(each => each.before.length > 0);
  const top = Math.max(...shown.flatMap(each => [...each.before, ...each.after]).filter(known).map(Math.abs), 0);
  return shown.map(each => {
    const lags = each.before.map((_, i) => each.first_lag + i * each.group);
    return plot({title: `${each.tag} → residual`, note: each.group > 1 ? `means of ${each.group} lags` : '', height: 200, bound: each.bound, marks: [{x: 0, label: 'feedback', left: true}],
      x: {label: 'lag, samples', unit: 'samples'}, y: {label: 'correlation', min: -top, max: top},
      lines: pair(lags, each.before, each.after.length ? each.after : lags.map(() => null))});
  });
}

function stepPlots(cv) {
  return cv.steps.map(step => {
    const x = step.before.map((_, i) => i * step.step);
    const per = `${cv.unit || cv.tag} per ${step.input_unit || step.input}`;
    return plot({title: `${step.input} → ${cv.tag}`, note: `Step of ${step.size} ${step.input_unit}`, height: 210,
      x: {label: 'time after the step, s', unit: 's'}, y: {label: per},
      band: step.low.length ? {x, low: step.low, high: step.high} : null,
      lines: pair(x, step.before, step.after).map((line, i) => ({...line, dashed: i === 0}))});
  });
}

const small = plots => element('div', {class: 'small'}, ...plots);

function fillCv(cv, body) {
  body.append(...data.sets.flatMap((set, i) => timePlots(cv, set, i)));
  body.append(element('h3', {}, 'Where it goes wrong: frequency and operating range'),
      element('p', {class: 'note'}, `Without the first ${data.sets.at(-1).settled} samples${data.sets.length > 1 ? ' of each run' : ''}, in which the simulations find their state.`), small([spectrumPlot(cv), ...levelPlots(cv)]));
  const correlations = correlationPlots(cv);
  if (correlations.length) body.append(element('h3', {}, 'What the residual goes with'),
      element('p', {class: 'note'}, 'Correlation of the residual with each input some samples earlier, both filtered so that the input is white: its shape is that of the error’s impulse response. ' +
        'Grey: ± 2/√N, which chance leaves at one point in twenty. Lags of 0 and less show the controller’s feedback, not the model.'), small(correlations));
  if (cv.steps.length) body.append(element('h3', {}, 'Step responses'),
      element('p', {class: 'note'}, 'From the operating point, per unit of the input. Band: what the 95 % intervals of this channel’s gain, time constant and dead time allow, each refitted with everything else.'),
      small(stepPlots(cv)));
}

// Plots are made when they are first seen; a closed unit of twenty CVs costs nothing.
function cvPanels() {
  const anyFound = data.cvs.some(cv => cv.found);
  const panels = data.cvs.map((cv, i) => {
    const open = anyFound ? cv.found : i < 3;
    const score = report.validation[i];
    const label = [cv.tag, element('span', {class: 'muted'}, [cv.description && ` ${cv.description}`, !cv.found && ' – nothing found here',
      score && known(score.fit_before) && ' – fit ' + fitText(score)].filter(Boolean).join(''))];
    const body = element('div');
    const panel = element('details', open ? {open: ''} : {}, element('summary', {}, ...label), body);
    const fill = () => { if (panel.open && !body.firstChild) fillCv(cv, body); };
    panel.addEventListener('toggle', fill);
    panel.fill = fill;
    return panel;
  });
  section('CV by CV', element('p', {class: 'note screen'}, 'Drag across a plot to zoom all plots of the same time, double-click to see all again. ' +
      'With the keyboard: Tab to a plot, arrows move the cursor, + and − zoom, 0 shows all.'), ...panels);
  panels.forEach(panel => panel.fill());
}

function inputPlots() {
  const plots = data.sets.flatMap((set, i) => data.inputs.map(input => plot({
    title: input.tag + (input.new ? ' (new to the model)' : ''), group: 'time' + i, height: 130, x: timeAxis(set), unseen: unseen(set),
    y: {label: input.unit || input.tag}, lines: [{name: 'measured', role: 'measured', x: times(set, input.sets[i].length), y: input.sets[i]}]})));
  section('Inputs', ...plots);
}

function curves() {
  if (!data.curves.length) return;
  section('Static curves', small(data.curves.map(curve => plot({title: curve.title, height: 240,
    x: {label: curve.x_label, min: Math.min(...curve.x), max: Math.max(...curve.x)}, y: {label: curve.y_label},
    lines: pair(curve.x, curve.before, curve.after).map((line, i) => ({...line, dashed: i === 0, loop: true}))}))));
}

// On paper everything is open and plots are as wide as the paper, so that their text stays legible.
function onPaper(paper) {
  document.body.classList.toggle('paper', paper);
  for (const panel of document.querySelectorAll('details')) {
    if (paper) panel.wasOpen = panel.open;
    panel.open = paper || panel.wasOpen;
    panel.fill();
  }
  redrawAll();
}

verdict();
findings();
gains();
cvPanels();
curves();
inputPlots();
closedLoop();
madeBy();
window.addEventListener('beforeprint', () => onPaper(true));
window.addEventListener('afterprint', () => onPaper(false));
