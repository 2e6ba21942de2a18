// Keys: what is held drives, what is pressed commands. A gamepad takes the place of held keys while it is moved. Losing the
// focus gives the wheel back, since nobody would hear a key come up.

const DRIVE: Record<string, string> = {
  ArrowUp: "up", ArrowDown: "down", ArrowLeft: "left", ArrowRight: "right",
  KeyW: "up", KeyS: "down", KeyA: "left", KeyD: "right", ShiftLeft: "brake", ShiftRight: "brake",
};
const LOOK_MS = 50;
const DEAD_ZONE = 0.08;

export type Shortcuts = Record<string, () => void>;

interface Driver {
  hold(command: object | null): void;
  giveBack(): void;
}

export class Keys {
  private readonly held = new Set<string>();
  private isDriving = false;
  private usesPad = false;
  private said = "";
  seq = 0;

  constructor(private readonly driver: Driver, shortcuts: Shortcuts) {
    addEventListener("keydown", (event) => this.down(event, shortcuts));
    addEventListener("keyup", (event) => { const key = DRIVE[event.code]; if (key && this.held.delete(key)) this.say(); });
    addEventListener("blur", () => this.letGo());
    document.addEventListener("visibilitychange", () => { if (document.hidden) this.letGo(); });
    setInterval(() => this.say(), LOOK_MS);
  }

  setDriving(on: boolean): void {
    if (this.isDriving && !on) this.driver.hold(null);
    if (on && !this.isDriving) (document.activeElement as HTMLElement | null)?.blur(); // arrows drive, whatever had the focus
    this.isDriving = on;
  }

  private letGo(): void {
    this.held.clear();
    if (!this.isDriving) return;
    this.say();
    this.driver.giveBack();
  }

  private down(event: KeyboardEvent, shortcuts: Shortcuts): void {
    const target = event.target as HTMLElement, name = event.key === " " ? "Space" : event.key;
    if (event.defaultPrevented || target.closest("input:not([type=checkbox], [type=range]), select, textarea, dialog[open]") || event.ctrlKey || event.metaKey || event.altKey) return;
    if (target.matches("input[type=range]") && name.startsWith("Arrow")) return; // moves by itself
    const key = DRIVE[event.code];
    if (key) this.held.add(key); // also before the wheel has come: whoever asks for it presses the next key at once
    if (key && this.isDriving) {
      event.preventDefault();
      if (!event.repeat) this.say();
      return;
    }
    const shortcut = shortcuts[name.length === 1 ? name.toLowerCase() : name];
    if (!shortcut || event.repeat || (target.closest("button, input:not([type=range])") && ["Space", "Enter"].includes(name))) return;
    event.preventDefault();
    shortcut();
  }

  /** Tell what is held, with a new number where it is something else than before. */
  private say(): void {
    if (!this.isDriving) return;
    const pad = this.pad(), command = pad ? { op: "steer", ...pad } : { op: "keys", down: [...this.held] };
    const text = JSON.stringify(command);
    if (text !== this.said) { this.said = text; this.seq++; }
    this.driver.hold({ ...command, seq: this.seq });
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
