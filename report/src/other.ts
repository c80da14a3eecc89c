import type { Material } from "three";
import type { OtherPlan, Phase, Scene, ViewData } from "./data";
import { Forces } from "./forces";
import type { Layers } from "./view";
import { Motion } from "./motion";
import { heldAt } from "./phases";
import { contactPoint, Robot, Shapes } from "./robot";

/// The plan to compare with, as it is drawn.
export class OtherRobot {
  readonly scene: Scene;
  readonly motion: Motion;
  readonly robot: Robot;
  readonly forces: Forces; // on the scale of the first plan's
  private readonly phases: Phase[];

  constructor(other: OtherPlan, data: ViewData, shapes: Shapes, material: Material) {
    this.scene = other.scene ?? data.scene;
    this.motion = new Motion(other.plan, this.scene.bodies.length, this.scene.contacts.length);
    this.robot = new Robot(this.scene, other.scene ? new Shapes(other.scene) : shapes, material);
    this.forces = new Forces(this.scene, data.size_m, data.weight_N);
    this.phases = other.phases;
  }
  show(t: number, layers: Layers): void {
    this.robot.group.visible = layers.other;
    this.robot.show(this.motion, t);
    this.forces.arrows.visible = layers.forces && layers.other;
    this.forces.show(this.motion, t, heldAt(this.phases, this.scene.surfaces, t), (c) =>
      contactPoint(this.scene, this.robot, c),
    );
  }
}
