// Reads an MCAP file with Foxglove's readers, checks what they check, and prints it as lines of JSON:
//   {"topic", "type", "encoding", "profiles", "hash", "definition"}   for each channel
//   {"of": TOPIC, "stamp": NS, "fields": [...]}               for each message, in the file's order; decoded by its
//                                                             definition: numbers and texts one after the other, a
//                                                             sequence is its length and then its elements
//   {"of": TOPIC, "stamp": NS, "cdr": BASE64}                 where there is no definition
//   {"profile", "messages", "chunks", ...}                    at the end
//
//   node read.mjs FILE          a whole file: front to back, and again by its index
//   node read.mjs FILE cut-off  front to back as far as it goes
import { open, readFile } from "node:fs/promises";
import { McapIndexedReader, McapStreamReader } from "@mcap/core";
import { parse } from "@foxglove/rosmsg";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import { decompress } from "fzstd";

const [path, kind] = process.argv.slice(2);
const decompressHandlers = { zstd: (data, size) => decompress(data, new Uint8Array(Number(size))) };
const text = new TextDecoder("utf-8", { fatal: true });
const lines = [];
// What JSON has no number for is {"number": TEXT}.
const isNoJson = (v) => typeof v === "bigint" || (typeof v === "number" && !Number.isFinite(v));
const say = (value) => lines.push(JSON.stringify(value, (_, v) => (isNoJson(v) ? { number: String(v) } : v)));

function fail(why) {
  console.error(`${path}: ${why}`);
  process.exit(1);
}

class Decoder {
  constructor(schema) {
    this.definitions = parse(text.decode(schema.data), { ros2: true });
    this.byName = new Map(this.definitions.map((d) => [d.name, d]));
    this.reader = new MessageReader(this.definitions);
  }
  decode(data) {
    const fields = [];
    this.append(this.reader.readMessage(data), this.definitions[0], fields);
    return fields;
  }
  append(value, definition, fields) {
    for (const field of definition.definitions.filter((f) => !f.isConstant)) {
      const one = (v) => {
        if (field.isComplex) this.append(v, this.byName.get(field.type), fields);
        else if (field.type === "time" || field.type === "duration") fields.push(v.sec, v.nsec ?? v.nanosec);
        else fields.push(v);
      };
      const v = value[field.name];
      if (!field.isArray) {
        one(v);
        continue;
      }
      if (field.arrayLength === undefined) fields.push(v.length);
      for (const element of v) one(element);
    }
  }
}

// Front to back, which checks each chunk's checksum.
const stream = new McapStreamReader({ decompressHandlers, includeChunks: true, validateCrcs: true });
stream.append(await readFile(path));
const schemas = new Map(), channels = new Map(), decoders = new Map(), counts = new Map();
let header, statistics, chunks = 0, messages = 0;
for (let record; (record = stream.nextRecord()); ) {
  if (record.type === "Header") header = record;
  if (record.type === "Chunk" && record.uncompressedCrc === 0) fail(`the chunk ${chunks} has no checksum`);
  if (record.type === "Chunk") chunks++;
  if (record.type === "Statistics") statistics = record;
  if (record.type === "Schema" && !schemas.has(record.id)) {
    schemas.set(record.id, record);
    if (record.encoding === "ros2msg") decoders.set(record.id, new Decoder(record));
    else if (record.encoding !== "" || record.data.length > 0) fail(`the schema ${record.name} is ${record.encoding}`);
  }
  if (record.type === "Channel" && !channels.has(record.id)) {
    channels.set(record.id, record);
    const schema = schemas.get(record.schemaId) ?? fail(`${record.topic} has no schema`);
    say({ topic: record.topic, type: schema.name, encoding: record.messageEncoding,
          profiles: record.metadata.get("offered_qos_profiles"),
          hash: record.metadata.get("topic_type_hash"), definition: text.decode(schema.data) });
  }
  if (record.type !== "Message") continue;
  const channel = channels.get(record.channelId) ?? fail(`a message of the unknown channel ${record.channelId}`);
  const count = counts.get(record.channelId) ?? 0;
  if (record.sequence !== count) fail(`${channel.topic}: message ${count} has the number ${record.sequence}`);
  if (record.logTime !== record.publishTime) fail(`${channel.topic}: ${record.logTime} is not ${record.publishTime}`);
  counts.set(record.channelId, count + 1);
  messages++;
  const decoder = decoders.get(channel.schemaId);
  const what = decoder ? { fields: decoder.decode(record.data) } : { cdr: Buffer.from(record.data).toString("base64") };
  say({ of: channel.topic, stamp: record.logTime, ...what });
}

const end = { profile: header.profile, messages, chunks };

// By the index, which checks the summary's checksum.
if (kind !== "cut-off") {
  if (!stream.done()) fail("it does not end as it should");
  const file = await open(path);
  const readable = {
    size: async () => BigInt((await file.stat()).size),
    read: async (offset, size) => {
      const { buffer, bytesRead } = await file.read(new Uint8Array(Number(size)), 0, Number(size), Number(offset));
      if (bytesRead !== Number(size)) throw new Error(`only ${bytesRead} of ${size} bytes at ${offset}`);
      return buffer;
    },
  };
  const indexed = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  let found = 0, before = 0n;
  const byChannel = new Map();
  for await (const message of indexed.readMessages({ validateCrcs: true })) {
    if (message.logTime < before) fail("the index is not in order");
    before = message.logTime;
    found++;
    byChannel.set(message.channelId, (byChannel.get(message.channelId) ?? 0) + 1);
  }
  if (found !== messages) fail(`it has ${messages} messages, its index ${found}`);
  if (indexed.chunkIndexes.length !== chunks) fail(`it has ${chunks} chunks, its index ${indexed.chunkIndexes.length}`);
  if (indexed.channelsById.size !== channels.size) fail("its summary has other channels");
  if (statistics.messageCount !== BigInt(messages) || statistics.chunkCount !== chunks || statistics.channelCount !== channels.size ||
      statistics.schemaCount !== schemas.size) fail("its statistics are wrong");
  for (const [id, count] of byChannel) {
    if (statistics.channelMessageCounts.get(id) !== BigInt(count)) fail(`the statistics of channel ${id} are wrong`);
  }
  if (indexed.dataSectionCrc === undefined || indexed.footer.summaryCrc === 0) fail("a checksum is missing");
  await file.close();
  end.crc = indexed.dataSectionCrc;
}
say(end);
process.stdout.write(lines.join("\n") + "\n");
