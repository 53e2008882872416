// Alarms: what they are called, where they belong, and their rows.
import type { Alarm } from './api';
import { h } from './dom';
import { cvLink, time } from './parts';
import { span } from './text';

/// A monitor that keeps no such states has those of its alarms alone.
export const stateOf = (alarm: Alarm): string => alarm.alarm_state ?? (alarm.to === 'active' ? 'unacknowledged' : 'normal');
export const needsAck = (alarm: Alarm) => ['unacknowledged', 'returned_unacknowledged'].includes(stateOf(alarm));
export const title = (alarm: { mv: string; cv: string }) => alarm.mv || alarm.cv ? `${alarm.mv}\u00a0→\u00a0${alarm.cv}` : 'Whole unit';

export const TABS = [
  ['active', 'Active'], ['shelved', 'Shelved'], ['suppressed', 'Suppressed'], ['out_of_service', 'Out of service'],
] as const;
export type Tab = typeof TABS[number][0];
export const tabOf = (alarm: Alarm): Tab => {
  const state = stateOf(alarm);
  return state === 'shelved' || state === 'suppressed' || state === 'out_of_service' ? state : 'active';
};

const WORDS: Record<string, string> = {
  unacknowledged: 'Unacknowledged', acknowledged: 'Acknowledged', returned_unacknowledged: 'Over, unacknowledged',
  shelved: 'Shelved', suppressed: 'Suppressed', out_of_service: 'Out of service', normal: 'Normal',
};
/// By itself, and so it ends: no command does.
export const isByDesign = (each: { suppressed?: boolean; suppressed_by_design?: boolean }) => each.suppressed_by_design === true && !each.suppressed;
export const BY_DESIGN = 'by design: the controller is off or the data are bad';
const SIGNS: Record<string, string> = { high: '1', medium: '2', low: '3' };

export const keyOf = (alarm: { unit: string; mv: string; cv: string }) => JSON.stringify([alarm.unit, alarm.mv, alarm.cv]);

function button(alarm: Alarm, action: string, text: string): HTMLElement {
  return h('button', { type: 'button', 'data-do': 'command', 'data-command': action, 'data-alarm': keyOf(alarm),
    'aria-label': `${text} ${title(alarm)}` }, text);
}

function buttons(alarm: Alarm): HTMLElement[] {
  switch (tabOf(alarm)) {
    case 'shelved': return [button(alarm, 'unshelve', 'Unshelve')];
    case 'suppressed': return isByDesign(alarm) ? [] : [button(alarm, 'unsuppress', 'Unsuppress')];
    case 'out_of_service': return [button(alarm, 'in_service', 'Back in service')];
    case 'active': break;
  }
  const more = [button(alarm, 'shelve', 'Shelve…'), button(alarm, 'out_of_service', 'Out of service…')];
  return needsAck(alarm) ? [button(alarm, 'acknowledge', 'Acknowledge'), ...more] : more;
}

export const PRIORITIES = 'Priority: ▲1 high, ▲2 medium, ▲3 low.';

/// Without buttons where the monitor stands by: it would refuse them all.
export function alarmRow(alarm: Alarm, unit: string, speaks: boolean): HTMLElement {
  const state = stateOf(alarm), rank = SIGNS[alarm.priority ?? ''] ?? '';
  const until = alarm.unshelve_time_ns ? Math.max(0, alarm.unshelve_time_ns / 1e9 - Date.now() / 1e3) : 0;
  return h('li', { class: `alarm ${state}`, 'data-key': keyOf(alarm) },
    h('span', { class: 'priority', title: alarm.priority ? `Priority ${alarm.priority}` : 'Alarm' }, h('span', { 'aria-hidden': 'true' }, '▲'), rank),
    h('div', { class: 'what' },
      h('p', {}, alarm.cv ? h('a', { href: cvLink(unit, alarm.cv) }, h('strong', {}, title(alarm))) : h('strong', {}, title(alarm)),
        h('span', { class: 'word' }, state === 'suppressed' && isByDesign(alarm) ? `Suppressed ${BY_DESIGN}` : WORDS[state] ?? state),
        alarm.notification_class && alarm.notification_class !== 'alarm' ? h('span', { class: 'word' }, alarm.notification_class) : null),
      h('p', {}, alarm.message || alarm.text || 'no size known yet'),
      alarm.cause_text && alarm.cause_text !== alarm.message ? h('p', { class: 'note' }, `Diagnosed: ${alarm.cause_text}`) : null,
      alarm.guidance ? h('p', { class: 'note' }, alarm.guidance) : null,
      h('p', { class: 'note' }, ...alarm.active_time_ns || alarm.time_ns ? ['since ', time(alarm.active_time_ns || alarm.time_ns)] : ['not active'],
        until ? `; for another ${span(until)}` : '',
        alarm.client_user_id ? `; ${alarm.client_user_id}` : '', alarm.comment ? `: ${alarm.comment}` : '')),
    h('div', { class: 'buttons' }, ...speaks ? buttons(alarm) : []));
}
