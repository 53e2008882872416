// The frame of the page: where one is, what changes, and whether the monitor is heard.
import { Refused } from './api';
import { CvPage } from './cv';
import { ask } from './dialog';
import { diagnosisPage } from './diagnosis';
import { h, morph } from './dom';
import { setZone } from './draw.js';
import { choose, journal } from './journal';
import { listen, type Link } from './live';
import { overview } from './overview';
import { system } from './system';
import { inUtc, nowText, nowUtc, zone } from './text';
import { setTab, unitPage } from './unit';

interface Page { name: string; update(): Promise<HTMLElement>; leave?(): void; choose?(span: number): void }

const kLeast = 1000; // ms between two looks at the same page
const kPolling = 5000;

const main = h('main', { id: 'main', tabindex: -1 });
const link = h('p', { id: 'link', role: 'status' });
const banner = h('div', { id: 'lost', role: 'alert' });
const notice = h('div', { id: 'notice', role: 'status' });
const clock = h('p', { id: 'clock' });
const nav = h('nav', { 'aria-label': 'Pages' });
let page: Page, turn = 0, looked = 0, pending = 0, busy = 0, again = false, arriving = false, state: Link['state'] = 'connecting';

const show = (name: string, update: () => Promise<HTMLElement>): Page => ({ name, update });

function route(): Page {
  const parts = location.hash.replace(/^#\/?/, '').split('/').map(each => { try { return decodeURIComponent(each); } catch { return each; } });
  const [first, unit, what, cv] = parts;
  if (first === 'journal') return show('Journal', journal);
  if (first === 'system') return show('System', system);
  if (first !== 'unit' || !unit) return show('Overview', overview);
  if (what === 'diagnosis') return show(`${unit} / Diagnosis`, () => diagnosisPage(unit));
  if (what === 'cv' && cv) {
    const one = new CvPage(unit, cv, () => void look());
    return { name: `${unit} / ${cv}`, update: () => one.update(), leave: () => one.leave(), choose: span => one.choose(span) };
  }
  return show(unit, () => unitPage(unit));
}

function drawNav(): void {
  const links: [string, string][] = [['#/', 'Overview'], ['#/journal', 'Journal'], ['#/system', 'System']];
  const here = location.hash || '#/';
  nav.replaceChildren(...links.map(([href, text]) => h('a', { href, 'aria-current': here === href || (href === '#/' && here.startsWith('#/unit')) ? 'page' : null }, text)));
}

/// Looks anew; of several that are under way the last one counts.
async function look(): Promise<void> {
  ++busy;
  try {
    await lookOnce();
  } finally {
    --busy;
    if (!busy && again) news();
  }
}

async function lookOnce(): Promise<void> {
  const mine = ++turn, at = page;
  looked = Date.now();
  again = false;
  let next: HTMLElement;
  try {
    next = await at.update();
  } catch (error) {
    if (mine !== turn || at !== page) return;
    // What stands there stays, and the banner says that it is old.
    if (!(error instanceof Refused)) return;
    next = h('div', {}, h('h1', { tabindex: -1 }, at.name), h('p', { class: 'problem' }, error.message));
  }
  if (mine !== turn || at !== page) return;
  morph(main, h('main', {}, next));
  if (!arriving) return;
  arriving = false;
  scrollTo(0, 0);
  main.querySelector('h1')?.focus();
}

/// Where answers take longer than news, a look that is under way is not overtaken by the next one: the
/// page would never be drawn.
function news(): void {
  if (busy) again = true;
  if (busy || pending) return;
  pending = window.setTimeout(() => {
    pending = 0;
    if (busy) again = true;
    else void look();
  }, Math.max(0, kLeast - (Date.now() - looked)));
}

function go(focus: boolean): void {
  page?.leave?.();
  page = route();
  document.title = `${page.name} – MPM monitor`;
  drawNav();
  main.replaceChildren(h('p', { class: 'note' }, 'Reading …'));
  arriving = focus;
  void look();
}

function showLink({ state: next, since }: Link): void {
  state = next;
  const [sign, text] = { connecting: ['○', 'Connecting'], live: ['●', 'Live'], polling: ['◐', 'Read every 5 s'], lost: ['✖', 'Connection lost'] }[next] as [string, string];
  link.className = next;
  link.replaceChildren(h('span', { 'aria-hidden': 'true' }, `${sign} `), text);
  document.body.classList.toggle('stale', next === 'lost');
  const at = new Date(since).toLocaleTimeString('en-GB');
  banner.replaceChildren(...next === 'lost' ? [h('strong', {}, 'Connection lost. '), `The monitor has not been heard since ${at}; what stands here is as old. Trying again by itself.`] : []);
}

function act(target: HTMLElement): void {
  const { do: what, tab, span, command, alarm } = target.dataset;
  if (what === 'tab' && tab) {
    setTab(tab);
    void look();
  }
  if (what === 'span' && span) page.choose?.(Number(span));
  if (what === 'command' && command && alarm) {
    const [unit, mv, cv] = JSON.parse(alarm) as [string, string, string];
    ask({ unit, mv, cv }, command, text => {
      notice.textContent = text;
      window.setTimeout(() => { if (notice.textContent === text) notice.textContent = ''; }, 6000);
      void look();
    });
  }
}

document.addEventListener('click', event => {
  const target = event.target instanceof Element ? event.target.closest<HTMLElement>('[data-do]') : null;
  if (target) act(target);
});
document.addEventListener('change', event => {
  const target = event.target;
  if (!(target instanceof HTMLSelectElement) || !target.dataset['choose']) return;
  choose(target.dataset['choose'], target.value);
  void look();
});
// Between tabs with the arrow keys.
document.addEventListener('keydown', event => {
  const tab = event.target instanceof HTMLElement && event.target.role === 'tab' ? event.target : null;
  const by = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
  if (!tab?.parentElement || !by) return;
  const tabs = [...tab.parentElement.querySelectorAll<HTMLElement>('[role=tab]')];
  const next = tabs[(tabs.indexOf(tab) + by + tabs.length) % tabs.length];
  next?.focus();
  if (next) act(next);
});

setZone(zone);
document.body.append(
  h('a', { class: 'skip', href: '#main', 'data-skip': true }, 'Skip to the content'),
  h('header', { class: 'top' }, h('p', { class: 'name' }, 'MPM monitor'), nav, link, clock),
  banner, notice, main);
document.querySelector('[data-skip]')?.addEventListener('click', event => {
  event.preventDefault(); // the hash is the page
  main.focus();
});
const tick = () => clock.replaceChildren(h('span', {}, nowText()), inUtc ? ' UTC' : h('span', { class: 'utc' }, ` ${nowUtc()}`));
tick();
setInterval(() => {
  tick();
  if (state === 'polling' && Date.now() - looked > kPolling) void look();
}, 1000);
addEventListener('hashchange', () => go(true));
go(false);
listen(news, showLink);
