// SPDX-License-Identifier: Apache-2.0
// Draws LF cameras as points; one draw call draws a million. When the frame changes, only two bytes per LF camera
// change: its use, and the share of its pixels that are read.

import * as THREE from "three";

import { IN_OTHER_FRAME, USED, type FrameUse } from "../data/frame_use";
import { USE_STYLES } from "./palette";

const VERTEX = `
attribute float use;
attribute float share;
attribute float isVirtual;
uniform float showsVirtual;
uniform vec3 colours[${USE_STYLES.length}];
uniform float sizes[${USE_STYLES.length}];
uniform float shown[${USE_STYLES.length}];
uniform float pixelRatio;
uniform float room;
varying vec3 colour;
varying float isHollow;
void main() {
  int kind = int(use + 0.5);
  colour = colours[kind];
  isHollow = isVirtual;
  if (kind == ${USED}) colour *= 0.55 + 0.45 * share;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  // Used cameras are drawn in front of the others at any position.
  if (kind == ${USED}) gl_Position.z -= 1e-4 * gl_Position.w;
  gl_PointSize = max(1.0, sizes[kind] * room * pixelRatio);
  if (shown[kind] < 0.5 || isVirtual * (1.0 - showsVirtual) > 0.5) gl_Position = vec4(2.0, 2.0, 2.0, 1.0);
}`;

const FRAGMENT = `
varying vec3 colour;
varying float isHollow;
void main() {
  vec2 place = gl_PointCoord - 0.5;
  float square = dot(place, place);
  // A virtual LF camera is a ring, a recorded one is a disk.
  if (square > 0.25 || isHollow * 0.08 > square) discard;
  gl_FragColor = vec4(colour, 1.0);
}`;

export class LfPoints {
  readonly object: THREE.Points;
  readonly positions: Float32Array;
  private readonly use: THREE.BufferAttribute;
  private readonly share: THREE.BufferAttribute;
  private readonly isVirtual: Uint8Array; // 1 for virtual LF cameras, 0 for recorded ones
  private readonly material: THREE.ShaderMaterial;

  //   virtualRanges  ids of virtual LF cameras, as [begin, end]
  constructor(positions: Float32Array, virtualRanges: [number, number][]) {
    this.positions = positions;
    const count = positions.length / 3;
    this.isVirtual = new Uint8Array(count);
    for (const [begin, end] of virtualRanges) this.isVirtual.fill(1, begin, end);
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    this.use = new THREE.BufferAttribute(new Uint8Array(count).fill(1), 1);
    this.share = new THREE.BufferAttribute(new Uint8Array(count), 1, true);
    this.use.setUsage(THREE.DynamicDrawUsage);
    this.share.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute("use", this.use);
    geometry.setAttribute("share", this.share);
    geometry.setAttribute("isVirtual", new THREE.BufferAttribute(this.isVirtual, 1));
    this.material = new THREE.ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: {
        colours: { value: USE_STYLES.map(() => new THREE.Vector3()) },
        sizes: { value: USE_STYLES.map((style) => style.size) },
        shown: { value: USE_STYLES.map(() => 1) },
        pixelRatio: { value: 1 },
        room: { value: 1 },
        showsVirtual: { value: 1 },
      },
    });
    this.object = new THREE.Points(geometry, this.material);
  }

  setTheme(isDark: boolean): void {
    USE_STYLES.forEach((style, i) => {
      const [r, g, b] = isDark ? style.dark : style.light;
      (this.material.uniforms.colours.value as THREE.Vector3[])[i].set(r / 255, g / 255, b / 255);
    });
  }

  setPixelRatio(ratio: number): void {
    this.material.uniforms.pixelRatio.value = ratio;
  }

  // Sets the size of the points by `spacing`, the approximate distance between neighbouring points on the screen in CSS
  // pixels. A point fills only a part of this distance, so that single points can be seen and clicked.
  setSpacing(spacing: number): void {
    this.material.uniforms.room.value = Math.max(0.3, Math.min(2.6, (0.62 * spacing) / 6));
  }

  show(kind: number, isShown: boolean): void {
    (this.material.uniforms.shown.value as number[])[kind] = isShown ? 1 : 0;
  }
  showVirtual(isShown: boolean): void {
    this.material.uniforms.showsVirtual.value = isShown ? 1 : 0;
  }
  private isShown(id: number): boolean {
    if (this.isVirtual[id] && this.material.uniforms.showsVirtual.value === 0) return false;
    return (this.material.uniforms.shown.value as number[])[this.kindOf(id)] === 1;
  }

  // Sets the use of all LF cameras in a frame.
  //   framesOfCamera  number of frames of the film that use each LF camera; null: not known yet
  setUse(use: FrameUse, framesOfCamera: Uint16Array | null): void {
    const kinds = this.use.array as Uint8Array;
    kinds.set(use.ofCameras);
    if (framesOfCamera)
      for (let i = 0; i < kinds.length; ++i) if (kinds[i] !== USED && framesOfCamera[i] > 0) kinds[i] = IN_OTHER_FRAME;
    const shares = this.share.array as Uint8Array;
    for (let i = 0; i < use.ids.length; ++i) shares[use.ids[i]] = Math.round(255 * Math.min(1, use.shares[i]));
    this.use.needsUpdate = true;
    this.share.needsUpdate = true;
  }

  kindOf(id: number): number {
    return (this.use.array as Uint8Array)[id];
  }

  // Returns the LF camera whose point is nearest to a position in the view, among those that are shown; null if none is
  // within `reach` pixels. A used LF camera is preferred to others that are slightly nearer.
  pick(camera: THREE.Camera, width: number, height: number, x: number, y: number, reach = 12): number | null {
    const m = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse).elements;
    const kinds = this.use.array as Uint8Array;
    let best: number | null = null;
    let bestScore = reach * reach;
    for (let i = 0; i < kinds.length; ++i) {
      if (!this.isShown(i)) continue;
      const px = this.positions[3 * i];
      const py = this.positions[3 * i + 1];
      const pz = this.positions[3 * i + 2];
      const w = m[3] * px + m[7] * py + m[11] * pz + m[15];
      if (w <= 0) continue;
      const sx = (0.5 + (0.5 * (m[0] * px + m[4] * py + m[8] * pz + m[12])) / w) * width;
      const sy = (0.5 - (0.5 * (m[1] * px + m[5] * py + m[9] * pz + m[13])) / w) * height;
      const dx = sx - x;
      const dy = sy - y;
      const score = dx * dx + dy * dy + (kinds[i] === USED ? 0 : 16);
      if (score < bestScore) {
        bestScore = score;
        best = i;
      }
    }
    return best;
  }
}
