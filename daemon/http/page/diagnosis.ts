// What the alarms were found to come from.
import { get, unitPath, type Diagnosis, type Finding, type Rival } from './api';
import { h } from './dom';
import { time, unitLink } from './parts';
import { interval, number } from './text';

const NAMES: Record<string, [string, number]> = { // and what an unchanged model has
  gain_ratio: ['Gain, plant / model', 1], time_constant_ratio: ['Time constant, plant / model', 1], dead_time_error: ['Dead time, plant − model, s', 0],
};

const cell = (text: string, label: string, name = '') => h('td', { 'data-label': label, class: name }, text);

type Numbers = NonNullable<NonNullable<Diagnosis['report']>['channels']>[number];

const isChanged = (each: Numbers, key: string): boolean => {
  const range = each.interval[key], modelled = NAMES[key]?.[1] ?? 0;
  return range !== undefined && (range[0] > modelled || range[1] < modelled);
};

function numberTable(channels: Numbers[], names: string[]): HTMLElement {
  const row = (each: Numbers) => h('tr', {}, h('th', { scope: 'row' }, `${each.mv}\u00a0→\u00a0${each.cv}`), ...names.map(key => {
    const value = each.parameters[key], range = each.interval[key], name = NAMES[key]?.[0] ?? key, changed = isChanged(each, key);
    if (value === undefined) return cell('–', name, 'number');
    return cell(`${number(value, 3)}${range ? ` (${interval(range[0], range[1])})` : ''}${changed ? ' ▲' : ''}`, name, changed ? 'number changed' : 'number');
  }));
  return h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': `Old model and new, ${channels.length} channels` }, h('table', { class: 'wide' },
    h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'Channel'), ...names.map(key => h('th', { scope: 'col', class: 'number' }, NAMES[key]?.[0] ?? key)))),
    h('tbody', {}, ...channels.map(row))));
}

function numbers(diagnosis: Diagnosis): HTMLElement | null {
  const channels = diagnosis.report?.channels ?? [];
  if (!channels.length) return null;
  const names = Object.keys(NAMES).filter(key => channels.some(each => each.parameters[key] !== undefined));
  const changed = channels.filter(each => names.some(key => isChanged(each, key)));
  const others = channels.filter(each => !changed.includes(each));
  return h('section', { 'data-key': 'numbers' }, h('h2', {}, 'Old model and new'),
    changed.length ? numberTable(changed, names) : h('p', {}, 'No channel is surely another than the model says.'),
    h('p', { class: 'note' }, 'In brackets 95 % intervals; ▲ what does not hold the old value.'),
    others.length ? h('details', {}, h('summary', {}, `${others.length} ${changed.length ? 'other ' : ''}channel${others.length === 1 ? '' : 's'} as modelled`), numberTable(others, names)) : null);
}

function validation(diagnosis: Diagnosis): HTMLElement | null {
  const rows = diagnosis.report?.validation ?? [];
  if (!rows.length) return null;
  const columns = ['Error before', 'Error after', 'Fit before, %', 'Fit after, %'];
  return h('section', { 'data-key': 'validation' }, h('h2', {}, 'On data that the fit has not seen'), h('div', { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': 'Errors before and after' }, h('table', { class: 'wide' },
    h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'CV'), ...columns.map(each => h('th', { scope: 'col', class: 'number' }, each)))),
    h('tbody', {}, ...rows.map(each => h('tr', {}, h('th', { scope: 'row' }, each.cv),
      ...[each.rmse_before, each.rmse_after, each.fit_before, each.fit_after].map((value, i) => cell(number(value, 3), columns[i] ?? '', 'number'))))))));
}

const WORTH_A_LINE = 0.1; // probability against the finding, from 2 ln odds; the report names the same ones

const probability = (worse: number): number => 1 / (1 + Math.exp(worse / 2));

function rivals(finding: Finding): string {
  const all = finding.rivals ?? [];
  const near = all.filter(each => each.inseparable || probability(each.worse) >= WORTH_A_LINE);
  if (!near.length) return all.length ? 'Nothing else that was tried comes near.' : '';
  const words = (each: Rival) => `${each.cause.replaceAll('_', ' ')}, ${[each.tag ?? each.mv, each.cv].filter(Boolean).join('\u00a0→\u00a0')}${each.inseparable ? ' (the data do not decide)' : ''}`;
  const others = all.length - near.length;
  return `Or else: ${near.map(words).join('; ')}${others ? `; ${others} other${others === 1 ? '' : 's'} less likely` : ''}.`;
}

export async function diagnosisPage(unit: string): Promise<HTMLElement> {
  const diagnosis = await get<Diagnosis>(`${unitPath(unit)}/diagnosis`);
  const { last, report, reports } = diagnosis;
  const findings = report?.findings ?? [];
  const newest = reports[0];
  return h('div', {},
    h('div', { class: 'head' }, h('h1', { tabindex: -1 }, h('a', { href: unitLink(unit) }, unit), ' / Diagnosis'),
      last ? h('p', { class: 'note' }, 'of the samples up to ', time(last.time_ns)) : null),
    !diagnosis.diagnosed ? h('p', {}, 'Alarms of this unit are not diagnosed: its file says so, or has no model.') : null,
    diagnosis.diagnosed && !last && !findings.length ? h('p', {}, 'No alarm has been diagnosed since the monitor was started. A diagnosis is made 300 samples after an alarm has begun.') : null,
    last?.problem ? h('p', { class: 'problem' }, last.problem) : null,
    last?.file_problem ? h('p', { class: 'problem' }, `The report could not be written: ${last.file_problem}`) : null,
    last?.headline || report?.headline ? h('p', { class: 'headline' }, last?.headline ?? report?.headline) : null,
    report?.details ? h('p', {}, report.details) : null,
    findings.length ? h('section', { 'data-key': 'findings' }, h('h2', {}, 'Findings'), h('ol', { class: 'findings' }, ...findings.map(each => h('li', {},
      h('strong', {}, `${each.title ?? each.cause}${each.mv || each.cv ? `, ${[each.mv, each.cv].filter(Boolean).join('\u00a0→\u00a0')}` : ''}`),
      h('span', { class: 'word' }, `${each.confidence > 0.999 ? '> 99.9' : number(100 * each.confidence, 3)} % sure`),
      h('p', {}, each.explanation),
      rivals(each) ? h('p', { class: 'note' }, rivals(each)) : null)))) : null,
    numbers(diagnosis), validation(diagnosis),
    newest ? h('section', { 'data-key': 'report' }, h('h2', {}, 'Report'),
      h('p', {}, ...reports.flatMap((each, i) => [i ? ', ' : '', h('a', { href: each.html, target: '_blank', rel: 'noopener' }, `alarm of ${each.name.replace(/^(\d+)(\d\d)(\d\d)T(\d\d)(\d\d)(\d\d).*/, '$1-$2-$3 $4:$5:$6 UTC')}`)])),
      h('iframe', { 'data-keep': true, 'data-key': newest.html, class: 'report', title: `Report on ${unit}`, sandbox: 'allow-scripts', src: newest.html })) : null);
}
