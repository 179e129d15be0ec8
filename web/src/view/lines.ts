// SPDX-License-Identifier: Apache-2.0
// Lines and faces whose points change often. New points are written into the memory of the old ones, if that is large
// enough.

import * as THREE from "three";

import type { Vec3 } from "../data/scene";

export class Lines {
  readonly object: THREE.LineSegments;
  private readonly geometry = new THREE.BufferGeometry();
  readonly material: THREE.LineBasicMaterial;

  constructor(opacity: number) {
    this.material = new THREE.LineBasicMaterial({
      transparent: opacity < 1,
      opacity,
      depthWrite: opacity >= 1,
    });
    this.object = new THREE.LineSegments(this.geometry, this.material);
    this.object.frustumCulled = false;
  }

  set(points: Vec3[], origin: Vec3): void {
    setPoints(this.geometry, points, origin);
  }
}

export class Faces {
  readonly object: THREE.Mesh;
  private readonly geometry = new THREE.BufferGeometry();
  readonly material: THREE.MeshBasicMaterial;

  constructor(opacity: number) {
    this.material = new THREE.MeshBasicMaterial({
      transparent: true,
      opacity,
      side: THREE.DoubleSide,
      depthWrite: false,
    });
    this.object = new THREE.Mesh(this.geometry, this.material);
    this.object.frustumCulled = false;
  }

  // Sets a convex polygon, as triangles that all have the first corner.
  setPolygon(corners: Vec3[], origin: Vec3): void {
    const triangles: Vec3[] = [];
    for (let i = 1; i + 1 < corners.length; ++i) triangles.push(corners[0], corners[i], corners[i + 1]);
    setPoints(this.geometry, triangles, origin);
  }
}

function setPoints(geometry: THREE.BufferGeometry, points: Vec3[], origin: Vec3): void {
  let attribute = geometry.getAttribute("position") as THREE.BufferAttribute | undefined;
  if (!attribute || attribute.count < points.length) {
    attribute = new THREE.BufferAttribute(new Float32Array(3 * points.length), 3);
    geometry.setAttribute("position", attribute);
  }
  points.forEach((p, i) => attribute.setXYZ(i, p[0] - origin[0], p[1] - origin[1], p[2] - origin[2]));
  attribute.needsUpdate = true;
  geometry.setDrawRange(0, points.length);
}

// Returns the edges of a closed polygon as pairs of points.
export function closed(corners: Vec3[]): Vec3[] {
  return corners.flatMap((corner, i) => [corner, corners[(i + 1) % corners.length]]);
}
