// Keys: what is held drives, what is pressed commands. Held keys are sent on each change and repeated, so that the server
// lets go when the page falls silent; losing the focus lets go at once. A gamepad takes their place while it is moved.

const DRIVE: Record<string, string> = {
  ArrowUp: "up", ArrowDown: "down", ArrowLeft: "left", ArrowRight: "right",
  KeyW: "up", KeyS: "down", KeyA: "left", KeyD: "right", ShiftLeft: "brake",
};
const REPEAT_MS = 50;
const DEAD_ZONE = 0.08;

export type Shortcuts = Record<string, () => void>;

export class Keys {
  private readonly held = new Set<string>();
  private isDriving = false;
  private usesPad = false;
  seq = 0;

  constructor(private readonly send: (command: object) => void, shortcuts: Shortcuts) {
    addEventListener("keydown", (event) => this.down(event, shortcuts));
    addEventListener("keyup", (event) => { const key = DRIVE[event.code]; if (key && this.held.delete(key)) this.say(); });
    addEventListener("blur", () => this.letGo());
    document.addEventListener("visibilitychange", () => this.letGo());
    setInterval(() => this.say(), REPEAT_MS);
  }

  setDriving(on: boolean): void {
    this.isDriving = on;
    if (!on) this.held.clear();
  }

  letGo(): void {
    this.held.clear();
    this.say();
  }

  private down(event: KeyboardEvent, shortcuts: Shortcuts): void {
    const target = event.target as HTMLElement;
    if (target.closest("input, select, textarea, dialog[open]") || event.ctrlKey || event.metaKey || event.altKey) return;
    const key = DRIVE[event.code];
    if (key && this.isDriving) {
      event.preventDefault();
      if (!event.repeat && !this.held.has(key)) { this.held.add(key); this.say(); }
      return;
    }
    const shortcut = shortcuts[event.key === " " ? "Space" : event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!shortcut || event.repeat || (target.closest("button, [role=tab]") && ["Space", "Enter"].includes(event.key === " " ? "Space" : event.key))) return;
    event.preventDefault();
    shortcut();
  }

  private say(): void {
    if (!this.isDriving) return;
    this.seq++;
    const pad = this.pad();
    this.send(pad ? { op: "steer", ...pad, seq: this.seq } : { op: "keys", down: [...this.held], seq: this.seq });
  }

  /** Left stick steers, triggers are the pedals; null while nobody touches it. */
  private pad(): { acceleration: number; steering: number } | null {
    const pad = navigator.getGamepads?.().find((it) => it?.connected && it.mapping === "standard");
    if (!pad) return null;
    const steering = Math.abs(pad.axes[0]) < DEAD_ZONE ? 0 : -pad.axes[0];
    const acceleration = pad.buttons[7].value - pad.buttons[6].value;
    if (steering || acceleration) this.usesPad = true;
    else if (this.held.size) this.usesPad = false;
    return this.usesPad ? { acceleration, steering } : null;
  }
}
