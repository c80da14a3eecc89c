import {
  BufferGeometry,
  type Color,
  CylinderGeometry,
  DoubleSide,
  Group,
  Line,
  LineBasicMaterial,
  LineLoop,
  Mesh,
  MeshBasicMaterial,
  SphereGeometry,
  Vector3,
} from "three";

const kFlat = 0.01; // largest height difference of level points [m]
const kLoaded = 1e-3; // of the weight; contacts with a smaller force count as unloaded

/// A contact in stance: touching point, normal of its surface, force on the robot [N].
export interface Support {
  point: Vector3;
  normal: Vector3;
  force: Vector3;
}

/// Corners of the convex hull of points seen from above, counterclockwise (Andrew's monotone chain).
export function hullFromAbove(points: Vector3[]): Vector3[] {
  const sorted = [...points].sort((a, b) => a.x - b.x || a.y - b.y);
  const turns = (a: Vector3, b: Vector3, c: Vector3) => (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) > 1e-12;
  const half = (all: Vector3[]): Vector3[] => {
    const chain: Vector3[] = [];
    for (const point of all) {
      while (chain.length > 1 && !turns(chain[chain.length - 2], chain[chain.length - 1], point)) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return sorted.length < 3 ? sorted : [...half(sorted), ...half([...sorted].reverse())];
}

/// Zero-moment point: mean of the contact points, weighted by normal forces. Null unless all loaded
/// contacts are on one horizontal plane; there the contact forces have no horizontal moment about
/// it.
export function zeroMomentPoint(supports: Support[], weight: number): Vector3 | null {
  const loaded = supports.filter(({ force, normal }) => force.dot(normal) > kLoaded * weight);
  if (loaded.length === 0) return null;
  const heights = loaded.map(({ point }) => point.z);
  if (Math.max(...heights) - Math.min(...heights) > kFlat) return null;
  if (loaded.some(({ normal }) => normal.z < 1 - 1e-6)) return null;
  const sum = loaded.reduce((total, { force }) => total + force.z, 0);
  return loaded.reduce((mean, { point, force }) => mean.addScaledVector(point, force.z / sum), new Vector3());
}

/// Centre of mass with its plumb line, support polygon and zero-moment point.
export class Balance {
  readonly massCentre = new Group();
  readonly polygon = new Group();
  readonly zmp: Mesh;
  corners: Vector3[] = [];
  private readonly massMaterial = new MeshBasicMaterial({ depthTest: false, transparent: true });
  private readonly zmpMaterial = new MeshBasicMaterial({ depthTest: false, transparent: true });
  private readonly lineMaterial = new LineBasicMaterial({ transparent: true });
  private readonly edgeMaterial = new LineBasicMaterial({ transparent: true });
  private readonly faceMaterial = new MeshBasicMaterial({
    transparent: true,
    opacity: 0.22,
    side: DoubleSide,
    depthWrite: false,
  });
  private readonly ball: Mesh;
  private readonly plumb: Line;
  private readonly edge: LineLoop;
  private readonly face: Mesh;

  constructor(private readonly size: number) {
    this.ball = new Mesh(new SphereGeometry(0.035 * size, 24, 16), this.massMaterial);
    this.plumb = new Line(new BufferGeometry(), this.lineMaterial);
    this.edge = new LineLoop(new BufferGeometry(), this.edgeMaterial);
    this.face = new Mesh(new BufferGeometry(), this.faceMaterial);
    this.zmp = new Mesh(
      new CylinderGeometry(0.04 * size, 0.04 * size, 0.01 * size, 24).rotateX(Math.PI / 2),
      this.zmpMaterial,
    );
    this.ball.renderOrder = this.zmp.renderOrder = 4;
    this.massCentre.add(this.ball, this.plumb);
    this.polygon.add(this.face, this.edge);
  }

  setColours(mass: Color, support: Color, zmp: Color): void {
    this.massMaterial.color.copy(mass);
    this.lineMaterial.color.copy(mass);
    this.edgeMaterial.color.copy(support);
    this.faceMaterial.color.copy(support);
    this.zmpMaterial.color.copy(zmp);
  }

  show(centre: Vector3, supports: Support[], weight: number): void {
    this.ball.position.copy(centre);
    const lowest = Math.min(centre.z, ...supports.map(({ point }) => point.z));
    this.plumb.geometry.setFromPoints([centre, new Vector3(centre.x, centre.y, lowest)]);
    this.corners = hullFromAbove(supports.map(({ point }) => point));
    this.polygon.visible = this.corners.length > 1;
    if (this.polygon.visible) this.drawPolygon();
    const zmp = zeroMomentPoint(supports, weight);
    this.zmp.visible = zmp !== null;
    if (zmp) this.zmp.position.copy(zmp);
  }

  private drawPolygon(): void {
    const raised = this.corners.map((corner) => corner.clone().setZ(corner.z + 0.004 * this.size));
    // Another number of corners needs new buffers.
    this.edge.geometry.dispose();
    this.face.geometry.dispose();
    this.edge.geometry = new BufferGeometry().setFromPoints(raised);
    const fan = raised.slice(2).flatMap((corner, i) => [raised[0], raised[i + 1], corner]);
    this.face.geometry = new BufferGeometry().setFromPoints(fan);
    this.face.visible = fan.length > 0;
  }
}
