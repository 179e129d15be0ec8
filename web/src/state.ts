// SPDX-License-Identifier: Apache-2.0
// The state of the page: the light field, the path as edited so far, the current frame, and the chosen LF camera. Views
// listen to its changes, and make all changes through it.

import { readFrames, type FrameCamera } from "./data/frame_camera";
import { readFrameUse, type FrameUse } from "./data/frame_use";
import {
  lastFrame,
  type CameraFacts,
  type DensityFacts,
  type FilmFacts,
  type PathHead,
  type PathNews,
  type RenderFacts,
  type SceneFacts,
  type Vec3,
} from "./data/scene";
import { getBytes, getJson, getText, post, SourceError } from "./data/source";
import { History } from "./path/history";
import { PathDocument } from "./path/path_document";
import { PathFrames } from "./path_frames";

export type Change =
  | "path" // a new valid path: the cameras of all frames may differ
  | "text" // the text of the path, valid or not
  | "frame"
  | "use" // it is known now which LF cameras the current frame uses
  | "film"
  | "density"
  | "selected"
  | "watch"
  | "preview"
  | "live" // LF images have been loaded for live pictures
  | "exposure"
  | "saving" // the text is about to be saved: typed text must be taken over now
  | "theme"
  | "message";

export interface PreviewFacts {
  frame: number;
  state: "rendering" | "finished" | "stopped" | "failed";
  message: string;
  changed: string;
}

const MOST_USES_BYTES = 96 << 20; // largest size of the kept use data of visited frames

export class State {
  path!: PathHead;
  frames: PathFrames | null = null; // null before open()
  frame = 1;
  use: FrameUse | null = null;
  density: DensityFacts | null = null;
  film: FilmFacts | null = null;
  framesOfCamera: Uint16Array | null = null;
  selected: CameraFacts | null = null;
  watch: RenderFacts | null = null;
  preview: PreviewFacts | null = null;
  exposure = 0; // brightening of all pictures of frames, stops
  message: { text: string; isError: boolean } | null = null;
  document!: PathDocument;
  history!: History;
  invalid: string | null = null; // why the text is no valid path; null if it is valid, or not checked
  unchecked: string | null = null; // why lfvisualizer has not checked the text; null if it has, or is about to
  isPlaying = false;
  addsKeys = false; // PathDocument.addsKeys of all edits
  isLive = false; // true while the live picture is shown
  isDark = true;

  private savedText = "";
  private shownText = ""; // text of the path whose cameras `frames` has
  // The points of the focus plane that were clicked so far in `frame`. Three points define the plane.
  planePoints: { frame: number; points: Vec3[] } | null = null;
  private savedId = "";
  private readonly listeners = new Map<Change, (() => void)[]>();
  private uses = new Map<string, ArrayBuffer>();
  private usesBytes = 0;
  private checking = 0;
  private taking = 0;
  private wanted = 1; // the frame that was chosen; `frame` follows when its camera is known
  private isLoadingFrame = false;
  private isSaving = false;
  private broken: string | null = null; // why the typed text is no YAML; null if it is
  // A new version of the file that is not shown because there are unsaved edits; null: none.
  private news: PathNews | null = null;
  private fileHasFault = false;
  private bytesThatSavingLoses = false;
  private selectedId: number | null = null; // the chosen LF camera; `selected` follows when its facts arrive
  private filmAsked = "";
  private filmIsStale = false;

  constructor(
    readonly scene: SceneFacts,
    readonly positions: Float32Array,
  ) {}

  on(changes: Change[], listener: () => void): void {
    for (const change of changes) this.listeners.set(change, [...(this.listeners.get(change) ?? []), listener]);
  }

  emit(change: Change): void {
    for (const listener of this.listeners.get(change) ?? []) listener();
  }

  say(text: string, isError = false): void {
    this.message = text ? { text, isError } : null;
    this.emit("message");
  }

  fail(error: unknown): void {
    this.say(error instanceof Error ? error.message : String(error), true);
  }

  get camera(): FrameCamera {
    return this.frames!.camera(this.frame)!;
  }
  // Cameras of the shown frames.
  get cameras(): FrameCamera[] {
    return this.frames?.shown ?? [];
  }
  get time(): number {
    return (this.frame - this.path.first_frame) / this.path.fps;
  }
  get lastFrame(): number {
    return lastFrame(this.path);
  }
  // Returns the number of the frame nearest to a time in seconds.
  frameAt(time: number): number {
    return this.path.first_frame + Math.round(time * this.path.fps);
  }
  // True if `frames` are those of the document as it is now.
  get isShown(): boolean {
    return this.shownText === this.document.text();
  }
  get isChanged(): boolean {
    return this.document.text() !== this.savedText;
  }

  // ------------------------------------------------------------------------------------ the path

  async open(): Promise<void> {
    const bytes = await getBytes(`path/${this.scene.path.id}/path.yaml`);
    const text = new TextDecoder().decode(bytes);
    this.bytesThatSavingLoses = text.includes("\uFFFD");
    this.savedText = text;
    this.savedId = this.scene.path.id;
    this.history = new History(text);
    this.document = PathDocument.parse(text, this.scene.light_field.unit_m);
    await this.take(this.scene.path, text);
    this.emit("text");
  }

  private async take(head: PathHead, text: string): Promise<void> {
    const number = ++this.taking;
    const frames = new PathFrames(head, readFrames(await getBytes(`path/${head.id}/frames.bin`)));
    const frame = () => Math.max(head.first_frame, Math.min(this.wanted, lastFrame(head)));
    while (number === this.taking && !frames.camera(frame())) await frames.load(frame());
    if (number !== this.taking) return; // a later edit was faster
    this.path = head;
    this.shownText = text;
    this.frames = frames;
    this.wanted = this.frame = frame();
    this.film = null;
    this.emit("path");
    await this.askFrame();
    void this.askFilm();
  }

  // Calls `change`, which edits the document and may throw. Then sends the text to the server, where the parser of the
  // programs checks it.
  //   merge  true: this edit and the previous one with the same label are one undo step
  // Returns false, and shows the error, if `change` threw.
  edit(label: string, change: (document: PathDocument) => void, merge = false): boolean {
    this.document.addsKeys = this.addsKeys;
    try {
      change(this.document);
    } catch (error) {
      this.fail(error);
      return false;
    }
    this.history.push(this.document.text(), label, { merge });
    void this.check();
    return true;
  }

  undo(): void {
    this.travel(this.history.undo());
  }
  redo(): void {
    this.travel(this.history.redo());
  }
  private travel(text: string | null | undefined): void {
    if (typeof text !== "string") return;
    this.document = PathDocument.parse(text, this.scene.light_field.unit_m);
    void this.check();
  }

  // Sets the document to a text that a person has typed. Returns false if it is no YAML; the document is then
  // unchanged.
  setText(text: string): boolean {
    try {
      this.document = PathDocument.parse(text, this.scene.light_field.unit_m);
    } catch (error) {
      ++this.checking; // pending answers are about another text
      this.broken = error instanceof Error ? error.message : String(error);
      this.invalid = this.broken;
      this.unchecked = null;
      this.emit("text");
      return false;
    }
    this.history.push(text, "edit the text", { merge: true });
    void this.check();
    return true;
  }

  private async check(): Promise<void> {
    const number = ++this.checking;
    const text = this.document.text();
    this.broken = null;
    this.emit("text");
    try {
      const head = await post<PathHead>("check", { text });
      if (number !== this.checking) return;
      this.invalid = null;
      this.unchecked = null;
      if (this.message?.isError) this.say("");
      if (head.id !== this.path.id) await this.take(head, text);
      else this.shownText = text;
    } catch (error) {
      if (number !== this.checking) return;
      const message = error instanceof Error ? error.message : String(error);
      // The parser's messages come with status 200. Any other status, such as a refusal, tells nothing about the text.
      const isOfParser = error instanceof SourceError && error.status === 200;
      this.invalid = isOfParser ? message : null;
      this.unchecked = isOfParser ? null : message;
      if (this.unchecked) this.say(`This edit was not checked: ${message}`, true);
    }
    this.emit("text");
    if (this.news && !this.isChanged) void this.fileHasChanged(this.news);
  }

  // Sends the text again if it has not been checked, for example because lfvisualizer could not be reached.
  checkAgain(): void {
    if (this.unchecked) void this.check();
  }

  async save(force = false): Promise<"saved" | "changed" | "failed"> {
    if (this.broken) {
      this.say(`Not saved: ${this.broken}`, true);
      return "failed";
    }
    if (this.bytesThatSavingLoses) {
      this.say(
        `Not saved: ${this.scene.path_file} has bytes that are no UTF-8, which would be ` +
          "lost. Convert it first, such as by iconv, and load this page again.",
        true,
      );
      return "failed";
    }
    const text = this.document.text();
    this.isSaving = true;
    try {
      const answer = await post<{ id: string }>("save", { text, expected: this.savedId, force });
      this.savedText = text;
      this.savedId = answer.id;
      this.news = null;
      this.say(`Saved ${this.scene.path_file}`);
      this.emit("text");
      return "saved";
    } catch (error) {
      if (error instanceof SourceError && error.isConflict) return "changed";
      this.fail(error);
      return "failed";
    } finally {
      this.isSaving = false;
    }
  }

  // Handles an event: another program has changed the path's file. Shows the new text, unless it has a fault or there
  // are unsaved edits; then only says that the file has changed.
  async fileHasChanged(news: PathNews): Promise<void> {
    this.news = null;
    if (news.id === this.savedId && this.fileHasFault) this.say("");
    this.fileHasFault = news.id !== this.savedId && news.fault !== "";
    if (news.id === this.savedId || this.isSaving) return;
    const what = `${this.scene.path_file} has been changed by another program`;
    if (news.fault) return this.say(`${what}, and has a fault: ${news.fault}`, true);
    try {
      const text = this.isChanged ? "" : await getText(`path/${news.id}/path.yaml`);
      if (this.isChanged) {
        this.news = news;
        return this.say(`${what}. Your edits here are not saved: Save asks before it writes over the file.`);
      }
      this.document = PathDocument.parse(text, this.scene.light_field.unit_m);
      this.history.push(text, "what another program wrote");
      this.savedText = text;
      this.savedId = news.id;
      await this.check();
      this.say(`${what}: this is what it says now.`);
    } catch (error) {
      this.fail(error);
    }
  }

  // ----------------------------------------------------------------------------------- the frame

  setFrame(frame: number): void {
    let wanted = Math.max(this.path.first_frame, Math.min(this.lastFrame, Math.round(frame)));
    // An export has the shown frames only.
    if (!this.scene.server) wanted = this.frames!.frameOf(this.frames!.indexOf(wanted));
    if (wanted === this.wanted) return;
    this.wanted = wanted;
    if (this.frames!.camera(wanted)) this.showFrame(wanted);
    else void this.loadFrame();
  }

  // Goes `count` frames forward, or back if it is negative. In an export, `count` is a number of shown frames.
  step(count: number): void {
    const { frames, scene, wanted } = this;
    this.setFrame(scene.server ? wanted + count : frames!.frameOf(Math.max(0, frames!.indexOf(wanted) + count)));
  }

  private async loadFrame(isSecond = false): Promise<void> {
    if (this.isLoadingFrame) return; // the running call ends with the newest frame
    this.isLoadingFrame = true;
    let isForgotten = false;
    try {
      while (!this.frames!.camera(this.wanted)) await this.frames!.load(this.wanted);
      if (this.wanted !== this.frame) this.showFrame(this.wanted);
    } catch (error) {
      // Status 410: the server has forgotten the path, so the text is sent again.
      isForgotten = error instanceof SourceError && error.status === 410 && !isSecond;
      if (!isForgotten) this.fail(error);
      if (!isForgotten) this.wanted = this.frame;
    } finally {
      this.isLoadingFrame = false;
    }
    if (isForgotten) await this.check().then(() => this.loadFrame(true));
  }

  private showFrame(frame: number): void {
    this.frame = frame;
    this.emit("frame");
    // While the film is played live, the server computes pictures only.
    if (!(this.isPlaying && this.isLive)) void this.askFrame();
  }

  private async bytesOfUse(frame: number): Promise<ArrayBuffer> {
    const name = `path/${this.path.id}/use/${frame}.bin`;
    const known = this.uses.get(name);
    if (known) return known;
    const bytes = await getBytes(name);
    this.uses.set(name, bytes);
    this.usesBytes += bytes.byteLength;
    for (const [old, oldBytes] of this.uses) {
      if (this.usesBytes <= MOST_USES_BYTES || old === name) break;
      this.uses.delete(old);
      this.usesBytes -= oldBytes.byteLength;
    }
    return bytes;
  }

  async askFrame(isSecond = false): Promise<void> {
    const { frame, path } = this;
    const isStill = () => frame === this.frame && path === this.path;
    try {
      const bytes = await this.bytesOfUse(frame);
      if (!isStill()) return;
      this.use = readFrameUse(frame, bytes);
      this.emit("use");
      const density = await getJson<DensityFacts>(`path/${path.id}/density/${frame}.json`);
      if (!isStill()) return;
      this.density = density;
      this.emit("density");
    } catch (error) {
      // Status 410: the server has forgotten the path, so the text is sent again.
      if (error instanceof SourceError && error.status === 410 && !isSecond)
        void this.check().then(() => (isStill() ? this.askFrame(true) : undefined));
      else if (isStill()) this.fail(error);
    }
  }

  async askFilm(): Promise<void> {
    const { id } = this.path;
    // If a request runs already, its answer may be out of date, so the request is repeated afterwards.
    this.filmIsStale = this.filmAsked === id;
    if (this.filmIsStale) return;
    this.filmAsked = id;
    try {
      const film = await getJson<FilmFacts>(`path/${id}/film.json`);
      const counts = await getBytes(`path/${id}/film.bin`);
      if (id !== this.path.id) return;
      this.film = film;
      this.framesOfCamera = new Uint16Array(counts);
      this.emit("film");
    } catch {
      // The curves stay empty. Shows no message, because the request of the frame's data shows the error.
    } finally {
      if (this.filmAsked === id) this.filmAsked = "";
      if (this.filmIsStale) void this.askFilm();
    }
  }

  // ------------------------------------------------------------------------------- the LF camera

  async select(id: number | null): Promise<void> {
    this.selectedId = id;
    if (id === null) {
      this.selected = null;
      this.emit("selected");
      return;
    }
    try {
      const selected = await getJson<CameraFacts>(`camera/${id}.json`);
      if (id !== this.selectedId) return;
      this.selected = selected;
      this.emit("selected");
    } catch (error) {
      if (id !== this.selectedId) return;
      if (this.scene.server) this.fail(error);
      else this.say("The exported page has no image of this LF camera.");
    }
  }

  // Chooses the next or previous LF camera, by ids, among those that the frame uses.
  selectNext(step: number): void {
    const ids = this.use ? [...this.use.ids].sort((a, b) => a - b) : [];
    if (ids.length === 0) return;
    const current = this.selectedId ?? -1;
    const at = ids.indexOf(current);
    const next = at < 0 ? 0 : (at + step + ids.length) % ids.length;
    void this.select(ids[next]);
  }
}
