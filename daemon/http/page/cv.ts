// One CV: measured against predicted, residual, inputs, correlations.
import { get, part, unitPath, type Correlation, type Correlations, type Limits, type Series, type Unit, type Values } from './api';
import { h } from './dom';
import { figure, type Figure, type Line, type Plot } from './draw.js';
import { outdated, outdatedClass, stateChip, time, unitLink } from './parts';
import { number, withUnit, zone, zoneText } from './text';

const SPANS: [string, number][] = [['10 min', 600], ['1 h', 3600], ['8 h', 28800], ['1 d', 86400], ['7 d', 604800], ['30 d', 2592000], ['90 d', 7776000]];
const kPoints = 600;
const kHigh = 200, kLow = 96; // pixels

/// How much room of its own size a limit may take away from what is drawn.
const kLimitReach = 0.6;

const constant = (value: number | null, times: number[]): Values => times.map(() => value);

export class CvPage {
  private figures: Record<string, Figure> = {};
  private correlations: Record<string, Figure> = {};
  private plots = h('div', { 'data-keep': true, 'data-key': 'plots', class: 'plots' });
  private lags = h('div', { 'data-keep': true, 'data-key': 'lags', class: 'lags' });
  private said: Record<string, HTMLElement> = {};
  private span = 3600;
  private chosen: [number, number] | null = null;

  constructor(private unit: string, private cv: string, private again: () => void) {}

  choose(span: number): void {
    this.span = span;
    this.chosen = null;
    this.again();
  }

  leave(): void {
    for (const each of [...Object.values(this.figures), ...Object.values(this.correlations)]) each.destroy();
  }

  private readonly zoom = (from: number | null, until?: number): void => {
    this.chosen = from === null || until === undefined ? null : [from, until];
    this.again();
  };

  private draw(name: string, plot: Plot, low: boolean): void {
    const known = this.figures[name];
    if (known) return known.update(plot);
    const node = figure({ ...plot, group: 'cv', onZoom: this.zoom }, { height: low ? kLow : kHigh });
    this.figures[name] = node;
    this.plots.append(node);
  }

  /// A limit that would squeeze what is drawn is told, not drawn. There are always two lines: a plot
  /// keeps those it began with.
  private limitLines(limits: Limits, series: Series): [Line[], string] {
    const drawn = [...series.measured.min, ...series.measured.max, ...series.setpoint].filter(each => each !== null);
    const low = Math.min(...drawn), high = Math.max(...drawn), reach = kLimitReach * Math.max(high - low, 1e-12);
    const given = [['low limit', limits.low], ['high limit', limits.high]] as const;
    const isNear = (value: number | null): value is number => value !== null && drawn.length > 0 && value > low - reach && value < high + reach;
    const far = given.filter(([, value]) => value !== null && !isNear(value)).map(([name, value]) => `${name} ${number(value)}`);
    return [given.map(([name, value]) => ({ name, role: 'limit', dashed: true, values: constant(isNear(value) ? value : null, series.times) })),
      [given.some(([, value]) => isNear(value)) ? 'dashed: limits' : '', far.length ? `beyond the picture: ${far.join(', ')}` : ''].filter(Boolean).join('; ')];
  }

  private drawSeries(series: Series, has_setpoint: boolean): void {
    const x = { clock: true, values: series.times };
    const ends: [number, number] = [series.from, series.until];
    const [limits, note] = this.limitLines(series.limits, series);
    const lines: Line[] = [{ name: 'measured', role: 'measured', values: series.measured.mean },
      { name: 'predicted', role: 'prediction', values: series.prediction }];
    if (has_setpoint) lines.push({ name: 'set-point', role: 'setpoint', values: series.setpoint });
    this.draw('measured', { title: 'Measured and predicted', note, x, y: { label: series.cv_unit }, ends, lines: [...lines, ...limits],
      bands: [{ role: 'measured', low: series.measured.min, high: series.measured.max }] }, false);
    const band = series.residual_band;
    const edges: Line[] = [['95 % from', band?.low ?? null] as const, ['to', band?.high ?? null] as const].map(([name, value]) =>
      ({ name, role: 'limit', dashed: true, values: constant(value, series.times) }));
    this.draw('residual', { title: 'Residual: measured minus predicted', note: band ? 'dashed: where 95 % lay while the CV matched' : '', x,
      y: { label: series.cv_unit }, ends, lines: [{ name: 'residual', role: 'measured', values: series.residual.mean }, ...edges],
      bands: [{ role: 'measured', low: series.residual.min, high: series.residual.max }] }, false);
    for (const input of series.inputs)
      this.draw(`input ${input.tag}`, { title: input.tag, x, y: { label: input.unit ? `${input.tag}, ${input.unit}` : input.tag }, ends,
        lines: [{ name: input.tag, role: 'input', values: input.mean }], bands: [{ role: 'input', low: input.min, high: input.max }] }, true);
  }

  private drawCorrelation(each: Correlation): void {
    const lags = each.values.map((_, i) => each.first_lag + i);
    const edges: Line[] = ([['low limit', -1], ['high limit', 1]] as const).map(([name, sign]) =>
      ({ name, role: 'limit', dashed: true, values: constant(each.limit === null ? null : sign * each.limit, lags) }));
    const plot: Plot = { title: `${each.mv} against the residual`, x: { label: 'lag, samples', values: lags }, y: { label: 'partial correlation' },
      lines: [{ name: 'correlation', role: 'measured', values: each.values }, ...edges] };
    const said = h('div', { class: 'said' }, stateChip(each.state), h('span', {}, each.text || 'as modelled'), excitation(each));
    const known = this.correlations[each.mv];
    if (known) {
      known.update(plot);
      this.said[each.mv]?.replaceChildren(...said.childNodes);
      return;
    }
    const node = figure(plot, { height: 150 });
    this.correlations[each.mv] = node;
    this.said[each.mv] = said;
    this.lags.append(h('div', { class: 'lag' }, node, said));
  }

  async update(): Promise<HTMLElement> {
    const path = `${unitPath(this.unit)}/cvs/${part(this.cv)}`;
    const stretch = this.chosen ? `from=${this.chosen[0]}&until=${this.chosen[1]}` : `span=${this.span}`;
    const [unit, series, correlations] = await Promise.all([
      get<Unit>(unitPath(this.unit)), get<Series>(`${path}/series?points=${kPoints}&${stretch}`), get<Correlations>(`${path}/correlations`)]);
    const cv = unit.cvs.find(each => each.tag === this.cv);
    if (series.times.length > 1) this.drawSeries(series, cv?.setpoint_tag != null);
    for (const each of correlations.inputs) if (each.values.length > 1) this.drawCorrelation(each);
    const off = cv && cv.measured !== null && cv.prediction !== null ? cv.measured - cv.prediction : null;
    const value = (name: string, text: string) => h('div', { class: 'kpi' }, h('dt', {}, name), h('dd', {}, h('span', { class: 'value' }, text)));
    const engineering = cv?.unit ?? '';
    const last = (this.chosen ? series.until : series.last ?? 0) * 1e9;
    const shown = this.chosen ? [time(series.from * 1e9), ' to ', time(last)] : last ? ['up to ', time(last)] : [];
    return h('div', { class: outdatedClass(unit) },
      h('div', { class: 'head' }, h('h1', { tabindex: -1 }, h('a', { href: unitLink(this.unit) }, this.unit), ' / ', this.cv),
        h('p', { class: 'note' }, cv?.description ?? '')),
      outdated(unit),
      h('dl', { class: 'kpis' }, value('Measured', withUnit(cv?.measured ?? null, engineering)), value('Predicted', withUnit(cv?.prediction ?? null, engineering)),
        value('Residual', withUnit(off, engineering)), value('Set-point', withUnit(cv?.setpoint ?? null, engineering)),
        value('Limits', `${number(cv?.limits.low)} to ${number(cv?.limits.high)}`)),
      h('div', { class: 'tools', role: 'group', 'aria-label': 'Time shown' },
        ...SPANS.map(([name, seconds]) => h('button', { type: 'button', 'data-do': 'span', 'data-span': seconds,
          'aria-pressed': !this.chosen && this.span === seconds ? 'true' : 'false' }, name)),
        this.chosen ? h('button', { type: 'button', class: 'main', 'data-do': 'span', 'data-span': this.span }, 'Show the latest') : null,
        h('span', { class: 'note' }, ...shown, last ? `; plots in ${zone === 'UTC' ? 'UTC' : `${zone}, ${zoneText(last)}`}` : '')),
      series.times.length > 1 ? null : h('p', { class: 'note' }, 'Nothing was measured in this time.'),
      this.plots,
      h('p', { class: 'note screen' }, 'Drag over a plot to zoom, which fetches that stretch anew; double click, or 0 on the keyboard, shows the latest again; arrow keys move the cursor.'),
      h('h2', {}, 'Correlation of each input with the residual'),
      h('p', { class: 'note' }, 'Dashed: what chance leaves of white residuals in 95 of 100 lags. In a closed loop the inputs move together, and one wrong channel shows in all of them; which one it is, the verdicts below say, which weigh all inputs at once.'),
      this.lags);
  }
}

/// How large an error of the gain would show by now.
function excitation(each: Correlation): HTMLElement {
  const kMost = 1; // a gain error of 100 %
  const error = each.smallest_error;
  const known = error !== null && error > 0;
  const text = !each.excited && !known ? 'has not moved enough to tell anything'
    : known ? `an error of the gain of ${number(100 * error, 2)} % would show` : 'moves enough';
  return h('span', { class: 'excitation' }, h('meter', { min: 0, max: kMost, value: known ? Math.max(0, kMost - error) : each.excited ? kMost : 0, 'aria-label': `Excitation by ${each.mv}` }),
    h('span', {}, ` Excitation: ${text}`));
}
