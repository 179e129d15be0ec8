// SPDX-License-Identifier: Apache-2.0
// Makes the parts of the live picture, and connects them.

import type { State } from "../state";
import { Comparison } from "./comparison";
import { ChosenPictures } from "./chosen_pictures";
import type { ExportedLive } from "./gl/exported_images";
import { ExportedPictures } from "./gl/exported_pictures";
import { GlPictures } from "./gl/gl_pictures";
import { GlRenderer } from "./gl/gl_renderer";
import { wishOf } from "./gl/wish";
import { LensPanel } from "./lens_panel";
import { LiveCamera } from "./live_camera";
import { LiveTools } from "./live_tools";
import { LiveView } from "./live_view";
import { ServerPictures, type Pictures } from "./pictures";

export interface Live {
  view: LiveView;
  camera: LiveCamera;
  panel: LensPanel;
  comparison: Comparison;
  // Handles a key while the live picture is shown. Returns false if the key has no meaning here.
  key(event: KeyboardEvent): boolean;
}

//   root         receives the picture
//   exported     the LF images of an exported page; null if there is a server
//   panelRoot    receives the panel of the lens
//   stopPlaying  is called when the camera is changed by hand
export function startLive(
  root: HTMLElement,
  panelRoot: HTMLElement,
  state: State,
  exported: ExportedLive | null,
  stopPlaying: () => void,
): Live {
  const camera = new LiveCamera(state, stopPlaying);
  const view = new LiveView(root, state, camera, picturesOf(state, exported));
  const comparison = new Comparison(state, view, camera);
  const tools = new LiveTools(state, camera, view.box);
  const panel = new LensPanel(panelRoot, { state, camera, view, tools, comparison, refused: exported?.refused ?? "" });
  const key = (event: KeyboardEvent): boolean => {
    const name = event.key.toLowerCase();
    if (name === "e") panel.togglePeaking();
    else if (name === "a") panel.toggleComparison();
    else return tools.key(event);
    return true;
  };
  return { view, camera, panel, comparison, key };
}

function picturesOf(state: State, exported: ExportedLive | null): Pictures {
  const loaded = () => state.emit("live");
  if (exported) return new ExportedPictures(exported, loaded);
  const path = () => state.path;
  const open = (lost: () => void) => new GlPictures(GlRenderer.open(lost), path, loaded);
  return new ChosenPictures(new ServerPictures(path), wishOf(location.search), open, loaded);
}
