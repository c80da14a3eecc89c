import {
  BufferGeometry,
  type Color,
  Group,
  LineBasicMaterial,
  LineLoop,
  LineSegments,
  Mesh,
  MeshStandardMaterial,
  PlaneGeometry,
  Quaternion,
  ShapeGeometry,
  Shape,
  Vector2,
  Vector3,
} from "three";
import type { Surface } from "./data";

const kGrid = 0.25; // [m]

/// Planes as a grid around the motion, patches as polygons; invisible from behind or below.
export class Ground {
  readonly group = new Group();
  private readonly faces: MeshStandardMaterial[] = [];
  private readonly lines: LineBasicMaterial[] = [];
  private readonly planes: Group[] = [];

  /// `centre` and `reach` [m]: visible part of a plane.
  constructor(surfaces: Surface[], centre: Vector3, reach: number) {
    for (const surface of surfaces)
      this.group.add(surface.patch.length > 0 ? this.patch(surface) : this.plane(surface, centre, reach));
  }

  /// Moves planes under a point, by whole grid steps.
  follow(point: Vector3): void {
    for (const plane of this.planes) {
      const along = point.clone().sub(plane.position).applyQuaternion(plane.quaternion.clone().invert());
      along.set(Math.round(along.x / kGrid) * kGrid, Math.round(along.y / kGrid) * kGrid, 0);
      plane.position.add(along.applyQuaternion(plane.quaternion));
    }
  }
  setColours(face: Color, line: Color): void {
    for (const material of this.faces) material.color.copy(face);
    for (const material of this.lines) material.color.copy(line);
  }

  private face(opacity: number): MeshStandardMaterial {
    const material = new MeshStandardMaterial({
      roughness: 1,
      transparent: opacity < 1,
      opacity,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    this.faces.push(material);
    return material;
  }
  private line(): LineBasicMaterial {
    const material = new LineBasicMaterial();
    this.lines.push(material);
    return material;
  }

  private plane(surface: Surface, centre: Vector3, reach: number): Group {
    const normal = new Vector3(...surface.normal);
    const point = new Vector3(...surface.point);
    const size = 2 * Math.ceil(2 * reach) * 0.5; // whole grid steps
    const plane = new Group();
    const face = new Mesh(new PlaneGeometry(size, size), this.face(1));
    face.receiveShadow = true;
    const step = kGrid;
    const points: Vector3[] = [];
    for (let x = -size / 2; x <= size / 2 + 1e-9; x += step) {
      points.push(
        new Vector3(x, -size / 2, 0),
        new Vector3(x, size / 2, 0),
        new Vector3(-size / 2, x, 0),
        new Vector3(size / 2, x, 0),
      );
    }
    plane.add(face, new LineSegments(new BufferGeometry().setFromPoints(points), this.line()));
    plane.quaternion.copy(new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), normal));
    // Below the robot, on whole grid steps: on level ground the lines are at round coordinates.
    const rounded = new Vector3(Math.round(centre.x / step) * step, Math.round(centre.y / step) * step, centre.z);
    this.planes.push(plane);
    plane.position.copy(rounded.addScaledVector(normal, -rounded.clone().sub(point).dot(normal)));
    return plane;
  }

  private patch(surface: Surface): Group {
    const normal = new Vector3(...surface.normal);
    const turn = new Quaternion().setFromUnitVectors(new Vector3(0, 0, 1), normal);
    const origin = new Vector3(...surface.patch[0]);
    const flat = surface.patch.map((corner) =>
      new Vector3(...corner).sub(origin).applyQuaternion(turn.clone().invert()),
    );
    const patch = new Group();
    const face = new Mesh(new ShapeGeometry(new Shape(flat.map((p) => new Vector2(p.x, p.y)))), this.face(0.85));
    face.receiveShadow = true;
    patch.add(face, new LineLoop(new BufferGeometry().setFromPoints(flat), this.line()));
    patch.quaternion.copy(turn);
    patch.position.copy(origin);
    return patch;
  }
}
