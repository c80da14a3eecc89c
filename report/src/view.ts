import {
  Box3,
  BoxHelper,
  Color,
  DirectionalLight,
  Fog,
  Group,
  HemisphereLight,
  PCFShadowMap,
  PerspectiveCamera,
  Raycaster,
  Scene as ThreeScene,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { Balance, type Support } from "./balance";
import type { Clock } from "./clock";
import type { Surface, ViewData } from "./data";
import { colour } from "./dom";
import { type DrawnForce, Forces, Trails } from "./forces";
import { Ground } from "./ground";
import { Motion } from "./motion";
import { OtherRobot } from "./other";
import { heldAt } from "./phases";
import { contactPoint, ghostMaterial, placementOf, Robot, Shapes } from "./robot";
import { cornersOf, Sight } from "./sight";

export interface Layers {
  forces: boolean;
  cones: boolean;
  ghost: boolean;
  other: boolean;
  trails: boolean;
  mass: boolean;
  support: boolean;
  zmp: boolean;
  follow: boolean;
}

const kFramed = 40; // number of moments for fitting the first view
const kToolbar = 50; // height of the switches above the view [px]

/// 3D view of the robot.
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
  private readonly ghostMaterial = ghostMaterial();
  private readonly other: OtherRobot | null = null;
  private readonly otherMaterial = ghostMaterial();
  private readonly ground: Ground;
  private readonly forces: Forces;
  private readonly simulatedForces: Forces | null = null;
  private readonly balance: Balance;
  private readonly sight: Sight;
  private readonly mark: BoxHelper;
  private isMoved = false; // by the reader: then resizing keeps the camera
  private readonly trails = new Trails();
  private readonly sun = new DirectionalLight(0xffffff, 2.2);
  private readonly centre = new Vector3();
  private readonly base = new Vector3();
  private waiting = false;

  /// Throws if the browser has no WebGL.
  constructor(
    private readonly container: HTMLElement,
    private readonly data: ViewData,
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
    if (this.simulation) {
      this.ghost = new Robot(data.scene, shapes, this.ghostMaterial);
      this.simulatedForces = new Forces(data.scene, data.size_m, data.weight_N, true);
    }
    if (data.other) this.other = new OtherRobot(data.other, data, shapes, this.otherMaterial);
    const reach = this.measure(this.plan.path(0, new Vector3()));
    this.layers = {
      forces: true,
      cones: true,
      ghost: true,
      other: true,
      trails: true,
      mass: false,
      support: false,
      zmp: false,
      follow: false,
    };
    this.ground = new Ground(data.scene.surfaces, this.centre, reach + 6 * data.size_m);
    this.forces = new Forces(data.scene, data.size_m, data.weight_N);
    this.balance = new Balance(data.size_m);
    this.mark = new BoxHelper(this.robot.group);
    this.mark.visible = false;
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
      this.balance.massCentre,
      this.balance.polygon,
      this.balance.zmp,
      this.mark,
    );
    if (this.ghost) this.scene.add(this.ghost.group);
    if (this.simulatedForces) this.scene.add(this.simulatedForces.arrows);
    if (this.other) this.scene.add(this.other.robot.group, this.other.forces.arrows);

    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, this.renderer.domElement);
    this.sight = new Sight(this.camera, this.controls);
    this.controls.addEventListener("change", () => this.ask());
    this.controls.addEventListener("start", () => {
      this.isMoved = true;
      this.sight.stop();
    });
    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
    this.resetCamera();
    this.setTheme();
    clock.onChange(() => this.ask());
    // Immediately: other work at start-up may delay frames.
    this.render();
    performance.mark("prowl-first-picture");
  }

  get canvas(): HTMLCanvasElement {
    return this.renderer.domElement;
  }
  /// Position and target of the camera; for links.
  get cameraPose(): number[] {
    return [...this.camera.position.toArray(), ...this.controls.target.toArray()];
  }
  set cameraPose(six: number[]) {
    this.isMoved = true;
    this.camera.position.fromArray(six, 0);
    this.controls.target.fromArray(six, 3);
    this.controls.update();
    this.ask();
  }
  get hasOwnCamera(): boolean {
    return this.isMoved;
  }
  /// Extent of the robot in the picture, from -1 to 1, right and up.
  screenBox(): { left: number; right: number; bottom: number; top: number } {
    this.robot.group.updateMatrixWorld(true);
    this.camera.updateMatrixWorld(true);
    const seen = cornersOf(new Box3().setFromObject(this.robot.group)).map((corner) => corner.project(this.camera));
    const [x, y] = [seen.map((point) => point.x), seen.map((point) => point.y)];
    return { left: Math.min(...x), right: Math.max(...x), bottom: Math.min(...y), top: Math.max(...y) };
  }
  /// Position of a world point in the window [px].
  screenPoint(point: Vector3): { x: number; y: number } {
    this.camera.updateMatrixWorld(true);
    const { x, y } = point.clone().project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + (0.5 + 0.5 * x) * box.width, y: box.top + (0.5 - 0.5 * y) * box.height };
  }

  /// Current placement of a body in the scene: x y z, quaternion x y z w.
  bodyPlacement(name: string, ghost = false): number[] {
    return placementOf(ghost ? this.ghost : this.robot, name);
  }
  /// The same for the other plan.
  otherPlacement(name: string): number[] {
    return placementOf(this.other?.robot, name);
  }
  /// Current position of a contact in the scene.
  contactPoint(contact: number, robot = this.robot): Vector3 {
    return contactPoint(this.data.scene, robot, contact);
  }

  /// Arrows and cones of the contacts, as drawn.
  arrows(): DrawnForce[] {
    return this.forces.drawn();
  }
  otherArrows(): DrawnForce[] {
    return this.other?.forces.drawn() ?? [];
  }
  simulatedArrows(): DrawnForce[] {
    return this.simulatedForces?.drawn() ?? [];
  }
  /// Centre of mass, corners of the support polygon, zero-moment point or null, as drawn.
  balanceNow(): { mass: number[]; corners: number[][]; zmp: number[] | null } {
    const centre = new Vector3();
    this.plan.massCentre(this.clock.time, centre);
    return {
      mass: centre.toArray(),
      corners: this.balance.corners.map((corner) => corner.toArray()),
      zmp: this.balance.zmp.visible ? this.balance.zmp.position.toArray() : null,
    };
  }
  /// Body of the robot at a point of the window [px], and the point hit; null without one.
  bodyAt(x: number, y: number): { body: number; point: Vector3 } | null {
    const box = this.canvas.getBoundingClientRect();
    const at = new Vector2((2 * (x - box.left)) / box.width - 1, 1 - (2 * (y - box.top)) / box.height);
    const ray = new Raycaster();
    this.robot.group.updateMatrixWorld(true);
    this.camera.updateMatrixWorld(true);
    ray.setFromCamera(at, this.camera);
    const hit = ray.intersectObject(this.robot.group, true)[0];
    if (!hit) return null;
    return { body: this.robot.bodies.findIndex((group) => group === hit.object.parent), point: hit.point };
  }
  /// Outlines a body; null for none.
  markBody(body: number | null): void {
    this.mark.visible = body !== null;
    if (body !== null) this.mark.setFromObject(this.robot.bodies[body]);
    this.ask();
  }

  /// Shows the motion of the current data.
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
    this.otherMaterial.color.set(colour("second"));
    this.other?.forces.setColours(new Color(colour("second")), new Color(colour("cone")));
    this.simulatedForces?.setColours(new Color(colour("simulation")), new Color(colour("cone")));
    this.balance.setColours(new Color(colour("mass")), new Color(colour("support")), new Color(colour("zmp")));
    this.mark.material.color.set(colour("head"));
    this.ask();
  }
  /// Frames the whole motion; only the robot if the camera follows it.
  resetCamera(): void {
    this.isMoved = false;
    this.update();
    const boxes = this.layers.follow ? [new Box3().setFromObject(this.robot.group)] : this.motionBoxes();
    this.sight.frame(boxes, kToolbar / Math.max(this.container.clientHeight, 1));
    this.ask();
  }
  setLayer(name: keyof Layers, on: boolean): void {
    this.layers[name] = on;
    if (name === "follow") {
      this.isMoved = true;
      if (on) this.sight.glideTo(3.4 * this.data.size_m);
      else this.sight.stop();
    }
    this.ask();
  }
  /// Draws in the next frame.
  ask(): void {
    this.update();
    if (this.waiting) return;
    this.waiting = true;
    requestAnimationFrame(() => {
      this.waiting = false;
      if (this.sight.gliding) this.ask();
      this.render();
    });
  }

  private render(): void {
    // Fades the ground into fog from every viewpoint.
    const distance = this.camera.position.distanceTo(this.controls.target);
    if (this.scene.fog instanceof Fog)
      [this.scene.fog.near, this.scene.fog.far] = [1.3 * distance, 2.8 * distance + this.reach];
    this.renderer.render(this.scene, this.camera);
  }
  /// Boxes around the robot at moments throughout the motion.
  private motionBoxes(): Box3[] {
    const boxes = Array.from({ length: kFramed }, (_, i) => {
      this.robot.show(this.plan, (i / (kFramed - 1)) * this.plan.end);
      return new Box3().setFromObject(this.robot.group);
    });
    this.robot.show(this.plan, this.clock.time);
    return boxes;
  }
  private drawTrails(): void {
    this.trails.clear();
    this.trails.add(this.plan.path(0, new Vector3()));
    for (const contact of this.data.scene.contacts)
      this.trails.add(this.plan.path(contact.body, new Vector3(...contact.point)));
  }
  private reach = 0;
  /// Sets the centre of the base path; returns the radius of its bounding box [m].
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
    if (this.layers.follow) this.ground.follow(this.base);
    if (this.layers.follow && !this.sight.step(this.base) && before.lengthSq() > 0)
      this.sight.move(this.base.clone().sub(before));
    this.sun.target.position.copy(this.base);
    this.sun.position.copy(this.base).add(new Vector3(-1.2, -1.6, 4).multiplyScalar(this.data.size_m));
    if (this.mark.visible) this.mark.update();
    this.trails.group.visible = this.layers.trails;
    this.showForces(t);
    this.other?.show(t, this.layers);
  }
  private showForces(t: number): void {
    const { surfaces } = this.data.scene;
    const held = heldAt(this.data.phases, surfaces, t);
    this.forces.arrows.visible = this.layers.forces;
    this.forces.cones.visible = this.layers.cones;
    this.forces.show(this.plan, t, held, (c) => this.contactPoint(c));
    if (this.ghost && this.simulation && this.simulatedForces) {
      const ghost = this.ghost;
      ghost.group.visible = this.layers.ghost;
      ghost.show(this.simulation, t);
      this.simulatedForces.arrows.visible = this.layers.forces && this.layers.ghost;
      // A simulated contact may push at any time: use the surface of the plan, or the first
      // surface.
      this.simulatedForces.show(
        this.simulation,
        t,
        (c) => held(c) ?? surfaces[0],
        (c) => this.contactPoint(c, ghost),
      );
    }
    const { mass, support, zmp } = this.layers;
    if (mass || support || zmp) this.showBalance(t, held);
    this.balance.massCentre.visible = mass;
    this.balance.polygon.visible &&= support;
    this.balance.zmp.visible &&= zmp;
  }
  private showBalance(t: number, held: (contact: number) => Surface | undefined): void {
    const supports = this.data.scene.contacts.flatMap((contact, c): Support[] => {
      const surface = held(c);
      if (!surface) return [];
      const normal = new Vector3(...surface.normal);
      const force = new Vector3();
      this.plan.force(t, c, force);
      return [{ point: this.contactPoint(c).addScaledVector(normal, -contact.radius), normal, force }];
    });
    const centre = new Vector3();
    this.plan.massCentre(t, centre);
    this.balance.show(centre, supports, this.data.weight_N);
  }
  private resize(): void {
    const { clientWidth, clientHeight } = this.container;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.setSize(clientWidth, clientHeight);
    this.camera.aspect = clientWidth / clientHeight;
    // The shorter side determines the field of view.
    this.camera.fov =
      this.camera.aspect >= 1
        ? 35
        : Math.min(60, (2 * Math.atan(Math.tan((17.5 * Math.PI) / 180) / this.camera.aspect) * 180) / Math.PI);
    this.camera.updateProjectionMatrix();
    if (this.isMoved || this.layers.follow) this.ask();
    else this.resetCamera();
  }
}
