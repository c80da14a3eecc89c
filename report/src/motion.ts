import { Quaternion, Vector3 } from "three";
import { floats, type MotionData } from "./data";

/// Index of the last sample at or before t (the later of two at one time), and the share of the way
/// to the next, 0 ... 1.
export function sampleAt(time: ArrayLike<number>, t: number): { index: number; share: number } {
  let low = 0;
  let high = time.length - 1;
  if (t >= time[high]) return { index: high, share: 0 };
  while (low < high - 1) {
    const middle = (low + high) >> 1;
    if (time[middle] <= t) low = middle;
    else high = middle;
  }
  const length = time[high] - time[low];
  return { index: low, share: length > 0 ? Math.min(Math.max((t - time[low]) / length, 0), 1) : 0 };
}

/// Bodies and contact forces of a motion at any time: linear between samples, orientations along
/// the shortest rotation.
export class Motion {
  readonly end: number;
  private readonly placements: Float32Array;
  private readonly forces: Float32Array;
  private readonly centres: Float32Array;
  private readonly other = new Quaternion();

  constructor(
    private readonly data: MotionData,
    private readonly bodies: number,
    private readonly contacts: number,
  ) {
    this.placements = floats(data.placements);
    this.forces = floats(data.forces);
    this.centres = floats(data.mass_centre);
    this.end = data.time[data.time.length - 1] ?? 0;
  }

  body(t: number, body: number, position: Vector3, rotation: Quaternion): void {
    const { index, share } = sampleAt(this.data.time, t);
    const at = 7 * (index * this.bodies + body);
    const p = this.placements;
    position.fromArray(p, at);
    rotation.fromArray(p, at + 3);
    if (share === 0) return;
    const next = at + 7 * this.bodies;
    position.lerp(new Vector3().fromArray(p, next), share);
    rotation.slerp(this.other.fromArray(p, next + 3), share);
  }
  force(t: number, contact: number, force: Vector3): void {
    const { index, share } = sampleAt(this.data.time, t);
    const at = 3 * (index * this.contacts + contact);
    force.fromArray(this.forces, at);
    if (share > 0) force.lerp(new Vector3().fromArray(this.forces, at + 3 * this.contacts), share);
  }
  /// Centre of mass [m].
  massCentre(t: number, centre: Vector3): void {
    const { index, share } = sampleAt(this.data.time, t);
    centre.fromArray(this.centres, 3 * index);
    if (share > 0) centre.lerp(new Vector3().fromArray(this.centres, 3 * (index + 1)), share);
  }
  /// Positions of a point fixed to a body, at every sample.
  path(body: number, point: Vector3): Vector3[] {
    const rotation = new Quaternion();
    return this.data.time.map((_, i) => {
      const at = 7 * (i * this.bodies + body);
      rotation.fromArray(this.placements, at + 3);
      return point.clone().applyQuaternion(rotation).add(new Vector3().fromArray(this.placements, at));
    });
  }
}
