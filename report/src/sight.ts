import { Box3, type PerspectiveCamera, Vector3 } from "three";
import type { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

const kDirection = new Vector3(0.78, -1, 0.42).normalize(); // from the target to the camera
const kFilled = 0.84; // share of the picture's width and height for the motion
const kGlide = 350; // [ms]

/// Position and target of the camera.
export class Sight {
  private glide: { begun: number; target: Vector3; offset: Vector3 } | null = null;

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly controls: OrbitControls,
  ) {}

  /// Looks at all boxes from as near as possible. The share `top` of the picture stays free above
  /// them.
  frame(boxes: Box3[], top: number): void {
    this.glide = null;
    const corners = boxes.flatMap(cornersOf);
    const right = new Vector3().crossVectors(this.camera.up, kDirection).normalize();
    const up = new Vector3().crossVectors(kDirection, right);
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const tall = Math.max(Math.min(kFilled, 1 - 2 * top), 0.5) * half;
    const wide = kFilled * half * this.camera.aspect;
    const target = boxes.reduce((all, box) => all.union(box), new Box3()).getCenter(new Vector3());
    let distance = 0;
    // Perspective enlarges near points: iterate to centre the picture.
    for (let round = 0; round < 5; ++round) {
      const points = corners.map((corner) => {
        const offset = corner.clone().sub(target);
        return { x: offset.dot(right), y: offset.dot(up), z: offset.dot(kDirection) };
      });
      distance = Math.max(...points.map(({ x, y, z }) => z + Math.max(Math.abs(x) / wide, Math.abs(y) / tall)));
      const middle = (values: number[]) => 0.5 * (Math.min(...values) + Math.max(...values)) * distance;
      target.addScaledVector(right, middle(points.map(({ x, z }) => x / (distance - z))));
      target.addScaledVector(up, middle(points.map(({ y, z }) => y / (distance - z))));
    }
    // The last shift may have moved a corner outside.
    for (const corner of corners) {
      const offset = corner.clone().sub(target);
      const needed = Math.max(Math.abs(offset.dot(right)) / wide, Math.abs(offset.dot(up)) / tall);
      distance = Math.max(distance, offset.dot(kDirection) + needed);
    }
    this.controls.target.copy(target);
    this.camera.position.copy(target).addScaledVector(kDirection, distance);
    this.controls.update();
  }

  /// Starts a glide to within `distance` of the target; step() continues it.
  glideTo(distance: number): void {
    const offset = this.camera.position.clone().sub(this.controls.target);
    if (offset.length() > distance) offset.setLength(distance);
    this.glide = { begun: performance.now(), target: this.controls.target.clone(), offset };
    if (matchMedia("(prefers-reduced-motion: reduce)").matches) this.glide.begun -= kGlide;
  }
  /// One step of a glide to the current `target`; false without a glide.
  step(target: Vector3): boolean {
    if (!this.glide) return false;
    const share = Math.min((performance.now() - this.glide.begun) / kGlide, 1);
    const eased = share * share * (3 - 2 * share);
    const offset = this.camera.position.clone().sub(this.controls.target).lerp(this.glide.offset, eased);
    this.controls.target.lerpVectors(this.glide.target, target, eased);
    this.camera.position.copy(this.controls.target).add(offset);
    this.camera.lookAt(this.controls.target);
    if (share >= 1) this.glide = null;
    return true;
  }
  get gliding(): boolean {
    return this.glide !== null;
  }
  stop(): void {
    this.glide = null;
  }
  move(by: Vector3): void {
    this.controls.target.add(by);
    this.camera.position.add(by);
  }
}

export function cornersOf(box: Box3): Vector3[] {
  const { min, max } = box;
  return [min.x, max.x].flatMap((x) => [min.y, max.y].flatMap((y) => [min.z, max.z].map((z) => new Vector3(x, y, z))));
}
