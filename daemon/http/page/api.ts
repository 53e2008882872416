// What the monitor's HTTP API answers (openapi.json), as far as the page uses it.

export type State = 'match' | 'watch' | 'mismatch' | 'undetermined';
export type Values = (number | null)[];
export interface Limits { low: number | null; high: number | null }
export interface Trend { now: number | null; change: number | null; times: number[]; values: Values }
export interface Kpi {
  service_factor: number | null; at_limits: number | null; outside_limits: number | null;
  prediction_error: number | null; determined: number | null; samples: number;
  model_accuracy: Trend; determined_trend: Trend;
}
export interface Alarm {
  unit: string; mv: string; cv: string; to: string; time_ns: number; text: string;
  cause?: string | null; cause_text?: string; cause_confidence?: number; state?: State;
  alarm_state?: string; priority?: string; severity?: number; message?: string; comment?: string;
  suppressed?: boolean; suppressed_by_design?: boolean;
  notification_class?: string; client_user_id?: string; active_time_ns?: number; ack_time_ns?: number;
  shelving_state?: string; unshelve_time_ns?: number; guidance?: string; display_url?: string;
}
export interface Card {
  unit: string; snapshot: number; speaks: boolean; attention: number; sample_time_s: number; time_ns: number;
  health: { state: string; detail: string };
  alarms: number; silenced_alarms: number; first_alarms: Alarm[];
  match: number; mismatch: number; undetermined: number;
  inputs: string[]; cvs: string[]; matrix: State[][]; kpi: Kpi;
}
export interface Input { tag: string; unit: string; description: string; kind: string; limits: Limits; value: number | null }
export interface Cv {
  tag: string; unit: string; description: string; setpoint_tag: string | null; limits: Limits;
  measured: number | null; prediction: number | null; setpoint: number | null;
}
export interface Channel {
  mv: string; cv: string; verdict: string; reason?: string; state: State; text: string;
  nonlinear_text: string; modelled: boolean; alarm: string; excited: boolean; smallest_error: number | null;
  gain_error_percent?: number;
}
export interface Trouble { severity: string; text: string }
export interface Health extends Record<string, unknown> { state: string; detail: string; frames: number }
export interface Unit {
  unit: string; snapshot: number; speaks: boolean; attention: number; sample_time_s: number; time_ns: number;
  inputs: Input[]; cvs: Cv[]; channels: Channel[]; alarms: Alarm[]; health: Health; troubles: Trouble[]; kpi: Kpi;
}
export interface Reaches { mean: Values; min: Values; max: Values }
export interface Series {
  unit: string; cv: string; cv_unit: string; first: number | null; last: number | null;
  from: number; until: number; step_s: number; times: number[];
  measured: Reaches; prediction: Values; setpoint: Values; residual: Reaches;
  residual_band: { low: number; high: number; samples: number } | null; limits: Limits;
  inputs: (Reaches & { tag: string; unit: string })[];
}
export interface Correlation {
  mv: string; first_lag: number; values: number[]; limit: number | null; lag: number;
  partial_correlation: number | null; excited: boolean; smallest_error: number | null;
  effective_samples: number | null; verdict: string; state: State; text: string;
}
export interface Correlations { sample_time_s: number; inputs: Correlation[] }
export interface Rival { cause: string; cv: string | null; mv: string | null; tag: string | null; worse: number; inseparable: boolean }
export interface Finding {
  cause: string; title?: string; cv: string | null; mv: string | null; explanation: string; confidence: number;
  in_model?: boolean; explains?: number; rivals?: Rival[];
}
export interface Diagnosis {
  unit: string; diagnosed: boolean;
  last: { interval: number; time_ns: number; alarm_time_ns: number; headline: string; problem: string; file_problem: string;
    causes: { mv: string; cv: string; cause: string; cause_text: string; cause_confidence: number;
      cause_parameters: Record<string, number>; cause_intervals: Record<string, [number, number]> }[] } | null;
  reports: { name: string; html: string; json: string }[];
  report: { verdict?: string; reason?: string; headline?: string; details?: string; findings?: Finding[];
    validation?: { cv: string; unit?: string; rmse_before: number; rmse_after: number; fit_before: number | null; fit_after: number | null; refused: boolean }[];
    channels?: { cv: string; mv: string; parameters: Record<string, number>; interval: Record<string, [number, number]> }[] } | null;
}
export interface Event {
  record: string; unit: string; mv: string; cv: string; to: string; time_ns: number; cause_text?: string;
  text?: string; message?: string; client_user_id?: string; comment?: string; suppressed?: boolean; suppressed_by_design?: boolean;
}
export interface SystemUnit extends Record<string, unknown> {
  unit: string; state: string; detail: string; time_ns: number; troubles: Trouble[]; samples_per_second: number;
}
export interface System {
  version: string; time_ns: number; started_ns: number; resident_bytes: number; processor_seconds: number;
  units: SystemUnit[]; commands: boolean; server?: Record<string, number>;
}

/// The monitor answered, and said no.
export class Refused extends Error {
  constructor(public status: number, text: string) { super(text); }
}

const kPatience = 8000; // ms

async function answer(response: Response): Promise<unknown> {
  const body: unknown = await response.json().catch(() => ({}));
  if (response.ok) return body;
  const said = body as { error?: string; text?: string };
  throw new Refused(response.status, said.error ?? said.text ?? `the monitor answered ${response.status}`);
}

export async function get<T>(path: string): Promise<T> {
  return await answer(await fetch(`/api/v1/${path}`, { signal: AbortSignal.timeout(kPatience), cache: 'no-store' })) as T;
}

export interface Command {
  unit: string; mv: string; cv: string; command: string; duration_s?: number; once?: boolean; user: string; comment: string;
}

export async function command(order: Command, token: string): Promise<string> {
  const reply = await answer(await fetch('/api/v1/commands', {
    method: 'POST', signal: AbortSignal.timeout(kPatience), body: JSON.stringify(order),
    headers: { 'Content-Type': 'application/json', Authorization: `Bearer ${token}` },
  })) as { text: string };
  return reply.text;
}

export const part = encodeURIComponent;
export const unitPath = (unit: string) => `units/${part(unit)}`;
