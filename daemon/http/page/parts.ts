// What several pages show.
import type { Card, Channel, Kpi, State, Trend } from './api';
import { h, svg } from './dom';
import { healthOf, moment, percent, span, STATES, utc, inUtc } from './text';

export const unitLink = (unit: string) => `#/unit/${encodeURIComponent(unit)}`;
export const cvLink = (unit: string, cv: string) => `${unitLink(unit)}/cv/${encodeURIComponent(cv)}`;

/// A moment in the viewer's zone with the plant's beside it.
export function time(ns: number | null | undefined): HTMLElement {
  return h('span', { class: 'time' }, h('span', {}, moment(ns)),
    !inUtc && ns ? h('span', { class: 'utc' }, ` (${utc(ns)})`) : null);
}

const kSilentSamples = 10, kLeastSilence = 5; // s; as in daemon/live/unit_health

/// When the last sample was taken, and how far that is from now where it should not be: the monitor's
/// own measure of silence.
export function lastSample(unit: { time_ns: number; sample_time_s: number }): HTMLElement {
  if (!unit.time_ns) return h('p', { class: 'note' }, 'no sample yet');
  const age = Date.now() / 1e3 - unit.time_ns / 1e9;
  const allowed = Math.max(kLeastSilence, kSilentSamples * unit.sample_time_s);
  // The space is where the line may break.
  return h('p', { class: 'note' }, 'last sample ', time(unit.time_ns), ' ',
    Math.abs(age) > allowed ? h('strong', { class: 'old' }, `△ ${span(Math.abs(age))} ${age > 0 ? 'ago' : 'ahead of this clock'}`) : null);
}

/// Of a monitor that only looks on, first of all.
export function standby(unit: { speaks: boolean; health: { detail: string } }): HTMLElement | null {
  if (unit.speaks) return null;
  const [first = '', ...speaker] = unit.health.detail.split('; ');
  return h('p', { class: 'standby', role: 'note' }, h('strong', {}, first === 'stands by' ? 'This monitor stands by' : 'This monitor stands by for another one'),
    speaker.length ? `; ${speaker.join('; ')}.` : '.', ' It takes no commands.');
}

/// While its health is a failure no verdicts come: what is shown of it is as old as its last sample.
export const isOutdated = (unit: { health: { state: string } }) => unit.health.state === 'failure';
export const outdatedClass = (unit: { health: { state: string } }) => (isOutdated(unit) ? 'outdated' : '');

export function outdated(unit: { time_ns: number; health: { state: string } }): HTMLElement | null {
  return isOutdated(unit) ? h('p', { class: 'no-verdicts', role: 'note' }, h('strong', {}, 'No verdicts come now'),
    ...unit.time_ns ? ['; those shown are of ', time(unit.time_ns), '.'] : ['.']) : null;
}

/// No colour where all is well.
export function healthChip(state: string): HTMLElement {
  const { word, sign, name } = healthOf(state);
  return h('span', { class: `chip health ${name}` }, sign ? h('span', { 'aria-hidden': 'true' }, `${sign} `) : null, word);
}

export function stateChip(state: State): HTMLElement {
  const { word, sign } = STATES[state];
  return h('span', { class: `state ${state}` }, h('span', { 'aria-hidden': 'true' }, `${sign} `), word);
}

/// A small line, its range 0..1: how it went, without numbers.
export function spark(trend: Trend): Element {
  const kWidth = 96, kHeight = 24, kEdge = 2;
  const { times, values } = trend;
  const first = times[0] ?? 0, last = times.at(-1) ?? 1;
  let path = '', down = false;
  values.forEach((value, i) => {
    if (value === null) { down = false; return; }
    const x = kEdge + (kWidth - 2 * kEdge) * ((times[i] ?? first) - first) / Math.max(last - first, 1e-9);
    const y = kHeight - kEdge - (kHeight - 2 * kEdge) * Math.min(1, Math.max(0, value));
    path += `${down ? 'L' : 'M'}${x.toFixed(1)} ${y.toFixed(1)}`;
    down = true;
  });
  return svg('svg', { class: 'spark', viewBox: `0 0 ${kWidth} ${kHeight}`, width: kWidth, height: kHeight, 'aria-hidden': 'true' },
    svg('path', { d: `M0 ${kHeight - 0.5}H${kWidth}`, class: 'base' }), svg('path', { d: path }));
}

function trendWord({ change }: Trend): string {
  const kNoticed = 0.05; // of a share
  if (change === null || Math.abs(change) < kNoticed) return '';
  return change < 0 ? 'falling' : 'rising';
}

const kpi = (name: string, value: string, title: string, ...more: (Element | null)[]) =>
  h('div', { class: 'kpi', title }, h('dt', {}, name), h('dd', {}, h('span', { class: 'value' }, value), ...more));

export function kpiStrip(kpis: Kpi): HTMLElement {
  const accuracy = kpis.model_accuracy, word = trendWord(accuracy);
  return h('dl', { class: 'kpis' },
    kpi('Service', percent(kpis.service_factor), 'Service factor: share of the time in which the controller acts'),
    kpi('At limits', percent(kpis.at_limits), 'Share of the time that MVs rest at a limit'),
    kpi('Prediction error', percent(kpis.prediction_error),
      'Error of the predictions over a settling time, in per cent of what the CVs move meanwhile: 100 % is no better than predicting no change'),
    kpi('Determined', percent(kpis.determined), 'Share of the channels that move enough to be judged'),
    kpi('Model accuracy', percent(accuracy.now),
      'How much smaller the errors of the predictions are than those of predicting no change; 100 % is a perfect model',
      word ? h('span', { class: 'note' }, word) : null, accuracy.now === null ? null : spark(accuracy)));
}

/// The matrix of a card: shapes alone, told in words to who cannot see them.
export function smallMatrix(card: Card): HTMLElement {
  const text = `${isOutdated(card) ? 'as it was: ' : ''}${card.mismatch} mismatch, ${card.match} match, ${card.undetermined} undetermined`;
  return h('div', { class: 'small-matrix', role: 'img', 'aria-label': `${card.inputs.length} inputs by ${card.cvs.length} CVs: ${text}` },
    ...card.matrix.map(row => h('div', { class: 'row' },
      ...row.map(state => h('span', { class: `cell ${state}` }, STATES[state].sign)))));
}

export function legend(states: State[]): HTMLElement {
  const order: State[] = ['mismatch', 'watch', 'match', 'undetermined'];
  return h('p', { class: 'legend' }, ...order.filter(each => states.includes(each)).map(stateChip));
}

export function shortText(channel: Channel): string {
  if (channel.state === 'match') return '';
  if (channel.verdict === 'mismatch' && channel.gain_error_percent !== undefined && Math.abs(channel.gain_error_percent) >= 0.5)
    return `gain ${channel.gain_error_percent > 0 ? '+' : '−'}${Math.abs(channel.gain_error_percent).toFixed(0)} %`;
  return (channel.reason ?? '').replaceAll('_', ' ');
}
