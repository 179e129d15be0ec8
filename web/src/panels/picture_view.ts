// A picture that a person may click to focus there.

import type { PickedFocus } from "../data/scene";
import { post } from "../data/source";
import { byId, element } from "../element";
import type { State } from "../state";
import { length, percent } from "../words";

export interface PickRequest {
  camera?: number; // an LF camera; else the frame
  x: number;
  y: number;
}

// Asks for the distance of what is seen there, and focuses on it from this frame on: at a key of
// the focus if there are keys, else all the film long.
export async function focusThere(state: State, request: PickRequest): Promise<void> {
  const { time } = state; // of the frame that was clicked, wherever the timeline is by then
  state.say("Comparing LF images …");
  try {
    const picked = await post<PickedFocus>("focus", {
      path: state.path.id,
      frame: state.frame,
      ...request,
    });
    let instead = "";
    const isTaken = state.edit("focus there", (document) => {
      const focus = document.quantity("focus_distance");
      if (!focus.given || focus.hasAccelerations) instead = ", instead of how the focus was given";
      if (!focus.given) document.useFocusDistance(picked.focus_distance);
      else if (focus.keyframes.length > 0)
        document.setKeyframe("focus_distance", time, picked.focus_distance);
      else if (focus.hasAccelerations) document.removeMotion("focus_distance", picked.focus_distance);
      else document.setBase("focus_distance", picked.focus_distance);
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

// Calls `pick` with the place in the picture's own coordinates, and marks it.
export function makePickable(
  frame: HTMLElement,
  size: () => [number, number],
  pick: (x: number, y: number) => void,
): void {
  frame.classList.add("pickable");
  frame.title = "Click to focus there";
  frame.addEventListener("click", (event) => {
    const box = frame.getBoundingClientRect();
    const x = (event.clientX - box.left) / box.width;
    const y = (event.clientY - box.top) / box.height;
    frame.querySelector(".mark")?.remove();
    frame.append(element("div", { class: "mark", style: `left:${100 * x}%;top:${100 * y}%` }));
    const [width, height] = size();
    pick(x * width, y * height);
  });
}

// A button that shows the picture over the whole space, and back.
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
