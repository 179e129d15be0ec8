// SPDX-License-Identifier: Apache-2.0
// The colours in which LF cameras are drawn, by their use, on a dark and on a light background. Uses differ not only in
// hue, but also in brightness and size.

export interface UseStyle {
  name: string; // as in USES (data/frame_use.ts); the last is "other"
  label: string;
  help: string;
  dark: [number, number, number];
  light: [number, number, number];
  size: number; // diameter of the point, CSS pixels
}

export const USE_STYLES: UseStyle[] = [
  {
    name: "used",
    label: "Collected",
    help: "pixels of this LF image become rays of the frame; the brighter the point, the larger their share",
    dark: [255, 170, 50],
    light: [200, 90, 0],
    size: 6,
  },
  {
    name: "outside",
    label: "Stands outside",
    help: "stands where no ray through lens and sensor plate passes",
    dark: [92, 98, 112],
    light: [150, 154, 164],
    size: 2.5,
  },
  {
    name: "angle",
    label: "Looks elsewhere",
    help: "looks along another direction than --max-angle allows",
    dark: [172, 120, 235],
    light: [120, 60, 190],
    size: 3.5,
  },
  {
    name: "sees-none",
    label: "Sees none of it",
    help: "stands where rays of the frame may pass, but no pixel of its LF image sees both lens and filmed region",
    dark: [70, 180, 190],
    light: [0, 120, 135],
    size: 3.5,
  },
  {
    name: "limit",
    label: "Beyond the limit",
    help: "comes after the first --max-images of the order, or is not in the package",
    dark: [225, 90, 120],
    light: [190, 30, 70],
    size: 3.5,
  },
  {
    name: "no-weight",
    label: "Of no weight",
    help: "is farther from every point of the lens than another LF camera",
    dark: [140, 150, 90],
    light: [110, 120, 40],
    size: 3.5,
  },
  {
    name: "other",
    label: "In another frame",
    help: "not in this frame, but in others of the film",
    dark: [80, 130, 215],
    light: [40, 90, 190],
    size: 3.5,
  },
];
