// live_page.ts — the page of the live view: what is where, and which act sends what.
import type * as THREE from "three";
import { formatInteger, formatSignificant } from "../format/number.ts";
import { button, download, h, select } from "../page/dom.ts";
import { forceText } from "../mesh3d/force_arrow.ts";
import { toggleTheme } from "../page/theme.ts";
import { fieldOf } from "./colouring.ts";
import { Connection, type Status } from "./connection.ts";
import { ForcePlot } from "./force_plot.ts";
import { History } from "./history.ts";
import { CutPanel } from "./cut_panel.ts";
import { LiveView } from "./live_view.ts";
import { paceText } from "./pace.ts";
import { ReplayControls } from "./replay_controls.ts";
import { legsTo, Placing, startOf } from "./placing.ts";
import type {
  Command,
  Hello,
  Keyframe,
  LiveFrame,
  Recorded,
  Role,
  Samples,
  SlowState,
  TextMessage,
  ToolState,
} from "./protocol.ts";
import { Slider } from "./slider.ts";
import { TissuePanel } from "./tissue_panel.ts";
import { FIELDS } from "./wire.ts";

interface ToolSliders {
  depth: Slider;
  side: Slider;
  third: Slider;
  speed: Slider;
}

const PLOT_EVERY = 125; // ms
const SEEN = 10_000; // frames that the plot over time shows: ten seconds

export class LivePage {
  readonly element = h("div", { class: "live" });
  readonly connection: Connection;
  readonly view: LiveView;
  hello: Hello | null = null;
  role: Role = { type: "role", drives: false, led: false, viewers: 0 };
  frame: LiveFrame | null = null;
  history = new History(0);
  private tool = 0;
  private waiting: Command | null = null; // the newest place or drag; one goes out a frame
  private sliders: ToolSliders[] = [];
  private told: SlowState | null = null;
  private replay: ReplayControls | null = null; // of a recorded run, in place of hands
  private readonly plots = {
    depth: new ForcePlot("Force [N] against depth", "depth [mm]", 1000),
    time: new ForcePlot("Force [N] over time", "time [s]", 1),
  };
  private readonly title = h("h1", {}, "Glisson");
  private readonly subtitle = h("p", { class: "muted live-subtitle" });
  private readonly status = h("p", { class: "live-status", role: "status" });
  private readonly notice = h("p", { class: "live-notice", role: "alert", hidden: true });
  private readonly lead = h("div", { class: "live-lead" });
  private readonly tools = h("section", { class: "live-panel", "aria-label": "Tools" });
  private readonly numbers = h("dl", { class: "live-numbers" });
  private readonly run = h("div", { class: "live-run", role: "group", "aria-label": "Run" });
  private readonly tissue = new TissuePanel((index, value) => this.send({ kind: "parameter", index, values: [value] }));
  private readonly events = h("ol", { class: "live-events" });
  private readonly values = new Map<string, HTMLElement>();
  private pauseButton: HTMLButtonElement | null = null;
  private readonly cutPanel: CutPanel;
  private readonly recordButton = button(
    "Save recording",
    "Save all forces since the last reset, and the motion as a scene that glisson run can replay (zip)",
    () => this.saveRecording(),
  );

  constructor() {
    this.connection = new Connection({
      text: (message) => this.text(message),
      binary: (message) => this.binary(message),
      status: (status) => this.showStatus(status),
    });
    this.view = new LiveView(() => this.hello, {
      mayAct: () => this.role.drives,
      grab: (vertex, at, bonded) => this.send({ kind: "grab", tool: bonded ? 1 : 0, index: vertex, values: xyz(at) }),
      place: (at) => this.placeAt(xyz(at)),
      drag: (to) => this.sendSoon({ kind: "drag", values: xyz(to) }),
      cut: (begins, from, to) => this.send({ kind: "cut", index: begins ? 1 : 0, values: [...xyz(from), ...xyz(to)] }),
      letGo: () => ((this.waiting = null), this.send({ kind: "letGo" })),
      push: (tool, depth) => this.push(tool, depth),
    });
    this.cutPanel = new CutPanel(this.view);
    this.element.append(this.head(), this.notice, this.body());
    setInterval(() => this.drawPlots(), PLOT_EVERY);
    this.showStatus({ kind: "waiting" });
  }

  private head(): HTMLElement {
    return h(
      "header",
      { class: "live-head" },
      h("div", {}, this.title, this.subtitle),
      h(
        "div",
        { class: "live-side" },
        this.status,
        this.lead,
        button("Dark or light", "Change between dark and light", toggleTheme),
      ),
    );
  }

  private body(): HTMLElement {
    this.view.onColour = (colouring) => this.send({ kind: "colour", index: fieldOf(colouring) });
    this.view.onInside = (wanted) => this.send({ kind: "inside", index: wanted ? 1 : 0 });
    const tools = h(
      "div",
      { class: "live-view-tools" },
      this.view.look.colour,
      this.view.look.detail,
      check("Edges", (on) => (this.view.edges = on)),
      check("Force", (on) => (this.view.force.on = on), true),
      this.view.look.seeThrough,
      this.view.cut.tick,
      button("Show all", "Show the whole body (0)", () => this.view.fit()),
      button("Save picture", "Save the view as a PNG", () => this.savePicture()),
      button("Save forces", "Save the forces of this run as CSV", () => this.saveForces()),
      this.recordButton,
    );
    return h(
      "main",
      { class: "live-main" },
      h(
        "div",
        { class: "live-left" },
        this.view.element,
        h("div", { class: "live-bar" }, this.cutPanel.modes, this.run),
        this.cutPanel.element,
        tools,
        this.view.cut.element,
      ),
      h(
        "div",
        { class: "live-right" },
        this.numbers,
        this.tools,
        this.plots.depth.element,
        this.plots.time.element,
        this.tissue.element,
        this.events,
      ),
    );
  }

  // ---- what comes in

  private text(message: TextMessage): void {
    if (message.type === "hello") this.start(message);
    if (message.type === "role") this.showRole(message);
    if (message.type === "state") this.showState(message);
    if (message.type === "notice") {
      this.notice.textContent = message.text;
      this.notice.hidden = message.text === "";
      setTimeout(() => this.told && this.tissue.follow(this.told.parameters), 700); // what was refused goes back
    }
  }

  private binary(message: Keyframe | LiveFrame | Samples): void {
    if (message.kind === "keyframe") {
      this.view.takeKeyframe(message);
      this.cutPanel.takeKeyframe(message);
    }
    if (message.kind === "samples") this.history.add(message);
    if (message.kind !== "frame") return;
    this.frame = message;
    this.view.takeFrame(message);
    this.showNumbers(message);
    this.flush();
  }

  private start(hello: Hello): void {
    const again = this.hello !== null;
    this.hello = hello;
    this.view.offer(hello.has_stress);
    const field = fieldOf(this.view.colours);
    if (field !== FIELDS.intensity) this.send({ kind: "colour", index: field }); // a new line begins with s
    this.view.askAgain();
    if (again) return; // the line was cut: everything here is as it was
    this.history = new History(hello.tools.length);
    document.title = `${hello.title} – Glisson`;
    this.title.textContent = hello.title;
    this.subtitle.textContent = `${hello.variant} · ${formatInteger(hello.tets)} tetrahedra · ${formatInteger(hello.vertices)} vertices`;
    this.cutPanel.start(hello);
    this.element.dataset["recorded"] = String(hello.recorded !== null);
    this.recordButton.hidden = !hello.can_record;
    if (hello.recorded) return this.startReplay(hello, hello.recorded);
    this.buildRun(hello);
    this.buildTools(hello);
    this.tissue.build(hello.parameters);
  }

  private startReplay(hello: Hello, recorded: Recorded): void {
    this.replay = new ReplayControls(
      recorded,
      (command) => this.send(command),
      (command) => this.sendSoon(command),
    );
    this.run.replaceChildren(this.replay.element);
    this.subtitle.textContent += ` · ${formatInteger(recorded.frames)} recorded frames`;
    this.view.canvas.addEventListener("keydown", (event) => {
      if (event.key !== " ") return;
      event.preventDefault();
      if (this.role.drives) this.replay?.toggle();
    });
    if (hello.tools.length > 1) {
      const tools = hello.tools.map((tool, i) => ({ value: String(i), label: tool.name }));
      this.tools.replaceChildren(select("Force of", tools, "0", (i) => (this.tool = Number(i))));
    }
    this.tools.hidden = hello.tools.length < 2;
    this.tissue.element.hidden = true;
  }

  private showStatus(status: Status): void {
    const texts = { open: "Connected", waiting: "Connecting …", ended: "" };
    this.status.textContent = status.kind === "ended" ? status.reason : texts[status.kind];
    this.status.dataset["kind"] = status.kind;
    this.element.dataset["status"] = status.kind;
  }

  private showRole(role: Role): void {
    this.role = role;
    const others = role.viewers === 1 ? "" : ` · ${role.viewers} viewers`;
    const act = role.drives
      ? button("Hand over", "Let another viewer lead", () => this.send({ kind: "give" }))
      : button("Take the lead", "Control this simulation", () => this.send({ kind: "take" }));
    act.disabled = !role.drives && role.led;
    if (act.disabled) act.title = "Another viewer leads; it can hand over";
    this.lead.replaceChildren(
      h("span", {}, (role.drives ? "You lead" : "You watch") + others),
      ...(role.viewers > 1 || !role.drives ? [act] : []),
    );
    this.element.dataset["drives"] = String(role.drives);
    for (const field of this.element.querySelectorAll<HTMLFieldSetElement>("fieldset")) field.disabled = !role.drives;
  }

  private showState(state: SlowState): void {
    this.cutPanel.show(state);
    this.element.dataset["pieces"] = String(state.pieces);
    this.told = state;
    this.tissue.follow(state.parameters);
    state.speeds_m_s.forEach((value, i) => this.sliders[i]?.speed.follow(1000 * value));
    this.events.replaceChildren(
      ...state.events
        .slice(-6)
        .map((event) =>
          h(
            "li",
            {},
            `${event.tool}: ${event.event} at ${formatSignificant(1000 * event.depth_m, 3)} mm, ${formatSignificant(event.time_s, 3)} s`,
          ),
        ),
    );
  }

  // ---- panels

  private buildRun(hello: Hello): void {
    this.pauseButton = button("Pause", "Pause (Space)", () => this.togglePause());
    const step = button("Step", "Advance one frame of 1 ms while paused", () => this.send({ kind: "step" }));
    const reset = button("Reset", "Back to rest, tools withdrawn", () => this.send({ kind: "reset" }));
    const play = button("Play the scene’s motion", "Back to rest, then play the scene’s motion of the tools", () =>
      this.send({ kind: "play" }),
    );
    const undo = button("Undo cut", "Back to before the last stroke of the blade (Ctrl+Z)", () =>
      this.send({ kind: "undo" }),
    );
    undo.hidden = hello.why_no_cut !== "";
    play.hidden = !hello.tools.some((tool) => tool.can_play);
    this.run.replaceChildren(h("fieldset", { class: "live-buttons" }, this.pauseButton, step, reset, undo, play));
    this.view.canvas.addEventListener("keydown", (event) => {
      const undoes = event.key.toLowerCase() === "z" && (event.ctrlKey || event.metaKey) && !undo.hidden;
      if (event.key !== " " && !undoes) return;
      event.preventDefault();
      if (undoes) return void (this.role.drives && this.send({ kind: "undo" }));
      this.togglePause();
    });
  }

  private togglePause(): void {
    if (this.role.drives) this.send({ kind: "pause", index: this.frame?.paused ? 0 : 1 });
  }

  private buildTools(hello: Hello): void {
    const sets = hello.tools.map((tool, i) => {
      const place = () => this.sendPlace(i);
      const mm = 1000;
      const aside = Math.max(5, 0.5 * mm * tool.most_m);
      const sliders = {
        depth: new Slider(`depth-${i}`, "Depth", "mm", mm * tool.least_m, mm * tool.most_m, 0, 0.05, "acts", place),
        side: new Slider(`side-${i}`, "Aside x", "mm", -aside, aside, 0, 0.05, "acts", place),
        third: new Slider(`third-${i}`, "Aside y", "mm", -aside, aside, 0, 0.05, "acts", place),
        speed: new Slider(
          `speed-${i}`,
          "Speed",
          "mm/s",
          0.1 * mm * tool.speed_m_s,
          10 * mm * tool.speed_m_s,
          mm * tool.speed_m_s,
          0.01 * mm * tool.speed_m_s,
          "acts",
          (value) => this.send({ kind: "speed", tool: i, values: [value / mm] }),
        ),
      };
      this.sliders.push(sliders);
      const field = h(
        "fieldset",
        { class: "live-tool" },
        h("legend", {}, tool.name),
        sliders.depth.element,
        sliders.speed.element,
        h("details", {}, h("summary", {}, "Move it freely"), sliders.side.element, sliders.third.element),
      );
      return field;
    });
    this.toolFields = sets;
    const names = hello.tools.map((tool, i) => ({ value: String(i), label: tool.name }));
    this.toolSelect = names.length > 1 ? select("Tool", names, "0", (i) => this.chooseTool(Number(i))) : null;
    this.tools.replaceChildren(...(this.toolSelect ? [this.toolSelect] : []), ...sets);
    this.chooseTool(Math.min(this.tool, Math.max(0, sets.length - 1)));
    this.tools.hidden = sets.length === 0;
    this.plots.depth.element.hidden = this.plots.time.element.hidden = sets.length === 0;
  }

  private toolFields: HTMLElement[] = [];
  private toolSelect: HTMLElement | null = null;

  /** The tool that sliders, numbers, plots and placing mean. */
  private chooseTool(tool: number): void {
    if (tool !== this.tool) this.placing.stop();
    this.tool = tool;
    this.toolFields.forEach((field, i) => (field.hidden = i !== tool));
    const list = this.toolSelect?.querySelector("select");
    if (list) list.value = String(tool);
  }

  private ownSpeed = 0.01; // of the tool that is being placed, before and after [m/s]
  private readonly placing = new Placing(
    ({ depth, aside }) => {
      const sliders = this.sliders[this.tool];
      [depth, ...aside].forEach((metres, k) => [sliders?.depth, sliders?.side, sliders?.third][k]?.set(1000 * metres));
      this.sendSoon({ kind: "place", tool: this.tool, values: [depth, ...aside] });
    },
    (speed) => {
      this.send({ kind: "speed", tool: this.tool, values: [Math.max(this.ownSpeed, speed ?? 0)] });
    },
  );

  /** The chosen tool, where it is an instrument, goes before a point of the surface. */
  private placeAt(point: [number, number, number]): void {
    const tools = this.hello?.tools ?? [];
    if (!tools[this.tool]?.instrument) this.chooseTool(tools.findIndex(({ instrument }) => instrument));
    const info = tools[this.tool];
    const state = this.frame?.tools[this.tool];
    const start = info && state ? startOf(info, state) : null;
    if (!info || !state || !start) return;
    if (!this.placing.busy) this.ownSpeed = (this.sliders[this.tool]?.speed.value ?? 10) / 1000;
    const before = this.view.reachAlong(start, info.direction);
    this.placing.begin(legsTo(point, info, state, before, this.view.size));
  }

  private number(name: string, value: string, unit: string): void {
    let field = this.values.get(name);
    if (!field) {
      field = h("dd", {});
      this.values.set(name, field);
      this.numbers.append(h("div", {}, h("dt", {}, name), field));
    }
    const text = unit ? `${value}\u00a0${unit}` : value;
    if (field.textContent !== text) field.textContent = text;
  }

  private showNumbers(frame: LiveFrame): void {
    const tool = frame.tools[this.tool];
    this.view.force.tool = this.tool;
    const direction = this.hello?.tools[this.tool]?.direction;
    if (tool && direction) {
      const force = tool.force.reduce((sum, f, i) => sum + f * direction[i]!, 0);
      this.element.dataset["force"] = String(force);
      this.element.dataset["depth"] = String(tool.depth);
      const size = Math.hypot(...tool.force);
      this.number("Force", forceText(size), "N"); // as beside the arrow
      this.number("Along the tool", fixed(force, 3), "N");
      this.placing.follow(tool);
      this.number("Depth", fixed(1000 * tool.depth, 2), "mm");
    }
    this.number("Time", fixed(frame.time, 2), "s");
    this.element.dataset["epoch"] = String(frame.epoch);
    this.element.dataset["time"] = String(frame.time);
    if (this.replay) {
      this.replay.follow(frame);
      return this.number("Pace", frame.paused ? "paused" : paceText(frame.realtimeFactor), "");
    }
    this.number("Pull", forceText(Math.hypot(...frame.grabForce)), "N");
    const pace = frame.building
      ? "making the body"
      : frame.stopped
        ? "stopped"
        : frame.paused
          ? "paused"
          : paceText(frame.realtimeFactor);
    this.number("Pace", pace, "");
    this.number("Computing", `${formatInteger(frame.p50)} / ${formatInteger(frame.p99)}`, "µs");
    this.number("Latency", this.connection.latency === null ? "–" : fixed(this.connection.latency, 0), "ms");
    if (this.pauseButton) this.pauseButton.textContent = frame.paused ? "Go on" : "Pause";
    frame.tools.forEach((state, i) => this.showPlace(this.sliders[i], state));
    const targetless = frame.playing || (frame.time < 0.05 && frame.epoch !== this.followed);
    if (targetless && tool) this.sliders[this.tool]?.depth.follow(1000 * tool.depth);
    this.followed = frame.time >= 0.05 ? frame.epoch : this.followed;
  }

  /** Sliders show where a tool is led to, their marks where it is; who only watches knows of no target. */
  private showPlace(sliders: ToolSliders | undefined, state: ToolState): void {
    if (!sliders) return;
    const places = [state.depth, ...state.aside].map((metres) => 1000 * metres);
    [sliders.depth, sliders.side, sliders.third].forEach((slider, k) => {
      slider.showNow(places[k]!, 2);
      if (!this.role.drives) slider.follow(places[k]!);
    });
  }

  private followed = 0;

  private drawPlots(): void {
    const { time, depth, force } = this.history;
    if (document.hidden || !this.hello || this.hello.tools.length === 0) return;
    const mark = this.replay && this.frame ? this.history.indexAt(this.frame.time) : -1;
    const path = this.replay ? { depth: depth[this.tool]!, force: force[this.tool]! } : this.history.paths[this.tool]!;
    this.plots.depth.show(path.depth, path.force, 0, mark);
    this.plots.time.show(time, force[this.tool]!, this.replay ? 0 : Math.max(0, time.length - SEEN), mark);
  }

  // ---- what goes out

  send(command: Command): void {
    if (command.kind === "reset" || command.kind === "play") this.placing.stop();
    if (command.kind === "reset")
      this.sliders.forEach(({ depth, side, third }) => [depth, side, third].forEach((s) => s.set(0)));
    this.connection.send(command);
  }

  private sendSoon(command: Command): void {
    this.waiting = command;
    requestAnimationFrame(() => this.flush());
  }

  private flush(): void {
    if (this.waiting) this.connection.send(this.waiting);
    this.waiting = null;
  }

  private push(tool: number, depth: number): void {
    this.chooseTool(tool);
    this.placing.stop();
    this.sliders[tool]?.depth.set(1000 * depth);
    this.sendPlace(tool);
  }

  private sendPlace(tool: number): void {
    const { depth, side, third } = this.sliders[tool]!;
    this.sendSoon({ kind: "place", tool, values: [depth.value / 1000, side.value / 1000, third.value / 1000] });
  }

  private saveForces(): void {
    const names = this.hello?.tools.map((tool) => tool.name) ?? [];
    download("forces.csv", new Blob([this.history.csv(names)], { type: "text/csv" }));
  }

  /** The program keeps it, from the last rest on; the browser saves what it sends. */
  private saveRecording(): void {
    const token = new URLSearchParams(location.search).get("token") ?? "";
    const link = h("a", { href: `/recording?${new URLSearchParams({ token })}`, download: "recording.zip" });
    document.body.append(link);
    link.click();
    link.remove();
  }

  private savePicture(): void {
    this.view.picture((canvas) => canvas.toBlob((blob) => blob && download("glisson.png", blob), "image/png"));
  }
}

const xyz = (v: THREE.Vector3): [number, number, number] => [v.x, v.y, v.z];
/** With a minus, but not for what is nothing. */
const fixed = (value: number, digits: number): string =>
  (Math.abs(value) < 0.5 * 10 ** -digits ? 0 : value).toFixed(digits).replace("-", "−");

function check(label: string, changed: (on: boolean) => void, on = false): HTMLElement {
  const box = h("input", { type: "checkbox", checked: on });
  box.addEventListener("change", () => changed(box.checked));
  return h("label", { class: "check" }, box, label);
}
