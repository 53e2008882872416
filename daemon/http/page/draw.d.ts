// The part of the report's drawing code (daemon/report/page/draw.js) that the page uses.
export type Values = (number | null)[];

export interface Line { name: string; role: string; values: Values; dashed?: boolean }
export interface Band { role: string; low: Values; high: Values }
export interface Plot {
  title?: string;
  note?: string;
  x: { clock?: boolean; label?: string; values: number[] };
  y: { label: string };
  lines: Line[];
  bands?: Band[];
  group?: string;
  low?: boolean;
  ends?: [number, number];
  onZoom?: (from: number | null, until?: number) => void;
}
export interface Figure extends HTMLElement {
  update(next: Partial<Plot>): void;
  destroy(): void;
}

export function figure(plot: Plot, options?: { keys?: boolean; title?: string; height?: number }): Figure;
export function number(value: number | null | undefined, digits?: number): string;
export function setZone(name: string): void;
