// SPDX-License-Identifier: Apache-2.0
// Types of the JSON data that the page reads: scene.json and the others (doc/formats/page_data.md).

export type Vec3 = [number, number, number];

export interface PathHead {
  id: string;
  frames: number; // number of frames
  first_frame: number; // number of the first one
  shown_step: number; // distance between two shown frames (PathFrames); 1: all are shown
  fps: number;
  unit_m: number;
  width: number;
  height: number;
  widest_radius: number; // radius of the widest opening of all frames; 0 unless blades turn as the lens closes
  transmission?: string; // of the lens, as a path file states it; missing if there is none
}

// Returns the number of the last frame.
export function lastFrame(path: PathHead): number {
  return path.first_frame + path.frames - 1;
}

// The data of the event that the path's file has changed.
export interface PathNews {
  id: string;
  fault: string; // why the file is no valid path; "" if it is one
}

// A depth map or a point cloud; its points are in depth/N.bin.
export interface DepthFacts {
  name: string;
  points: number;
  points_in_file: number;
  unknown: number; // elements of a depth map without a depth
  has_confidence: boolean;
  has_colours: boolean;
  spread: number; // distance of neighbouring points, divided by their distance from the camera
  centre?: Vec3; // of the camera that sees the points, relative to the origin; missing: not known
}

export interface SceneFacts {
  version: string;
  light_field: {
    name: string;
    images: number;
    unit_m: number;
    origin: Vec3;
    depths?: [number, number];
    virtual_ranges?: [number, number][]; // ids of virtual LF images, as [begin, end]; missing: there are none
  };
  path: PathHead;
  path_file: string;
  commands: { forecast: string; render: string; packages: string; densify: string }; // of a POSIX shell, one a line
  packages: { name: string; frames: number[] }[];
  packages_note: string;
  watch: string;
  server: boolean;
  depths?: DepthFacts[]; // missing: there are none
}

// Facts about the shown frames (PathFrames).
export interface FilmFacts {
  done: number;
  total: number;
  images: number[];
  rays: number[];
}

export interface DensityFacts {
  cameras_in_lens: number;
  camera_distance: number | null;
  uncovered_share: number;
  fitting_aperture: number;
  least_aperture: number | null;
  depths: [number, number | null];
  depths_known: boolean;
  near_displacement_px: number | null;
  far_displacement_px: number | null;
  copies_px: number | null; // distance of copies, if virtual LF images would help; otherwise null
}

export interface CameraFacts {
  id: number;
  name: string;
  centre: Vec3;
  forward: Vec3;
  up: Vec3;
  corners: Vec3[];
  width: number;
  height: number;
  focal_px: number;
  distorted: boolean;
  virtual: boolean;
}

export interface OverlapFacts {
  rect?: [number, number, number, number];
  outlines: [number, number][][];
}

export interface RenderFacts {
  folder: string;
  frames: { frame: number; finished: boolean; changed: string; changed_s: number }[];
}

export interface PickedFocus {
  point: Vec3;
  focus_distance: number;
  certainty: number;
  cameras: number[];
}
