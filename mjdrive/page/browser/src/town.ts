// The scene message -> three.js: one instanced mesh a shape, meshes by material.
import * as THREE from "three";
import type { Message } from "./codec";

const SIGNALS = 3;
const LIT = [[0.1, 0.95, 0.35], [1, 0.78, 0.08], [1, 0.12, 0.08]], DARK = [[0.04, 0.13, 0.07], [0.15, 0.12, 0.04], [0.15, 0.05, 0.04]];

interface Placed { body: number; position: number[]; quaternion: number[]; color: number[] }
interface Part extends Placed { shape: string; size: number[] }
interface MeshPlaced extends Placed { mesh: number; material: number }

const SHAPES: Record<string, THREE.BufferGeometry> = {
  box: new THREE.BoxGeometry(2, 2, 2),
  cylinder: new THREE.CylinderGeometry(1, 1, 2, 24).rotateX(Math.PI / 2),
  sphere: new THREE.SphereGeometry(1, 24, 16),
};
const LAMP = new THREE.SphereGeometry(1, 12, 8);

export const srgb = ([r, g, b]: ArrayLike<number> & Iterable<number>): THREE.Color => new THREE.Color().setRGB(r, g, b, THREE.SRGBColorSpace);
const matrix = (position: number[], [w, x, y, z]: number[], size: number[]): THREE.Matrix4 =>
  new THREE.Matrix4().compose(new THREE.Vector3(...position), new THREE.Quaternion(x, y, z, w), new THREE.Vector3(...size));

export class TownScene {
  readonly group = new THREE.Group();
  readonly bodies: THREE.Group[] = [];
  private lamps?: THREE.InstancedMesh;
  private shown = "";

  constructor(readonly message: Message) {
    const { head, blobs } = message;
    for (let body = 0; body < head.bodies; body++) this.bodies.push(new THREE.Group());
    this.group.add(...this.bodies);
    for (const shape of Object.keys(SHAPES)) this.addInstances(shape, blobs[shape] as Float32Array);
    this.addMeshes(head.meshes);
    for (const part of head.parts as Part[]) this.addPart(part);
    this.addLamps(blobs.lamps as Float32Array);
    this.addLand(head.bounds, head.land);
    this.addShadow();
  }

  /** Light one lamp of each light. */
  showLights(signals: Uint8Array): void {
    const key = signals.join("");
    if (!this.lamps || key === this.shown) return;
    this.shown = key;
    signals.forEach((signal, light) => {
      for (let lamp = 0; lamp < SIGNALS; lamp++) this.lamps!.setColorAt(SIGNALS * light + lamp, srgb((lamp === signal ? LIT : DARK)[lamp]));
    });
    this.lamps.instanceColor!.needsUpdate = true;
  }

  dispose(): void {
    this.group.traverse((it) => {
      if (!(it instanceof THREE.Mesh)) return;
      if (!Object.values(SHAPES).includes(it.geometry)) it.geometry.dispose();
      for (const material of [it.material].flat()) { material.map?.dispose(); material.dispose(); }
    });
  }

  private addInstances(shape: string, rows: Float32Array): void {
    const count = rows.length / 13;
    if (!count) return;
    const mesh = new THREE.InstancedMesh(SHAPES[shape], new THREE.MeshLambertMaterial(), count);
    for (let index = 0; index < count; index++) {
      const row = [...rows.subarray(13 * index, 13 * index + 13)];
      mesh.setMatrixAt(index, matrix(row.slice(0, 3), row.slice(3, 7), row.slice(7, 10)));
      mesh.setColorAt(index, srgb(row.slice(10)));
    }
    mesh.frustumCulled = false;
    this.group.add(mesh);
  }

  private addMeshes(placed: MeshPlaced[]): void {
    const groups = new Map<string, MeshPlaced[]>();
    for (const it of placed) {
      const key = `${it.mesh} ${it.material} ${it.body} ${it.color}`;
      groups.set(key, [...(groups.get(key) ?? []), it]);
    }
    for (const same of groups.values()) {
      const [first] = same;
      const mesh = new THREE.InstancedMesh(this.geometry(first.mesh), this.material(first), same.length);
      same.forEach((it, index) => mesh.setMatrixAt(index, matrix(it.position, it.quaternion, [1, 1, 1])));
      mesh.frustumCulled = false;
      (first.body < 0 ? this.group : this.bodies[first.body]).add(mesh);
    }
  }

  private geometry(number: number): THREE.BufferGeometry {
    const { blobs } = this.message, geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(blobs[`vertices_${number}`], 3));
    if (blobs[`uv_${number}`]) geometry.setAttribute("uv", new THREE.BufferAttribute(blobs[`uv_${number}`], 2));
    if (blobs[`faces_${number}`]) geometry.setIndex(new THREE.BufferAttribute(blobs[`faces_${number}`], 1));
    return geometry;
  }

  private material({ material, color }: MeshPlaced): THREE.Material {
    const texture = this.message.head.textures[material];
    const map = texture === undefined ? null : this.texture(texture);
    return new THREE.MeshLambertMaterial({ color: map ? 0xffffff : srgb(color), map, flatShading: true });
  }

  private texture(number: number): THREE.Texture {
    const name = `texture_${number}`, [height, width] = this.message.shapes[name], rgb = this.message.blobs[name];
    const rgba = new Uint8Array(4 * width * height).fill(255);
    for (let pixel = 0; pixel < width * height; pixel++) rgba.set(rgb.subarray(3 * pixel, 3 * pixel + 3) as Uint8Array, 4 * pixel);
    const texture = new THREE.DataTexture(rgba, width, height);
    texture.wrapS = texture.wrapT = THREE.RepeatWrapping;
    texture.colorSpace = THREE.SRGBColorSpace;
    texture.generateMipmaps = true;
    texture.minFilter = THREE.LinearMipmapLinearFilter;
    texture.needsUpdate = true;
    return texture;
  }

  private addPart({ body, shape, position, quaternion, size, color }: Part): void {
    const mesh = new THREE.Mesh(SHAPES[shape], new THREE.MeshLambertMaterial({ color: srgb(color) }));
    mesh.applyMatrix4(matrix(position, quaternion, size));
    this.bodies[body].add(mesh);
  }

  private addLamps(rows: Float32Array): void {
    if (!rows.length) return;
    this.lamps = new THREE.InstancedMesh(LAMP, new THREE.MeshBasicMaterial(), rows.length / 4);
    for (let index = 0; index < rows.length / 4; index++) {
      const [x, y, z, radius] = rows.subarray(4 * index, 4 * index + 4);
      this.lamps.setMatrixAt(index, matrix([x, y, z], [1, 0, 0, 0], [radius, radius, radius]));
      this.lamps.setColorAt(index, srgb(DARK[index % SIGNALS]));
    }
    this.lamps.frustumCulled = false;
    this.group.add(this.lamps);
  }

  private addLand([left, bottom, right, top]: number[], color: number[]): void {
    const far = 600;
    const land = new THREE.Mesh(new THREE.PlaneGeometry(right - left + 2 * far, top - bottom + 2 * far), new THREE.MeshLambertMaterial({ color: srgb(color) }));
    land.position.set((left + right) / 2, (bottom + top) / 2, -0.05);
    this.group.add(land);
  }

  /** A soft dark patch under the car: cheaper than shadow maps, which make software WebGL five times slower. */
  private addShadow(): void {
    const size = 64, alpha = new Uint8Array(4 * size * size);
    for (let row = 0; row < size; row++) for (let column = 0; column < size; column++) {
      const edge = Math.max(Math.abs(row / (size - 1) - 0.5), Math.abs(column / (size - 1) - 0.5)) * 2;
      alpha[4 * (row * size + column) + 3] = 120 * Math.max(0, Math.min(1, (1 - edge) / 0.35));
    }
    const map = new THREE.DataTexture(alpha, size, size);
    map.magFilter = THREE.LinearFilter;
    map.needsUpdate = true;
    const quad = new THREE.Mesh(new THREE.PlaneGeometry(5.0, 2.3), new THREE.MeshBasicMaterial({ map, transparent: true, depthWrite: false, polygonOffset: true, polygonOffsetFactor: -4 }));
    quad.position.set(1.3, 0, 0.06);
    this.bodies[0]?.add(quad);
  }
}
