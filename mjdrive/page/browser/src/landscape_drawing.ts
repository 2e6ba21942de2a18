// How a landscape is drawn: axes, points of the search, the colour scale.
import { COLORS } from "./dom";

export interface Box { x: number; y: number; width: number; height: number }
export interface Spot { acceleration: number; steering: number }

export const DEPTH_NATS = 12; // as in mjdrive/web/policies.py
const MARGIN = { left: 44, bottom: 34, top: 6, right: 46 };
const ITERATION_COLORS = ["rgba(255,255,255,.45)", "rgba(86,200,255,.8)", "rgba(150,255,150,1)"];
const BAR_PX = 8;

export const boxOf = (width: number, height: number): Box =>
  ({ x: MARGIN.left, y: MARGIN.top, width: width - MARGIN.left - MARGIN.right, height: height - MARGIN.top - MARGIN.bottom });

/** Left is left: steering is positive to the left, so it falls to the right. */
export const place = (box: Box, { acceleration, steering }: Spot): [number, number] =>
  [box.x + (1 - steering) / 2 * box.width, box.y + (1 - acceleration) / 2 * box.height];

export function spotAt(box: Box, x: number, y: number): Spot | null {
  const steering = 1 - 2 * (x - box.x) / box.width, acceleration = 1 - 2 * (y - box.y) / box.height;
  return Math.abs(steering) <= 1 && Math.abs(acceleration) <= 1 ? { acceleration, steering } : null;
}

export function drawAxes(pen: CanvasRenderingContext2D, box: Box): void {
  pen.strokeStyle = "rgba(255,255,255,.18)"; pen.lineWidth = 1;
  pen.beginPath();
  pen.moveTo(box.x + box.width / 2, box.y); pen.lineTo(box.x + box.width / 2, box.y + box.height);
  pen.moveTo(box.x, box.y + box.height / 2); pen.lineTo(box.x + box.width, box.y + box.height / 2);
  pen.stroke();
  pen.fillStyle = COLORS.text; pen.font = "11px system-ui, sans-serif";
  const below = box.y + box.height + 5;
  pen.textBaseline = "top";
  for (const [text, share, align] of [["+1 left", 0, "left"], ["0", 0.5, "center"], ["−1 right", 1, "right"]] as const) {
    pen.textAlign = align; pen.fillText(text, box.x + share * box.width, below);
  }
  pen.textAlign = "center"; pen.fillText("steering", box.x + box.width / 2, below + 14);
  pen.textAlign = "right"; pen.textBaseline = "middle";
  for (const [text, share] of [["+1", 0.02], ["0", 0.5], ["−1", 0.98]] as const) pen.fillText(text, box.x - 5, box.y + share * box.height);
  pen.save();
  pen.translate(10, 0); pen.rotate(-Math.PI / 2); pen.textAlign = "center";
  for (const [text, share] of [["gas", 0.08], ["acceleration", 0.5], ["brake", 0.9]] as const) pen.fillText(text, -(box.y + share * box.height), 0);
  pen.restore();
}

export function drawScale(pen: CanvasRenderingContext2D, box: Box): void {
  const x = box.x + box.width + 10, ramp = pen.createLinearGradient(0, box.y + box.height, 0, box.y);
  MAGMA.forEach((color, index) => ramp.addColorStop(index / (MAGMA.length - 1), `rgb(${color})`));
  pen.fillStyle = ramp; pen.fillRect(x, box.y, BAR_PX, box.height);
  pen.fillStyle = COLORS.text; pen.textAlign = "left"; pen.textBaseline = "middle";
  for (const [text, share] of [["0", 0.02], [`−${DEPTH_NATS}`, 0.98]] as const) pen.fillText(text, x + BAR_PX + 3, box.y + share * box.height);
  pen.save();
  pen.translate(x + BAR_PX + 11, box.y + box.height / 2); pen.rotate(-Math.PI / 2); pen.textAlign = "center";
  pen.fillText("nats below the best", 0, 0);
  pen.restore();
}

export function drawPoints(pen: CanvasRenderingContext2D, box: Box, points: Int8Array, numIterations: number, shown: number): void {
  const each = points.length / numIterations;
  for (let iteration = 0; iteration < numIterations; iteration++) {
    if (shown >= 0 && shown !== iteration) continue;
    pen.fillStyle = ITERATION_COLORS[Math.round((iteration / Math.max(1, numIterations - 1)) * 2)];
    for (let at = iteration * each; at < (iteration + 1) * each; at += 2) {
      const [x, y] = place(box, { acceleration: points[at] / 127, steering: points[at + 1] / 127 });
      pen.fillRect(x - 1, y - 1, 2, 2);
    }
  }
}

/** A ring for what the policy chose, a square for what a person drove, a cross for where one looks: shapes, not colours, tell them apart. */
export function drawMark(pen: CanvasRenderingContext2D, box: Box, spot: Spot, shape: "ring" | "square" | "cross"): void {
  const [x, y] = place(box, spot);
  for (const [width, color] of [[4, "rgba(0,0,0,.7)"], [2, shape === "square" ? COLORS.car : COLORS.chosen]] as const) {
    pen.strokeStyle = color; pen.lineWidth = width;
    pen.beginPath();
    if (shape === "ring") pen.arc(x, y, 6, 0, 7);
    else if (shape === "square") pen.rect(x - 5, y - 5, 10, 10);
    else { pen.moveTo(x - 8, y); pen.lineTo(x + 8, y); pen.moveTo(x, y - 8); pen.lineTo(x, y + 8); }
    pen.stroke();
  }
}

/** A square of pixels, acceleration outermost, into an image that has left on the left. */
export function paint(field: HTMLCanvasElement, pixels: Uint8Array, size: number): void {
  if (field.width !== size) field.width = field.height = size;
  const image = new ImageData(size, size), last = size - 1;
  for (let row = 0; row < size; row++) for (let column = 0; column < size; column++) {
    image.data.set([...magma(pixels[(last - row) * size + (last - column)] / 255), 255], 4 * (row * size + column));
  }
  field.getContext("2d")!.putImageData(image, 0, 0);
}

const MAGMA = [[9, 10, 20], [58, 20, 104], [140, 41, 129], [222, 73, 104], [254, 159, 109], [252, 253, 191]];
function magma(value: number): number[] {
  const at = Math.min(value, 0.9999) * (MAGMA.length - 1), low = Math.floor(at), share = at - low;
  return MAGMA[low].map((from, index) => from + share * (MAGMA[low + 1][index] - from));
}
