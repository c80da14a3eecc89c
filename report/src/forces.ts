import {
  BufferGeometry,
  type Color,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  Line,
  LineBasicMaterial,
  LineSegments,
  Mesh,
  MeshBasicMaterial,
  Quaternion,
  Vector3,
} from "three";
import type { Scene, Surface } from "./data";
import type { Motion } from "./motion";

const kUp = new Vector3(0, 0, 1);
const kSeen = 1e-3; // of the weight; smaller forces are hidden

/// An arrow as drawn: start [m], force that its length represents [N], friction coefficient of its
/// cone.
export interface DrawnForce {
  name: string;
  visible: boolean;
  from: number[];
  vector: number[];
  cone: { slope: number };
}

interface Contact {
  arrow: Group;
  shaft: Mesh;
  head: Mesh;
  cone: Group;
}

/// Contact forces on the robot as arrows from the touching points, in friction cones as high as the
/// arrow's tip: a tip on the rim is a foot about to slip.
export class Forces {
  readonly arrows = new Group();
  readonly cones = new Group();
  private readonly contacts: Contact[];
  private readonly arrowMaterial = new MeshBasicMaterial({ depthTest: false, transparent: true, opacity: 0.95 });
  private readonly coneMaterial = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.16,
    side: DoubleSide,
    depthWrite: false,
  });
  private readonly rimMaterial = new LineBasicMaterial({ transparent: true, opacity: 0.7 });
  private readonly perNewton: number; // [m/N]
  private readonly thickness: number; // [m]

  /// Broad arrows are transparent, and lie below others.
  constructor(
    private readonly scene: Scene,
    size: number,
    private readonly weight: number,
    private readonly isBroad = false,
  ) {
    this.perNewton = (1.05 * size) / weight;
    this.thickness = (isBroad ? 0.022 : 0.012) * size;
    if (isBroad) this.arrowMaterial.opacity = 0.6;
    this.contacts = scene.contacts.map(() => this.make());
  }

  setColours(arrow: Color, cone: Color): void {
    this.arrowMaterial.color.copy(arrow);
    this.coneMaterial.color.copy(cone);
    this.rimMaterial.color.copy(cone);
  }

  /// `point(c)`: position of contact c in the world; `held(c)`: surface that it may push against
  /// now, if any.
  show(
    motion: Motion,
    t: number,
    held: (contact: number) => Surface | undefined,
    point: (contact: number) => Vector3,
  ): void {
    const force = new Vector3();
    this.contacts.forEach((contact, c) => {
      const surface = held(c);
      motion.force(t, c, force);
      const seen = surface !== undefined && force.length() > kSeen * this.weight;
      contact.arrow.visible = contact.cone.visible = seen;
      if (!seen) return;
      const normal = new Vector3(...surface.normal);
      const touch = point(c).addScaledVector(normal, -this.scene.contacts[c].radius);
      this.placeArrow(contact, touch, force);
      const height = Math.max(force.dot(normal) * this.perNewton, 1e-4);
      contact.cone.position.copy(touch);
      contact.cone.quaternion.copy(new Quaternion().setFromUnitVectors(kUp, normal));
      contact.cone.scale.set(height * surface.friction, height * surface.friction, height);
    });
  }

  drawn(): DrawnForce[] {
    return this.contacts.map(({ arrow, head, cone }, c) => {
      arrow.updateWorldMatrix(true, true);
      const from = new Vector3().setFromMatrixPosition(arrow.matrixWorld);
      const tip = new Vector3(0, 0, 1).applyMatrix4(head.matrixWorld);
      return {
        name: this.scene.contacts[c].name,
        visible: arrow.visible,
        from: from.toArray(),
        vector: tip.sub(from).divideScalar(this.perNewton).toArray(),
        cone: { slope: cone.scale.x / cone.scale.z },
      };
    });
  }

  private placeArrow(contact: Contact, touch: Vector3, force: Vector3): void {
    const length = force.length() * this.perNewton;
    const head = Math.min(6 * this.thickness, 0.5 * length);
    contact.arrow.position.copy(touch);
    contact.arrow.quaternion.copy(new Quaternion().setFromUnitVectors(kUp, force.clone().normalize()));
    contact.shaft.scale.set(this.thickness, this.thickness, length - head);
    contact.head.position.z = length - head;
    contact.head.scale.set(2.4 * this.thickness, 2.4 * this.thickness, head);
  }

  private make(): Contact {
    const arrow = new Group();
    const shaft = new Mesh(
      new CylinderGeometry(1, 1, 1, 16).rotateX(Math.PI / 2).translate(0, 0, 0.5),
      this.arrowMaterial,
    );
    const head = new Mesh(new ConeGeometry(1, 1, 24).rotateX(Math.PI / 2).translate(0, 0, 0.5), this.arrowMaterial);
    shaft.renderOrder = head.renderOrder = this.isBroad ? 2.5 : 3;
    arrow.add(shaft, head);
    const cone = new Group();
    // Apex at the origin, mouth of radius 1 at z = 1: scaled to the friction coefficient.
    const side = new Mesh(
      new ConeGeometry(1, 1, 48, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5),
      this.coneMaterial,
    );
    side.renderOrder = 2;
    cone.add(
      side,
      new LineSegments(
        new EdgesGeometry(new ConeGeometry(1, 1, 48, 1, true).rotateX(-Math.PI / 2).translate(0, 0, 0.5), 30),
        this.rimMaterial,
      ),
    );
    this.arrows.add(arrow);
    this.cones.add(cone);
    return { arrow, shaft, head, cone };
  }
}

/// Paths of points of the robot.
export class Trails {
  readonly group = new Group();
  private readonly material = new LineBasicMaterial({ transparent: true, opacity: 0.8 });

  clear(): void {
    for (const line of this.group.children) (line as Line).geometry.dispose();
    this.group.clear();
  }
  add(points: Vector3[]): void {
    this.group.add(new Line(new BufferGeometry().setFromPoints(points), this.material));
  }
  setColour(colour: Color): void {
    this.material.color.copy(colour);
  }
}
