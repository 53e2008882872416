// Our programs as processes of this test, ended by their own ids.
import { spawn } from "node:child_process";
import { mkdtempSync, rmSync, writeFileSync } from "node:fs";
import os from "node:os";
import path from "node:path";

export const token = "0123456789abcdef0123456789abcdef";
export const work = mkdtempSync(path.join(os.tmpdir(), "mpm-page-"));
const tokenFile = path.join(work, "token");
writeFileSync(tokenFile, `${token}\n`, { mode: 0o600 });
const tag = `mpm-page-${process.pid}`; // keeps this test apart from others on the machine
const running = new Set();

function start(program, args) {
  const child = spawn(program, args, { stdio: ["ignore", "ignore", "pipe"] });
  running.add(child);
  child.said = "";
  child.ended = new Promise((resolve) => child.once("exit", () => { running.delete(child); resolve(); }));
  child.stderr.on("data", (text) => { child.said += text; });
  return child;
}

export async function monitor(bin, units, { port = 0, folder = "state" } = {}) {
  const child = start(path.join(bin, "mpmd"), [...units.flatMap((unit) => ["--config", unit]), "--partition", tag,
    "--http", String(port), "--token-file", tokenFile, "--state-dir", path.join(work, folder)]);
  for (let waits = 0; waits < 200; ++waits) {
    const found = child.said.match(/operator page at (\S+)/);
    if (found) return { child, url: found[1], port: Number(new URL(found[1]).port) };
    if (!running.has(child)) break;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  throw new Error(`mpmd does not serve the page: ${child.said}`);
}

export const plant = (bin, unit, { samples, speed }) => start(path.join(bin, "mpmsim"), ["--config", unit, "--scenario", "hidden_gain",
  "--seed", "3", "--samples", String(samples), "--speed", String(speed), "--wait-readers", "10", "--partition", tag]);

export async function end(child, signal = "SIGTERM") {
  if (running.has(child)) child.kill(signal);
  await child.ended;
}

export async function endAll() {
  await Promise.all([...running].map((child) => end(child, "SIGKILL")));
  rmSync(work, { recursive: true, force: true });
}
