// Numbers, times and words as the page shows them.
import { number } from './draw.js';

export { number };

/// So many digits that the two can be told apart.
export function interval(low: number, high: number): string {
  const kFewest = 3, kMost = 7;
  let digits = kFewest;
  while (digits < kMost && low !== high && number(low, digits) === number(high, digits)) ++digits;
  return `${number(low, digits)} to ${number(high, digits)}`;
}

export const percent = (share: number | null | undefined, digits = 0): string =>
  share === null || share === undefined || !Number.isFinite(share) ? '–' : `${(100 * share).toFixed(digits)} %`;

export const withUnit = (value: number | null, unit: string): string => `${number(value)}${unit && value !== null ? ` ${unit}` : ''}`;

const two = (value: number) => String(value).padStart(2, '0');
const kMonths = ['Jan', 'Feb', 'Mar', 'Apr', 'May', 'Jun', 'Jul', 'Aug', 'Sep', 'Oct', 'Nov', 'Dec'];

export const zone = Intl.DateTimeFormat().resolvedOptions().timeZone || 'UTC';
export const inUtc = new Date().getTimezoneOffset() === 0;

const clock = (date: Date) => `${two(date.getHours())}:${two(date.getMinutes())}:${two(date.getSeconds())}`;
const utcClock = (date: Date) => `${two(date.getUTCHours())}:${two(date.getUTCMinutes())}:${two(date.getUTCSeconds())}`;

/// "03:12:08", with the day where that is not today.
export function moment(ns: number | null | undefined): string {
  if (!ns) return '–';
  const date = new Date(ns / 1e6), now = new Date();
  const year = date.getFullYear() === now.getFullYear() ? '' : ` ${date.getFullYear()}`;
  return date.toDateString() === now.toDateString() ? clock(date)
    : `${date.getDate()} ${kMonths[date.getMonth()]}${year} ${clock(date)}`;
}

/// Beside it, what the plant and the logs write: "02:12:08 UTC", with its day where that is another.
export function utc(ns: number | null | undefined): string {
  if (!ns) return '';
  const date = new Date(ns / 1e6);
  const other = date.getUTCDate() !== date.getDate() ? `${date.getUTCDate()} ${kMonths[date.getUTCMonth()]} ` : '';
  return `${other}${utcClock(date)} UTC`;
}

/// "UTC+1", as of that moment.
export function zoneText(ns: number): string {
  const minutes = -new Date(ns / 1e6).getTimezoneOffset(), size = Math.abs(minutes);
  return minutes ? `UTC${minutes > 0 ? '+' : '−'}${Math.floor(size / 60)}${size % 60 ? `:${two(size % 60)}` : ''}` : 'UTC';
}

export const nowText = () => clock(new Date());
export const nowUtc = () => `${utcClock(new Date())} UTC`;

export function span(seconds: number): string {
  for (const [name, size] of [['d', 86400], ['h', 3600], ['min', 60]] as const)
    if (seconds >= 2 * size) return `${Math.round(seconds / size)} ${name}`;
  return `${Math.max(0, Math.round(seconds))} s`;
}

export const HEALTH: Record<string, { word: string; sign: string; name: string }> = {
  normal: { word: 'Normal', sign: '', name: 'ok' },
  maintenance_required: { word: 'Maintenance required', sign: '◆', name: 'maintenance' },
  function_check: { word: 'Function check', sign: '▣', name: 'check' },
  out_of_specification: { word: 'Out of specification', sign: '△', name: 'doubtful' },
  failure: { word: 'Failure', sign: '✖', name: 'failure' },
};
export const healthOf = (state: string) => HEALTH[state] ?? { word: state || 'Starting', sign: '▣', name: 'check' };

export const STATES = {
  mismatch: { word: 'Mismatch', sign: '▲' },
  watch: { word: 'Watch', sign: '◆' },
  match: { word: 'Match', sign: '✓' },
  undetermined: { word: 'Undetermined', sign: '?' },
} as const;
