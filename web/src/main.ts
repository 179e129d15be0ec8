// SPDX-License-Identifier: Apache-2.0
// Assembles the page of lfvisualizer and connects its parts.

import type { PathNews, RenderFacts, SceneFacts, Vec3 } from "./data/scene";
import { getBytes, getJson, listen, receivedBytes } from "./data/source";
import { ask, showCommands, showKeys } from "./dialogs";
import { byId, element } from "./element";
import { DepthLayer } from "./depth_layer";
import { Legend } from "./legend";
import type { ExportedLive } from "./live/gl/exported_images";
import { startLive, type Live } from "./live/live";
import { EditPanel } from "./panels/edit_panel";
import { FramePanel } from "./panels/frame_panel";
import { ImagePanel } from "./panels/image_panel";
import { RenderPanel } from "./panels/render_panel";
import { setEasedKey } from "./path/eases";
import { State, type PreviewFacts } from "./state";
import { Timeline } from "./timeline";
import { SpaceView, type Preset } from "./view/space_view";
import { plural } from "./words";

const PRESETS: [Preset, string][] = [
  ["overview", "Overview"],
  ["aperture", "Aperture"],
  ["side", "Side"],
  ["top", "Top"],
  ["through", "Through the lens"],
];

interface Panel {
  shown(): void;
}

async function start(): Promise<void> {
  const scene = await getJson<SceneFacts>("scene.json");
  const positions = new Float32Array(await getBytes("cameras.bin"));
  const exported = scene.server ? null : await getJson<ExportedLive>("live.json");
  const state = new State(scene, positions);
  document.title = `${scene.light_field.name} — lfvisualizer`;
  byId("what").textContent =
    `${scene.light_field.name} · ${plural(scene.light_field.images, "LF image")} · ${scene.path_file}`;

  const { origin, virtual_ranges: virtualRanges = [] } = scene.light_field;
  let depths: DepthLayer | null = null;
  const select = (id: number | null) => {
    void state.select(id);
    if (id !== null) show("image");
  };
  const canvas = byId<HTMLCanvasElement>("scene");
  const view = new SpaceView(canvas, positions, virtualRanges, origin, select, (place) => depths?.focusOn(place));
  new Legend(byId("legend"), state, view);
  const timeline = new Timeline(state);
  const { show, panels } = makeTabs(state, timeline, exported);
  const look = wireViews(state, view, panels.live, show);
  wireSpace(state, view);
  wireButtons(state);
  if (scene.depths) depths = new DepthLayer(byId("depths"), state, view, panels.live, scene.depths);
  wireKeys(state, timeline, panels, show, look, depths);
  wireMessages(state);
  wireTheme(state, view);
  await state.open();
  if (scene.server) wireNews(state);
  if (scene.packages_note) state.say(scene.packages_note);
  view.look("overview");
  state.emit("theme");
  await depths?.load();
  // Measurements (bench/) and tests read this object.
  Object.assign(window, { lfvisualizer: { state, view, live: panels.live, depths, receivedBytes } });
  document.body.dataset.ready = "yes";
}

interface Panels {
  render: RenderPanel;
  live: Live;
}

function makeTabs(
  state: State,
  timeline: Timeline,
  exported: ExportedLive | null,
): { show: (name: string) => void; panels: Panels } {
  const section = () => element("section", { role: "tabpanel", hidden: true });
  const roots = { frame: section(), image: section(), edit: section(), lens: section(), render: section() };
  byId("panels").append(...Object.values(roots));
  const render = new RenderPanel(roots.render, state);
  const live = startLive(byId("live"), roots.lens, state, exported, () => timeline.stop());
  const panels: Record<string, [string, HTMLElement, Panel]> = {
    frame: ["Frame", roots.frame, new FramePanel(roots.frame, state)],
    image: ["LF image", roots.image, new ImagePanel(roots.image, state)],
    edit: ["Path", roots.edit, new EditPanel(roots.edit, state)],
    lens: ["Lens", roots.lens, live.panel],
    render: ["Render", roots.render, render],
  };
  const buttons = new Map<string, HTMLElement>();
  const show = (wanted: string) => {
    for (const [name, [, root, panel]] of Object.entries(panels)) {
      root.hidden = name !== wanted;
      buttons.get(name)!.setAttribute("aria-selected", String(name === wanted));
      if (name === wanted) panel.shown();
    }
  };
  for (const [name, [label]] of Object.entries(panels)) {
    const button = element("button", { role: "tab", "data-tab": name, click: () => show(name) }, label);
    buttons.set(name, button);
    byId("tabs").append(button);
  }
  show(state.scene.watch ? "render" : "frame");
  return { show, panels: { render, live } };
}

type View = Preset | "live" | "space"; // "space": the view in space as it was before the live picture

// Makes the buttons of the views. Returns a function that chooses a view.
function wireViews(state: State, space: SpaceView, live: Live, show: (name: string) => void): (view: View) => void {
  const views: [View, string][] = [...PRESETS];
  if (live.panel.isUsable) views.unshift(["live", "Live picture"]);
  const buttons = new Map<View, HTMLElement>();
  const look = (view: View) => {
    const isLive = view === "live";
    byId("space").classList.toggle("live", isLive);
    buttons.get("live")?.setAttribute("aria-pressed", String(isLive));
    space.show(!isLive);
    if (isLive !== state.isLive) live.view.show(isLive);
    if (isLive) show("lens");
    else if (view !== "space") space.look(view);
  };
  for (const [view, label] of views) {
    const button = element("button", { "data-view": view, click: () => look(view) }, label);
    buttons.set(view, button);
    byId("views").append(button);
  }
  return look;
}

function wireSpace(state: State, view: SpaceView): void {
  const keyPlaces = () => {
    const places: Vec3[] = [];
    try {
      const position = state.document.quantity("position");
      for (const key of position.keyframes) places.push(key.value as Vec3);
      if (position.baseIsKey) places.push(position.base as Vec3);
    } catch {
      // The text is being edited, and is not valid at the moment: there are no key points.
    }
    view.setKeyPoints(places);
  };
  state.on(["path"], () => {
    view.setPath(state.cameras);
    view.setFrame(state.camera);
    keyPlaces();
  });
  state.on(["frame"], () => view.setFrame(state.camera));
  state.on(["use", "film"], () => {
    if (state.use) view.points.setUse(state.use, state.framesOfCamera);
    const empty = byId("empty");
    empty.hidden = !state.use || state.use.ids.length > 0;
    empty.textContent = `Frame ${state.frame} takes no LF image: it will be black.`;
    view.draw();
  });
  state.on(["density"], () => {
    view.model.setDensity(state.camera, state.density);
    view.draw();
  });
  state.on(["selected"], () => view.setChosen(state.selected));
}

async function save(state: State): Promise<void> {
  state.emit("saving");
  if ((await state.save()) !== "changed") return;
  const isSure = await ask(
    `${state.scene.path_file} has been changed by another program since it was opened here. ` + "Write over it?",
    "Write over it",
  );
  if (isSure) await state.save(true);
}

function wireButtons(state: State): void {
  byId("edit-buttons").hidden = !state.scene.server;
  const undo = byId<HTMLButtonElement>("undo");
  const redo = byId<HTMLButtonElement>("redo");
  const saving = byId<HTMLButtonElement>("save");
  undo.addEventListener("click", () => state.undo());
  redo.addEventListener("click", () => state.redo());
  saving.addEventListener("click", () => void save(state));
  byId("commands").addEventListener("click", () => showCommands(state));
  byId("help").addEventListener("click", showKeys);
  state.on(["text"], () => {
    undo.disabled = !state.history.canUndo;
    redo.disabled = !state.history.canRedo;
    undo.title = `Undo ${state.history.undoLabel ?? ""} (Ctrl+Z)`;
    redo.title = `Redo ${state.history.redoLabel ?? ""} (Ctrl+Shift+Z)`;
    saving.disabled = !state.isChanged || state.invalid !== null;
    saving.textContent = state.isChanged ? "Save ●" : "Save";
  });
  window.addEventListener("beforeunload", (event) => {
    if (state.scene.server && state.isChanged) event.preventDefault();
  });
}

function wireKeys(
  state: State,
  timeline: Timeline,
  { render, live }: Panels,
  show: (name: string) => void,
  look: (view: View) => void,
  depths: DepthLayer | null,
): void {
  const plain: Record<string, (event: KeyboardEvent) => void> = {
    " ": () => timeline.toggle(),
    ArrowLeft: (event) => state.step(event.shiftKey ? -10 : -1),
    ArrowRight: (event) => state.step(event.shiftKey ? 10 : 1),
    Home: () => state.setFrame(state.path.first_frame),
    End: () => state.setFrame(state.lastFrame),
    "[": () => (show("image"), state.selectNext(-1)),
    "]": () => (show("image"), state.selectNext(1)),
    "?": () => showKeys(),
    k: () =>
      state.edit("add a key of focus distance", (path) =>
        setEasedKey(path, "focus_distance", state.time, state.camera.focusDistance),
      ),
    p: () => (show("render"), void render.start()),
    l: () => look(state.isLive ? "space" : "live"),
  };
  if (depths) {
    plain.d = () => depths.toggle();
    plain.x = () => state.isLive || depths.focusOnMiddle();
  }
  PRESETS.forEach(([preset], i) => (plain[String(i + 1)] = () => look(preset)));
  window.addEventListener("keydown", (event) => {
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (event.ctrlKey || event.metaKey) {
      if (!state.scene.server || byId<HTMLDialogElement>("dialog").open) return;
      const isText = event.target instanceof HTMLTextAreaElement;
      if (key === "s") void save(state);
      else if (key === "z" && event.shiftKey && !isText) state.redo();
      else if (key === "z" && !isText) state.undo();
      else if (key === "y" && !isText) state.redo();
      else return;
      event.preventDefault();
      return;
    }
    const target = event.target as HTMLElement;
    const isTyped = /^(INPUT|TEXTAREA|SELECT)$/.test(target.tagName) && target.id !== "scrub";
    if (event.altKey || isTyped || byId<HTMLDialogElement>("dialog").open) return;
    // If a button has the focus, the browser presses it with the space bar.
    if (key === " " && target.tagName === "BUTTON") return;
    if (!state.scene.server && "kp".includes(key)) return;
    if (!live.panel.isUsable && key === "l") return;
    if (state.isLive && live.key(event)) return event.preventDefault();
    const action = plain[key];
    if (!action) return;
    event.preventDefault();
    action(event);
  });
}

function wireMessages(state: State): void {
  const box = byId("message");
  let timer = 0;
  state.on(["message"], () => {
    clearTimeout(timer);
    box.hidden = state.message === null;
    if (!state.message) return;
    box.className = state.message.isError ? "error" : "";
    box.replaceChildren(
      state.message.text,
      element("button", { click: () => state.say(""), "aria-label": "Close" }, "✕"),
    );
    if (!state.message.isError) timer = window.setTimeout(() => state.say(""), 6000);
  });
}

function wireTheme(state: State, view: SpaceView): void {
  const wished = window.matchMedia("(prefers-color-scheme: dark)");
  let chosen: string | null = null;
  try {
    chosen = localStorage.getItem("lfvisualizer-theme");
  } catch {
    // The browser does not allow storage: the theme of the system is used.
  }
  const apply = () => {
    state.isDark = chosen ? chosen === "dark" : wished.matches;
    document.documentElement.dataset.theme = state.isDark ? "dark" : "light";
    view.setTheme(state.isDark);
    state.emit("theme");
  };
  wished.addEventListener("change", apply);
  byId("theme").addEventListener("click", () => {
    chosen = state.isDark ? "light" : "dark";
    try {
      localStorage.setItem("lfvisualizer-theme", chosen);
    } catch {
      // The browser does not allow storage: the choice lasts until the page is closed.
    }
    apply();
  });
  apply();
}

function wireNews(state: State): void {
  const link = byId("link");
  let wasGone = false;
  listen(
    {
      watch: (data) => {
        state.watch = JSON.parse(data) as RenderFacts;
        state.emit("watch");
      },
      preview: (data) => {
        state.preview = JSON.parse(data) as PreviewFacts;
        state.emit("preview");
      },
      live: () => state.emit("live"),
      film: (data) => {
        if ((JSON.parse(data) as { path: string }).path === state.path.id) void state.askFilm();
      },
      path: (data) => void state.fileHasChanged(JSON.parse(data) as PathNews),
      poses: (data) => state.say((JSON.parse(data) as { warning: string }).warning, true),
    },
    (isThere) => {
      link.textContent = isThere ? "" : "lfvisualizer has been ended";
      link.className = isThere ? "" : "bad";
      if (isThere && wasGone) {
        void state.askFrame();
        state.checkAgain();
        state.emit("live");
      }
      wasGone = !isThere;
    },
  );
}

start().catch((error: unknown) => {
  const box = byId("message");
  box.hidden = false;
  box.className = "error";
  box.textContent = error instanceof Error ? error.message : String(error);
});
