// SPDX-License-Identifier: Apache-2.0

/** Values of a grid, the last index of the shape fastest. */
export interface NamedArray {
  data: Uint8Array | Int8Array | Uint16Array | Int16Array | Uint32Array | Int32Array |
    Float32Array | Float64Array;
  /** Along z, y and x. */
  shape: [number, number, number];
}

export interface RenderOptions {
  /** Pixels; the scene's unless given. */
  width?: number;
  height?: number;
  /** Largest error of a pixel, in each channel; the scene's unless given. */
  tolerance?: number;
}

export interface Picture {
  width: number;
  height: number;
  /** Premultiplied linear R, G, B and A of each pixel, row by row from the top. */
  rgba: Float32Array;
  /** Largest error of each pixel; null if the scene's method does not know it. */
  error: Float32Array | null;
  largestError: number;
  /** Pixels whose error may be above the tolerance. */
  pixelsOver: number;
  seconds: number;
  /** The camera, as in a scene. */
  camera: object;
}

export class Pellucid {
  /**
   * Renders a scene: an object as docs/reference/scene.md describes it, whose files are the names
   * of `arrays`, such as {"field": {"file": "head", "spacing": [1, 1, 2]}}. Files of other formats
   * may be given as bytes (Uint8Array): "head.nii". Throws Error with one line that says what to
   * do.
   */
  render(scene: object, arrays?: Record<string, NamedArray | Uint8Array>,
    options?: RenderOptions): Picture;
}

/**
 * Loads the renderer, which is one file of WebAssembly beside this one. `module`: its bytes, where
 * they are at hand. Throws Error where the browser lacks SIMD or exceptions of WebAssembly.
 */
export function load(module?: Uint8Array | ArrayBuffer): Promise<Pellucid>;
