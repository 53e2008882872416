// All units, worst first.
import { get, type Alarm, type Card } from './api';
import { h } from './dom';
import { healthChip, kpiStrip, lastSample, outdated, outdatedClass, smallMatrix, standby, unitLink } from './parts';
import { needsAck, title } from './alarm';

const kAlarmsAlone = /^\d+ (silenced )?alarms?(, \d+ silenced)?$/; // which chips say already
const kAttention = ['well', 'unsettled', 'doubtful', 'blind', 'alarmed'];

const alarmLine = (alarm: Alarm) => h('li', { class: needsAck(alarm) ? 'alarm-line unacknowledged' : 'alarm-line' },
  h('span', { class: 'sign', 'aria-hidden': 'true' }, '▲ '), h('strong', {}, title(alarm)), alarm.message || alarm.text ? ` ${alarm.message || alarm.text}` : '');

function card(unit: Card): HTMLElement {
  const more = unit.alarms - unit.first_alarms.filter(each => each.cv).length; // that of the whole unit counts none
  return h('article', { class: `card ${kAttention[unit.attention]}`, 'data-key': unit.unit },
    h('header', {}, h('h2', {}, h('a', { href: unitLink(unit.unit) }, unit.unit)), healthChip(unit.health.state),
      unit.alarms ? h('span', { class: 'chip alarmed' }, h('span', { 'aria-hidden': 'true' }, '▲ '), `${unit.alarms} alarm${unit.alarms > 1 ? 's' : ''}`) : null,
      unit.silenced_alarms ? h('span', { class: 'chip' }, `${unit.silenced_alarms} silenced`) : null),
    standby(unit),
    outdated(unit),
    h('div', { class: `card-body ${outdatedClass(unit)}` }, smallMatrix(unit), kpiStrip(unit.kpi)),
    unit.first_alarms.length ? h('ul', { class: 'plain' }, ...unit.first_alarms.map(alarmLine), more > 0 ? h('li', {}, `and ${more} more`) : null) : null,
    unit.speaks && unit.health.detail && !kAlarmsAlone.test(unit.health.detail) ? h('p', { class: 'note' }, unit.health.detail) : null,
    lastSample(unit));
}

export async function overview(): Promise<HTMLElement> {
  const { units } = await get<{ units: Card[] }>('units');
  // Of units that are alike in what they need, by name, and 2 before 10.
  const rank = (a: Card, b: Card) => b.attention - a.attention || b.alarms - a.alarms || b.mismatch - a.mismatch;
  units.sort((a, b) => rank(a, b) || a.unit.localeCompare(b.unit, 'en', { numeric: true }));
  const calling = units.filter(unit => unit.attention >= 2).length;
  return h('div', {},
    h('div', { class: 'head' }, h('h1', { tabindex: -1 }, 'Overview'),
      h('p', { class: 'note' }, `${units.length} unit${units.length === 1 ? '' : 's'}, ${calling ? `${calling} to look at` : 'none to look at'}; those that need somebody first`)),
    h('div', { class: 'cards' }, ...units.map(card)));
}
