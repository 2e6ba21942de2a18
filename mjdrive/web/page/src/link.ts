// The socket: acknowledges every message, so that a slow page loses frames and never sees old ones; comes back by itself.
import { unpack, type Message } from "./codec";

export interface State {
  town: string; policy: string; seed: number; paused: boolean; speed: number; recorded: number;
  wheel: "free" | "yours" | "taken"; pages: number; infractions: Infraction[];
}
export type Infraction = [kind: string, time: number, x: number, y: number, cause: string];

interface Handlers {
  message(message: Message): void;
  state(state: State): void;
  note(line: string, isError: boolean): void;
  scene(): void;
  status(line: string, live: boolean): void;
}

const AGAIN_MS = 1000;

export class Link {
  private socket!: WebSocket;
  private handled = 0;

  constructor(private readonly on: Handlers) {
    this.connect();
    document.addEventListener("visibilitychange", () => this.send({ op: "hidden", on: document.hidden }));
  }

  send(command: object): void {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(command));
  }

  private connect(): void {
    const address = new URL("ws", location.href);
    address.protocol = address.protocol.replace("http", "ws");
    address.search = address.hash = "";
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.handled = 0;
    this.socket.onopen = () => { this.on.status("live", true); if (document.hidden) this.send({ op: "hidden", on: true }); };
    this.socket.onclose = (event) => {
      this.on.status(event.reason || "connection lost, trying again …", false);
      setTimeout(() => this.connect(), AGAIN_MS);
    };
    this.socket.onmessage = ({ data }) => (typeof data === "string" ? this.hear(JSON.parse(data)) : this.look(data));
  }

  private look(data: ArrayBuffer): void {
    this.send({ op: "ack", n: ++this.handled });
    this.on.message(unpack(data));
  }

  private hear(told: any): void {
    if (told.k === "state") this.on.state(told);
    else if (told.k === "note") this.on.note(told.line, told.error);
    else if (told.k === "scene") this.on.scene();
  }
}
