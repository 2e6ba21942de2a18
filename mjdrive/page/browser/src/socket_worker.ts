// The socket, in a thread of its own: a frame may take a second where a machine draws in software, and neither the answer to
// a key nor the sign that it is still held may wait for one. What is held is repeated from here, as long as the page itself
// has spoken lately; a page that hangs lets go.
import { unpack } from "./codec";

export type ToWorker =
  | { open: string } | { say: object } | { hold: object | null } | { handled: number; socket: number };
export type FromWorker =
  | { message: Awaited<ReturnType<typeof unpack>>; number: number; socket: number }
  | { told: any } | { status: string; isLive: boolean } | { failure: string };

const REPEAT_MS = 50;
const HANGS_MS = 2000;
const AGAIN_MS = 1000;
const LOST_MS = 15_000; // the server gives a sign of life every five seconds

const page = self as unknown as MessagePort;
const tell = (value: FromWorker): void => page.postMessage(value);
let address = "", socket: WebSocket | undefined, numSockets = 0, numMessages = 0;
let held: object | null = null, heldAt = 0, heardAt = 0;
let reading: Promise<void> = Promise.resolve();

page.onmessage = ({ data }: MessageEvent<ToWorker>) => {
  if ("open" in data) { address = data.open; connect(); }
  else if ("say" in data) say(data.say);
  else if ("hold" in data) hold(data.hold);
  else if (data.socket === numSockets) say({ op: "ack", n: data.handled });
};

function hold(command: object | null): void {
  const isNew = JSON.stringify(command) !== JSON.stringify(held);
  held = command;
  heldAt = performance.now();
  if (command && isNew) say(command);
}

setInterval(() => {
  const now = performance.now();
  if (held && now - heldAt < HANGS_MS) say(held);
  if (socket?.readyState === WebSocket.OPEN && now - heardAt > LOST_MS) socket.close();
}, REPEAT_MS);

function say(command: object): void {
  if (socket?.readyState === WebSocket.OPEN) socket.send(JSON.stringify(command));
}

function connect(): void {
  socket = new WebSocket(address);
  socket.binaryType = "arraybuffer";
  const number = ++numSockets;
  numMessages = 0;
  heardAt = performance.now();
  socket.onopen = () => tell({ status: "live", isLive: true });
  socket.onclose = (event) => {
    tell({ status: event.reason || "connection lost, trying again …", isLive: false });
    setTimeout(connect, AGAIN_MS);
  };
  socket.onmessage = ({ data }) => {
    heardAt = performance.now();
    if (typeof data === "string") return tell({ told: JSON.parse(data) });
    reading = reading.then(() => read(data, number, ++numMessages));
  };
}

/** Unpack here; the page gets the arrays without a copy. */
async function read(data: ArrayBuffer, number: number, count: number): Promise<void> {
  try {
    const message = await unpack(data);
    const buffers = new Set(Object.values(message.blobs).map((it) => it.buffer as ArrayBuffer));
    page.postMessage({ message, number: count, socket: number } satisfies FromWorker, [...buffers]);
  } catch (error) { tell({ failure: (error as Error).message }); }
}
