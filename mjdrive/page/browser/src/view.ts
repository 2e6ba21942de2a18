// The 3D view: sixty pictures a second whatever the server's rate, poses between the last two that came; none where nothing moves.
import * as THREE from "three";
import { Cameras, type CameraName } from "./cameras";
import type { Message } from "./codec";
import { TownScene } from "./town";

const SKY = 0xc3d6e6;
const NUMBERS = 7; // of a pose: position, quaternion
const SLOW_MS = 45;
const LONGEST_GAP_MS = 250;
const SETTLED_MS = 2000; // the chase camera has come to rest by then

export class View {
  town?: TownScene;
  readonly cameras: Cameras;
  rendered = 0;
  calls = 0;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private before: Float32Array | null = null;
  private now: Float32Array | null = null;
  private cameAt = 0;
  private interval = 20;
  private last = 0;
  private cost = 16;
  private restUntil = 0;
  private touchedAt = 0;

  /** Throws where there is no WebGL. */
  constructor(private readonly canvas: HTMLCanvasElement, antialias: boolean) {
    const context = canvas.getContext("webgl2", { antialias, powerPreference: "high-performance" });
    if (!context) throw new Error("There is no WebGL here.");
    this.renderer = new THREE.WebGLRenderer({ canvas, context });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.cameras = new Cameras(canvas, this.touch);
    this.scene.background = new THREE.Color(SKY);
    this.scene.fog = new THREE.Fog(SKY, 120, 420);
    this.scene.add(new THREE.HemisphereLight(0xf4f8ff, 0x8a8a70, 1.9));
    const sun = new THREE.DirectionalLight(0xfff2dc, 1.9);
    sun.position.set(-41, -56, 72);
    this.scene.add(sun);
    requestAnimationFrame(this.frame);
  }

  setTown(message: Message): void {
    if (this.town) { this.scene.remove(this.town.group); this.town.dispose(); }
    this.town = new TownScene(message);
    this.scene.add(this.town.group);
    this.before = this.now = null;
    this.touch();
  }

  choose(camera: CameraName): void { this.cameras.choose(camera); this.touch(); }

  setPose(poses: Float32Array, jump = false): void {
    const time = performance.now(), gap = time - this.cameAt;
    if (gap < LONGEST_GAP_MS) this.interval += 0.1 * (gap - this.interval);
    this.cameAt = time;
    this.before = jump || !this.now || far(this.now, poses) ? poses : this.now;
    this.now = poses;
    this.touch();
  }

  private touch = (): void => { this.touchedAt = performance.now(); };

  private frame = (time: number): void => {
    requestAnimationFrame(this.frame);
    const gap = time - this.last;
    this.last = time;
    if (document.hidden || !this.canvas.clientWidth) return this.touch(); // what changes meanwhile is drawn later
    if (time < this.restUntil) return;
    this.giveUpPixelsBeforeMessages(gap, time);
    this.fit();
    if (time > this.touchedAt + SETTLED_MS) return;
    const car = this.town?.bodies[0];
    if (this.now && car) { this.place(); this.cameras.follow(car, gap); }
    this.renderer.render(this.scene, this.cameras.camera);
    this.rendered++;
    this.calls = this.renderer.info.render.calls;
  };

  /** A slow machine first loses pixels; then it leaves half of its time to messages and keys. */
  private giveUpPixelsBeforeMessages(gap: number, time: number): void {
    if (this.rendered > 5 && gap < 2000) this.cost += 0.2 * (gap - this.cost);
    if (this.cost <= SLOW_MS) return;
    if (this.rendered % 10 === 9 && this.renderer.getPixelRatio() > 0.5) this.renderer.setPixelRatio(this.renderer.getPixelRatio() / 2);
    this.restUntil = time + Math.min(this.cost, 200);
  }

  private fit(): void {
    const { clientWidth: width, clientHeight: height } = this.canvas, ratio = this.renderer.getPixelRatio(), { camera } = this.cameras;
    if (this.canvas.width === Math.floor(width * ratio) && this.canvas.height === Math.floor(height * ratio)) return;
    this.renderer.setSize(width, height, false);
    camera.aspect = width / Math.max(height, 1);
    camera.updateProjectionMatrix();
    this.touch();
  }

  private place(): void {
    const share = Math.min(1, (performance.now() - this.cameAt) / this.interval), [from, to] = [this.before!, this.now!];
    this.town!.bodies.forEach((body, index) => {
      const at = NUMBERS * index;
      body.position.fromArray(from, at).lerp(B.fromArray(to, at), share);
      body.quaternion.copy(quaternion(QA, from, at)).slerp(quaternion(QB, to, at), share);
    });
  }
}

const B = new THREE.Vector3(), QA = new THREE.Quaternion(), QB = new THREE.Quaternion();
const quaternion = (into: THREE.Quaternion, poses: Float32Array, at: number): THREE.Quaternion =>
  into.set(poses[at + 4], poses[at + 5], poses[at + 6], poses[at + 3]);
const far = (one: Float32Array, other: Float32Array): boolean => Math.hypot(one[0] - other[0], one[1] - other[1]) > 5;
