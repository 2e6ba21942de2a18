// The page's end of the socket, which lives in a worker: it acknowledges every message when that has been handled, so that a
// slow page loses frames and never sees old ones.
import type { Message } from "./codec";
import type { FromWorker, ToWorker } from "./socket_worker";

export interface State {
  town: string; policy: string; seed: number; paused: boolean; speed: number; recorded: number; infractions: Infraction[];
  fault?: string | null; wheel: "free" | "yours" | "taken"; pages: number; you: number; operator: number; driver: number; asking: number[];
  link?: "slow" | "full";
}
export type Infraction = [kind: string, time: number, x: number, y: number, cause: string];

interface Handlers {
  message(message: Message): void;
  state(state: State): void;
  note(line: string, isError: boolean): void;
  scene(): void;
  status(line: string, isLive: boolean): void;
}

export class Link {
  private readonly worker = new Worker(new URL("./socket_worker.ts", import.meta.url), { type: "module", name: "socket" });

  constructor(private readonly on: Handlers) {
    this.worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.hear(data);
    document.addEventListener("visibilitychange", () => this.sayHidden());
    const address = new URL("ws", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    address.search = address.hash = "";
    this.post({ open: address.href });
  }

  send(command: object): void { this.post({ say: command }); }

  /** What is held down; the worker repeats it until something else is, or null. */
  hold(command: object | null): void { this.post({ hold: command }); }

  private post(value: ToWorker): void { this.worker.postMessage(value); }

  private hear(data: FromWorker): void {
    if ("message" in data) {
      this.on.message(data.message);
      this.post({ handled: data.number, socket: data.socket });
    } else if ("status" in data) {
      this.on.status(data.status, data.isLive);
      if (data.isLive && document.hidden) this.sayHidden();
    } else if ("failure" in data) this.on.note(data.failure, true);
    else if (data.told.k === "state") this.on.state(data.told);
    else if (data.told.k === "note") this.on.note(data.told.line, data.told.error);
    else if (data.told.k === "scene") this.on.scene();
  }

  private sayHidden(): void { this.send({ op: "hidden", on: document.hidden }); }
}
