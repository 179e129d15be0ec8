// Makes the parts of the live picture, and connects them.

import type { State } from "../state";
import { Comparison } from "./comparison";
import { LensPanel } from "./lens_panel";
import { LiveCamera } from "./live_camera";
import { LiveTools } from "./live_tools";
import { LiveView } from "./live_view";

export interface Live {
  view: LiveView;
  camera: LiveCamera;
  panel: LensPanel;
  comparison: Comparison;
  // Handles a key while the live picture is shown. Returns false if the key has no meaning here.
  key(event: KeyboardEvent): boolean;
}

//   root         receives the picture
//   panelRoot    receives the panel of the lens
//   stopPlaying  is called when the camera is changed by hand
export function startLive(root: HTMLElement, panelRoot: HTMLElement, state: State, stopPlaying: () => void): Live {
  const camera = new LiveCamera(state, stopPlaying);
  const view = new LiveView(root, state, camera);
  const comparison = new Comparison(state, view, camera);
  const tools = new LiveTools(state, camera, view.box);
  const panel = new LensPanel(panelRoot, { state, camera, view, tools, comparison });
  const key = (event: KeyboardEvent): boolean => {
    const name = event.key.toLowerCase();
    if (name === "e") panel.togglePeaking();
    else if (name === "a") panel.toggleComparison();
    else return tools.key(event);
    return true;
  };
  return { view, camera, panel, comparison, key };
}
