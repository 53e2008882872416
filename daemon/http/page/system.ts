// How the monitor itself fares.
import { get, type System, type SystemUnit } from './api';
import { h } from './dom';
import { healthChip, time, unitLink } from './parts';
import { healthOf, number, span } from './text';

const COUNTS: [string, string][] = [
  ['frames', 'complete samples'], ['used', 'used'], ['missing', 'missing'], ['incomplete', 'incomplete'], ['late', 'late'], ['repeated', 'repeated'],
  ['out_of_order', 'out of order'], ['bad_values', 'bad values'], ['wrong_length', 'of wrong length'], ['beyond', 'beyond numbering'],
  ['restarts', 'controller restarts'], ['unknown_unit', 'of unknown units'], ['page_dropped_samples', 'dropped by this page'],
];

function unitRow(unit: SystemUnit): HTMLElement {
  const counts = COUNTS.filter(([key], i) => i < 2 || Number(unit[key] ?? 0) > 0).map(([key, word]) => `${Number(unit[key] ?? 0).toLocaleString('en').replaceAll(',', '\u202f')} ${word}`);
  return h('tr', { 'data-key': unit.unit }, h('th', { scope: 'row' }, h('a', { href: unitLink(unit.unit) }, unit.unit)),
    h('td', { 'data-label': 'Health' }, healthChip(unit.state)),
    h('td', { 'data-label': 'Samples / s', class: 'number' }, number(unit.samples_per_second, 3)),
    h('td', { 'data-label': 'Last sample' }, unit.time_ns ? time(unit.time_ns) : '–'),
    h('td', { 'data-label': 'Counters' }, counts.join(', ')),
    h('td', { 'data-label': 'Troubles' }, unit.troubles.length ? h('ul', { class: 'plain' }, ...unit.troubles.map(each =>
      h('li', {}, `${healthOf(each.severity).sign} ${each.text}`))) : unit.detail || 'none'));
}

export async function system(): Promise<HTMLElement> {
  const state = await get<System>('system');
  const age = (state.time_ns - state.started_ns) / 1e9;
  const fact = (name: string, text: string | HTMLElement) => [h('dt', {}, name), h('dd', {}, text)];
  const server = state.server ?? {};
  const memory = state.units.reduce((sum, each) => sum + Number(each['page_history_bytes'] ?? 0), 0);
  return h('div', {},
    h('div', { class: 'head' }, h('h1', { tabindex: -1 }, 'System')),
    h('section', {}, h('h2', {}, 'Units'), h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Units' }, h('table', { class: 'wide' },
      h('thead', {}, h('tr', {}, ...['Unit', 'Health', 'Samples / s', 'Last sample', 'Counters', 'Troubles'].map((each, i) => h('th', { scope: 'col', class: i === 2 ? 'number' : '' }, each)))),
      h('tbody', {}, ...state.units.map(unitRow))))),
    h('section', {}, h('h2', {}, 'Monitor'), h('dl', { class: 'facts' },
      ...fact('Version', state.version), ...fact('Running since', time(state.started_ns)), ...fact('For', span(age)),
      ...fact('Memory', `${number(state.resident_bytes / 1e6, 3)} MB, of which ${number(memory / 1e6, 3)} MB for the plots`),
      ...fact('Processor', `${number(100 * state.processor_seconds / Math.max(age, 1), 2)} % of a core since the start`),
      ...fact('Pages open', `${server['streams'] ?? '–'} of at most ${server['most_streams'] ?? '–'}`),
      ...fact('Requests', `${server['requests'] ?? '–'}, ${server['refused'] ?? '–'} refused`),
      ...fact('Commands', state.commands ? 'taken from who knows the token' : 'not taken: the monitor was started without --token-file'))));
}
