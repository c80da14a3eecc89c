import { el, short } from "./dom";
import type { OnlineData, OnlineMoment } from "./online_data";

/// Steps and ranges of the command; the controller keeps to what the robot can do.
const kStep = { forward: 0.1, left: 0.1, turn: 0.1, height: 0.02 };
type Part = keyof typeof kStep;
const kNames: Record<Part, string> = { forward: "ahead", left: "left", turn: "turn", height: "height" };
const kUnits: Record<Part, string> = { forward: "m/s", left: "m/s", turn: "rad/s", height: "m" };
const kKeys: Record<string, [Part, number]> = {
  ArrowUp: ["forward", 1],
  ArrowDown: ["forward", -1],
  ArrowLeft: ["turn", 1],
  ArrowRight: ["turn", -1],
  a: ["left", 1],
  d: ["left", -1],
  PageUp: ["height", 1],
  PageDown: ["height", -1],
};
const kFullStick = { forward: 0.6, left: 0.3, turn: 0.6 }; // of a gamepad [m/s, rad/s]
const kDead = 0.12; // of a stick, where it counts as released

/// Remote control of a run that goes on: buttons, keys and a gamepad for the command, and a kick.
export class Remote {
  readonly element: HTMLElement;
  private readonly command: Record<Part, number> = { forward: 0, left: 0, turn: 0, height: 0 };
  private readonly outputs: Record<Part, HTMLElement>;
  private readonly clock = el("output", { class: "readout" });
  private readonly moves = el("output", { class: "moves" });
  private readonly gait: HTMLSelectElement;
  private readonly size = el("input", {
    type: "number",
    min: "0.1",
    max: "2",
    step: "0.1",
    value: "0.5",
    "aria-label": "Size of the kick in metres per second",
  });
  private stick = "";

  constructor(data: OnlineData) {
    this.gait = el(
      "select",
      { "aria-label": "Gait" },
      ...data.gaits.map((name) => el("option", { value: name, selected: name === data.gait }, name)),
    );
    this.gait.addEventListener("change", () => this.send());
    const parts = Object.keys(kStep) as Part[];
    const output = () => el("output", {}, "0");
    this.outputs = { forward: output(), left: output(), turn: output(), height: output() };
    const button = (text: string, label: string, act: () => void) => {
      const made = el("button", { type: "button", "aria-label": label }, text);
      made.addEventListener("click", act);
      return made;
    };
    const row = (part: Part) =>
      el(
        "div",
        { class: "part" },
        el("span", {}, kNames[part]),
        button("−", `less ${kNames[part]}`, () => this.change(part, -1)),
        this.outputs[part],
        button("+", `more ${kNames[part]}`, () => this.change(part, 1)),
        el("small", {}, kUnits[part]),
      );
    this.element = el(
      "section",
      { class: "remote", "aria-label": "Command" },
      el("div", { class: "transport" }, this.clock, this.moves),
      el("div", { class: "parts" }, ...parts.map(row)),
      el(
        "div",
        { class: "parts" },
        el("label", {}, "gait ", this.gait),
        button("Stop", "Stop", () => this.halt()),
        button("Kick", "Kick", () => this.kick()),
        el("label", {}, this.size, " m/s"),
      ),
      el(
        "p",
        { class: "hint" },
        "Keys: ↑ ↓ ahead and back, ← → turn, a d sideways, page up and down height, space stops, k kicks. Or a gamepad: left stick to go, right stick to turn, first button kicks.",
      ),
    );
    document.addEventListener("keydown", (event) => this.press(event));
  }

  show(moment: OnlineMoment): void {
    this.clock.textContent = `${moment.time.toFixed(1)} s`;
    const [ahead, left, turn] = moment.measured;
    this.moves.textContent = `measured: ${ahead.toFixed(2)} m/s ahead, ${left.toFixed(2)} m/s left, ${turn.toFixed(2)} rad/s`;
    this.readGamepad();
  }
  end(text: string): void {
    this.moves.textContent = text;
    for (const field of this.element.querySelectorAll<HTMLButtonElement>("button, select, input"))
      field.disabled = true;
  }

  private change(part: Part, by: number): void {
    this.command[part] = Math.round((this.command[part] + by * kStep[part]) * 100) / 100;
    this.send();
  }
  private halt(): void {
    this.command.forward = this.command.left = this.command.turn = 0;
    this.send();
  }
  private kick(): void {
    void this.post({ kick: Number(this.size.value) });
  }
  private send(): void {
    for (const part of Object.keys(kStep) as Part[]) this.outputs[part].textContent = short(this.command[part]);
    void this.post({ ...this.command, gait: this.gait.value });
  }
  private async post(wish: object): Promise<void> {
    try {
      await fetch("/wishes", {
        method: "POST",
        headers: { "Content-Type": "application/json" },
        body: JSON.stringify(wish),
      });
    } catch {
      this.end("the server has ended");
    }
  }
  private press(event: KeyboardEvent): void {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if ((event.target as HTMLElement).closest("select, input")) return;
    const part = kKeys[event.key];
    if (part) this.change(...part);
    else if (event.key === " ") this.halt();
    else if (event.key === "k" && !event.repeat) this.kick();
    else return;
    event.preventDefault();
  }
  private readGamepad(): void {
    const pad = navigator.getGamepads?.().find((one) => one?.connected);
    if (!pad) return;
    const [left, up, turn] = [pad.axes[0], pad.axes[1], pad.axes[2]].map((axis) =>
      Math.abs(axis ?? 0) < kDead ? 0 : Math.round(-20 * axis) / 20,
    );
    const kicks = pad.buttons[0]?.pressed ?? false;
    const now = JSON.stringify([left, up, turn, kicks]);
    if (now === this.stick) return;
    this.stick = now;
    this.command.forward = up * kFullStick.forward;
    this.command.left = left * kFullStick.left;
    this.command.turn = turn * kFullStick.turn;
    this.send();
    if (kicks) this.kick();
  }
}
