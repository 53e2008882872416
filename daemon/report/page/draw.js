'use strict';
// Plots with uPlot, from what plot_json.cpp writes:
//   {title, note, x, y, lines, bands, marks, unseen, group, low, paths}
//   x      {clock | label, stretches: [[start, step, count], ...]}, seconds; an unknown value stands
//          between two stretches; or {label, values, log}
//   y      {label, log}
//   lines  [{name, role: measured | before | after | ..., values, dashed, points, x}]
//   bands  [{role, low, high}]; marks [{x, label}]; unseen: shaded from here on
//   group  plots that share zoom and cursor; paths: x goes back, each line has its own
// and, where values come later (the operator page):
//   ends   [first, last] of x, where that is not what the values have
//   onZoom called with the stretch that was chosen, or with null for all, instead of zooming
// Colours are those of the style sheet, read when something is drawn.

function element(name, attributes, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) node.setAttribute(key, value);
  node.append(...children.filter(child => child !== null && child !== undefined));
  return node;
}

const drawnPlots = new Set();
const colour = name => getComputedStyle(document.documentElement).getPropertyValue('--' + name).trim();
const font = () => `11px ${getComputedStyle(document.body).fontFamily}`;
const known = value => value !== null && Number.isFinite(value);

function number(value, digits = 4) {
  if (!known(value)) return '–';
  const size = Math.abs(value);
  const text = size !== 0 && (size < 1e-4 || size >= 1e7)
    ? value.toExponential(Math.max(0, digits - 3)) : String(Number(value.toPrecision(digits)));
  return text.replaceAll('-', '−');
}

// --- time -------------------------------------------------------------------------------------

const MINUTE = 60, HOUR = 3600, DAY = 86400;
const UNITS = [['days', DAY], ['h', HOUR], ['min', MINUTE], ['s', 1]];
const unitOf = span => UNITS.find(([, seconds]) => span >= 2 * seconds) || UNITS.at(-1);
const INCREMENTS = [-3, -2, -1, 0, 1, 2, 3, 4, 5].flatMap(power => [1, 2, 5].map(digit => digit * 10 ** power));

// The zone of the data; a browser that does not know it shows UTC.
let zone = 'UTC';
function setZone(name) {
  try {
    new Intl.DateTimeFormat('en', {timeZone: name});
    zone = name;
  } catch { zone = 'UTC'; }
}
const localDate = seconds => uPlot.tzDate(new Date(seconds * 1e3), zone);
const DATE = uPlot.fmtDate('{D} {MMM} {YYYY} {HH}:{mm}:{ss}');
// [from this step on, always, when the year, month, day, hour, minute, second turns, which go together]
const TICKS = [
  [365 * DAY, '{YYYY}', null, null, null, null, null, null, 1],
  [28 * DAY, '{MMM}', '\n{YYYY}', null, null, null, null, null, 1],
  [DAY, '{D} {MMM}', '\n{YYYY}', null, null, null, null, null, 1],
  [MINUTE, '{HH}:{mm}', '\n{D} {MMM} {YYYY}', null, '\n{D} {MMM}', null, null, null, 1],
  [0.001, '{HH}:{mm}:{ss}', '\n{D} {MMM} {YYYY}', null, '\n{D} {MMM}', null, null, null, 1],
];

const dated = plot => Boolean(plot.x.clock && page.zone);

// --- values -----------------------------------------------------------------------------------

function positions(x) {
  if (x.values) return x.values;
  return x.stretches.flatMap(([start, step, count], i) => {
    const own = Array.from({length: count}, (_, k) => start + k * step);
    return i ? [start - step / 2, ...own] : own;  // where the value is unknown
  });
}

// Lines by size: two models as strong lines, the measured one thin and on top of them, so that none
// hides another.
const WIDTH = {measured: 1, before: 2, after: 2, prediction: 2, setpoint: 1, limit: 1, input: 1};
const ORDER = {limit: -2, setpoint: -1, before: 0, after: 1, prediction: 1, input: 1, measured: 2};

function series(line) {
  const stroke = () => colour(line.role);
  const one = {label: line.name, stroke, width: WIDTH[line.role], spanGaps: false, points: {show: false}};
  if (line.dashed) Object.assign(one, {dash: [3, 4], width: 1});
  if (line.points) Object.assign(one, {paths: () => null, points: {show: true, size: 4, fill: stroke, width: 0}});
  return one;
}

const translucent = (role, share) => `color-mix(in srgb, ${colour(role)} ${share}%, transparent)`;

// --- a plot -----------------------------------------------------------------------------------

// Of a logarithmic axis the decades alone; null is a tick that the plot has no room for.
const tickText = (tick, log) => !known(tick) || log && Math.abs(Math.log10(tick) % 1) > 1e-9 ? '' : number(tick);

function axes(plot, range) {
  const bare = plot.bare;  // the plot below it has the axis
  const common = {stroke: () => colour('muted'), font: font(), grid: {stroke: () => colour('grid'), width: 1},
    ticks: {show: false}, border: {show: false}};
  const x = {...common, space: 70, size: 20, gap: 4};
  if (bare) Object.assign(x, {size: 6, values: (_, ticks) => ticks.map(() => '')});
  if (dated(plot)) {
    if (!bare) Object.assign(x, {values: TICKS, size: 36});
  } else if (plot.x.stretches) {
    const [name, seconds] = unitOf(range);
    x.incrs = INCREMENTS.map(each => each * seconds);
    if (!bare) {
      x.values = (_, ticks) => ticks.map(tick => number(tick / seconds));
      x.label = `${plot.x.label || 'time'}, ${name}`;
    }
  } else {
    x.values = (_, ticks) => ticks.map(tick => tickText(tick, plot.x.log));
    x.label = plot.x.label;
  }
  if (x.label) Object.assign(x, {labelSize: 18, labelGap: 0, labelFont: font()});
  const widest = values => Math.max(...(values || []).map(text => String(text ?? '').length));
  // Plots of one group stand above each other.
  const y = {...common, size: (_, values) => plot.group ? 54 : 12 + 6.4 * Math.max(3, widest(values)),
    space: plot.low ? 22 : 32, gap: 4,
    values: (_, ticks) => ticks.map(tick => tickText(tick, plot.y.log))};
  return [x, y];
}

// What uPlot has no word for: shading, marks, bands and paths.
function extras(plot, lines) {
  const shade = u => {
    const {ctx, bbox} = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    if (known(plot.unseen)) {
      const from = u.valToPos(plot.unseen, 'x', true);
      ctx.fillStyle = colour('shade');
      ctx.fillRect(from, bbox.top, bbox.left + bbox.width - from, bbox.height);
    }
    for (const band of plot.bands || []) fillBand(u, band);
    ctx.restore();
  };
  const over = u => {
    const {ctx, bbox} = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    if (plot.paths) for (const line of lines) strokePath(u, line);
    ctx.font = `${11 * devicePixelRatio}px ${getComputedStyle(document.body).fontFamily}`;
    for (const mark of plot.marks || []) {
      const x = u.valToPos(mark.x, 'x', true);
      ctx.strokeStyle = ctx.fillStyle = colour('ink');
      ctx.setLineDash([4 * devicePixelRatio, 3 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      const late = x > bbox.left + 0.7 * bbox.width;
      ctx.textAlign = late ? 'right' : 'left';
      ctx.textBaseline = 'top';
      ctx.fillText(mark.label, x + (late ? -5 : 5) * devicePixelRatio, bbox.top + 3 * devicePixelRatio);
    }
    ctx.restore();
  };
  return {drawClear: [shade], draw: [over]};  // under the grid, over the lines
}

function fillBand(u, band) {
  const x = u.data[0], {ctx} = u;
  ctx.fillStyle = translucent(band.role, band.role === 'measured' ? 30 : 20);
  let from = -1;
  for (let i = 0; i <= x.length; ++i) {
    const here = i < x.length && known(band.low[i]);
    if (here && from < 0) from = i;
    if (here || from < 0) continue;
    ctx.beginPath();
    for (let k = from; k < i; ++k) ctx.lineTo(u.valToPos(x[k], 'x', true), u.valToPos(band.high[k], 'y', true));
    for (let k = i - 1; k >= from; --k) ctx.lineTo(u.valToPos(x[k], 'x', true), u.valToPos(band.low[k], 'y', true));
    ctx.fill();
    from = -1;
  }
}

function strokePath(u, line) {
  const {ctx} = u;
  ctx.strokeStyle = colour(line.role);
  ctx.lineWidth = WIDTH[line.role] * devicePixelRatio;
  ctx.lineJoin = 'round';
  ctx.setLineDash([]);
  ctx.beginPath();
  let down = false;
  line.values.forEach((value, i) => {
    if (!known(value) || !known(line.x[i])) { down = false; return; }
    const x = u.valToPos(line.x[i], 'x', true), y = u.valToPos(value, 'y', true);
    if (down) ctx.lineTo(x, y); else ctx.moveTo(x, y);
    down = true;
  });
  ctx.stroke();
}

// Least and greatest of all that is drawn, with a margin.
function span(lists, log) {
  let low = Infinity, high = -Infinity;
  for (const list of lists) for (const value of list) {
    if (!known(value) || (log && value <= 0)) continue;
    if (value < low) low = value;
    if (value > high) high = value;
  }
  if (low > high) return log ? [0.1, 1] : [0, 1];
  if (log) return [low / 1.5, high * 1.5];
  const margin = high > low ? 0.06 * (high - low) : Math.abs(high) * 0.05 || 0.5;
  return [low - margin, high + margin];
}

const groups = new Map();

// Zooming one plot of a group zooms all of them.
function zoomTogether(plot) {
  return u => {
    const group = groups.get(plot.group);
    if (!group || group.busy) return;
    group.busy = true;
    const {min, max} = u.scales.x;
    for (const other of group.plots) if (other !== u) other.setScale('x', {min, max});
    group.busy = false;
  };
}

function place(plot, value) {
  if (dated(plot)) return DATE(localDate(value));
  if (plot.x.stretches) {
    const [name, seconds] = unitOf(Math.abs(value));
    return `${number(value / seconds)} ${name}`;
  }
  return number(value);
}

function key(line) {
  return element('span', {class: 'key'}, element('i', {class: line.role + (line.dashed ? ' dashed' : '')}), line.name);
}

// A figure. The keys of the lines are drawn unless an earlier figure beside it shows the same.
function figure(plot, {keys = true, title = plot.title, height = plot.low ? 110 : 210} = {}) {
  let lines = [...plot.lines].sort((a, b) => ORDER[a.role] - ORDER[b.role]);
  const readout = element('span', {class: 'readout', 'aria-live': 'polite'});
  const note = element('span', {class: 'note'}, plot.note || '');
  const caption = element('figcaption', {}, title ? element('b', {}, title) : null,
      ...(keys && plot.lines.length > 1 ? plot.lines.filter(line => !line.dashed).map(key) : []),
      plot.note || plot.onZoom ? note : null, readout);
  const canvas = element('div', {class: 'canvas', role: 'img', tabindex: 0,
    'aria-label': [title, plot.note, plot.y.label, plot.lines.map(line => line.name).join(', ')].filter(Boolean).join('. ')});
  // Below a title that is the tag, its unit alone.
  const unit = plot.y.label === title ? '' : plot.y.label.startsWith(`${title}, `) ? plot.y.label.slice(title.length + 2) : plot.y.label;
  const node = element('figure', {class: plot.low ? 'low' : ''}, unit ? element('div', {class: 'unit'}, unit) : null, canvas);
  if (caption.childNodes.length > 1 || title) node.prepend(caption); else node.append(readout);

  let x, values, y, ends;
  const measure = () => {
    x = plot.paths ? [...new Set(plot.lines.flatMap(line => line.x))].filter(known).sort((a, b) => a - b) : positions(plot.x);
    values = lines.map(line => plot.paths ? x.map(() => null) : line.values);
    y = span([...lines.map(line => line.values), ...(plot.bands || []).flatMap(band => [band.low, band.high])], plot.y.log);
    ends = plot.ends ? [...plot.ends] : plot.paths || plot.x.values ? span([x], plot.x.log) : [x[0], x.at(-1)];
    if (!(ends[1] > ends[0])) ends[1] = ends[0] + 1;
  };
  measure();
  const options = {
    width: 300, height, padding: [6, 10, 0, 0], legend: {show: false}, tzDate: localDate, ms: 1e-3,
    cursor: {drag: {x: !plot.paths, y: false, setScale: !plot.onZoom},
      bind: plot.onZoom ? {dblclick: () => () => { plot.onZoom(null); return null; }} : {}, points: {show: false}, y: false,
      sync: plot.group ? {key: plot.group, setSeries: false} : undefined},
    scales: {x: {time: dated(plot), distr: plot.x.log ? 3 : 1, range: (u, min, max) => u.zoomed || min !== null && max - min < 0.999 * (ends[1] - ends[0]) && min >= ends[0] && max <= ends[1] ? [min, max] : ends},
      y: {distr: plot.y.log ? 3 : 1, range: () => y}},
    series: [{}, ...lines.map(series)],
    axes: axes(plot, ends[1] - ends[0]),
    hooks: {...extras(plot, lines), setScale: plot.group ? [(u, name) => name === 'x' && zoomTogether(plot)(u)] : [],
      setSelect: plot.onZoom ? [u => {
        const {left, width} = u.select;
        if (width < 4) return;
        u.setSelect({left: 0, top: 0, width: 0, height: 0}, false);
        plot.onZoom(u.posToVal(left, 'x'), u.posToVal(left + width, 'x'));
      }] : [],
      setCursor: [u => {
        const i = u.cursor.idx;
        readout.textContent = plot.paths || !known(i) || u.cursor.left < 0 ? ''
          : [place(plot, x[i]), ...plot.lines.filter(line => !line.dashed || known(line.values[i])).map(line => `${line.name} ${number(line.values[i])}`)].join(' · ');
      }]},
  };
  const make = () => {
    const width = Math.floor(canvas.clientWidth);
    if (width < 40) return;
    if (node.plot) {
      if (node.plot.width !== width) node.plot.setSize({width, height});
      return;
    }
    node.plot = new uPlot(options, [x, ...values], canvas);
    drawnPlots.add(node.plot);
    if (!plot.group) return;
    if (!groups.has(plot.group)) groups.set(plot.group, {plots: [], busy: false});
    groups.get(plot.group).plots.push(node.plot);
  };
  canvas.addEventListener('keydown', event => moveCursor(event, node.plot, plot.onZoom));
  node.make = make;
  // The same lines with other values, and another note.
  node.update = next => {
    Object.assign(plot, next);
    note.textContent = plot.note || '';
    lines = [...plot.lines].sort((a, b) => ORDER[a.role] - ORDER[b.role]);
    measure();
    if (node.plot) node.plot.setData([x, ...values]);
  };
  const observer = new ResizeObserver(make);
  observer.observe(canvas);
  node.destroy = () => {
    observer.disconnect();
    if (!node.plot) return;
    drawnPlots.delete(node.plot);
    const group = groups.get(plot.group);
    if (group) group.plots.splice(group.plots.indexOf(node.plot), 1);
    node.plot.destroy();
  };
  return node;
}

// With the keyboard: arrows move the cursor, 0 shows all.
function moveCursor(event, u, onZoom) {
  const by = {ArrowLeft: -1, ArrowRight: 1}[event.key];
  if (!u || (!by && event.key !== '0')) return;
  event.preventDefault();
  if (!by && onZoom) return onZoom(null);
  if (!by) {
    u.setScale('x', {min: u.data[0][0], max: u.data[0].at(-1)});
    return;
  }
  const width = u.bbox.width / devicePixelRatio;
  const at = u.cursor.left < 0 ? width / 2 : u.cursor.left;
  u.setCursor({left: Math.min(Math.max(at + by * (event.shiftKey ? 40 : 4), 0), width), top: 10});
}

function redrawAll() {
  for (const plot of drawnPlots) plot.redraw(false, true);
}
