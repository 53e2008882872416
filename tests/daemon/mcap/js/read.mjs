// node read.mjs FILE.mcap LONG.csv: reads the recording with the index and as a stream, checks all
// CRCs, decodes by the schema inside, and compares every value with `mpm convert --layout long`.
import { parseIDL } from "@foxglove/omgidl-parser";
import { MessageReader } from "@foxglove/omgidl-serialization";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { decompress } from "fzstd";
import fs from "node:fs";
import { open } from "node:fs/promises";

const [path, csv] = process.argv.slice(2);
const fail = (text) => {
  console.error(`${path}: ${text}`);
  process.exit(1);
};
const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };

const expected = new Map();
for (const line of fs.readFileSync(csv, "utf8").trim().split("\n").slice(1)) {
  const [tag, time, value, quality] = line.split(",");
  expected.set(`${tag} ${Math.round(Number(time) * 1e3)}`, { value, quality });
}

const file = await open(path);
const size = BigInt((await file.stat()).size);
const readable = {
  size: async () => size,
  read: async (offset, length) => {
    const bytes = new Uint8Array(Number(length));
    await file.read(bytes, 0, Number(length), Number(offset));
    return bytes;
  },
};
// XCDR2 puts a length before sequences of strings and of structs (DDS-XTypes 1.3); version 1.0.3 of
// the library does not read it.
class Xcdr2Reader extends MessageReader {
  readMemberFieldValue(field, reader, header, options) {
    const plain = field.isComplex !== true && field.type !== "string";
    if (options.usesDelimiterHeader && field.isArray && !plain) reader.dHeader();
    return super.readMemberFieldValue(field, reader, header, options);
  }
}

const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
const decoders = new Map();
const decode = (message) => {
  const channel = reader.channelsById.get(message.channelId);
  const schema = reader.schemasById.get(channel.schemaId);
  if (schema.encoding !== "omgidl" || channel.messageEncoding !== "cdr") fail("not omgidl and cdr");
  if (!decoders.has(schema.id))
    decoders.set(
      schema.id,
      new Xcdr2Reader(schema.name, parseIDL(new TextDecoder().decode(schema.data))),
    );
  return [channel.topic, decoders.get(schema.id).readMessage(message.data)];
};

const names = ["good", "uncertain", "bad"];
const tags = new Map();
let messages = 0, values = 0, last = 0n;
for await (const message of reader.readMessages({ validateCrcs: true })) {
  ++messages;
  if (message.logTime < last) fail("not in the order of log times");
  last = message.logTime;
  const [topic, sample] = decode(message);
  if (topic === "mpm/layout") {
    tags.set(`mpm/${sample.kind}`, sample.tags);
    continue;
  }
  if (sample.source_time_ns !== message.publishTime) fail("publish time is not the source time");
  const layout = tags.get(topic) ?? fail(`no layout of ${topic}`);
  sample.values.forEach((value, i) => {
    if (layout[i] === "") return;
    const key = `${layout[i]} ${Number(sample.source_time_ns / 1000000n)}`;
    const cell = expected.get(key) ?? fail(`${key} is not in ${csv}`);
    expected.delete(key);
    ++values;
    const same = Number.isFinite(value) ? Object.is(Number(cell.value), value) : cell.value === "";
    const quality = Number.isFinite(value) ? names[sample.quality[i] ?? 0] : "bad";
    if (!same || quality !== cell.quality)
      fail(`${key}: ${value} ${quality}, not ${cell.value} ${cell.quality}`);
  });
}
// What no topic ever said is missing in the table.
for (const [key, cell] of expected) if (cell.value !== "") fail(`${key} is not in the recording`);
if (BigInt(messages) !== reader.statistics.messageCount) fail("the statistics count otherwise");

const stream = new McapStreamReader({ validateCrcs: true, decompressHandlers });
stream.append(fs.readFileSync(path));
let streamed = 0;
for (let record; (record = stream.nextRecord()) != undefined; ) if (record.type === "Message") ++streamed;
if (!stream.done() || streamed !== messages) fail(`${streamed} messages in the stream`);
console.log(`${path}: ${messages} messages, ${values} values, all the same`);
