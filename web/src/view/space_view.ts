// SPDX-License-Identifier: Apache-2.0
// Shows the light field and the render camera in 3D. Draws only when something has changed.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { add, focusPoint, type FrameCamera } from "../data/frame_camera";
import type { CameraFacts, Vec3 } from "../data/scene";
import { cssColour } from "../element";
import type { DepthCloud, PickedPoint } from "./depth_cloud";
import { LfPoints } from "./lf_points";
import { closed, Faces, Lines } from "./lines";
import { RenderCameraModel } from "./render_camera_model";

export type Preset = "overview" | "aperture" | "side" | "top" | "through";

export class SpaceView {
  readonly points: LfPoints;
  readonly model: RenderCameraModel;
  private readonly renderer: THREE.WebGLRenderer;
  private readonly scene = new THREE.Scene();
  private readonly camera = new THREE.PerspectiveCamera(40, 1, 0.001, 1000);
  private readonly controls: OrbitControls;
  private readonly path = new Lines(0.95);
  private readonly keyPoints: THREE.Points;
  private readonly chosen = new Lines(1);
  private readonly chosenFace = new Faces(0.12);
  private readonly ring: THREE.Points;
  private readonly mark: THREE.Points; // the point of the depths that was picked last
  private clouds: DepthCloud[] = [];
  private readonly size: number; // diagonal of the box around all LF cameras, world units
  private readonly spacing: number; // approximate distance between neighbouring LF cameras, world units
  private pending = false;
  private isShown = true;
  private frameCamera: FrameCamera | null = null;
  private through = false;
  private isDark = true;
  private showsChosen = true; // true: also the frustum of the chosen LF camera is drawn

  constructor(
    private readonly canvas: HTMLCanvasElement,
    positions: Float32Array,
    virtualRanges: [number, number][],
    private readonly origin: Vec3,
    onPick: (id: number | null) => void,
    onPickPlace: (place: Vec3) => void,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.points = new LfPoints(positions, virtualRanges);
    this.points.object.geometry.computeBoundingSphere();
    this.points.object.geometry.computeBoundingBox();
    this.model = new RenderCameraModel(origin);
    this.size = extentOf(positions);
    // The spacing is computed as if the LF cameras filled a square. LF cameras in a volume look denser on the screen.
    this.spacing = (0.7 * this.size) / Math.max(1, Math.sqrt(positions.length / 3) - 1);
    this.ring = dots(11, 0xffffff);
    this.ring.visible = false;
    this.mark = dots(9, 0xffffff);
    this.mark.visible = false;
    this.keyPoints = dots(7, 0xffffff);
    this.scene.add(
      this.points.object,
      this.model.object,
      this.path.object,
      this.keyPoints,
      this.chosen.object,
      this.chosenFace.object,
      this.ring,
      this.mark,
    );
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => (this.through = false));
    new ResizeObserver(() => this.resize()).observe(canvas);
    // When the browser gives a lost graphics context back, three.js uploads everything with the next drawing, but has
    // forgotten the colour of the background. Its own listener comes first, because it was added first.
    canvas.addEventListener("webglcontextrestored", () => this.setTheme(this.isDark));
    this.listenForPicks(onPick, onPickPlace);
    this.resize();
  }

  private listenForPicks(onPick: (id: number | null) => void, onPickPlace: (place: Vec3) => void): void {
    let down: [number, number] | null = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      down = [event.offsetX, event.offsetY];
    });
    this.canvas.addEventListener("pointerup", (event) => {
      // A drag turns the view, and its end must not choose an LF camera.
      if (!down || Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) > 3) return;
      const { clientWidth, clientHeight } = this.canvas;
      const point = this.pickPoint(event.offsetX, event.offsetY);
      // In front of a surface, an LF camera must be hit more exactly.
      const reach = point ? 6 : 12;
      const id = this.points.pick(this.camera, clientWidth, clientHeight, event.offsetX, event.offsetY, reach);
      if (point && (id === null || this.aheadOf(id) > point.ahead)) onPickPlace(point.place);
      else onPick(id);
    });
  }

  // Returns the foremost point of the depths at a position in the view.
  private pickPoint(x: number, y: number): PickedPoint | null {
    const { clientWidth, clientHeight } = this.canvas;
    // The camera may have moved since the last drawing, which is what brings its matrices up to date.
    this.camera.updateMatrixWorld();
    const picked = this.clouds.map((cloud) => cloud.pick(this.camera, clientWidth, clientHeight, x, y));
    return picked.reduce((best, one) => (one && (!best || one.ahead < best.ahead) ? one : best), null);
  }

  private aheadOf(id: number): number {
    const place = new THREE.Vector3().fromArray(this.points.positions, 3 * id);
    return -place.applyMatrix4(this.camera.matrixWorldInverse).z;
  }

  // Shows the points of depth files.
  setClouds(clouds: DepthCloud[]): void {
    this.scene.remove(...this.clouds.map((cloud) => cloud.object));
    this.clouds = clouds;
    this.scene.add(...clouds.map((cloud) => cloud.object));
    this.draw();
  }

  // Returns the point of the depths in the middle of the view, relative to the origin; null if there is none.
  pointInMiddle(): Vec3 | null {
    return this.pickPoint(this.canvas.clientWidth / 2, this.canvas.clientHeight / 2)?.place ?? null;
  }

  // Marks a place, relative to the origin.
  markPoint(place: Vec3): void {
    placeDots(this.mark, [place], [0, 0, 0]);
    this.mark.visible = true;
    this.draw();
  }

  setTheme(isDark: boolean): void {
    this.isDark = isDark;
    this.renderer.setClearColor(new THREE.Color(cssColour("--space")));
    this.points.setTheme(isDark);
    this.model.setTheme(isDark);
    this.path.material.color.setHex(isDark ? 0xff5fa2 : 0xc2185b);
    (this.keyPoints.material as THREE.PointsMaterial).color.setHex(isDark ? 0xff5fa2 : 0xc2185b);
    this.chosen.material.color.setHex(isDark ? 0xffffff : 0x000000);
    this.chosenFace.material.color.setHex(isDark ? 0xffffff : 0x000000);
    (this.ring.material as THREE.PointsMaterial).color.setHex(isDark ? 0xffffff : 0x000000);
    (this.mark.material as THREE.PointsMaterial).color.setHex(isDark ? 0x63d68a : 0x0a7f3a);
    this.draw();
  }

  setPath(cameras: FrameCamera[]): void {
    const corners = thinned(
      cameras.map((camera) => camera.centre),
      4000,
    );
    const segments: Vec3[] = [];
    for (let i = 0; i + 1 < corners.length; ++i) segments.push(corners[i], corners[i + 1]);
    this.path.set(segments, this.origin);
    this.draw();
  }

  setKeyPoints(places: Vec3[]): void {
    placeDots(this.keyPoints, places, this.origin);
    this.draw();
  }

  setFrame(camera: FrameCamera): void {
    this.frameCamera = camera;
    this.model.set(camera, this.size * 0.004);
    if (this.through) this.look("through");
    this.draw();
  }

  // Marks the chosen LF camera, and draws its frustum, 0.6 focus distances long; null removes both.
  setChosen(facts: CameraFacts | null): void {
    this.ring.visible = facts !== null;
    this.showChosen();
    if (facts) {
      const depth = 0.6 * (this.frameCamera?.focusDistance ?? this.size);
      const corners = facts.corners.map((direction) => add(facts.centre, direction, depth));
      this.chosen.set([...corners.flatMap((corner) => [facts.centre, corner]), ...closed(corners)], this.origin);
      this.chosenFace.setPolygon(corners, this.origin);
      placeDots(this.ring, [facts.centre], this.origin);
    }
    this.draw();
  }

  private showChosen(): void {
    this.chosen.object.visible = this.chosenFace.object.visible = this.ring.visible && this.showsChosen;
  }

  look(preset: Preset): void {
    const frame = this.frameCamera;
    if (!frame) return;
    this.through = preset === "through";
    const up = new THREE.Vector3(...frame.up);
    const forward = new THREE.Vector3(...frame.forward);
    const right = new THREE.Vector3(...frame.right);
    const centre = new THREE.Vector3(...add(frame.centre, this.origin, -1));
    // In the view of the aperture, the focus plane and the frustum would hide the LF cameras in the lens.
    this.model.showFocus(preset !== "aperture");
    this.showsChosen = preset !== "aperture";
    this.showChosen();
    this.camera.fov = 40;
    this.camera.up.copy(up);
    let target = centre.clone();
    if (preset === "through") {
      const view = (2 * Math.atan(frame.height / 2 / frame.fy) * 180) / Math.PI;
      this.camera.fov = Math.min(100, view * 1.08);
      target.addScaledVector(forward, frame.focusDistance);
      this.camera.position.copy(centre).addScaledVector(forward, -0.02 * frame.focusDistance);
    } else if (preset === "aperture") {
      const reach = Math.max(1.5 * frame.radius, this.size * 0.06);
      this.camera.position.copy(centre).addScaledVector(forward, -this.distanceFor(reach));
    } else if (preset === "overview") {
      // Looks from behind the lens, from the nearest distance at which all LF cameras and the focus plane are in the
      // view.
      this.camera.fov = 50;
      target.addScaledVector(forward, 0.3 * frame.focusDistance);
      const offset = centre
        .clone()
        .sub(target)
        .addScaledVector(forward, -1.1 * this.size)
        .addScaledVector(right, 1.1 * this.size)
        .addScaledVector(up, 0.6 * this.size);
      this.camera.updateProjectionMatrix();
      offset.multiplyScalar(0.3);
      for (let i = 0; i < 60; ++i) {
        this.camera.position.copy(target).add(offset);
        this.camera.lookAt(target);
        this.camera.updateMatrixWorld();
        if (this.everything(frame).every((corner) => isWithin(corner, this.camera))) break;
        offset.multiplyScalar(1.06);
      }
    } else {
      if (preset === "top") this.camera.up.copy(forward);
      const sphere = new THREE.Box3().setFromPoints(this.everything(frame)).getBoundingSphere(new THREE.Sphere());
      target = sphere.center;
      this.camera.position
        .copy(target)
        .addScaledVector(
          preset === "side" ? right : up,
          this.distanceFor(0.9 * sphere.radius) * (preset === "side" ? -1 : 1),
        );
    }
    this.controls.target.copy(target);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
  }

  // Returns the distance at which a sphere of this radius just fits into the view.
  private distanceFor(radius: number): number {
    const half = (this.camera.fov * Math.PI) / 360;
    const narrower = Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect));
    return radius / Math.sin(narrower);
  }

  // Returns the corners of the box around all LF cameras, and of the part of the focus plane that the frame shows.
  private everything(frame: FrameCamera): THREE.Vector3[] {
    const box = this.points.object.geometry.boundingBox!;
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(
      (i) =>
        new THREE.Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z),
    );
    for (const [x, y] of [
      [0, 0],
      [frame.width, 0],
      [frame.width, frame.height],
      [0, frame.height],
    ])
      corners.push(new THREE.Vector3(...add(focusPoint(frame, x, y), this.origin, -1)));
    return corners;
  }

  private distanceToField(): number {
    const sphere = this.points.object.geometry.boundingSphere;
    const middle = sphere ? sphere.center : new THREE.Vector3();
    return Math.max(1e-6, this.camera.position.distanceTo(middle));
  }

  resize(): void {
    const width = Math.max(1, this.canvas.clientWidth);
    const height = Math.max(1, this.canvas.clientHeight);
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(width, height, false);
    this.points.setPixelRatio(ratio);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  // Draws nothing until it is shown again.
  show(isShown: boolean): void {
    this.isShown = isShown;
    this.draw();
  }

  // Requests a redraw at the next refresh of the screen.
  draw(): void {
    if (this.pending || !this.isShown) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.render();
    });
  }

  render(): void {
    const distance = this.camera.position.distanceTo(this.controls.target);
    this.camera.near = Math.max(1e-6, distance * 1e-3);
    this.camera.far = distance * 50 + 20 * this.size;
    this.camera.updateProjectionMatrix();
    const pixelsPerUnit =
      this.canvas.clientHeight / (2 * Math.tan((this.camera.fov * Math.PI) / 360) * this.distanceToField());
    this.points.setSpacing(this.spacing * pixelsPerUnit);
    const ratio = this.renderer.getPixelRatio();
    const pixels = (ratio * this.canvas.clientHeight) / (2 * Math.tan((this.camera.fov * Math.PI) / 360));
    for (const cloud of this.clouds) cloud.setScale(pixels, ratio);
    this.renderer.render(this.scene, this.camera);
  }
}

// Returns true if a point is in the view, with a margin. The far plane is ignored, because render() sets it beyond
// everything that is drawn.
function isWithin(point: THREE.Vector3, camera: THREE.Camera): boolean {
  const isBefore = point.clone().applyMatrix4(camera.matrixWorldInverse).z < 0;
  const seen = point.clone().project(camera);
  return isBefore && Math.abs(seen.x) < 0.96 && Math.abs(seen.y) < 0.94;
}

// Returns round points that are drawn in front of everything else.
function dots(size: number, colour: number): THREE.Points {
  const material = new THREE.PointsMaterial({ size, color: colour, sizeAttenuation: false });
  material.depthTest = false;
  material.onBeforeCompile = (shader) => {
    shader.fragmentShader = shader.fragmentShader.replace(
      "#include <clipping_planes_fragment>",
      "if (length(gl_PointCoord - 0.5) > 0.5) discard;\n#include <clipping_planes_fragment>",
    );
  };
  const points = new THREE.Points(new THREE.BufferGeometry(), material);
  points.frustumCulled = false;
  points.renderOrder = 1;
  return points;
}

function placeDots(points: THREE.Points, places: Vec3[], origin: Vec3): void {
  const numbers = places.flatMap((place) => add(place, origin, -1));
  points.geometry.setAttribute("position", new THREE.Float32BufferAttribute(numbers, 3));
}

function thinned<T>(all: T[], most: number): T[] {
  const step = Math.ceil(all.length / most);
  return step <= 1 ? all : all.filter((_, i) => i % step === 0 || i === all.length - 1);
}

// Returns the diagonal of the box around all positions; 1 if they are one point.
export function extentOf(positions: Float32Array): number {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  const size = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  return size > 0 ? size : 1;
}
