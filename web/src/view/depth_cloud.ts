// SPDX-License-Identifier: Apache-2.0
// Draws the points of a depth file: squares that about touch each other, so that they look like a surface.

import * as THREE from "three";

import { depthRange, type DepthPoints } from "../data/depth_points";
import type { DepthFacts, Vec3 } from "../data/scene";

const VERTEX = `
attribute vec4 tint;
uniform float least;
uniform float byDepth;
uniform vec3 eye;
uniform vec3 axis;
uniform float inverseNear;
uniform float inverseFar;
uniform vec3 centre;
uniform float spread;
uniform float pixels;
uniform float pixelRatio;
uniform float size;
varying vec3 colour;
void main() {
  vec4 seen = modelViewMatrix * vec4(position, 1.0);
  gl_Position = projectionMatrix * seen;
  float wide = 1.3 * spread * distance(position, centre);
  gl_PointSize = clamp(size * wide * pixels / max(-seen.z, 1e-9), pixelRatio, 24.0 * pixelRatio);
  if (tint.a < least) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
  // From far (dark blue) over green to near (light yellow).
  float near = clamp((1.0 / max(dot(axis, position - eye), 1e-9) - inverseFar) / (inverseNear - inverseFar), 0.0, 1.0);
  vec3 farther = mix(vec3(0.16, 0.13, 0.45), vec3(0.13, 0.58, 0.55), near * 2.0);
  vec3 nearer = mix(vec3(0.13, 0.58, 0.55), vec3(0.99, 0.90, 0.25), near * 2.0 - 1.0);
  colour = byDepth > 0.5 ? (near < 0.5 ? farther : nearer) : tint.rgb;
}`;

const FRAGMENT = `
varying vec3 colour;
void main() {
  gl_FragColor = vec4(colour, 1.0);
}`;

export interface DepthStyle {
  least: number; // least confidence of the points that are drawn, 0 to 1
  byDepth: boolean; // true: colours tell the distance; false: they are those of the picture
  size: number; // factor of the size of points
}

export interface PickedPoint {
  place: Vec3; // relative to the origin of the scene
  ahead: number; // distance from the viewer, along the direction of the view
}

export class DepthCloud {
  readonly object: THREE.Points;
  private least = 0; // of 255

  constructor(
    readonly facts: DepthFacts,
    private readonly points: DepthPoints,
  ) {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(points.places, 3));
    geometry.setAttribute("tint", new THREE.BufferAttribute(points.tints, 4, true));
    const uniform = (value: unknown) => ({ value });
    const material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        least: uniform(0),
        byDepth: uniform(0),
        eye: uniform(new THREE.Vector3()),
        axis: uniform(new THREE.Vector3(0, 0, 1)),
        inverseNear: uniform(1),
        inverseFar: uniform(0),
        centre: uniform(new THREE.Vector3(...(facts.centre ?? [0, 0, 0]))),
        spread: uniform(facts.spread),
        pixels: uniform(1),
        pixelRatio: uniform(1),
        size: uniform(1),
      },
    });
    this.object = new THREE.Points(geometry, material);
    this.object.frustumCulled = false;
  }

  private get uniforms(): Record<string, THREE.IUniform> {
    return (this.object.material as THREE.ShaderMaterial).uniforms;
  }

  setStyle(style: DepthStyle): void {
    this.least = Math.round(255 * style.least);
    this.uniforms.least.value = (this.least - 0.5) / 255;
    this.uniforms.byDepth.value = style.byDepth ? 1 : 0;
    this.uniforms.size.value = style.size;
  }

  // Sets the render camera from which distances are measured.
  //   eye  its centre, relative to the origin of the scene
  setCamera(eye: Vec3, forward: Vec3): void {
    const [near, far] = depthRange(this.points.places, eye, forward);
    (this.uniforms.eye.value as THREE.Vector3).set(...eye);
    (this.uniforms.axis.value as THREE.Vector3).set(...forward);
    this.uniforms.inverseNear.value = 1 / near;
    this.uniforms.inverseFar.value = 1 / far;
    // Points of an unknown camera are as large as if the render camera saw them.
    if (!this.facts.centre) (this.uniforms.centre.value as THREE.Vector3).set(...eye);
  }

  //   pixels  size on the screen, in its pixels, of a length at the same distance
  setScale(pixels: number, ratio: number): void {
    this.uniforms.pixels.value = pixels;
    this.uniforms.pixelRatio.value = ratio;
  }

  // Returns the number of points that are sure enough to be drawn.
  shownCount(): number {
    if (this.least === 0) return this.facts.points;
    let count = 0;
    for (let i = 3; i < this.points.tints.length; i += 4) if (this.points.tints[i] >= this.least) ++count;
    return count;
  }

  // Returns the foremost of the drawn points near a position in the view; null if there is none.
  pick(camera: THREE.Camera, width: number, height: number, x: number, y: number): PickedPoint | null {
    if (!this.object.visible) return null;
    const reach = 5;
    const m = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
    const { places, tints } = this.points;
    let best = -1;
    let ahead = Infinity;
    for (let i = 0; 3 * i < places.length; ++i) {
      const [px, py, pz] = [places[3 * i], places[3 * i + 1], places[3 * i + 2]];
      const w = m[3] * px + m[7] * py + m[11] * pz + m[15];
      if (w <= 0 || w >= ahead || tints[4 * i + 3] < this.least) continue;
      const dx = (0.5 + (0.5 * (m[0] * px + m[4] * py + m[8] * pz + m[12])) / w) * width - x;
      const dy = (0.5 - (0.5 * (m[1] * px + m[5] * py + m[9] * pz + m[13])) / w) * height - y;
      if (dx * dx + dy * dy > reach * reach) continue;
      best = i;
      ahead = w;
    }
    return best < 0 ? null : { place: [...places.subarray(3 * best, 3 * best + 3)] as Vec3, ahead };
  }
}
