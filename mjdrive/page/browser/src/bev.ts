// The bird's-eye view as the policy gets it: five planes, coloured here, so that switching one off costs nothing.
import type { Blob_ } from "./codec";
import { $, COLORS, make } from "./dom";

type Rgb = readonly [number, number, number];

const BACKGROUND: Rgb = [22, 25, 30], ROAD: Rgb = [74, 82, 95], LINES: Rgb = [170, 180, 192];
/** A light's plane holds 80, 170 or 255. */
const GREEN: Rgb = [55, 214, 122], YELLOW: Rgb = [245, 197, 66], RED: Rgb = [255, 77, 77];
const signal = (value: number): Rgb => (value > 212 ? RED : value > 125 ? YELLOW : GREEN);
const CHANNELS: { name: string; swatch: Rgb; share: number; color(value: number): Rgb }[] = [
  { name: "road", swatch: ROAD, share: 1, color: () => ROAD },
  { name: "lines", swatch: LINES, share: 1, color: () => LINES },
  { name: "lights 1.5 s ago", swatch: [120, 128, 138], share: 0.35, color: signal },
  { name: "0.8 s ago", swatch: [120, 128, 138], share: 0.55, color: signal },
  { name: "now", swatch: [120, 128, 138], share: 1, color: signal },
];

export class BevPanel {
  private readonly canvas = $<HTMLCanvasElement>("bev");
  private readonly shown = CHANNELS.map(() => true);
  private image?: ImageData;
  private planes?: Blob_;
  private car = [0, 0, 0]; // its width, and how far its nose and its tail are above the lower edge [px]

  constructor() {
    $("channels").append(...CHANNELS.map(({ name, swatch }, channel) => {
      const box = make("input", { type: "checkbox", checked: true, ariaLabel: channel > 2 ? `lights ${name}` : name });
      box.onchange = () => { this.shown[channel] = box.checked; this.draw(); };
      const label = make("label", {}, box, name);
      label.style.setProperty("--swatch", `rgb(${swatch})`);
      return label;
    }));
  }

  /** Say where in the view the car is: its width, and how far its nose and its tail are above the lower edge [px]. */
  setCar(footprint: number[]): void { this.car = footprint; }

  show(planes: Blob_, size: number): void {
    this.planes = planes;
    if (this.image?.width !== size) {
      this.canvas.width = this.canvas.height = size;
      this.image = new ImageData(size, size);
    }
    this.draw();
  }

  private draw(): void {
    if (!this.image || !this.planes) return;
    const { data, width } = this.image, area = width * width, planes = this.planes;
    for (let pixel = 0; pixel < area; pixel++) {
      let [r, g, b] = BACKGROUND;
      for (let channel = 0; channel < CHANNELS.length; channel++) {
        const value = this.shown[channel] ? planes[channel * area + pixel] : 0;
        if (!value) continue;
        const { share } = CHANNELS[channel], color = CHANNELS[channel].color(value);
        r += share * (color[0] - r); g += share * (color[1] - g); b += share * (color[2] - b);
      }
      data[4 * pixel] = r; data[4 * pixel + 1] = g; data[4 * pixel + 2] = b; data[4 * pixel + 3] = 255;
    }
    const pen = this.canvas.getContext("2d")!;
    pen.putImageData(this.image, 0, 0);
    this.drawCar(pen, width);
  }

  /** A mark for the eye, no part of the view. */
  private drawCar(pen: CanvasRenderingContext2D, size: number): void {
    const [width, nose, tail] = this.car, left = size / 2 - width / 2, top = size - nose;
    pen.strokeStyle = COLORS.trail;
    pen.lineWidth = 1.4;
    pen.strokeRect(left, top, width, nose - tail);
    pen.beginPath(); pen.moveTo(left, top + 6); pen.lineTo(size / 2, top + 2); pen.lineTo(left + width, top + 6); pen.stroke();
  }
}
