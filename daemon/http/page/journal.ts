// Alarm events, chosen by unit, CV and time.
import { get, type Card, type Event } from './api';
import { h } from './dom';
import { BY_DESIGN, isByDesign, title } from './alarm';
import { cvLink, time, unitLink } from './parts';

const SINCE: [string, number][] = [['last hour', 3600], ['last day', 86400], ['last week', 604800], ['all that is kept', 0]];
const chosen = { unit: '', cv: '', since: 0 };

export function choose(name: string, value: string): void {
  if (name === 'unit') Object.assign(chosen, { unit: value, cv: '' });
  if (name === 'cv') chosen.cv = value;
  if (name === 'since') chosen.since = Number(value);
}

const WORDS: Record<string, string> = { active: '▲ Alarm', cleared: 'Cleared', diagnosed: 'Diagnosed' };

const sentence = (words: string) => words.charAt(0).toUpperCase() + words.slice(1);

function select(name: string, text: string, options: [string, string][], value: string): HTMLElement {
  return h('label', {}, `${text} `, h('select', { 'data-choose': name, 'data-key': `${name} ${value}` },
    ...options.map(([key, word]) => h('option', { value: key, selected: key === value }, word))));
}

export async function journal(): Promise<HTMLElement> {
  const { units } = await get<{ units: Card[] }>('units');
  const query = new URLSearchParams();
  if (chosen.unit) query.set('unit', chosen.unit);
  if (chosen.cv) query.set('cv', chosen.cv);
  if (chosen.since) query.set('since', String(Math.floor(Date.now() / 1e3 - chosen.since)));
  const { events } = await get<{ events: Event[] }>(`journal?${query}`);
  const cvs = units.find(each => each.unit === chosen.unit)?.cvs ?? [];
  return h('div', {},
    h('div', { class: 'head' }, h('h1', { tabindex: -1 }, 'Journal'), h('p', { class: 'note' }, `${events.length} event${events.length === 1 ? '' : 's'}, the youngest first`)),
    h('div', { class: 'tools', role: 'group', 'aria-label': 'Which events' },
      select('unit', 'Unit', [['', 'all'], ...units.map(each => [each.unit, each.unit] as [string, string])], chosen.unit),
      select('cv', 'CV', [['', 'all'], ...cvs.map(each => [each, each] as [string, string])], chosen.cv),
      select('since', 'Time', SINCE.map(([word, seconds]) => [String(seconds), word]), String(chosen.since))),
    events.length ? h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Events' }, h('table', { class: 'wide' },
      h('thead', {}, h('tr', {}, ...['Time', 'Event', 'Unit', 'Channel', 'What'].map(each => h('th', { scope: 'col' }, each)))),
      h('tbody', {}, ...events.map(each => h('tr', { 'data-key': `${each.unit} ${each.mv} ${each.cv} ${each.time_ns} ${each.to}` },
        h('td', { 'data-label': 'Time' }, time(each.time_ns)),
        h('td', { 'data-label': 'Event', class: `event ${each.to}` }, WORDS[each.to] ?? sentence(each.to.replaceAll('_', ' ')), each.to === 'suppressed' && !each.client_user_id && isByDesign(each) ? ` ${BY_DESIGN}` : ''),
        h('td', { 'data-label': 'Unit' }, h('a', { href: unitLink(each.unit) }, each.unit)),
        h('td', { 'data-label': 'Channel' }, each.cv ? h('a', { href: cvLink(each.unit, each.cv) }, title(each)) : title(each)),
        h('td', { 'data-label': 'What' }, each.message || each.cause_text || each.text || '–',
          each.client_user_id ? ` (${each.client_user_id}${each.comment ? `: ${each.comment}` : ''})` : '')))))) : h('p', {}, 'No such event.'));
}
