// SPDX-License-Identifier: Apache-2.0
// The dialogs of the page: the commands that make this film, the list of keys, and a question to be confirmed.

import { byId, element } from "./element";
import type { State } from "./state";

function open(...children: (HTMLElement | string)[]): HTMLDialogElement {
  const dialog = byId<HTMLDialogElement>("dialog");
  dialog.replaceChildren(...children);
  if (!dialog.open) dialog.showModal();
  return dialog;
}

const closeButton = () =>
  element(
    "div",
    { class: "row" },
    element("button", { click: () => byId<HTMLDialogElement>("dialog").close() }, "Close"),
  );

// Copies the text. The label of the button then says whether it was copied, because a browser may refuse.
async function copyText(text: string, button: HTMLElement): Promise<void> {
  try {
    await navigator.clipboard.writeText(text);
    button.textContent = "Copied";
  } catch {
    button.textContent = "The browser refuses to copy: select the text";
  }
}

export function showCommands(state: State): void {
  const { commands } = state.scene;
  const blocks: [string, string][] = [
    ["What it will take: images, bytes, rays, memory, time", commands.forecast],
    ["On this machine", commands.render],
    ["In packages, for several machines (lfsubmit, Slurm)", commands.packages],
  ];
  if (state.density?.copies_px && commands.densify)
    blocks.push(["With virtual LF images, because LF cameras stand far apart", commands.densify]);
  open(
    element("h2", {}, "Commands that make this film"),
    state.isChanged ? element("p", { class: "bad" }, "The path has changes that are not saved: save it first.") : "",
    ...blocks.flatMap(([label, text]) => {
      const copy = element("button", {}, "Copy");
      copy.addEventListener("click", () => void copyText(text, copy));
      return [
        element("div", { class: "row", style: "justify-content:space-between" }, label, copy),
        element("pre", {}, text),
      ];
    }),
    closeButton(),
  );
}

const KEYS: [string, string][] = [
  ["Space", "play, pause"],
  ["← →", "one frame back or on; with Shift, ten"],
  ["Home End", "first and last frame"],
  ["[ ]", "previous and next LF image that this frame takes"],
  ["1 … 5", "views: overview, aperture, side, top, through the lens"],
  ["L", "the live picture, or back to the view in space"],
  ["K", "add a key of the focus distance at this frame"],
  ["P", "render a small preview of this frame"],
  ["D", "show or hide the points of depth files (--depth)"],
  ["X", "focus on the point in the middle of the view in space"],
  ["Ctrl+Z, Ctrl+Shift+Z", "undo, redo"],
  ["Ctrl+S", "save the path"],
  ["?", "these keys"],
];

const LIVE_KEYS: [string, string][] = [
  [", .", "focus nearer or farther"],
  ["− +", "close or open the aperture"],
  ["C", "the mouse moves the camera, or works the lens again"],
  ["Arrows", "then orbit round the point in focus; with Shift, slide; Page Up and Page Down dolly"],
  ["E", "focus peaking: colour the edges that are in focus"],
  ["A", "keep this picture as A and compare with it, or end the comparison"],
  ["Esc", "forget a drag that has not ended"],
];

function keyTable(keys: [string, string][]): HTMLElement {
  const row = ([key, what]: [string, string]) =>
    element("tr", {}, element("td", {}, element("kbd", {}, key)), element("td", {}, what));
  return element("table", {}, ...keys.map(row));
}

export function showKeys(): void {
  open(
    element("h2", {}, "Keys"),
    keyTable(KEYS),
    element("h2", {}, "In the live picture"),
    keyTable(LIVE_KEYS),
    element(
      "p",
      { class: "muted" },
      "In space: drag to turn, wheel to come nearer, right button to shift, click an LF camera " +
        "to see its image, or a point of the depths to focus on it. In pictures: click to focus there, Shift-click three " +
        "places to tilt the focus plane through them. In the timeline: drag keys.",
    ),
    closeButton(),
  );
}

export function ask(question: string, yes: string): Promise<boolean> {
  return new Promise((resolve) => {
    const dialog = open(
      element("p", {}, question),
      element(
        "div",
        { class: "row" },
        element("button", { click: () => dialog.close() }, "Cancel"),
        element("button", { class: "primary", click: () => dialog.close("yes") }, yes),
      ),
    );
    dialog.returnValue = "";
    dialog.addEventListener("close", () => resolve(dialog.returnValue === "yes"), { once: true });
  });
}
