// Asks what a command needs: who, why, for how long, and the token once.
import { command, Refused, type Command } from './api';
import { h } from './dom';
import { title } from './alarm';

const WORDS: Record<string, string> = {
  acknowledge: 'Acknowledge', shelve: 'Shelve', unshelve: 'Unshelve', suppress: 'Suppress', unsuppress: 'Unsuppress',
  out_of_service: 'Take out of service', in_service: 'Put back in service',
};
const FOR: [string, string][] = [['1800', '30 minutes'], ['3600', '1 hour'], ['14400', '4 hours'], ['28800', '8 hours'], ['once', 'until it has cleared once']];

// Of this tab alone, and gone with it.
const kToken = 'mpm.token', kUser = 'mpm.user';

const field = (text: string, node: HTMLElement, help = '') => h('label', { class: 'field' }, h('span', {}, text), node, help ? h('span', { class: 'note' }, help) : null);

export function ask(alarm: { unit: string; mv: string; cv: string }, action: string, done: (text: string) => void): void {
  const user = h('input', { name: 'user', required: true, maxlength: 100, autocomplete: 'username' }) as HTMLInputElement;
  user.value = sessionStorage.getItem(kUser) ?? '';
  const comment = h('textarea', { name: 'comment', rows: 2, maxlength: 1000 }) as HTMLTextAreaElement;
  const duration = h('select', { name: 'duration' }, ...FOR.map(([value, text]) => h('option', { value }, text))) as HTMLSelectElement;
  duration.value = '3600';
  const token = h('input', { name: 'token', type: 'password', required: true, autocomplete: 'off' }) as HTMLInputElement;
  token.value = sessionStorage.getItem(kToken) ?? '';
  const problem = h('p', { class: 'problem', role: 'alert' });
  const word = WORDS[action] ?? action;
  const send = h('button', { type: 'submit', class: 'main' }, word) as HTMLButtonElement;
  const form = h('form', {},
    h('h2', { id: 'dialog-title' }, `${word}: ${title(alarm)}`), h('p', { class: 'note' }, `Unit ${alarm.unit}`),
    action === 'shelve' ? field('For how long', duration) : null,
    field('Your name', user), field('Comment', comment),
    token.value ? null : field('Token', token, 'Of this monitor’s operators; kept until this tab is closed.'),
    problem, h('div', { class: 'buttons' }, send, h('button', { type: 'button', 'data-close': true }, 'Cancel')));
  const dialog = h('dialog', { 'aria-labelledby': 'dialog-title' }, form) as HTMLDialogElement;

  form.addEventListener('submit', event => {
    event.preventDefault();
    const order: Command = { unit: alarm.unit, mv: alarm.mv, cv: alarm.cv, command: action, user: user.value.trim(), comment: comment.value.trim() };
    if (action === 'shelve')
      if (duration.value === 'once') order.once = true;
      else order.duration_s = Number(duration.value);
    send.disabled = true;
    problem.textContent = '';
    const keep = () => { // what was right is not asked for again
      sessionStorage.setItem(kUser, order.user);
      sessionStorage.setItem(kToken, token.value);
    };
    command(order, token.value).then(text => {
      keep();
      dialog.close();
      done(text || `${word}: done`);
    }).catch((error: unknown) => {
      if (error instanceof Refused && error.status !== 401 && error.status !== 403) keep();
      if (error instanceof Refused && error.status === 401) {
        sessionStorage.removeItem(kToken);
        if (!token.isConnected) problem.before(field('Token', token));
        token.value = '';
        token.focus();
      }
      problem.textContent = `Not done: ${error instanceof Refused ? error.message : 'the monitor does not answer'}`;
    }).finally(() => { send.disabled = false; });
  });
  form.querySelector('[data-close]')?.addEventListener('click', () => dialog.close());
  dialog.addEventListener('close', () => dialog.remove());
  document.body.append(dialog);
  dialog.showModal();
}
