'use strict';
// Line plots as SVG. A plot is a figure from
//   {title, note, height, group, x: axis, y: axis, lines, band, bound, unseen, marks}
//   axis: {label, kind: 'linear' | 'log' | 'date', unit, min, max}   min, max: fixed or at least
//   line: {name, role: 'measured' | 'before' | 'after', x, y, dashed, dots, loop, quiet}
//     loop: x may go back; quiet: not in the legend
//   band: {name, x, low, high}; bound: half width around 0; unseen: [from, to] shaded
//   marks: [{x, label, left}]; settled: y is scaled for what comes after it
// Plots of one group share their range of x and their cursor.

const SVG = 'http://www.w3.org/2000/svg';
const MARGIN = {left: 58, right: 10, top: 8, bottom: 34};
const groups = new Map();
const plots = [];

function element(name, attributes, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes || {})) node.setAttribute(key, value);
  node.append(...children.filter(child => child !== null && child !== undefined));
  return node;
}

function drawn(name, attributes, text) {
  const node = document.createElementNS(SVG, name);
  for (const key in attributes) node.setAttribute(key, attributes[key]);
  if (text !== undefined) node.textContent = text;
  return node;
}

function known(value) { return value !== null && Number.isFinite(value); }

function number(value, digits = 4) {
  if (!known(value)) return '–';
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e7)) return value.toExponential(digits - 2);
  return String(Number(value.toPrecision(digits))).replace('-', '−');
}

// --- axes -------------------------------------------------------------------------------------

const DATE_STEPS = [1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 10800, 21600,
  43200, 86400, 172800, 604800, 1209600, 2592000, 7776000, 31536000];

function niceStep(span, count) {
  const rough = span / Math.max(1, count);
  const power = 10 ** Math.floor(Math.log10(rough));
  return [1, 2, 5, 10].find(factor => factor * power >= rough) * power;
}

function multiples(low, high, step) {
  const ticks = [];
  for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) ticks.push(i * step);
  return ticks;
}

function dateText(seconds, step) {
  const iso = new Date(seconds * 1000).toISOString();
  if (step >= 86400) return iso.slice(0, 10);
  if (seconds % 86400 === 0) return iso.slice(5, 10);  // midnight: which day begins
  return iso.slice(11, step >= 60 ? 16 : 19);
}

// An axis over `low`..`high`, `from`..`to` pixels.
function makeScale(axis, low, high, from, to) {
  const log = axis.kind === 'log';
  const inner = log ? Math.log10 : value => value;
  const a = inner(low), b = inner(high);
  const place = value => from + (to - from) * (inner(value) - a) / (b - a || 1);
  const value = pixel => {
    const at = a + (b - a) * (pixel - from) / (to - from);
    return log ? 10 ** at : at;
  };
  const room = Math.abs(to - from);
  let ticks, text;
  if (log) {
    const every = Math.max(1, Math.ceil((b - a) / (room / (from > to ? 28 : 45))));
    ticks = multiples(a, b, every).map(power => 10 ** power);
    if (ticks.length < 2) ticks = multiples(low, high, niceStep(high - low, room / 60));
    text = tick => number(tick, 2);
  } else if (axis.kind === 'date') {
    const step = DATE_STEPS.find(each => each * (room / 85) >= high - low) || DATE_STEPS.at(-1);
    ticks = multiples(low, high, step);
    text = tick => dateText(tick, step);
  } else {
    const step = niceStep(high - low, room / (from > to ? 26 : 75));
    ticks = multiples(low, high, step);
    text = tick => number(tick, Math.max(1, 1 + Math.ceil(Math.log10(Math.max(Math.abs(low), Math.abs(high)) / step))));
  }
  return {place, value, ticks, text, low, high};
}

// First index with x >= at.
function lowerBound(x, at) {
  let low = 0, high = x.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (x[middle] < at) low = middle + 1; else high = middle;
  }
  return low;
}

function nearest(x, at) {
  const i = lowerBound(x, at);
  return i > 0 && (i === x.length || at - x[i - 1] < x[i] - at) ? i - 1 : i;
}

// --- the plot ---------------------------------------------------------------------------------

class Plot {
  constructor(spec) {
    this.spec = spec;
    const all = spec.lines.flatMap(line => line.x.length ? [Math.min(line.x[0], line.x.at(-1)), Math.max(line.x[0], line.x.at(-1))] : []);
    this.full = [spec.x.min ?? Math.min(...all), spec.x.max ?? Math.max(...all)];
    if (!(this.full[1] > this.full[0])) this.full[1] = this.full[0] + 1;
    this.group = groups.get(spec.group) || {plots: [], range: null};
    if (spec.group) groups.set(spec.group, this.group);
    this.group.plots.push(this);
    this.still = spec.lines.some(line => line.loop);  // x goes back: no cursor
    this.svg = drawn('svg', {class: 'plot', tabindex: 0, role: 'img', 'aria-label': this.describe()});
    this.node = element('figure', {}, this.caption(), this.svg);
    this.listen();
    plots.push(this);
    new ResizeObserver(() => this.draw()).observe(this.svg);
  }

  describe() {
    const {title, note, x, y, lines} = this.spec;
    return `${title}. ${note ? note + ' ' : ''}${y.label} over ${x.label}: ${lines.map(line => line.name).join(', ')}.`;
  }

  caption() {
    const caption = element('figcaption', {}, element('b', {}, this.spec.title));
    for (const line of this.spec.lines) {
      if (!line.quiet && this.spec.lines.length > 1)
        caption.append(element('span', {class: 'key'}, element('i', {class: line.role + (line.dashed ? ' dashed' : '')}), line.name));
    }
    if (this.spec.note) caption.append(element('span', {class: 'note'}, this.spec.note));
    this.heard = element('span', {class: 'heard', 'aria-live': 'polite'});
    caption.append(this.heard);
    return caption;
  }

  // Range of y over what is shown of x, with a margin.
  span(range) {
    const {lines, band, bound, settled, y} = this.spec;
    const log = y.kind === 'log';
    if (settled !== undefined && range[0] < settled && range[1] > settled) range = [settled, range[1]];
    let low = y.min ?? Infinity, high = y.max ?? -Infinity;
    const take = (x, values, loop) => {
      const from = loop ? 0 : Math.max(0, lowerBound(x, range[0]) - 1);
      const to = loop ? x.length : Math.min(x.length, lowerBound(x, range[1]) + 1);
      for (let i = from; i < to; ++i) {
        const value = values[i];
        if (!known(value) || (log && value <= 0)) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    };
    for (const line of lines) take(line.x, line.y, line.loop);
    if (band) { take(band.x, band.low); take(band.x, band.high); }
    if (bound) { low = Math.min(low, -bound); high = Math.max(high, bound); }
    if (!(high >= low)) [low, high] = log ? [0.1, 1] : [0, 1];
    if (log) return [low / 1.5, high * 1.5];
    if (high === low) { low -= Math.abs(low) * 0.05 || 0.5; high += Math.abs(high) * 0.05 || 0.5; }
    const margin = 0.06 * (high - low);
    return [low === y.min && low === 0 ? 0 : low - margin, high + margin];
  }

  draw() {
    const width = Math.round(this.svg.clientWidth), height = this.spec.height || 200;
    if (width < 60) return;
    const {x, y, lines, band, bound, unseen, marks} = this.spec;
    const range = this.group.range || this.full;
    const [low, high] = this.span(range);
    this.width = width;
    this.height = height;
    this.sx = makeScale(x, range[0], range[1], MARGIN.left, width - MARGIN.right);
    this.sy = makeScale(y, low, high, height - MARGIN.bottom, MARGIN.top);
    const svg = this.svg;
    svg.setAttribute('viewBox', `0 0 ${width} ${height}`);
    svg.setAttribute('height', height);
    svg.replaceChildren();
    const inner = {x: MARGIN.left, y: MARGIN.top, width: width - MARGIN.left - MARGIN.right, height: height - MARGIN.top - MARGIN.bottom};
    const clip = 'clip' + (Plot.count = (Plot.count || 0) + 1);
    const clipPath = drawn('clipPath', {id: clip});
    clipPath.append(drawn('rect', inner));
    const content = drawn('g', {'clip-path': `url(#${clip})`});
    svg.append(clipPath);
    if (unseen) {
      const from = Math.max(MARGIN.left, this.sx.place(unseen[0])), to = Math.min(width - MARGIN.right, this.sx.place(unseen[1]));
      if (to > from) content.append(drawn('rect', {class: 'unseen', x: from, y: MARGIN.top, width: to - from, height: inner.height}));
    }
    this.axes(svg, inner);
    svg.append(content);
    if (bound) content.append(drawn('rect', {class: 'bound', x: MARGIN.left, width: inner.width, y: this.sy.place(bound), height: this.sy.place(-bound) - this.sy.place(bound)}));
    if (band) content.append(drawn('path', {class: 'band', d: this.path(band.x, band.high) + this.path(band.x.slice().reverse(), band.low.slice().reverse(), true).replace('M', 'L') + 'Z'}));
    for (const line of lines) {
      content.append(drawn('path', {class: line.role + (line.dashed ? ' dashed' : ''), d: this.path(line.x, line.y, line.loop)}));
      if (line.dots) line.x.forEach((at, i) => {
        if (known(line.y[i])) content.append(drawn('circle', {class: line.role, r: 2.2, cx: this.sx.place(at), cy: this.sy.place(line.y[i])}));
      });
    }
    for (const mark of marks || []) this.mark(content, mark);
    svg.append(drawn('rect', {class: 'frame', ...inner}));
    this.cursorGroup = drawn('g', {'pointer-events': 'none'});
    this.dragBox = drawn('rect', {class: 'drag', y: MARGIN.top, height: inner.height, visibility: 'hidden'});
    svg.append(this.dragBox, this.cursorGroup);
  }

  axes(svg, inner) {
    const bottom = inner.y + inner.height;
    for (const tick of this.sx.ticks) {
      const at = this.sx.place(tick);
      svg.append(drawn('line', {class: 'grid', x1: at, x2: at, y1: inner.y, y2: bottom}));
      svg.append(drawn('text', {x: at, y: bottom + 14, 'text-anchor': at > this.width - 30 ? 'end' : 'middle'}, this.sx.text(tick)));
    }
    for (const tick of this.sy.ticks) {
      const at = this.sy.place(tick);
      svg.append(drawn('line', {class: 'grid', x1: inner.x, x2: inner.x + inner.width, y1: at, y2: at}));
      svg.append(drawn('text', {x: inner.x - 5, y: at + 4, 'text-anchor': 'end'}, this.sy.text(tick)));
    }
    svg.append(drawn('text', {x: inner.x + inner.width / 2, y: this.height - 4, 'text-anchor': 'middle'}, this.spec.x.label));
    svg.append(drawn('text', {transform: `translate(11 ${inner.y + inner.height / 2}) rotate(-90)`, 'text-anchor': 'middle'}, this.spec.y.label));
  }

  path(x, y, loop) {
    const range = this.group.range || this.full;
    const from = loop ? 0 : Math.max(0, lowerBound(x, range[0]) - 1);
    const to = loop ? x.length : Math.min(x.length, lowerBound(x, range[1]) + 1);
    const log = this.spec.y.kind === 'log';
    let text = '', pen = 'M';
    for (let i = from; i < to; ++i) {
      if (!known(y[i]) || (log && y[i] <= 0)) { pen = 'M'; continue; }
      text += pen + this.sx.place(x[i]).toFixed(1) + ' ' + this.sy.place(y[i]).toFixed(1);
      pen = 'L';
    }
    return text;
  }

  mark(content, mark) {
    const at = this.sx.place(mark.x);
    if (at < MARGIN.left || at > this.width - MARGIN.right) return;
    const late = mark.left || at > this.width * 0.7;
    content.append(drawn('line', {class: 'mark', x1: at, x2: at, y1: MARGIN.top, y2: this.height - MARGIN.bottom}));
    content.append(drawn('text', {x: at + (late ? -4 : 4), y: MARGIN.top + 12, 'text-anchor': late ? 'end' : 'start'}, mark.label));
  }

  // --- cursor and zoom ---

  // Beside the cursor: where it is and what every line is there.
  showCursor(at) {
    if (this.still || !this.sx) return;
    const inside = at !== null && at >= this.sx.low && at <= this.sx.high;
    this.cursorGroup.replaceChildren();
    if (!inside) return;
    const x = this.sx.place(at), late = x > this.width * 0.75;
    this.cursorGroup.append(drawn('line', {class: 'cursor', x1: x, x2: x, y1: MARGIN.top, y2: this.height - MARGIN.bottom}));
    let y = MARGIN.top + 24;
    const say = (role, text) => {
      this.cursorGroup.append(drawn('text', {class: 'value ' + role, x: x + (late ? -6 : 6), y, 'text-anchor': late ? 'end' : 'start'}, text));
      y += 13;
    };
    say('where', this.placeText(at));
    const said = [];
    for (const line of this.spec.lines) {
      if (!line.x.length) continue;
      const value = number(line.y[nearest(line.x, at)]);
      said.push(`${line.name} ${value}`);
      if (y < this.height - MARGIN.bottom) say(line.role, (line.quiet ? line.name + ' ' : '') + value);
    }
    if (document.activeElement === this.svg) this.heard.textContent = `${this.placeText(at)}: ${said.join(', ')}`;
  }

  placeText(at) {
    const {x} = this.spec;
    if (x.kind === 'date') return new Date(at * 1000).toISOString().replace('T', ' ').slice(0, 19) + ' UTC';
    return number(at, 5) + (x.unit ? ' ' + x.unit : '');
  }

  cursor(at) {
    this.group.cursor = at;
    for (const plot of this.group.plots) plot.showCursor(at);
  }

  zoom(range) {
    if (range) {
      range = [Math.max(range[0], this.full[0]), Math.min(range[1], this.full[1])];
      if (!(range[1] > range[0])) return;
    }
    this.group.range = range;
    for (const plot of this.group.plots) { plot.draw(); plot.showCursor(this.group.cursor ?? null); }
  }

  listen() {
    const svg = this.svg;
    const pixel = event => {
      const box = svg.getBoundingClientRect();
      const at = (event.clientX - box.left) * this.width / box.width;
      return Math.min(Math.max(at, MARGIN.left), this.width - MARGIN.right);
    };
    let start = null;
    svg.addEventListener('pointerdown', event => {
      if (event.button !== 0 || this.still) return;
      start = pixel(event);
      svg.setPointerCapture(event.pointerId);
    });
    svg.addEventListener('pointermove', event => {
      if (!this.sx) return;
      const at = pixel(event);
      this.cursor(this.sx.value(at));
      if (start === null) return;
      this.dragBox.setAttribute('visibility', 'visible');
      this.dragBox.setAttribute('x', Math.min(start, at));
      this.dragBox.setAttribute('width', Math.abs(at - start));
    });
    svg.addEventListener('pointerup', event => {
      if (start === null) return;
      const from = Math.min(start, pixel(event)), to = Math.max(start, pixel(event));
      start = null;
      this.dragBox.setAttribute('visibility', 'hidden');
      if (to - from > 5) this.zoom([this.sx.value(from), this.sx.value(to)]);
    });
    svg.addEventListener('pointercancel', () => {
      start = null;
      this.dragBox.setAttribute('visibility', 'hidden');
    });
    svg.addEventListener('pointerleave', () => { if (start === null) this.cursor(null); });
    svg.addEventListener('dblclick', () => this.zoom(null));
    svg.addEventListener('blur', () => this.cursor(null));
    svg.addEventListener('keydown', event => this.key(event));
  }

  // Arrows move the cursor, + and - zoom around it, 0 or Escape show all.
  key(event) {
    if (this.still || !this.sx) return;
    const [low, high] = this.group.range || this.full;
    const log = this.spec.x.kind === 'log';
    const middle = log ? Math.sqrt(low * high) : (low + high) / 2;
    const at = Math.min(Math.max(this.group.cursor ?? middle, low), high);
    const pixels = {ArrowLeft: -1, ArrowRight: 1}[event.key];
    if (pixels) {
      const to = this.sx.place(at) + pixels * (event.shiftKey ? 40 : 4);
      this.cursor(Math.min(Math.max(this.sx.value(to), low), high));
    } else if (event.key === '+' || event.key === '-') {
      const factor = event.key === '+' ? 0.5 : 2;
      const ends = [low, high].map(end => log ? at * (end / at) ** factor : at + (end - at) * factor);
      this.group.cursor = at;
      this.zoom(ends);
    } else if (event.key === '0' || event.key === 'Escape') {
      this.zoom(null);
    } else {
      return;
    }
    event.preventDefault();
  }
}

function plot(spec) { return new Plot(spec).node; }

function redrawAll() { for (const each of plots) each.draw(); }
