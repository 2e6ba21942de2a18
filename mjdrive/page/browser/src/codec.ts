// Messages of the server; mjdrive/page/wire.py says what each holds.

export const VERSION = 1;

export type Blob_ = Float32Array | Uint32Array | Uint8Array | Int8Array;

export interface Message {
  kind: string;
  head: Record<string, any>;
  blobs: Record<string, Blob_>;
  shapes: Record<string, number[]>;
}

const VIEWS: Record<string, any> = {
  float32: Float32Array, uint32: Uint32Array, uint8: Uint8Array, int8: Int8Array,
};

export async function unpack(buffer: ArrayBuffer): Promise<Message> {
  const length = new DataView(buffer).getUint32(0, true);
  const { v, k, b, ...head } = JSON.parse(new TextDecoder().decode(new Uint8Array(buffer, 4, length)));
  if (v !== VERSION) throw new Error(`The server speaks version ${v}, this page ${VERSION}. Load the page again.`);
  const blobs: Record<string, Blob_> = {}, shapes: Record<string, number[]> = {};
  for (const [name, [dtype, shape, offset, deflated]] of Object.entries(b as Record<string, [string, number[], number, number?]>)) {
    const begin = 4 + length + offset, count = shape.reduce((product, size) => product * size, 1);
    blobs[name] = deflated === undefined
      ? new VIEWS[dtype](buffer, begin, count)
      : new VIEWS[dtype](await inflate(new Uint8Array(buffer, begin, deflated)), 0, count);
    shapes[name] = shape;
  }
  return { kind: k, head, blobs, shapes };
}

export async function fetchMessage(address: string): Promise<Message> {
  const answer = await fetch(address);
  if (!answer.ok) throw new Error((await answer.json().catch(() => ({}))).error ?? `${answer.status} ${answer.statusText}`);
  return unpack(await answer.arrayBuffer());
}

export async function fetchJson<T>(address: string, post = false): Promise<T> {
  const answer = await fetch(address, { method: post ? "POST" : "GET" });
  const value = await answer.json();
  if (!answer.ok) throw new Error(value.error ?? answer.statusText);
  return value;
}

const inflate = (content: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> =>
  new Response(new Blob([content]).stream().pipeThrough(new DecompressionStream("deflate"))).arrayBuffer();
