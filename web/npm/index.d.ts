import type { Camera, Scene } from "three";
import type { PassNode, PassNodeOptions, WebGPURenderer } from "three/webgpu";

/**
 * Options of {@link nmtPass}; those of a three.js pass, without `samples`, since sums cannot be multisampled, and
 * `depthBuffer`, since transparent objects are tested against opaque ones.
 */
export interface NMTPassOptions extends Omit<PassNodeOptions, "samples" | "depthBuffer"> {
  /**
   * A shipped network, or the WGSL that `nmt export MODEL.json --format wgsl` writes of a network of four or six
   * moments, or `MODEL.chain.wgsl`, which it writes of one with ends or a core. Default: `"recommended"`.
   */
  network?: "recommended" | "small" | "moments-6" | "ends" | "core-small" | "core" | "core-large" | { wgsl: string };
  /**
   * Least and greatest distance along the view direction of anything transparent, in scene units. By default it is
   * found every frame from the bounding spheres of transparent objects. Any range that holds all is right, a tight one
   * is best.
   */
  range?: [number, number] | null;
}

/** A render pass that draws transparent objects in any order. */
export class NMTPassNode extends PassNode {
  constructor(scene: Scene, camera: Camera, options?: NMTPassOptions);
  readonly isNMTPassNode: true;
  /** See {@link NMTPassOptions.range}; may be set at any time. */
  range: [number, number] | null;
}

/** The node of a pass that draws `scene` seen by `camera`, transparent objects in any order. */
export function nmtPass(scene: Scene, camera: Camera, options?: NMTPassOptions): NMTPassNode;

/** Why a renderer cannot run the pass, in words; `null` where it can. Call it after `await renderer.init()`. */
export function whyUnsupported(renderer: WebGPURenderer): string | null;
