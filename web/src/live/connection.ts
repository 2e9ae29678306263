// connection.ts — the WebSocket: comes back by itself, goes on as the same viewer, measures how long an act takes to show.
import { type Command, type Keyframe, type LiveFrame, type Samples, type TextMessage } from "./protocol.ts";
import { decodeMessage, decodeText, encodeCommand } from "./protocol.ts";

const FIRST_WAIT = 400; // ms
const LONGEST_WAIT = 5000;
const UNANSWERED: ReadonlySet<Command["kind"]> = new Set(["take", "give", "colour", "visible"]); // by no echo
const SESSION = "glisson-session";

export type Status = { kind: "open" } | { kind: "waiting" } | { kind: "ended"; reason: string };

export interface Listener {
  text(message: TextMessage): void;
  binary(message: Keyframe | LiveFrame | Samples): void;
  status(status: Status): void;
}

export class Connection {
  latency: number | null = null; // of the last acts [ms]
  private socket: WebSocket | null = null;
  private sequence = 0;
  private sent: { sequence: number; at: number }[] = [];
  private wait = FIRST_WAIT;

  constructor(private readonly listener: Listener) {
    document.addEventListener("visibilitychange", () => this.tellVisible());
  }

  /** A page that nobody sees gets no frames, and the body is held where all are hidden. */
  private tellVisible(): void {
    this.send({ kind: "visible", index: document.hidden ? 0 : 1 });
  }

  open(): void {
    const query = new URLSearchParams({ token: new URLSearchParams(location.search).get("token") ?? "" });
    const session = stored();
    if (session) query.set("session", session);
    const socket = new WebSocket(`ws://${location.host}/stream?${query}`);
    socket.binaryType = "arraybuffer";
    socket.onopen = () => {
      this.wait = FIRST_WAIT;
      if (document.hidden) this.tellVisible();
      this.listener.status({ kind: "open" });
    };
    socket.onmessage = (event) => this.receive(event.data as string | ArrayBuffer);
    socket.onclose = (event) => this.closed(event);
    this.socket = socket;
  }

  private receive(data: string | ArrayBuffer): void {
    if (typeof data === "string") {
      const message = decodeText(data);
      if (!message) return;
      if (message.type === "hello") keep(message.session);
      return this.listener.text(message);
    }
    const message = decodeMessage(data);
    if (!message) return;
    if (message.kind === "frame") this.measure(message.echo);
    this.listener.binary(message);
  }

  /** A frame that shows the act with this number has come. */
  private measure(echo: number): void {
    const found = this.sent.findIndex((act) => act.sequence === echo);
    if (found < 0) return;
    const passed = performance.now() - this.sent[found]!.at;
    this.latency = this.latency === null ? passed : 0.8 * this.latency + 0.2 * passed;
    this.sent.splice(0, found + 1);
  }

  private closed(event: CloseEvent): void {
    this.socket = null;
    this.sent = [];
    if (event.reason === "continued elsewhere")
      return this.listener.status({ kind: "ended", reason: "This view continues in another window." });
    this.listener.status({ kind: "waiting" });
    setTimeout(() => this.open(), this.wait);
    this.wait = Math.min(LONGEST_WAIT, 1.7 * this.wait);
  }

  send(command: Command): void {
    if (this.socket?.readyState !== WebSocket.OPEN) return;
    this.sequence = (this.sequence + 1) % 2 ** 32;
    this.socket.send(encodeCommand(command, this.sequence));
    if (UNANSWERED.has(command.kind)) return;
    this.sent.push({ sequence: this.sequence, at: performance.now() });
    if (this.sent.length > 200) this.sent.shift();
  }

  /** Cuts the line, as a network would. */
  drop(): void {
    this.socket?.close();
  }
}

function stored(): string | null {
  try {
    return sessionStorage.getItem(SESSION);
  } catch {
    return null; // no storage: a reload is a new viewer
  }
}

function keep(session: string): void {
  try {
    sessionStorage.setItem(SESSION, session);
  } catch {
    // see stored()
  }
}
