// SPDX-License-Identifier: Apache-2.0
// Pictures in which a click sets the focus.

import type { FrameCamera } from "../data/frame_camera";
import type { PickedFocus } from "../data/scene";
import { post } from "../data/source";
import { focusThrough } from "../data/tilted_focus";
import { byId, element } from "../element";
import { setAtTime, setFocusDistance } from "../path/set_at_time";
import type { State } from "../state";
import { length, percent, precise } from "../words";

export interface PickRequest {
  camera?: number; // the LF camera whose image was clicked; unset: the frame's picture was clicked
  x: number; // column of the clicked position, in pixels of the LF image or elements of the frame
  y: number; // its row
}

// Asks the server for the distance of the point at a position in a picture, and focuses on it.
//   isOfPlane  true: the point is one of three that define the focus plane, so that only the third changes the focus
export async function focusThere(state: State, request: PickRequest, isOfPlane: boolean): Promise<void> {
  // The values at the time of the click: the timeline may have moved on when the answer arrives.
  const { time, frame, camera } = state;
  state.say("Comparing LF images …");
  try {
    const picked = await post<PickedFocus>("focus", {
      path: state.path.id,
      frame: state.frame,
      ...request,
    });
    if (isOfPlane) return addToPlane(state, picked, time, frame, camera);
    let instead = "";
    const isTaken = state.edit("focus there", (document) => {
      instead = setFocusDistance(document, time, picked.focus_distance);
    });
    if (!isTaken) return;
    state.say(
      `Focused at ${length(picked.focus_distance)}${instead}, from ${picked.cameras.length} LF images ` +
        `(certain to ${percent(picked.certainty)})`,
    );
  } catch (error) {
    state.fail(error);
  }
}

// Stores a point of the focus plane. When there are three, tilts the focus plane so that it contains all of them.
function addToPlane(state: State, picked: PickedFocus, time: number, frame: number, camera: FrameCamera): void {
  const before = state.planePoints?.frame === frame ? state.planePoints.points : [];
  const points = [...before, picked.point];
  state.planePoints = points.length < 3 ? { frame, points } : null;
  if (points.length < 3)
    return state.say(`Point ${points.length} of 3 of the focus plane, at ${length(picked.focus_distance)}`);
  const plane = focusThrough(camera, points);
  if (!plane)
    return state.say(
      "These three points lie on a line, or on a plane that the lens cannot focus on: click three others.",
      true,
    );
  const { distance, horizontal_deg, vertical_deg } = plane;
  const isTaken = state.edit("tilt the focus plane", (document) => {
    setFocusDistance(document, time, distance);
    setAtTime(document, "focus_tilt", time, { horizontal: horizontal_deg, vertical: vertical_deg });
  });
  if (isTaken)
    state.say(
      `Focused through three points: at ${length(distance)}, tilted by ` +
        `${precise(horizontal_deg, 3)}° and ${precise(vertical_deg, 3)}°`,
    );
}

// Makes a picture clickable: a click marks the position and calls `pick` with it, as a position in a picture with the
// width and height that size() returns. isOfPlane is true for a click with Shift, which sets one of three points of a
// focus plane.
export function makePickable(
  frame: HTMLElement,
  size: () => [number, number],
  pick: (x: number, y: number, isOfPlane: boolean) => void,
): void {
  frame.classList.add("pickable");
  frame.title = "Click to focus there; Shift-click three places to tilt the focus plane through them";
  frame.addEventListener("click", (event) => {
    const box = frame.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width;
    const y = (event.clientY - box.top) / box.height;
    frame.querySelector(".mark")?.remove();
    frame.append(element("div", { class: "mark", style: `left:${100 * x}%;top:${100 * y}%` }));
    const [width, height] = size();
    pick(x * width, y * height, event.shiftKey);
  });
}

// Returns a button that enlarges the picture over the whole view, and at the next click puts it back.
export function enlargeButton(picture: HTMLElement): HTMLButtonElement {
  const place = document.createComment("");
  const button = element("button", { "aria-pressed": "false", title: "Esc: back" }, "Large");
  window.addEventListener("keydown", (event) => {
    if (event.key === "Escape" && picture.classList.contains("large")) button.click();
  });
  button.addEventListener("click", () => {
    const isLarge = picture.classList.toggle("large");
    button.setAttribute("aria-pressed", String(isLarge));
    if (isLarge) {
      picture.replaceWith(place);
      byId("space").append(picture);
    } else {
      place.replaceWith(picture);
    }
  });
  return button;
}
