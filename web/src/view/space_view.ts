// The light field and the render camera in space: drawn when something has changed, never else.

import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";

import { add, type FrameCamera } from "../data/frame_camera";
import type { CameraFacts, Vec3 } from "../data/scene";
import { cssColour } from "../element";
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
  private readonly size: number; // of the light field
  private pending = false;
  private frameCamera: FrameCamera | null = null;
  private through = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    positions: Float32Array,
    private readonly origin: Vec3,
    onPick: (id: number | null) => void,
  ) {
    this.renderer = new THREE.WebGLRenderer({ canvas, antialias: true });
    this.points = new LfPoints(positions);
    this.model = new RenderCameraModel(origin);
    this.size = extentOf(positions);
    this.ring = dots(11, 0xffffff);
    this.ring.visible = false;
    this.keyPoints = dots(7, 0xffffff);
    this.scene.add(
      this.points.object,
      this.model.object,
      this.path.object,
      this.keyPoints,
      this.chosen.object,
      this.chosenFace.object,
      this.ring,
    );
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.enableDamping = false;
    this.controls.addEventListener("change", () => this.draw());
    this.controls.addEventListener("start", () => (this.through = false));
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.listenForPicks(onPick);
    this.resize();
  }

  private listenForPicks(onPick: (id: number | null) => void): void {
    let down: [number, number] | null = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      down = [event.offsetX, event.offsetY];
    });
    this.canvas.addEventListener("pointerup", (event) => {
      // A drag turns the view.
      if (!down || Math.hypot(event.offsetX - down[0], event.offsetY - down[1]) > 3) return;
      onPick(
        this.points.pick(
          this.camera,
          this.canvas.clientWidth,
          this.canvas.clientHeight,
          event.offsetX,
          event.offsetY,
        ),
      );
    });
  }

  setTheme(isDark: boolean): void {
    this.renderer.setClearColor(new THREE.Color(cssColour("--space")));
    this.points.setTheme(isDark);
    this.model.setTheme(isDark);
    this.path.material.color.setHex(isDark ? 0xff5fa2 : 0xc2185b);
    (this.keyPoints.material as THREE.PointsMaterial).color.setHex(isDark ? 0xff5fa2 : 0xc2185b);
    this.chosen.material.color.setHex(isDark ? 0xffffff : 0x000000);
    this.chosenFace.material.color.setHex(isDark ? 0xffffff : 0x000000);
    (this.ring.material as THREE.PointsMaterial).color.setHex(isDark ? 0xffffff : 0x000000);
    this.draw();
  }

  setPath(cameras: FrameCamera[]): void {
    const corners = thinned(cameras.map((camera) => camera.centre), 4000);
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

  // The LF camera that is looked at: its frustum, as far as the focus plane.
  setChosen(facts: CameraFacts | null): void {
    this.ring.visible = facts !== null;
    this.chosen.object.visible = facts !== null;
    this.chosenFace.object.visible = facts !== null;
    if (facts) {
      const depth = 0.6 * (this.frameCamera?.focusDistance ?? this.size);
      const corners = facts.corners.map((direction) => add(facts.centre, direction, depth));
      this.chosen.set(
        [...corners.flatMap((corner) => [facts.centre, corner]), ...closed(corners)],
        this.origin,
      );
      this.chosenFace.setPolygon(corners, this.origin);
      placeDots(this.ring, [facts.centre], this.origin);
    }
    this.draw();
  }

  look(preset: Preset): void {
    const frame = this.frameCamera;
    if (!frame) return;
    this.through = preset === "through";
    const local = (p: Vec3) => new THREE.Vector3(...add(p, this.origin, -1));
    const up = new THREE.Vector3(...frame.up);
    const forward = new THREE.Vector3(...frame.forward);
    const right = new THREE.Vector3(...frame.right);
    const centre = local(frame.centre);
    const view = (2 * Math.atan(frame.height / 2 / frame.fy) * 180) / Math.PI;
    this.camera.fov = preset === "through" ? Math.min(100, view * 1.08) : 40;
    this.camera.up.copy(up);
    const target = centre.clone();
    const span = Math.max(this.size, 2.4 * frame.radius, 0.25 * frame.focusDistance);
    if (preset === "aperture") {
      const reach = Math.max(3.2 * frame.radius, this.size * 0.12);
      this.camera.position.copy(centre).addScaledVector(forward, -reach / 0.66);
    } else if (preset === "side" || preset === "top") {
      target.addScaledVector(forward, 0.45 * frame.focusDistance);
      const away = preset === "side" ? right.clone().negate() : up.clone();
      if (preset === "top") this.camera.up.copy(forward);
      this.camera.position
        .copy(target)
        .addScaledVector(away, 1.15 * Math.max(span, frame.focusDistance));
    } else if (preset === "through") {
      target.addScaledVector(forward, frame.focusDistance);
      this.camera.position.copy(centre).addScaledVector(forward, -0.02 * frame.focusDistance);
    } else {
      target.addScaledVector(forward, 0.42 * frame.focusDistance);
      this.camera.position
        .copy(centre)
        .addScaledVector(forward, -0.75 * Math.max(span, 0.6 * frame.focusDistance))
        .addScaledVector(right, -0.8 * Math.max(span, 0.6 * frame.focusDistance))
        .addScaledVector(up, 0.55 * Math.max(span, 0.6 * frame.focusDistance));
    }
    this.controls.target.copy(target);
    this.camera.updateProjectionMatrix();
    this.controls.update();
    this.draw();
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

  draw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      const distance = this.camera.position.distanceTo(this.controls.target);
      this.camera.near = Math.max(1e-6, distance * 1e-3);
      this.camera.far = distance * 50 + 20 * this.size;
      this.camera.updateProjectionMatrix();
      this.renderer.render(this.scene, this.camera);
    });
  }
}

function dots(size: number, colour: number): THREE.Points {
  const material = new THREE.PointsMaterial({ size, color: colour, sizeAttenuation: false });
  material.depthTest = false;
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

function extentOf(positions: Float32Array): number {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < positions.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], positions[i]);
    high[i % 3] = Math.max(high[i % 3], positions[i]);
  }
  const size = Math.hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]);
  return size > 0 ? size : 1;
}
