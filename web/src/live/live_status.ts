// SPDX-License-Identifier: Apache-2.0
// The line below the live picture: the lens, the LF images of the picture, the share of the lens that was recorded, and
// a warning of double edges.

import { fNumber, type FrameCamera } from "../data/frame_camera";
import { countsOf, USES, type FrameUse } from "../data/frame_use";
import type { LiveFacts } from "../data/live_picture";
import type { DensityFacts } from "../data/scene";
import { element } from "../element";
import type { State } from "../state";
import { bytes, byteSize, length, millimetres, percent, plural, precise, shortNumber } from "../words";
import { displacements, levelOf, type Displacement, type Level } from "./double_edges";

const LEAST_RECORDED = 0.9; // share of the lens below which the line warns, as the panel of the frame does

export function apertureText(camera: FrameCamera, unit_m: number): string {
  if (camera.radius === 0) return "pinhole";
  return `f/${precise(fNumber(camera), 3)}, ${millimetres(2 * camera.radius, unit_m)}`;
}

//   isWhole  true: the picture is a still one of the path's camera at this frame, with virtual LF images
export function statusOf(state: State, camera: FrameCamera, facts: LiveFacts, isWhole: boolean): HTMLElement[] {
  const { unit_m } = state.path;
  const parts = [
    part("lens", `${apertureText(camera, unit_m)} · focus ${length(camera.focusDistance)}`),
    part("images", imagesText(facts, unit_m)),
  ];
  const isLoading = facts.done < facts.wanted;
  const { use } = state;
  const difference = isWhole && !isLoading && use?.frame === state.frame ? differenceText(facts, use) : null;
  if (difference) parts.push(part("difference", difference, "none", DIFFERENCE_HELP));
  const isLacking = 1 - facts.uncovered_share < LEAST_RECORDED && !isLoading;
  // Without lens weights, neither the spacing of the LF images nor their share of the lens is known.
  if (facts.images > 0 && facts.camera_distance > 0)
    parts.push(part("recorded", recordedText(facts), isLacking ? "gentle" : "none"));
  if (isLoading) parts.push(part("loading", `loading ${shortNumber(facts.done)} of ${shortNumber(facts.wanted)}`));
  if (facts.wanted < facts.needed) parts.push(part("memory", memoryText(facts), "gentle", MEMORY_HELP));
  if (facts.first_broken) parts.push(part("broken", brokenText(facts), "loud", BROKEN_HELP));
  if (facts.camera_distance > 0 && camera.radius > 0) {
    const all = displacements(camera, facts.camera_distance, state.scene.light_field.depths);
    const worst = all.reduce((a, b) => (b.elements > a.elements ? b : a));
    const level = levelOf(worst.elements);
    if (level !== "none") parts.push(part("edges", edgesText(worst, level), level, EDGES_HELP));
  }
  const copies = copiesText(state.density, state.scene.commands.densify, state.isChanged);
  if (copies)
    parts.push(element("span", { "data-part": "copies", "data-level": "gentle", title: COPIES_HELP }, copies));
  return parts;
}

const COPIES_HELP =
  "LF cameras stand too far apart for this lens, so that what is out of focus appears as copies. The live picture does " +
  "not make virtual LF images. The command makes them, and renders the film with them.";

// Says which command fills the lens with virtual LF images; null if they would not help, or cannot be made.
export function copiesText(density: DensityFacts | null, command: string, isChanged: boolean): string | null {
  if (!density?.copies_px || !command) return null;
  const saved = isChanged ? "save the path, and then " : "";
  return `copies ${precise(density.copies_px, 2)} elements apart: ${saved}${command} fills the lens`;
}

const EDGES_HELP =
  "How far apart neighbouring LF images show the same point. Up to about one element looks like blur, more than four " +
  "look like double edges.";

const MEMORY_HELP =
  "The picture is made of the LF images that fit the memory limit, spread over the lens. Start lfvisualizer with a " +
  "larger --live-memory, make the window smaller, or close the aperture.";

const BROKEN_HELP = "LF images that could not be loaded are tried again after five seconds, when the picture changes.";

function part(name: string, text: string, level = "none", title: string | null = null): HTMLElement {
  return element("span", { "data-part": name, "data-level": level, title }, text);
}

// A quick picture states how many LF images it has, of those in memory that it could take. A still picture states the
// LF images that a frame would use: LF images in memory without a weight do not count.
function imagesText({ images, takeable, used, camera_distance }: LiveFacts, unit_m: number): string {
  const spacing = camera_distance > 0 ? `, spacing ${millimetres(camera_distance, unit_m)}` : "";
  if (images < takeable) return `${shortNumber(images)} of ${shortNumber(takeable)} LF images${spacing}`;
  return `${shortNumber(used)} ${used === 1 ? "LF image" : "LF images"}${spacing}`;
}

const DIFFERENCE_HELP =
  "A frame is made of the LF images that the options of lfvisualizer and its packages allow, and of all that the lens " +
  "sees. The live picture obeys neither --max-images nor --max-angle, and has memory for a limited number of LF images.";

// Says how many LF images the frame takes if the live picture has another number, and why; null if both are equal.
export function differenceText({ used, wanted, needed, broken }: LiveFacts, use: FrameUse): string | null {
  const ofFrame = use.ids.length;
  if (used === ofFrame) return null;
  const counts = countsOf(use);
  const reasons: string[] = [];
  if (counts[USES.indexOf("limit")] > 0) reasons.push("limited by --max-images or its package");
  if (counts[USES.indexOf("angle")] > 0) reasons.push("limited by --max-angle");
  if (used < ofFrame && wanted < needed) reasons.push("because memory is limited");
  if (used < ofFrame && broken > 0) reasons.push("broken ones included");
  if (reasons.length === 0) reasons.push("because the film has another size than this picture");
  return `the frame takes ${shortNumber(ofFrame)}, ${reasons.join(", ")}`;
}

function recordedText({ uncovered_share }: LiveFacts): string {
  return `${percent(1 - uncovered_share)} of the lens recorded`;
}

export function memoryText({ wanted, needed, memory_bytes, image_bytes }: LiveFacts): string {
  const counts = `${shortNumber(wanted)} of ${shortNumber(needed)} LF images`;
  return `${counts}: memory limit ${bytes(memory_bytes)}; all need --live-memory ${byteSize(needed * image_bytes)}`;
}

function brokenText({ broken, first_broken }: LiveFacts): string {
  return broken > 0 ? `${plural(broken, "LF image")} broken: ${first_broken}` : first_broken;
}

function edgesText({ elements, depth }: Displacement, level: Level): string {
  const where = Number.isFinite(depth) ? `at depth ${length(depth)}` : "at infinity";
  return `${level === "loud" ? "double edges" : "slight double edges"}: ${precise(elements, 2)} elements ${where}`;
}
