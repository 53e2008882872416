// One unit: matrix, alarms, what is open.
import { get, unitPath, type Channel, type Unit } from './api';
import { alarmRow, PRIORITIES, tabOf, TABS, type Tab } from './alarm';
import { h } from './dom';
import { cvLink, healthChip, kpiStrip, lastSample, legend, outdated, outdatedClass, shortText, standby, stateChip, unitLink } from './parts';
import { healthOf, STATES, withUnit } from './text';

let tab: Tab = 'active';
export const setTab = (name: string) => { tab = name as Tab; };

function cell(unit: string, channel: Channel): HTMLElement {
  const { word, sign } = STATES[channel.state];
  const text = shortText(channel);
  return h('td', { class: channel.state },
    h('a', { href: cvLink(unit, channel.cv), title: channel.text || word },
      h('span', { class: 'sign', 'aria-hidden': 'true' }, sign), h('span', { class: 'word' }, word),
      text ? h('span', { class: 'more' }, text) : null));
}

function matrix(unit: Unit): HTMLElement {
  const of = (mv: string, cv: string) => unit.channels.find(each => each.mv === mv && each.cv === cv);
  return h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Matrix of channels' },
    h('table', { class: 'matrix' },
      h('caption', { class: 'heard' }, 'Verdict on each channel, inputs by CVs'),
      h('thead', {}, h('tr', {}, h('td', {}),
        ...unit.cvs.map(cv => h('th', { scope: 'col' }, h('a', { href: cvLink(unit.unit, cv.tag), title: cv.description }, cv.tag),
          h('span', { class: 'value' }, withUnit(cv.measured, cv.unit)))))),
      h('tbody', {}, ...unit.inputs.map(input => h('tr', { 'data-key': input.tag },
        h('th', { scope: 'row', title: input.description }, input.tag, input.kind === 'dv' ? h('span', { class: 'kind' }, ' DV') : null,
          h('span', { class: 'value' }, withUnit(input.value, input.unit))),
        ...unit.cvs.map(cv => {
          const channel = of(input.tag, cv.tag);
          return channel ? cell(unit.unit, channel) : h('td', {});
        }))))));
}

/// What `mpm detect` would print of the channels that do not simply match.
function told(unit: Unit): HTMLElement | null {
  const open = unit.channels.filter(each => each.state !== 'match' || each.nonlinear_text);
  if (!open.length) return null;
  const rank = { mismatch: 0, watch: 1, undetermined: 2, match: 3 };
  open.sort((a, b) => rank[a.state] - rank[b.state]);
  return h('section', { class: outdatedClass(unit), 'aria-labelledby': 'told' }, h('h2', { id: 'told' }, 'Channels in words'),
    h('ul', { class: 'told' }, ...open.map(each => h('li', { 'data-key': `${each.mv} ${each.cv}` }, stateChip(each.state),
      h('a', { href: cvLink(unit.unit, each.cv) }, `${each.mv}\u00a0→\u00a0${each.cv}`),
      h('span', {}, [each.text, each.nonlinear_text].filter(Boolean).join('; '))))));
}

function alarms(unit: Unit): HTMLElement {
  const rows = unit.alarms.filter(each => tabOf(each) === tab);
  return h('section', { class: 'alarms', 'aria-labelledby': 'alarms' }, h('h2', { id: 'alarms' }, 'Alarms'),
    h('div', { class: 'tabs', role: 'tablist', 'aria-labelledby': 'alarms' }, ...TABS.map(([name, text]) => {
      const count = unit.alarms.filter(each => tabOf(each) === name).length;
      return h('button', { type: 'button', role: 'tab', id: `tab-${name}`, 'aria-controls': 'alarm-panel', 'aria-selected': name === tab ? 'true' : 'false',
        tabindex: name === tab ? 0 : -1, 'data-do': 'tab', 'data-tab': name }, `${text} (${count})`);
    })),
    h('div', { role: 'tabpanel', id: 'alarm-panel', 'aria-labelledby': `tab-${tab}`, tabindex: 0 },
      rows.length ? h('ul', { class: 'alarm-list' }, ...rows.map(each => alarmRow(each, unit.unit, unit.speaks)))
        : h('p', { class: 'note' }, tab === 'active' ? 'No alarm is active.' : 'None.'),
      rows.some(each => each.priority) ? h('p', { class: 'note' }, PRIORITIES) : null,
      rows.length && !unit.speaks ? h('p', { class: 'note' }, 'They are acted on at the monitor that speaks.') : null));
}

export async function unitPage(name: string): Promise<HTMLElement> {
  const unit = await get<Unit>(unitPath(name));
  const troubles = unit.troubles.filter(each => each.text);
  return h('div', {},
    h('div', { class: 'head' }, h('h1', { tabindex: -1 }, unit.unit), healthChip(unit.health.state),
      lastSample(unit), h('a', { class: 'button', href: `${unitLink(unit.unit)}/diagnosis` }, 'Diagnosis')),
    standby(unit),
    troubles.length ? h('ul', { class: 'troubles' }, ...troubles.map(each => h('li', { class: healthOf(each.severity).name },
      h('span', { 'aria-hidden': 'true' }, `${healthOf(each.severity).sign} `), h('strong', {}, `${healthOf(each.severity).word}: `), each.text)))
      : null,
    unit.speaks && !troubles.length && unit.health.state === 'function_check' ? h('p', { class: 'note' }, unit.health.detail) : null,
    outdated(unit),
    h('div', { class: outdatedClass(unit) }, kpiStrip(unit.kpi)),
    h('div', { class: 'columns' },
      h('section', { class: outdatedClass(unit), 'aria-labelledby': 'matrix' }, h('h2', { id: 'matrix' }, 'Model against plant'), matrix(unit), legend(unit.channels.map(each => each.state))),
      alarms(unit)),
    told(unit));
}
