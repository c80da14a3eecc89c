import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CapsuleGeometry,
  Color,
  CylinderGeometry,
  Group,
  type Material,
  Matrix4,
  Mesh,
  MeshStandardMaterial,
  Quaternion,
  SphereGeometry,
  SRGBColorSpace,
  Vector3,
} from "three";
import { toCreasedNormals } from "three/examples/jsm/utils/BufferGeometryUtils.js";
import { floats, integers, type Scene, type Triple, type Visual } from "./data";
import type { Motion } from "./motion";

const kCrease = (40 * Math.PI) / 180; // sharper edges appear as edges

/// Geometry shared by the robot and its ghost.
export class Shapes {
  private readonly meshes: BufferGeometry[];

  constructor(private readonly scene: Scene) {
    this.meshes = scene.meshes.map((mesh) => {
      const geometry = new BufferGeometry();
      geometry.setAttribute("position", new BufferAttribute(floats(mesh.positions), 3));
      geometry.setIndex(new BufferAttribute(integers(mesh.triangles), 1));
      return toCreasedNormals(geometry, kCrease);
    });
  }

  /// Parts of a visual in its body, with their own colours.
  parts(visual: Visual): { geometry: BufferGeometry; colour: Triple | null; matrix: Matrix4 }[] {
    const [a, b, c] = visual.size;
    const p = visual.placement;
    const matrix = new Matrix4().compose(
      new Vector3(p[0], p[1], p[2]),
      new Quaternion(p[3], p[4], p[5], p[6]),
      new Vector3(1, 1, 1),
    );
    const one = (geometry: BufferGeometry) => [{ geometry, colour: visual.colour, matrix }];
    const alongZ = (geometry: BufferGeometry) => one(geometry.rotateX(Math.PI / 2));
    switch (visual.kind) {
      case "box":
        return one(new BoxGeometry(a, b, c));
      case "sphere":
        return one(new SphereGeometry(a, 32, 20));
      case "cylinder":
        return alongZ(new CylinderGeometry(a, a, c, 32));
      case "capsule":
        return alongZ(new CapsuleGeometry(a, c, 12, 24));
      case "mesh":
        matrix.scale(new Vector3(a, b, c));
        return visual.meshes.map((m) => ({
          geometry: this.meshes[m],
          colour: visual.colour ?? this.scene.meshes[m].colour,
          matrix,
        }));
    }
  }
}

/// The robot with one group per body, in world coordinates. A ghost has one colour, and is
/// transparent.
export class Robot {
  readonly group = new Group();
  readonly bodies: Group[];
  private readonly position = new Vector3();
  private readonly rotation = new Quaternion();

  constructor(scene: Scene, shapes: Shapes, ghost: Material | null) {
    this.bodies = scene.bodies.map((name) => {
      const body = new Group();
      body.name = name;
      this.group.add(body);
      return body;
    });
    const materials = new Map<string, Material>();
    for (const visual of scene.visuals) {
      for (const part of shapes.parts(visual)) {
        const mesh = new Mesh(part.geometry, ghost ?? materialOf(part.colour, materials));
        mesh.applyMatrix4(part.matrix);
        mesh.castShadow = mesh.receiveShadow = ghost === null;
        this.bodies[visual.body].add(mesh);
      }
    }
  }

  show(motion: Motion, t: number): void {
    this.bodies.forEach((body, b) => {
      motion.body(t, b, this.position, this.rotation);
      body.position.copy(this.position);
      body.quaternion.copy(this.rotation);
    });
  }
}

function materialOf(colour: Triple | null, made: Map<string, Material>): Material {
  const key = colour === null ? "" : colour.join();
  let material = made.get(key);
  if (!material) {
    const own = new Color().setRGB(...(colour ?? ([0.72, 0.73, 0.75] as Triple)), SRGBColorSpace);
    // Pure colours of CAD files hide shading: keep the hue, soften the colour.
    const { h, s, l } = own.getHSL({ h: 0, s: 0, l: 0 }, SRGBColorSpace);
    own.setHSL(h, Math.min(s, 0.45), Math.min(Math.max(l, 0.24), 0.88), SRGBColorSpace);
    material = new MeshStandardMaterial({ color: own, roughness: 0.62, metalness: 0.08 });
    made.set(key, material);
  }
  return material;
}

/// Transparent; hidden where it coincides with the plan.
export function ghostMaterial(): MeshStandardMaterial {
  return new MeshStandardMaterial({
    transparent: true,
    opacity: 0.5,
    roughness: 0.8,
    polygonOffset: true,
    polygonOffsetFactor: 2,
    polygonOffsetUnits: 40,
  });
}

/// Current position of a contact in the scene.
export function contactPoint(scene: Scene, robot: Robot, contact: number): Vector3 {
  const { body, point } = scene.contacts[contact];
  const group = robot.bodies[body];
  group.updateWorldMatrix(true, false);
  return new Vector3(...point).applyMatrix4(group.matrixWorld);
}

/// Placement of a body in the scene: x y z, quaternion x y z w; empty for an unknown name.
export function placementOf(robot: Robot | null | undefined, name: string): number[] {
  const body = robot?.bodies.find((group) => group.name === name);
  if (!body) return [];
  body.updateWorldMatrix(true, false);
  const position = new Vector3();
  const rotation = new Quaternion();
  body.matrixWorld.decompose(position, rotation, new Vector3());
  return [...position.toArray(), ...rotation.toArray()];
}
