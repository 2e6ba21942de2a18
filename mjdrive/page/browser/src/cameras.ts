// Where one looks from. The chase camera is smoothed relative to the car, not in the world, or it would swing.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

export const CAMERAS = ["chase", "hood", "top", "orbit"] as const;
export type CameraName = (typeof CAMERAS)[number];

const CHASE = { back: 8, up: 3.6, ahead: 6, settle_ms: 250 };
const HOOD = { ahead: 1.3, up: 1.35 };
const TOP = { up: 55, ahead: 12 };

export class Cameras {
  readonly camera = new THREE.PerspectiveCamera(55, 1, 0.4, 1200);
  name: CameraName = "chase";
  private readonly orbit: OrbitControls;
  private readonly behind = new THREE.Vector3(-CHASE.back, 0, CHASE.up);
  private readonly forward = new THREE.Vector3();
  private readonly want = new THREE.Vector3();
  private isSettled = false;

  /** Calls back whenever who looks turns the orbit camera. */
  constructor(canvas: HTMLElement, onTurn: () => void) {
    this.camera.up.set(0, 0, 1);
    this.orbit = new OrbitControls(this.camera, canvas);
    this.orbit.enabled = false;
    this.orbit.maxPolarAngle = 1.5;
    this.orbit.minDistance = 3;
    this.orbit.maxDistance = 400;
    this.orbit.addEventListener("change", onTurn);
  }

  choose(name: CameraName): void {
    this.name = name;
    this.orbit.enabled = name === "orbit";
    this.isSettled = false;
    if (name === "orbit") this.camera.position.set(this.orbit.target.x - 14, this.orbit.target.y - 18, 14);
  }

  follow(car: THREE.Object3D, elapsedMs: number): void {
    const { camera, forward } = this, place = car.position;
    forward.set(1, 0, 0).applyQuaternion(car.quaternion).setZ(0).normalize();
    camera.up.set(0, 0, 1);
    if (this.name === "orbit") {
      camera.position.add(this.want.copy(place).sub(this.orbit.target));
      this.orbit.target.copy(place);
      this.orbit.update();
    } else if (this.name === "chase") {
      this.want.set(-CHASE.back * forward.x, -CHASE.back * forward.y, CHASE.up);
      this.behind.lerp(this.want, this.isSettled ? 1 - Math.exp(-Math.min(elapsedMs, 200) / CHASE.settle_ms) : 1);
      camera.position.copy(place).add(this.behind);
      camera.lookAt(place.x + CHASE.ahead * forward.x, place.y + CHASE.ahead * forward.y, place.z + 1);
      this.orbit.target.copy(place);
    } else if (this.name === "hood") {
      camera.position.copy(place).addScaledVector(forward, HOOD.ahead).setZ(place.z + HOOD.up);
      camera.lookAt(this.want.copy(camera.position).addScaledVector(forward, 20).setZ(place.z + HOOD.up - 1));
    } else {
      camera.up.copy(forward);
      camera.position.copy(place).addScaledVector(forward, TOP.ahead).setZ(TOP.up);
      camera.lookAt(this.want.copy(camera.position).setZ(0));
    }
    this.isSettled = true;
  }
}
