// The bird's-eye view as the policy gets it: five planes, coloured here, so that switching one off costs nothing.
import type { Blob_ } from "./codec";
import { $, make } from "./dom";

const CHANNELS: [string, [number, number, number]][] = [
  ["road", [74, 82, 95]], ["lines", [240, 214, 120]],
  ["lights −1.5 s", [150, 70, 160]], ["lights −0.8 s", [215, 95, 120]], ["lights now", [255, 84, 66]],
];
const BACKGROUND = [22, 25, 30], CAR = [255, 107, 87];

export class BevPanel {
  private readonly canvas = $<HTMLCanvasElement>("bev");
  private readonly shown = CHANNELS.map(() => true);
  private image?: ImageData;
  private planes?: Blob_;

  constructor() {
    $("channels").append(...CHANNELS.map(([name, color], channel) => {
      const box = make("input", { type: "checkbox", checked: true });
      box.onchange = () => { this.shown[channel] = box.checked; this.draw(); };
      const label = make("label", {}, box, name);
      label.style.setProperty("--swatch", `rgb(${color})`);
      return label;
    }));
  }

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
        const share = this.shown[channel] ? planes[channel * area + pixel] / 255 : 0;
        if (!share) continue;
        const color = CHANNELS[channel][1];
        r += share * (color[0] - r); g += share * (color[1] - g); b += share * (color[2] - b);
      }
      data[4 * pixel] = r; data[4 * pixel + 1] = g; data[4 * pixel + 2] = b; data[4 * pixel + 3] = 255;
    }
    const pen = this.canvas.getContext("2d")!;
    pen.putImageData(this.image, 0, 0);
    this.drawCar(pen, width);
  }

  /** Rear axle 40 px above the bottom less 1.3 m; a mark for the eye, no part of the view. */
  private drawCar(pen: CanvasRenderingContext2D, size: number): void {
    pen.strokeStyle = `rgb(${CAR})`;
    pen.lineWidth = 1.2;
    pen.strokeRect(size / 2 - 4.5, size - 40 - 12, 9, 24);
  }
}
