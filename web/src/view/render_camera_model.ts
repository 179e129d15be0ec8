// SPDX-License-Identifier: Apache-2.0
// Draws the render camera of a frame: the lens with its blades, the viewing frustum up to the focus plane, the focus
// plane, the widened frustum, and the nearest and farthest depth of the scene. The widened frustum consists of rays
// from the rim of the lens through the corners of the focus plane.

import * as THREE from "three";

import { add, elementDirection, focusPoint, lensRim, type FrameCamera } from "../data/frame_camera";
import type { DensityFacts, Vec3 } from "../data/scene";
import { closed, Faces, Lines } from "./lines";

const GRID = 6; // number of cells along the width of the focus plane
const BEHIND = 0.35; // approximate length of the widened frustum's rays behind the lens, in focus distances
const BEYOND = 1.5; // approximate length of these rays in front of the lens, in focus distances

export class RenderCameraModel {
  readonly object = new THREE.Group();
  readonly widened = new THREE.Group();
  readonly depths = new THREE.Group();
  private readonly lensFace = new Faces(0.28);
  private readonly lensLines = new Lines(1);
  private readonly frustum = new Lines(0.9);
  private readonly focusFace = new Faces(0.13);
  private readonly focusLines = new Lines(0.5);
  private readonly widenedLines = new Lines(0.22);
  private readonly depthLines = [new Lines(0.9), new Lines(0.9)];
  private readonly depthFaces = [new Faces(0.08), new Faces(0.08)];

  constructor(private readonly origin: Vec3) {
    this.widened.add(this.widenedLines.object);
    for (const part of [...this.depthLines, ...this.depthFaces]) this.depths.add(part.object);
    for (const part of [this.focusFace, this.focusLines, this.frustum, this.lensFace, this.lensLines])
      this.object.add(part.object);
    this.object.add(this.widened, this.depths);
  }

  setTheme(isDark: boolean): void {
    const lens = isDark ? 0x7fe3ff : 0x006f94;
    const frame = isDark ? 0xe8ecf4 : 0x30343c;
    const focus = isDark ? 0x63d68a : 0x0a7f3a;
    this.lensFace.material.color.setHex(lens);
    this.lensLines.material.color.setHex(lens);
    this.frustum.material.color.setHex(frame);
    this.focusFace.material.color.setHex(focus);
    this.focusLines.material.color.setHex(focus);
    this.widenedLines.material.color.setHex(lens);
  }

  set(camera: FrameCamera, smallest: number): void {
    const { origin } = this;
    // A pinhole is drawn as a lens with a small radius.
    const rim = lensRim(camera.radius > 0 ? camera : { ...camera, radius: smallest });
    this.lensFace.setPolygon(rim, origin);
    this.lensLines.set(closed(rim), origin);

    const { width, height } = camera;
    const corners = (
      [
        [0, 0],
        [width, 0],
        [width, height],
        [0, height],
      ] as const
    ).map(([x, y]) => focusPoint(camera, x, y));
    const axis = focusPoint(camera, camera.cx, camera.cy);
    this.frustum.set(
      [
        ...corners.flatMap((corner) => [camera.centre, corner]),
        ...closed(corners),
        // A triangle that marks the upper side of the frame.
        ...closed([
          focusPoint(camera, width * 0.46, 0),
          focusPoint(camera, width * 0.54, 0),
          add(focusPoint(camera, width * 0.5, 0), camera.up, 0.045 * camera.focusDistance),
        ]),
      ],
      origin,
    );
    this.focusFace.setPolygon(corners, origin);
    const lines: Vec3[] = [camera.centre, axis];
    for (let i = 1; i < GRID; ++i) {
      lines.push(focusPoint(camera, (width * i) / GRID, 0));
      lines.push(focusPoint(camera, (width * i) / GRID, height));
    }
    const rows = Math.max(2, Math.round((GRID * height) / width));
    for (let i = 1; i < rows; ++i) {
      lines.push(focusPoint(camera, 0, (height * i) / rows));
      lines.push(focusPoint(camera, width, (height * i) / rows));
    }
    this.focusLines.set(lines, origin);

    const few = lensRim({ ...camera, radius: Math.max(camera.radius, smallest) }, 12);
    const rays: Vec3[] = [];
    for (const point of few)
      for (const corner of corners) {
        const along = add(corner, point, -1);
        rays.push(add(point, along, -BEHIND), add(point, along, BEYOND));
      }
    this.widenedLines.set(rays, origin);
  }

  // Shows or hides everything but the lens: the frustum, the focus plane, the widened frustum and the depths.
  showFocus(isShown: boolean): void {
    for (const part of [this.focusFace, this.focusLines, this.frustum]) part.object.visible = isShown;
    this.widened.visible = isShown;
    for (const part of [...this.depthLines, ...this.depthFaces]) part.object.visible = isShown;
  }

  // Draws a plane at the nearest depth of the scene and one at the farthest, but at most four focus distances away.
  // Their colour shows the displacement of points at the nearest and the farthest depth between neighbouring LF
  // cameras: green up to 1.5 elements, yellow up to 4, red above or if unknown. null hides the planes.
  setDensity(camera: FrameCamera, density: DensityFacts | null): void {
    this.depths.visible = density !== null;
    if (!density) return;
    const far = Math.min(density.depths[1] ?? Infinity, 4 * camera.focusDistance);
    const ends: [number, number | null][] = [
      [density.depths[0], density.near_displacement_px],
      [far, density.far_displacement_px],
    ];
    ends.forEach(([depth, displacement], i) => {
      const corners = (
        [
          [0, 0],
          [camera.width, 0],
          [camera.width, camera.height],
          [0, camera.height],
        ] as const
      ).map(([x, y]) => add(camera.centre, elementDirection(camera, x, y), depth));
      const colour = displacementColour(displacement ?? Infinity);
      this.depthLines[i].set(closed(corners), this.origin);
      this.depthLines[i].material.color.set(colour);
      this.depthFaces[i].setPolygon(corners, this.origin);
      this.depthFaces[i].material.color.set(colour);
    });
  }
}

export function displacementColour(pixels: number): string {
  return pixels <= 1.5 ? "#4fbf6b" : pixels <= 4 ? "#e0a526" : "#e0524a";
}
