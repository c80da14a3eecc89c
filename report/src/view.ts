import {
  Color,
  DirectionalLight,
  Fog,
  Group,
  HemisphereLight,
  MeshStandardMaterial,
  PCFShadowMap,
  PerspectiveCamera,
  Quaternion,
  Scene as ThreeScene,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { Clock } from "./clock";
import { type Phase, type ReportData } from "./data";
import { colour } from "./dom";
import { type DrawnForce, Forces, Trails } from "./forces";
import { Ground } from "./ground";
import { Motion } from "./motion";
import { Robot, Shapes } from "./robot";

export interface Layers {
  forces: boolean;
  cones: boolean;
  ghost: boolean;
  trails: boolean;
  follow: boolean;
}

/// The phase of the plan at a time: the later one at a switch, the last one after the end.
export function phaseAt(phases: Phase[], t: number): Phase | undefined {
  return phases.findLast((phase) => phase.start <= t + 1e-9) ?? phases[0];
}

/// The robot in three dimensions.
export class View {
  plan: Motion;
  readonly simulation: Motion | null;
  readonly layers: Layers;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new ThreeScene();
  private readonly camera = new PerspectiveCamera(35, 1, 0.01, 200);
  private readonly controls: OrbitControls;
  private readonly robot: Robot;
  private readonly ghost: Robot | null = null;
  private readonly ghostMaterial = new MeshStandardMaterial({
    transparent: true,
    opacity: 0.5,
    roughness: 0.8,
    // Where both are in one place, the plan is seen alone.
    polygonOffset: true,
    polygonOffsetFactor: 2,
    polygonOffsetUnits: 40,
  });
  private readonly ground: Ground;
  private readonly forces: Forces;
  private readonly trails = new Trails();
  private readonly sun = new DirectionalLight(0xffffff, 2.2);
  private readonly centre = new Vector3();
  private readonly base = new Vector3();
  private waiting = false;

  /// Throws if the browser has no WebGL.
  constructor(
    private readonly container: HTMLElement,
    private readonly data: ReportData,
    private readonly clock: Clock,
  ) {
    const { bodies, contacts } = data.scene;
    this.plan = new Motion(data.plan, bodies.length, contacts.length);
    this.simulation = data.simulation && new Motion(data.simulation, bodies.length, contacts.length);
    this.renderer = new WebGLRenderer({ antialias: true });
    this.renderer.shadowMap.enabled = true;
    this.renderer.shadowMap.type = PCFShadowMap;
    this.container.append(this.renderer.domElement);
    this.renderer.domElement.setAttribute("aria-hidden", "true");

    const shapes = new Shapes(data.scene);
    this.robot = new Robot(data.scene, shapes, null);
    if (this.simulation) this.ghost = new Robot(data.scene, shapes, this.ghostMaterial);
    const reach = this.measure(this.plan.path(0, new Vector3()));
    this.layers = { forces: true, cones: true, ghost: true, trails: true, follow: reach > 2.5 * data.size_m };
    this.ground = new Ground(data.scene.surfaces, this.centre, reach + 6 * data.size_m);
    this.forces = new Forces(data);
    this.drawTrails();

    const light = new Group();
    light.add(new HemisphereLight(0xffffff, 0x8a8f98, 1.6), this.sun, this.sun.target);
    this.setUpShadow(data.size_m);
    this.scene.add(
      light,
      this.ground.group,
      this.robot.group,
      this.forces.cones,
      this.forces.arrows,
      this.trails.group,
    );
    if (this.ghost) this.scene.add(this.ghost.group);

    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.controls.addEventListener("change", () => this.ask());
    this.resetCamera();
    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
    this.setTheme();
    clock.onChange(() => this.ask());
    this.update();
  }

  /// Placement of a body in the scene as it is now: x y z, quaternion x y z w.
  bodyPlacement(name: string, ghost = false): number[] {
    const body = (ghost ? this.ghost : this.robot)?.bodies.find((group) => group.name === name);
    if (!body) return [];
    body.updateWorldMatrix(true, false);
    const position = new Vector3();
    const rotation = new Quaternion();
    body.matrixWorld.decompose(position, rotation, new Vector3());
    return [...position.toArray(), ...rotation.toArray()];
  }
  /// Where a contact of the robot is in the scene now.
  contactPoint(contact: number): Vector3 {
    const { body, point } = this.data.scene.contacts[contact];
    const group = this.robot.bodies[body];
    group.updateWorldMatrix(true, false);
    return new Vector3(...point).applyMatrix4(group.matrixWorld);
  }

  /// Arrows and cones of the contacts as they are drawn.
  arrows(): DrawnForce[] {
    return this.forces.drawn();
  }

  /// Shows the motion that the data has now.
  setPlan(): void {
    this.plan = new Motion(this.data.plan, this.data.scene.bodies.length, this.data.scene.contacts.length);
    this.drawTrails();
    this.ask();
  }
  setTheme(): void {
    this.scene.background = new Color(colour("scene"));
    this.scene.fog = new Fog(colour("scene"));
    this.ground.setColours(new Color(colour("ground")), new Color(colour("ground-line")));
    this.forces.setColours(new Color(colour("force")), new Color(colour("cone")));
    this.trails.setColour(new Color(colour("trail")));
    this.ghostMaterial.color.set(colour("simulation"));
    this.ask();
  }
  resetCamera(): void {
    const distance = 3.4 * this.data.size_m + (this.layers.follow ? 0 : 1.2 * this.reach);
    const target = this.layers.follow ? this.base.clone() : this.centre.clone();
    this.controls.target.copy(target.setZ(target.z - 0.25 * this.data.size_m));
    this.camera.position
      .copy(this.controls.target)
      .add(new Vector3(0.78, -1, 0.42).normalize().multiplyScalar(distance));
    this.controls.update();
    this.ask();
  }
  setLayer(name: keyof Layers, on: boolean): void {
    this.layers[name] = on;
    this.ask();
  }
  /// Draws in the next frame.
  ask(): void {
    this.update();
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      // The ground ends in haze, wherever it is looked at from.
      const distance = this.camera.position.distanceTo(this.controls.target);
      if (this.scene.fog instanceof Fog)
        [this.scene.fog.near, this.scene.fog.far] = [1.3 * distance, 2.8 * distance + this.reach];
      this.renderer.render(this.scene, this.camera);
    });
  }

  private drawTrails(): void {
    this.trails.clear();
    this.trails.add(this.plan.path(0, new Vector3()));
    for (const contact of this.data.scene.contacts)
      this.trails.add(this.plan.path(contact.body, new Vector3(...contact.point)));
  }
  private reach = 0;
  /// Sets the middle of the base's path; returns how far it is from it at most [m].
  private measure(path: Vector3[]): number {
    const low = path[0].clone();
    const high = path[0].clone();
    for (const point of path) {
      low.min(point);
      high.max(point);
    }
    this.centre.addVectors(low, high).multiplyScalar(0.5);
    this.reach = 0.5 * low.distanceTo(high);
    return this.reach;
  }
  private setUpShadow(size: number): void {
    this.sun.castShadow = true;
    this.sun.shadow.mapSize.set(1024, 1024);
    this.sun.shadow.intensity = 0.55;
    this.sun.shadow.bias = -0.0005;
    this.sun.shadow.normalBias = 0.004;
    const box = this.sun.shadow.camera;
    [box.left, box.right, box.bottom, box.top] = [-2 * size, 2 * size, -2 * size, 2 * size];
    [box.near, box.far] = [0.1, 12 * size];
  }
  private update(): void {
    const t = this.clock.time;
    this.robot.show(this.plan, t);
    const before = this.base.clone();
    this.base.copy(this.robot.bodies[0].position);
    if (this.layers.follow && before.lengthSq() > 0) {
      const moved = this.base.clone().sub(before);
      this.controls?.target.add(moved);
      this.camera.position.add(moved);
    }
    this.sun.target.position.copy(this.base);
    this.sun.position.copy(this.base).add(new Vector3(-1.2, -1.6, 4).multiplyScalar(this.data.size_m));
    if (this.ghost && this.simulation) {
      this.ghost.group.visible = this.layers.ghost;
      this.ghost.show(this.simulation, t);
    }
    this.trails.group.visible = this.layers.trails;
    this.forces.arrows.visible = this.layers.forces;
    this.forces.cones.visible = this.layers.cones;
    this.forces.show(this.plan, t, phaseAt(this.data.phases, t), (contact) => this.contactPoint(contact));
  }
  private resize(): void {
    const { clientWidth, clientHeight } = this.container;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    // What is in sight is set by the shorter side.
    this.camera.fov =
      this.camera.aspect >= 1
        ? 35
        : Math.min(60, (2 * Math.atan(Math.tan((17.5 * Math.PI) / 180) / this.camera.aspect) * 180) / Math.PI);
    this.camera.updateProjectionMatrix();
    this.ask();
  }
}
