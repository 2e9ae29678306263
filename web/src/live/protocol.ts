// protocol.ts — messages as the page uses them. wire.ts has the format, made from apps/view/wire/messages.toml.
import { Reader } from "./reader.ts";
import * as wire from "./wire.ts";

export type {
  Command,
  Hello,
  LiveEvent,
  ParameterInfo,
  Recorded,
  Role,
  SlowState,
  TextMessage,
  ToolInfo,
} from "./wire.ts";

export interface Keyframe extends Omit<wire.Keyframe, "inside"> {
  kind: "keyframe";
  kinds: Uint8Array | null; // of each triangle: 0 skin, 1 a face that was cut, 2 skin whose capsule is torn; null: all skin
  tissue: string; // name of what most of the body is; may be empty
  regions: wire.Region[]; // closed surfaces of what else there is
  tets: Uint32Array | null; // of the whole body, whose other vertices come last; null: its surfaces alone were sent
}

export interface ToolState extends Omit<wire.Tool, "points"> {
  points: number[];
}

export interface LiveFrame extends Omit<wire.Frame, "tools"> {
  kind: "frame";
  tools: ToolState[];
}

export interface Samples {
  kind: "samples";
  tools: number;
  rows: { epoch: number; time: number; depth: number[]; force: number[] }[];
}

/** A binary message; null where it is none that this page knows. */
export function decodeMessage(buffer: ArrayBuffer): Keyframe | LiveFrame | Samples | null {
  const at = new Reader(buffer);
  try {
    const kind = new DataView(buffer).getUint8(0);
    if (kind === wire.MESSAGES.keyframe) return keyframeOf(wire.readKeyframe(at));
    if (kind === wire.MESSAGES.frame) return frameOf(wire.readFrame(at));
    if (kind === wire.MESSAGES.samples) return samplesOf(wire.readSamples(at));
  } catch (error) {
    if (!(error instanceof RangeError)) throw error; // cut short
  }
  return null;
}

function keyframeOf({ inside, ...skin }: wire.Keyframe): Keyframe {
  return {
    kind: "keyframe",
    ...skin,
    kinds: inside?.kinds.some((kind) => kind !== 0) ? inside.kinds : null,
    tissue: inside?.tissue ?? "",
    regions: inside?.regions ?? [],
    tets: inside?.whole?.tets ?? null,
  };
}

const frameOf = (frame: wire.Frame): LiveFrame => ({
  kind: "frame",
  ...frame,
  tools: frame.tools.map((tool) => ({ ...tool, points: [...tool.points] })),
});

const samplesOf = ({ tools, rows }: wire.Samples): Samples => ({
  kind: "samples",
  tools,
  rows: rows.map(({ epoch, time, readings }) => ({
    epoch,
    time,
    depth: readings.filter((_, k) => k % 2 === 0),
    force: readings.filter((_, k) => k % 2 === 1),
  })),
});

/** A message in JSON; null where it is none that this page knows, or a field is missing or of another kind. */
export function decodeText(text: string): wire.TextMessage | null {
  const message = JSON.parse(text) as wire.TextMessage;
  const fields = Object.entries(wire.TEXTS[message.type] ?? { type: "unknown" });
  const said = message as unknown as Record<string, unknown>;
  return fields.every(([name, kind]) => isOf(said[name], kind)) ? message : null;
}

/** A number that is not finite and a part that there is not come as null. */
function isOf(value: unknown, kind: string): boolean {
  if (value === null) return kind === "number" || kind === "object";
  return kind === "list" ? Array.isArray(value) : typeof value === kind;
}

/** The bytes of a command. */
export function encodeCommand(command: wire.Command, sequence: number): ArrayBuffer {
  const { kind, tool, sequence: count, end } = wire.COMMAND_AT;
  const index = "index" in command ? [command.index] : [];
  const values: number[] = "values" in command ? [...command.values] : [];
  const view = new DataView(new ArrayBuffer(end + 4 * index.length + 4 * values.length));
  view.setUint8(kind, wire.COMMANDS[command.kind]);
  view.setUint8(tool, "tool" in command ? command.tool : 0);
  view.setUint32(count, sequence, true);
  index.forEach((value) => view.setUint32(end, value, true));
  values.forEach((value, i) => view.setFloat32(end + 4 * index.length + 4 * i, value, true));
  return view.buffer;
}
